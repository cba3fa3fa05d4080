//! Hit mapping: a point of a coarse triangle to the full-resolution triangle and barycentrics (paper sections 3.6 and 5, figures 7 and 10).
//!
//! `levels` times: if b_k > 1/2 for one k: child k, b_k = 2 b_k - 1 and the others doubled; else child 3 and each b = 1 - 2b. Exactly
//! 1/2 goes to the centre. The sum stays 1 exactly and no memory is read.
//! Legal: b0 + b1 + b2 = 2^31, levels 0 to 10, node below 4^(10 - levels).

use super::parts::{Parts, Registers, TAG};
use super::{Block, Form, Timing};
use crate::num::{BARY_ONE, Bary, MAX_LEVELS, U, Wire, wire_struct};

/// Number of a node within its level: 4^10 at most.
pub type NodeIndex = U<20>;

wire_struct! {
    /// Input of [`BaryMap`].
    pub struct In {
        /// Levels to go down: N - n.
        levels: U<4>,
        /// Node on level n.
        node: NodeIndex,
        /// Weight of p0.
        b0: Bary,
        /// Weight of p1.
        b1: Bary,
        /// Weight of p2.
        b2: Bary,
    }
}

wire_struct! {
    /// Output of [`BaryMap`].
    pub struct Out {
        /// Node on level N.
        node: NodeIndex,
        /// Weight of its corner 0.
        b0: Bary,
        /// Weight of its corner 1.
        b1: Bary,
        /// Weight of its corner 2.
        b2: Bary,
    }
}

/// The block.
pub struct BaryMap;

/// One level: child number and its coordinates.
#[inline(always)]
fn step(b: [u64; 3]) -> (u64, [u64; 3]) {
    const HALF: u64 = BARY_ONE / 2;
    // At most one exceeds one half, because they add up to one.
    match (0..3).zip(0u64..).find(|&(k, _): &(usize, u64)| b[k] > HALF) {
        Some((k, child)) => {
            let mut out = b.map(|c| 2 * c);
            out[k] -= BARY_ONE;
            (child, out)
        }
        None => (3, b.map(|c| BARY_ONE - 2 * c)),
    }
}

impl Block for BaryMap {
    const NAME: &'static str = "bary_map";
    const TIMING: Timing = Timing::pipelined(MAX_LEVELS);
    type In = In;
    type Out = Out;
    /// A stage a level.
    fn timing(form: &Form) -> Timing {
        Timing::pipelined(form.levels)
    }
    fn parts(form: &Form) -> Parts {
        let (levels, left) = (form.levels, 4);
        let stage = Registers::stage(left + 2 * levels + 3 * Bary::WIDTH + TAG);
        Parts {
            products: vec![],
            // Of each level: above a half, 1 - 2b; and one of three.
            add_bits: levels * (3 * (Bary::WIDTH - 1) + 3 * Bary::WIDTH),
            select_bits: levels * 2 * 3 * Bary::WIDTH,
            // Behind the last no level is left.
            registers: (levels * stage).without(left),
        }
    }
    #[inline]
    fn eval(input: &In) -> Out {
        let mut b = [input.b0.get(), input.b1.get(), input.b2.get()];
        let mut node = input.node.get();
        for _ in 0..input.levels.get() {
            let (child, next) = step(b);
            node = node << 2 | child;
            b = next;
        }
        let [b0, b1, b2] = b.map(Bary::new);
        Out { node: NodeIndex::new(node), b0, b1, b2 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn one_half_goes_to_the_centre_and_corners_keep_their_order() {
        let half = BARY_ONE / 2;
        assert_eq!(step([half, half, 0]), (3, [0, 0, BARY_ONE]));
        assert_eq!(step([half + 1, half - 1, 0]), (0, [2, BARY_ONE - 2, 0]));
        assert_eq!(step([0, BARY_ONE, 0]), (1, [0, BARY_ONE, 0]));
        assert_eq!(step([0, 0, BARY_ONE]), (2, [0, 0, BARY_ONE]));
    }

    proptest! {
        #[test]
        fn the_sum_stays_one_and_the_point_stays(x in 0..=BARY_ONE, y in 0..=BARY_ONE, levels in 0u32..=10) {
            let (b1, b2) = (x.min(y), x.max(y) - x.min(y));
            let b0 = BARY_ONE - b1 - b2;
            let u = |v| Bary::new(v);
            let out = BaryMap::eval(&In { levels: U::new(u64::from(levels)), node: U::ZERO, b0: u(b0), b1: u(b1), b2: u(b2) });
            let b = [out.b0.get(), out.b1.get(), out.b2.get()];
            prop_assert_eq!(b.iter().sum::<u64>(), BARY_ONE);
            // Position in the lattice of 2^levels steps, scaled by 2^31: exact.
            let corners = crate::mesh::lattice::node(levels, levels, out.node.get() as u32);
            let at = |f: fn((u32, u32)) -> u32| (0..3).map(|k| u64::from(f(corners[k])) * b[k]).sum::<u64>();
            prop_assert_eq!(at(|c| c.0), b1 << levels);
            prop_assert_eq!(at(|c| c.1), b2 << levels);
        }
    }
}
