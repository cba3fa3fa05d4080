//! The LOD test where another ray may decide about each edge (paper section 3.8): each edge as [`LodTest`] has it for the ray that decides about it.
//!
//! Both ends of an edge are taken along its own viewer, so there are six distances where one ray has three: two dot products side by side, which the edges pass through in turn or three times over.
//! Legal: as [`LodTest`], for all three rays; `by` at most 2.

use super::lod_test::{self, LodTest, bound, cone_tolerance, distance_along, edge_arithmetic, edge_opening};
use super::parts::{CONE_TOLERANCE_LATENCY, DISTANCE, EDGE_OPENING_LATENCY, Parts, Registers, TAG, dot_product_latency};
use super::tree_deciders::Decider;
use super::{Block, EdgesPerCycle, Form, Timing};
use crate::block::bound_decode::BoundDecode;
use crate::num::{BoundCode, BoundScale, Cone, EdgeState, Point, Ray, Wire, wire_struct};

wire_struct! {
    /// Input of [`LodTestBy`].
    pub struct In {
        /// The ray.
        ray: Ray,
        /// Its first viewer.
        first: Ray,
        /// Its second viewer.
        second: Ray,
        /// Who decides about edge (p1, p2), (p2, p0), (p0, p1): 0 the ray, 1 and 2 its viewers.
        by: [Decider; 3],
        /// Corner p0 of the (morphed) triangle.
        p0: Point,
        /// Corner p1.
        p1: Point,
        /// Corner p2.
        p2: Point,
        /// Bound code of edge (p1, p2).
        e0: BoundCode,
        /// Bound code of edge (p2, p0).
        e1: BoundCode,
        /// Bound code of edge (p0, p1).
        e2: BoundCode,
        /// The model's bound scale.
        scale: BoundScale,
    }
}

/// The block.
pub struct LodTestBy;

impl LodTestBy {
    /// Timing of the default's RTL with one edge (its parameter `EDGES_PER_CYCLE` = 1).
    pub const ONE_EDGE: Timing = one_edge();
    /// And with three.
    pub const THREE_EDGES: Timing = three_edges();
}

/// Of a corner as a viewer sees it and of a direction: exact starts have no zeros to leave out.
const RELATIVE: u32 = Form::FULL.relative();
const COMPONENT: u32 = Form::FULL.component();
const ALONG: u32 = dot_product_latency(RELATIVE, COMPONENT);
/// Cycles of `lod_edge_by`.
pub const EDGE_LATENCY: u32 = ALONG + 1 + CONE_TOLERANCE_LATENCY + EDGE_OPENING_LATENCY;

/// Edges at once: what they take, an edge, the output.
const fn three_edges() -> Timing {
    Timing::pipelined(1 + EDGE_LATENCY + 1)
}

/// In turn: two passes more.
const fn one_edge() -> Timing {
    Timing { latency: three_edges().latency + 2, interval: 3 }
}

const fn timing(form: &Form) -> Timing {
    match form.lod_edges_per_cycle {
        EdgesPerCycle::Three => three_edges(),
        EdgesPerCycle::One => one_edge(),
    }
}

/// `lod_edge_by`: two distances, the nearer of them, its tolerance, its bound in time for that, and the opening.
fn edge() -> Registers {
    let nearer = 2 * distance_along(&Form::FULL) + Registers::skid(DISTANCE) + Registers::line(Cone::WIDTH, ALONG + 1, 2);
    let to_code = ALONG + 1 + CONE_TOLERANCE_LATENCY - BoundDecode::TIMING.latency;
    nearer + cone_tolerance() + Registers::line(BoundCode::WIDTH + BoundScale::WIDTH, to_code, 2) + bound() + edge_opening()
}

/// Bits of what an edge takes: its ends as its viewer sees them, that one's direction and cone, the code.
const EDGE_IN: u32 = 6 * RELATIVE + 3 * COMPONENT + Cone::WIDTH + BoundCode::WIDTH;

fn registers(form: &Form) -> Registers {
    let taken = 3 * EDGE_IN + BoundScale::WIDTH;
    match form.lod_edges_per_cycle {
        EdgesPerCycle::Three => Registers::stage(taken) + 3 * edge() + Registers::line(TAG, 1 + EDGE_LATENCY, 3),
        EdgesPerCycle::One => {
            let pass = 2;
            let states = Registers::line(pass + TAG, EDGE_LATENCY, 3) + Registers::bits(2 * (1 + EdgeState::WIDTH));
            (Registers::bits(taken + TAG + 1 + pass) + edge() + states).in_turns(3)
        }
    }
}

impl Block for LodTestBy {
    const NAME: &'static str = "lod_test_by";
    const TIMING: Timing = timing(&Form::FULL);
    type In = In;
    type Out = lod_test::Out;
    fn timing(form: &Form) -> Timing {
        timing(form)
    }
    fn parts(form: &Form) -> Parts {
        let (products, adds, selects) = edge_arithmetic(6, RELATIVE, COMPONENT);
        Parts {
            products,
            add_bits: adds + 18 * RELATIVE,
            // A viewer of three for each edge.
            select_bits: selects + 3 * 2 * Ray::WIDTH,
            registers: registers(form) + Registers::stage(lod_test::Out::WIDTH + TAG),
        }
    }
    #[inline]
    fn eval(input: &In) -> lod_test::Out {
        let &In { ray, p0, p1, p2, e0, e1, e2, scale, .. } = input;
        let viewer = |by: Decider| match by.get() {
            0 => &input.ray,
            1 => &input.first,
            _ => &input.second,
        };
        LodTest::by(input.by.map(viewer), &lod_test::In { ray, p0, p1, p2, e0, e1, e2, scale })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::{Direction, U};

    #[test]
    fn each_edge_is_decided_by_its_own_viewer() {
        // Code 160 is a bound of 1024. Of the rays, one tolerates all, one nothing, and one 600.
        let ray = |offset| Ray {
            origin: Point::new(0, 0, -100),
            direction: Direction::new(0, 0, 1 << 29),
            cone: Cone { offset: U::new(offset), ..Cone::default() },
        };
        let [p0, p1, p2] = [[0, 0, 0], [64, 0, 0], [0, 64, 0]].map(|[x, y, z]| Point::new(x, y, z));
        let [e0, e1, e2] = [BoundCode::new(160); 3];
        let states = |by: [u64; 3]| {
            let by = by.map(U::new);
            let scale = BoundScale::default();
            let out = LodTestBy::eval(&In { ray: ray(5000), first: ray(0), second: ray(600), by, p0, p1, p2, e0, e1, e2, scale });
            (out.refine, [out.s0, out.s1, out.s2].map(|s| s.get()))
        };
        assert_eq!(states([0, 0, 0]), (false, [0; 3]));
        assert_eq!(states([0, 1, 2]), (true, [0, 256, 180]));
        assert_eq!(states([2, 0, 1]), (true, [180, 0, 256]));
    }
}
