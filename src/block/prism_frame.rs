//! A node and a ray in the node's local space, as the prisms of its children are tested (docs/numbers.md, "Prisms").
//!
//! The axis along which the ray moves most becomes z, the next ones x and y; axes are mirrored so that d >= 0. Local coordinates: steps of 2^shift units from the first
//! full-resolution corner A, rounded down before they are mirrored. D = d in [`DIRECTION`] bits; u = floor(((A_x - o_x) d_z - (A_z - o_z) d_x) / 2^(k+shift-2)) + 1, d_z below 2^k,
//! v likewise with y: how far A lies beside the ray, in quarters of a step times d_z / 2^k. `soft`: how far a corner as morphed can lie from the one of full resolution.
//! `open`: A lies too far beside the ray, or corners were morphed too far, for these numbers; then all children are met.
//! Legal: what `ray_setup` gives for a ray that moves; |points| <= `COORD_LIMIT`.

use super::parts::{Multiplier, Parts, Registers, TAG, multiplier_latency};
use super::ray_setup::{self, Reciprocal};
use super::{Block, Form, Timing};
use crate::num::prism::local_corners;
use crate::num::{Point, S, U, Vec3, Wire, wire_struct};

/// Bits of a component of D.
pub const DIRECTION: u32 = 12;
/// Fraction bits of what lies across the ray.
pub const FRACTION: u32 = 2;
wire_struct! {
    /// Input of [`PrismFrame`].
    pub struct In {
        /// The ray's constants.
        ray: ray_setup::Out,
        /// Corners and inserted vertices of full resolution: p0, p1, p2, q0, q1, q2.
        full: [Point; 6],
        /// The same as morphed for this ray.
        morphed: [Point; 6],
    }
}

wire_struct! {
    /// What the children of a node share.
    pub struct Frame {
        /// All children are met.
        open: bool,
        /// An odd number of axes is mirrored: below a triangle and above it change places.
        flipped: bool,
        /// Units of a local step: 2^shift.
        shift: U<5>,
        /// D, x first.
        d: [U<12>; 3],
        /// Of the first corner across the ray.
        u: S<13>,
        /// Likewise, of y.
        v: S<13>,
        /// Of the first corner along z from the ray's origin, in units.
        z: S<33>,
        /// Most that morphed corners lie beside full-resolution ones, in quarters of a step.
        soft_u: U<13>,
        /// Likewise.
        soft_v: U<13>,
        /// Along z, in steps.
        soft_z: U<10>,
        /// Of d along z.
        reciprocal: Reciprocal,
    }
}

wire_struct! {
    /// Output of [`PrismFrame`].
    pub struct Out {
        /// What the children share.
        frame: Frame,
        /// The corners and inserted vertices in local coordinates.
        corners: [Vec3<11>; 6],
    }
}

/// The block.
pub struct PrismFrame;

/// Number of the axis along which a ray moves most; of equals the last.
#[inline(always)]
pub(super) fn main_axis([x, y, z]: [u64; 3]) -> usize {
    if z >= x && z >= y { 2 } else { usize::from(y >= x) }
}

/// `soft` of x or y from how far corners are morphed along it and along z, in steps; they themselves, and D, are rounded.
#[inline(always)]
fn soft(m: i32, mz: i32, d: U<12>, dz: U<12>) -> U<13> {
    let reach = ((m * dz.narrow() + mz * d.narrow()) >> (DIRECTION - FRACTION)) + 3;
    U::new(if m | mz == 0 { 0 } else { u64::from(reach.unsigned_abs()) })
}

#[inline(always)]
fn units(p: &Point) -> [i32; 3] {
    [p.x.narrow(), p.y.narrow(), p.z.narrow()]
}

/// Bits of a coordinate, of a difference of two, of |d|, of a moment, of steps, and of a local coordinate once it is mirrored.
const COORDINATE: u32 = 32;
const DIFFERENCE: u32 = 33;
const MAGNITUDE: u32 = 30;
const MOMENT: u32 = 63;
const STEP: u32 = 10;
const LOCAL: u32 = 11;

impl PrismFrame {
    /// Registers with a tag of so many bits, stage by stage, beside four multipliers.
    pub(super) fn registers(tag: u32) -> Registers {
        let (differences, corners) = (15 * DIFFERENCE, 15 * LOCAL);
        let ray = 2 * MOMENT + Reciprocal::WIDTH + tag;
        let product = Multiplier { unsigned: 1, ..Multiplier::new(COORDINATE, MAGNITUDE + 1) };
        let narrow = 3 * DIRECTION + 5 + 1 + DIFFERENCE;
        [
            differences + COORDINATE + 3 * COORDINATE + 1 + 3 + 3 * MAGNITUDE + 3 * COORDINATE + COORDINATE + ray,
            differences + 3 * COORDINATE + 1 + 5 + 5 + 3 + 3 * MAGNITUDE + DIFFERENCE + ray,
            corners + 1 + 3 * STEP + narrow + 5 + ray,
            4 * (STEP + DIRECTION) + 2 + corners + 1 + STEP + narrow + 5 + ray,
            2 * (MOMENT + 1) + 2 * 13 + corners + 1 + STEP + narrow + 6 + Reciprocal::WIDTH + tag,
        ]
        .map(Registers::stage)
        .into_iter()
        .chain([4 * product.registers(), Registers::skid(Out::WIDTH + tag)])
        .sum::<Registers>()
        // Of all differences' bits the lowest make no shift.
        .without(STEP - 1)
    }
}

