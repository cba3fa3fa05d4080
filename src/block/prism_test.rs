//! Ray against the prism of a node's child: division-free, and never a miss of what the prism holds (docs/numbers.md, "Prisms"; lemma L10c).
//!
//! Seen along the ray, a prism is its triangle let out by its reaches and swept by its heights, a hexagon at most, whose sides are parallel to the triangle's edges and to the
//! normal. The ray is a point there: it misses if it lies beyond a side by more than what was rounded and morphed. With the corners c_i across the ray, e_m = c_(m+2) - c_(m+1),
//! E_m = c_(m+1) x c_(m+2), A = E_0 + E_1 + E_2, N' = N across the ray, K_i = N' x c_i:
//! E_m within [-reach_m A, (1 + reach_(m+1) + reach_(m+2)) A], in whichever order, less the heights' (K_(m+2) - K_(m+1)) height; and 0 within the K_i let out.
//! `t_near` is that of the prism's nearest z. A ray also misses what lies behind its origin, and what is farther than `t_max`. A miss gives t_near = 0.
//! Legal: a frame from [`super::prism_frame`] with corners of a child of its node.

use super::box_test::{self, entry};
use super::parts::{Parts, Registers, TAG};
use super::prism_frame::{DIRECTION, FRACTION, Frame};
use super::ray_setup::Reciprocal;
use super::{Block, Form, Timing};
use crate::num::prism::{HEIGHT, OPEN, area, normal};
use crate::num::{BOX_SHIFT, RayT, T_NEAR_TO_T_SHIFT, TNear, U, Vec3, Wire, wire_struct};

wire_struct! {
    /// Input of [`PrismTest`].
    pub struct In {
        /// What the children share.
        frame: Frame,
        /// t of the closest hit so far.
        t_max: RayT,
        /// The child's corners.
        corners: [Vec3<11>; 3],
        /// Codes: reach beyond the edges (p1, p2), (p2, p0), (p0, p1), height below and above.
        planes: [U<3>; 5],
        /// Exponent of reaches.
        reach: U<3>,
        /// Exponent of heights.
        height: U<4>,
    }
}

/// The block.
pub struct PrismTest;

/// N' has so many fraction bits fewer than N D.
const NORMAL_SHIFT: u32 = DIRECTION - FRACTION - HEIGHT.trailing_zeros();

/// Across the ray: x first.
type Across = [i32; 2];

/// At most 2^27 of numbers of 14 bits.
#[inline(always)]
fn cross([a, b]: Across, [c, d]: Across) -> i32 {
    a * d - b * c
}

#[inline(always)]
fn least([a, b, c]: [i32; 3]) -> i32 {
    a.min(b).min(c)
}

#[inline(always)]
fn most([a, b, c]: [i32; 3]) -> i32 {
    a.max(b).max(c)
}

/// Bits of a local coordinate times D, of a corner across the ray, of an area, of E and A, of K; of what reaches, sides and heights make of them; of places along the ray, in
/// steps and units, and of an entry distance before it is shifted.
const LOCAL_PRODUCT: u32 = 22;
const CORNER: u32 = 14;
const AREA: u32 = 22;
const CROSS: u32 = 28;
const WHOLE: u32 = 27;
const STRIP: u32 = 27;
const OUT: u32 = 29;
const SIDE: u32 = 32;
const SWEEP: u32 = 30;
const ALONG: u32 = 16;
const PLACE: u32 = 40;
const ENTRY: u32 = 34;
const MARGIN: u32 = 28;

impl PrismTest {
    /// Registers with a tag of so many bits, stage by stage.
    pub(super) fn registers(tag: u32) -> Registers {
        let local = 11;
        let [d, softness, t] = [3 * DIRECTION, 2 * CORNER, TNear::WIDTH];
        let codes = 9 + 6 + 3 + 4;
        let along = 33 + 5 + Reciprocal::WIDTH;
        let ray = 10 + along + t + 1 + tag;
        let waits = codes + ray;
        let (corners, e, sides, products) = (6 * CORNER, 3 * CROSS, 6 * SIDE, 6 * WHOLE);
        [
            12 * LOCAL_PRODUCT + 6 * local + 5 * local + d + 26 + 26 + waits,
            corners + 6 * 21 + softness + 8 * local + d + waits,
            2 * corners + products + 3 * AREA + 2 * ALONG + 2 * local + softness + d + waits,
            corners + e + products + 3 + 3 * (AREA - 1) + 4 + 2 * ALONG + softness + d + waits,
            corners + e + WHOLE + 3 * 8 + 3 * MARGIN + 2 * ALONG + softness + d + waits,
            corners + e + WHOLE + 4 * 20 + 3 * OUT + 2 * 13 + 3 * MARGIN + 2 * ALONG + softness + waits,
        ]
        .map(Registers::stage)
        .into_iter()
        .chain([Registers::skid(corners + e + 2 * 13 + sides + 3 * MARGIN + softness + 2 * ALONG + along + t + 1 + tag + codes)])
        .chain(
            [
                e + 8 * 26 + sides + 16 + 1 + Reciprocal::WIDTH + t + 1 + tag + codes,
                e + 3 * STRIP + STRIP + sides + ENTRY + 5 + 1 + t + 1 + tag + codes,
                e + 9 * STRIP + sides + t + 1 + t + 1 + tag + codes,
                e + 6 * SWEEP + 9 * STRIP + sides + t + 3 + tag + codes,
                6 + 2 * SIDE + 3 * STRIP + 3 + t + 3 + tag,
            ]
            .map(Registers::stage),
        )
        .chain([Registers::skid(1 + t + 1 + tag), Registers::stage(1 + t + tag)])
        .sum::<Registers>()
        // Heights and their exponent have been read by the last stage that has codes.
        .without(6 + 4)
    }
}

