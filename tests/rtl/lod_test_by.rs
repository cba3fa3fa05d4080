//! The level-of-detail test with a viewer for each edge.

use crate::draw::Draw;
use crate::lod_test;
use crate::suite::{Category, Suite};
use lodray::block::lod_test::LodTest;
use lodray::block::lod_test_by::{In, LodTestBy};
use lodray::block::{self, Block, Timing};
use lodray::num::{Ray, U};
use tb::Build;

/// The triangle of a case of the one-ray test, whose ray is one of the three; the others are any.
fn around(draw: &mut Draw, case: &block::lod_test::In, mut others: impl FnMut(&mut Draw) -> Ray) -> In {
    let mut rays = [case.ray, others(draw), others(draw)];
    rays.rotate_left(draw.below(3) as usize);
    let [ray, first, second] = rays;
    let &block::lod_test::In { p0, p1, p2, e0, e1, e2, scale, .. } = case;
    In { ray, first, second, by: [0; 3].map(|_| U::new(draw.below(3))), p0, p1, p2, e0, e1, e2, scale }
}

/// Three rays of any kind.
fn random(draw: &mut Draw) -> In {
    let case = lod_test::random(draw);
    around(draw, &case, Draw::ray)
}

/// Rays from about the same place with cones of about a pixel: what prior rays are.
fn paths(draw: &mut Draw) -> In {
    let case = lod_test::pixels(draw);
    around(draw, &case, |draw| lod_test::pixels(draw).ray)
}

/// A case at a border of the one-ray test for one of the edges, by any of the rays.
fn border(draw: &mut Draw) -> In {
    let case = lod_test::border(draw);
    around(draw, &case, Draw::ray)
}

/// All three are one ray: whoever decides.
fn one_ray(draw: &mut Draw) -> In {
    let case = lod_test::border(draw);
    around(draw, &case, |_| case.ray)
}

/// The ray itself decides about everything.
fn own(draw: &mut Draw) -> In {
    In { by: [U::ZERO; 3], ..paths(draw) }
}

fn of_one(i: &In, ray: Ray) -> block::lod_test::Out {
    let &In { p0, p1, p2, e0, e1, e2, scale, .. } = i;
    LodTest::eval(&block::lod_test::In { ray, p0, p1, p2, e0, e1, e2, scale })
}

type Is = Category<LodTestBy>;

pub fn suite() -> Suite<LodTestBy> {
    Suite::new(
        |i| {
            let legal = |ray| {
                let &In { p0, p1, p2, e0, e1, e2, scale, .. } = i;
                lod_test::legal(&block::lod_test::In { ray, p0, p1, p2, e0, e1, e2, scale })
            };
            [i.ray, i.first, i.second].into_iter().all(legal) && i.by.iter().all(|by| by.get() < 3)
        },
        vec![
            Is::any("random", random),
            Is::any("paths", paths),
            Is::any("borders", border),
            Is::all("one ray", one_ray, |i, o| of_one(i, i.ray) == *o),
            Is::all("its own decisions", own, |i, o| of_one(i, i.ray) == *o),
        ],
        vec![
            ("three viewers, three states", |i, o| {
                i.by[0] != i.by[1] && i.by[1] != i.by[2] && i.by[2] != i.by[0] && o.s0 != o.s1 && o.s1 != o.s2 && o.s2 != o.s0
            }),
            ("none of the three alone decides so", |i, o| [i.ray, i.first, i.second].into_iter().all(|ray| of_one(i, ray) != *o)),
            ("open by a viewer alone", |i, o| o.refine && !of_one(i, i.ray).refine),
            ("closed by viewers alone", |i, o| !o.refine && of_one(i, i.ray).refine),
        ],
        vec![
            ("who decides", 0..=26, |i, _| i.by.iter().fold(0, |code, by| 3 * code + by.get())),
            ("s0 in sixteenths", 0..=16, |_, o| o.s0.get() >> 4),
            ("s1 in sixteenths", 0..=16, |_, o| o.s1.get() >> 4),
            ("s2 in sixteenths", 0..=16, |_, o| o.s2.get() >> 4),
            ("refine", 0..=1, |_, o| o.refine.into()),
        ],
    )
}

fn with(edges_per_cycle: u32, timing: Timing) -> Suite<LodTestBy> {
    Suite { build: Build::block::<LodTestBy>().parameter("EDGES_PER_CYCLE", edges_per_cycle), timing, ..suite() }
}

crate::suite::modes!(three_edges_per_cycle: with(3, LodTestBy::THREE_EDGES));
crate::suite::modes!(one_edge_per_cycle: with(1, LodTestBy::ONE_EDGE));