impl Block for PrismFrame {
    const NAME: &'static str = "prism_frame";
    const TIMING: Timing = Timing::pipelined(3 + multiplier_latency(32, 31));
    type In = In;
    type Out = Out;
    fn parts(_: &Form) -> Parts {
        Parts {
            products: vec![[4, COORDINATE, MAGNITUDE + 1], [4, STEP, DIRECTION]],
            // Differences, mirrored coordinates and moments; sums across the ray.
            add_bits: 33 * DIFFERENCE + 3 * COORDINATE + MOMENT + 3 * STEP + 15 * LOCAL + 2 * 2 * (MOMENT + 1),
            // The ray and the corners turned, in two steps; shifts.
            select_bits: 2 * (3 * (1 + MAGNITUDE + 2 * COORDINATE) + 2 * MOMENT + 15 * DIFFERENCE)
                + 5 * (15 * LOCAL + 3 * COORDINATE + 3 * MAGNITUDE)
                + 6 * 2 * (MOMENT + 3),
            registers: Self::registers(TAG),
        }
    }
    #[inline(always)]
    fn eval(i: &In) -> Out {
        let axes = [&i.ray.x, &i.ray.y, &i.ray.z];
        let d = axes.map(|axis| axis.d.get());
        let z = main_axis(d);
        let (x, y) = ((z + 1) % 3, (z + 2) % 3);
        // At least 1.
        let k = 64 - d[z].leading_zeros();
        let narrow = |of: u64| (of << DIRECTION) >> k; // 12 bits
        let [dx, dy, dz] = [d[x], d[y], d[z]].map(narrow);

        let points = i.full.each_ref().map(units);
        let (local, shift) = local_corners(&points);
        let mirrored = |axis: usize, of: i64| if axes[axis].mirror { -of } else { of };
        let corners = local.map(|p| {
            let along = |axis: usize| S::new(mirrored(axis, p[axis].into()));
            Vec3 { x: along(x), y: along(y), z: along(z) }
        });

        // Products below 2^61, moments below 2^62: 63 bits. Only if d is 1 there and nothing was dropped does the shift go to the left, of numbers below 2^34.
        let first = [0, 1, 2].map(|axis| mirrored(axis, points[0][axis].into()));
        let (wide, main, moment) = (d.map(u64::cast_signed), first[z], i.ray.moment.get());
        let across = |axis: usize, moment: i64| {
            let exact = first[axis] * wide[z] - main * wide[axis] + moment;
            ((exact << FRACTION.saturating_sub(k + shift)) >> (k + shift).saturating_sub(FRACTION)) + 1
        };
        let (u, v) = (across(x, moment[y]), across(y, -moment[x]));
        let is_far = |of: i64| !(-4096..4096).contains(&of);

        // All bits that any of the differences has: at least the largest less one, and less than twice it.
        let (mut bits, mut moves) = ([0; 3], false);
        for (p, f) in i.morphed.iter().zip(&i.full) {
            for (bits, (p, f)) in bits.iter_mut().zip(p.get().into_iter().zip(f.get())) {
                *bits |= (p - f) ^ ((p - f) >> 63);
                moves |= p != f;
            }
        }
        let steps = bits.map(|bits| (bits.cast_unsigned() >> shift) + u64::from(moves));
        let is_wide = steps.iter().any(|&steps| steps > U::<10>::MAX.get());
        let open = is_far(u) || is_far(v) || is_wide;

        let most = |axis: usize| U::<10>::new(if is_wide { 0 } else { steps[axis] }).narrow();
        let (mx, my, mz) = (most(x), most(y), most(z));
        let [dx, dy, dz] = [dx, dy, dz].map(U::<12>::new);
        let side = |of: i64| S::<13>::new(if is_far(of) { 0 } else { of });
        let frame = Frame {
            open,
            flipped: axes[0].mirror ^ axes[1].mirror ^ axes[2].mirror,
            shift: U::new(shift.into()),
            d: [dx, dy, dz],
            u: side(u),
            v: side(v),
            z: S::new(main - axes[z].origin.get()),
            soft_u: soft(mx, mz, dx, dz),
            soft_v: soft(my, mz, dy, dz),
            soft_z: U::new(u64::from(mz.unsigned_abs())),
            reciprocal: axes[z].reciprocal,
        };
        Out { frame, corners }
    }
}
