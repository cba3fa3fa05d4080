//! What blocks are made of: their arithmetic, their registers, and what they share in `rtl/` (multipliers, widths between stages, cycles of parts).
//!
//! The counts stand beside each block ([`Block::parts`](super::Block::parts)), as formulas in the widths of its types; `tests/hardware/registers.rs` holds the registers
//! against those that the RTL declares, and against the netlists of `docs/hardware.md`.

mod divide;
mod multiplier;
mod registers;

pub(super) use divide::DivisorMultiples;
pub use multiplier::{EDGE_PRODUCT_STAGES, LIMB, cross_product_latency, dot_product_latency, multiplier_latency};
pub(super) use multiplier::{Multiplier, cross_product, dot_product};
pub use registers::Registers;

use super::Form;
use crate::num::{Direction, EdgeState, Point, START_BITS, Wire};

/// What a block is made of and an operation of it does: each comparison is a sum, each step of a shifter a selection.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Parts {
    /// Products of an operation: how many, bits of one factor, bits of the other.
    pub products: Vec<[u32; 3]>,
    /// Bits added or compared in an operation.
    pub add_bits: u32,
    /// Bits selected, one of two, in an operation.
    pub select_bits: u32,
    /// Registers.
    pub registers: Registers,
}

/// Bits of the tag of a block that stands alone, as in `docs/hardware.md` and in the tests: the RTL's default.
pub const TAG: u32 = 8;

/// Edge functions and det, positive: |p x q| |d| < 2^96.
pub const EDGE_FUNCTION: u32 = 96;
/// Numerator of t, positive: |a| |b| |c| < 2^98.4.
pub const T_NUMERATOR: u32 = 99;

impl Form {
    /// A coordinate without the bits that are always 0.
    pub const fn coordinate(&self) -> u32 {
        Point::WIDTH / 3 - self.coordinate_zeros
    }

    /// Difference of two coordinates.
    pub const fn relative(&self) -> u32 {
        self.coordinate() + 1
    }

    /// Component of p x q: |p_i q_j| < 2^64, and two of them.
    pub const fn normal(&self) -> u32 {
        2 * self.relative()
    }

    /// A component of a direction.
    pub const fn component(&self) -> u32 {
        Direction::WIDTH / 3 - self.direction_zeros
    }

    /// Edge function with its sign, below 2^96 in steps of the bits that are always 0.
    pub const fn signed_edge(&self) -> u32 {
        EDGE_FUNCTION + 1 - 2 * self.coordinate_zeros - self.direction_zeros
    }

    /// Numerator of t with its sign, likewise below 2^98.4.
    pub const fn signed_t(&self) -> u32 {
        T_NUMERATOR + 1 - 3 * self.coordinate_zeros
    }

    /// Registers of the products of p x q with d, and of those with a beside them: so many that both take as long.
    pub const fn edge_product_stages(&self) -> [u32; 2] {
        let [d, a] = [dot_product_latency(self.normal(), self.component()), dot_product_latency(self.normal(), self.relative())];
        let longest = if d > a { d } else { a };
        [EDGE_PRODUCT_STAGES + longest - d, EDGE_PRODUCT_STAGES + longest - a]
    }

    /// Cycles of `edge_function`: p x q, and its product with d.
    pub const fn edge_function_latency(&self) -> u32 {
        let [with_d, _] = self.edge_product_stages();
        cross_product_latency(self.relative()) + with_d - 1 + dot_product_latency(self.normal(), self.component())
    }
}

/// Component of p x q of an exact start in steps of 2^-31, signed: |p x q| < 2^65.6 units.
pub const EXACT_NORMAL: u32 = 98;
/// d.(p x q) likewise: below 2^96 units.
pub const EXACT_EDGE: u32 = EDGE_FUNCTION + START_BITS + 1;
/// a.(b x c) likewise: below 2^98.4 units.
pub const EXACT_T: u32 = T_NUMERATOR + START_BITS + 1;
/// Registers of the products of the exact p x q, likewise of those with a beside them, which take as long.
pub const START_PRODUCT_STAGES: u32 = 2;
/// Cycles of `start_edge`: two cross products, their sum, and its product with d.
pub const START_EDGE_LATENCY: u32 =
    cross_product_latency(Form::FULL.relative()) + 1 + START_PRODUCT_STAGES - 1 + dot_product_latency(EXACT_NORMAL, Form::FULL.component());

/// l = (p - x).d / 2^30 of the LOD test, signed: below 2^62.8 and its fraction dropped.
pub const DISTANCE: u32 = Form::FULL.relative() + Form::FULL.component() - 30;
/// D of the LOD test, clamped to this width.
pub const TOLERANCE: u32 = 34;

/// Cycles of `entry_distance`: factors, products, the shift, and the largest of three.
pub const ENTRY_DISTANCE_LATENCY: u32 = 5;
/// Cycles of `tri_decide`: signs, decision, numbers.
pub const TRI_DECIDE_LATENCY: u32 = 3;
/// Cycles of `cone_tolerance`: factors, l slope, the sum, a shift in two steps, the clamp.
pub const CONE_TOLERANCE_LATENCY: u32 = 1 + multiplier_latency(DISTANCE, 18) + 4;
/// Cycles of `edge_opening`: the comparison, and a step of division for each bit of s below 1.
pub const EDGE_OPENING_LATENCY: u32 = 1 + EdgeState::WIDTH - 1;