impl Block for PrismTest {
    const NAME: &'static str = "prism_test";
    const TIMING: Timing = Timing::pipelined(14);
    type In = In;
    type Out = box_test::Out;
    fn parts(_: &Form) -> Parts {
        Parts {
            products: vec![[12, 11, 13], [6, 11, 11], [6, 14, 14], [6, 13, 14], [4, 8, 13], [6, 13, 14], [2, 12, 14], [1, 16, 18]],
            // Across the ray and along it, small products of codes among them; comparisons.
            add_bits: 6 * (LOCAL_PRODUCT + CORNER)
                + 3 * AREA
                + 3 * (CROSS + 3 * STRIP)
                + 9 * OUT
                + 12 * SIDE
                + 9 * SWEEP
                + 12 * SIDE
                + 3 * PLACE,
            select_bits: 3 * 4 * AREA + 3 * 3 * OUT + 6 * 4 * SWEEP + 6 * SIDE + 10 * PLACE + 5 * ENTRY,
            registers: Self::registers(TAG),
        }
    }
    #[inline(always)]
    fn eval(i: &In) -> box_test::Out {
        let frame = &i.frame;
        let [dx, dy, dz] = frame.d.map(|d| d.narrow());
        let l = i.corners.map(|c| [c.x.narrow(), c.y.narrow(), c.z.narrow()]);
        let code = |j: usize| i.planes[j].narrow();
        let (reaches, heights) = ([code(0), code(1), code(2)], if frame.flipped { [code(4), code(3)] } else { [code(3), code(4)] });
        let (reach, height) = (i.reach.narrow() + 1, i.height.narrow());
        let open = frame.open | (i.reach.get() == u64::from(OPEN));

        // Across the ray: of 14, 8 and 13 bits.
        let turned = |p: [i32; 3], shift: u32| [(p[0] * dz - p[2] * dx) >> shift, (p[1] * dz - p[2] * dy) >> shift];
        let c = l.map(|p| {
            let [u, v] = turned(p, DIRECTION - FRACTION);
            [u + frame.u.narrow(), v + frame.v.narrow()]
        });
        let n = normal(area(l));
        let across = turned(n, NORMAL_SHIFT);

        // What was rounded, and morphed.
        let around = 4 + ((3 * (reaches[0] + reaches[1] + reaches[2])) >> reach) + ((2 * heights[0].max(heights[1])) >> height);
        let [soft_u, soft_v] = [frame.soft_u, frame.soft_v].map(|soft| around + soft.narrow());
        let margin = |[u, v]: Across| u.abs() * soft_v + v.abs() * soft_u;

        // 28, 27 and 27 bits.
        let e = [0, 1, 2].map(|m| cross(c[(m + 1) % 3], c[(m + 2) % 3]));
        let whole = e[0] + e[1] + e[2];
        let k = c.map(|c| cross(across, c));
        let out = [0, 1, 2].map(|m| (reaches[m] * whole) >> reach);
        let mut inside = true;
        for m in 0..3 {
            let (a, b) = ((m + 1) % 3, (m + 2) % 3);
            let (near, far) = (-out[m], whole + out[a] + out[b]);
            let by = k[b] - k[a];
            let (down, up) = ((-heights[0] * by) >> height, (heights[1] * by) >> height);
            let margin = margin([c[b][0] - c[a][0], c[b][1] - c[a][1]]) + 2;
            inside &= (e[m] >= near.min(far) - down.max(up) - margin) & (e[m] <= near.max(far) - down.min(up) + margin);
        }
        let let_out = |of: i32, [k0, k1, k2]: [i32; 3], shift: i32| {
            of + ((reaches[0] * (of - k0) + reaches[1] * (of - k1) + reaches[2] * (of - k2)) >> shift)
        };
        let margin = margin(across);
        inside &= (let_out(least(k), k, reach) <= margin) & (let_out(most(k), k, reach) >= -margin);

        // Along it.
        let along = [l[0][2], l[1][2], l[2][2]];
        let (down, up) = ((-heights[0] * n[2] * HEIGHT) >> height, (heights[1] * n[2] * HEIGHT) >> height);
        let soft = frame.soft_z.narrow();
        let low = let_out(least(along), along, reach) + down.min(up) - soft;
        let high = let_out(most(along), along, reach) + down.max(up) + soft + 2;
        let place = |steps: i32| frame.z.get() + (i64::from(steps) << frame.shift.get());
        let ahead = place(high) >= 0;

        // The nearest corner keeps to the limit: 16 bits, but of a prism that does not hold its corners.
        let t_near =
            TNear::new(entry(frame.reciprocal, (place(low) >> BOX_SHIFT).min(65_535)).min(TNear::MAX.get().cast_signed()).cast_unsigned());
        let hit = open | (inside & ahead & ((t_near.get() << T_NEAR_TO_T_SHIFT) <= i.t_max.get()));
        box_test::Out { hit, t_near: if hit & !open { t_near } else { TNear::ZERO } }
    }
}
