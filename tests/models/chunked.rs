//! Levels by object and chunk: what is chosen covers the model, is as coarse as may be, has the edges open that are counted; and its hits are those of its triangles.

use lodray::block::Block;
use lodray::block::start_test::Below;
use lodray::block::tri_test::{self, TriTest};
use lodray::mesh::{Hierarchy, edge_index, lattice};
use lodray::method::bvh::{NoStore, cut_triangle, level_ids};
use lodray::method::chunked::{CHUNK, ChunkShape, Chunks, METHOD};
use lodray::method::{ClosestHit, HitSink, Knobs, TriangleId, knob};
use lodray::num::{Point, bound_decode};
use lodray::rays::{Eye, ModelSpace, Query, RayFile, Sight};
use lodray::run::cast;
use lodray_test_support::models::{Rng, ball, scene_of, terrain};
use std::collections::BTreeMap;

/// One eye beside the model's middle, in units, at which a cone of a pixel is `tan_theta` wide.
fn sight(h: &Hierarchy, at: [f64; 3], tan_theta: f64, delta: f64) -> Sight {
    let space = ModelSpace::of(&scene_of(h));
    let size = space.radius() / space.placement.scale;
    let eye = at.map(|v| v * size);
    let eye = Eye::at(eye, tan_theta);
    Sight { delta, least_radius: eye.least_radius(space.lo.map(f64::from), space.hi.map(f64::from)), eyes: vec![eye], frame: None }
}

fn models() -> [(&'static str, Hierarchy); 3] {
    let mut two = ball(4, 0.2, 3);
    let moved = |by: i32| two.points.iter().map(|&[x, y, z]| [x + by, y, z]).collect::<Vec<_>>();
    let (near, far) = (moved(-(1 << 29)), moved(1 << 29));
    two.points = [near, far].concat();
    let others: Vec<_> = two.triangles.iter().map(|t| t.map(|v| v + two.base_vertices)).collect();
    two.triangles.extend(others);
    two.base_vertices *= 2;
    two.bounds.codes = [two.bounds.codes.clone(), two.bounds.codes].concat();
    [("terrain", terrain(3, 4, 0.5, 1)), ("ball", ball(5, 0.3, 2)), ("two balls", two)]
}

fn corners(h: &Hierarchy, id: u32) -> [[i32; 3]; 3] {
    let TriangleId { tree, level, node } = cut_triangle(h.levels, id);
    lattice::node(h.levels, level, node).map(|at| h.tree(tree as usize)[lattice::index(h.levels, at)])
}

/// Edges of triangles that no other has.
fn lone_edges(h: &Hierarchy, ids: &[u32]) -> usize {
    let mut uses = BTreeMap::new();
    for &id in ids {
        let p = corners(h, id);
        for k in 0..3 {
            let (a, b) = (p[k], p[(k + 1) % 3]);
            *uses.entry([a.min(b), a.max(b)]).or_insert(0) += 1;
        }
    }
    uses.values().filter(|&&count| count == 1).count()
}

#[test]
fn what_is_chosen_covers_the_model_once_with_the_edges_open_that_are_counted() {
    let mut mixed = 0;
    for (name, h) in models() {
        for shape in [ChunkShape::Object, ChunkShape::Splits(1), ChunkShape::Splits(2), ChunkShape::Splits(10)] {
            let chunks = Chunks::new(&h, shape);
            for (at, delta) in [([0.0, 0.9, 0.6], 1.0), ([1.5, 0.0, 0.2], 0.3), ([0.0, 3.0, 1.0], 4.0), ([40.0, 0.0, 0.0], 1.0)] {
                let seen = sight(&h, at, 1e-3, delta);
                let ids = chunks.chosen(&h, &seen);
                let mut below = vec![0; h.triangles.len() << (2 * h.levels)];
                for &id in &ids {
                    let of = cut_triangle(h.levels, id);
                    let splits = 2 * (h.levels - of.level);
                    let first = ((of.tree as usize) << (2 * h.levels)) + ((of.node as usize) << splits);
                    below[first..first + (1 << splits)].iter_mut().for_each(|count| *count += 1);
                }
                assert!(below.iter().all(|&count| count == 1), "{name}, {shape:?}");
                let (_, seams) = chunks.seams(&h, &seen);
                // The border of a terrain is lone at every level: count it by its sides.
                if name == "ball" {
                    assert_eq!(seams, lone_edges(&h, &ids), "{shape:?}");
                } else if shape == ChunkShape::Object {
                    assert_eq!(seams, 0, "{name}");
                }
                let levels: std::collections::BTreeSet<u32> = ids.iter().map(|&id| cut_triangle(h.levels, id).level).collect();
                mixed += usize::from(levels.len() > 1);
                assert!(levels.len() > 1 || name == "two balls" || seams == 0, "{name}, {shape:?}");
            }
            // Whoever tolerates nothing has the finest level, and who tolerates everything the base mesh.
            let finest = chunks.chosen(&h, &sight(&h, [0.0, 3.0, 1.0], 1e-3, f64::INFINITY));
            let base = chunks.chosen(&h, &sight(&h, [0.0, 3.0, 1.0], 1e-3, 0.0));
            assert!(finest == level_ids(&h, h.levels) && base == level_ids(&h, 0), "{name}, {shape:?}");
        }
    }
    assert!(mixed > 8, "{mixed}");
}

#[test]
fn a_chunk_is_as_coarse_as_its_nearest_point_tolerates() {
    for (name, h) in models() {
        for splits in [1, 2] {
            let chunks = Chunks::new(&h, ChunkShape::Splits(splits));
            let seen = sight(&h, [0.3, 1.2, 0.5], 1e-3, 1.0);
            // Largest bound of the edges of a level within a triangle, and the least radius of a cone in the box of all its points.
            let within = |of: TriangleId, level: u32| {
                let (mut most, mut lo, mut hi) = (0, [i32::MAX; 3], [i32::MIN; 3]);
                let down = 2 * (h.levels - of.level);
                for node in of.node << down..(of.node + 1) << down {
                    for p in lattice::node(h.levels, h.levels, node).map(|at| h.tree(of.tree as usize)[lattice::index(h.levels, at)]) {
                        (lo, hi) = (std::array::from_fn(|k| lo[k].min(p[k])), std::array::from_fn(|k| hi[k].max(p[k])));
                    }
                }
                let down = 2 * (level - of.level);
                for node in of.node << down..(of.node + 1) << down {
                    let p = lattice::node(h.levels, level, node);
                    for k in (0..3).filter(|_| level < h.levels) {
                        let code = h.codes(of.tree as usize)[edge_index(h.levels, level, p[k], p[(k + 1) % 3])];
                        most = most.max(bound_decode(h.bounds.scale, code));
                    }
                }
                most as f64 <= 2.0 * seen.least_radius_in(lo.map(f64::from), hi.map(f64::from))
            };
            for id in chunks.chosen(&h, &seen) {
                let of = cut_triangle(h.levels, id);
                let chunk = |level: u32| TriangleId { level, node: of.node >> (2 * (of.level - level)), ..of };
                let above = of.level.saturating_sub(splits);
                assert!(of.level == h.levels || within(chunk(above), of.level), "{name}: {of:?} is too coarse");
                if above > 0 {
                    assert!(!within(chunk(above - 1), of.level - 1), "{name}: {of:?} could be coarser");
                } else if of.level > 0 {
                    assert!(!within(chunk(0), of.level - 1), "{name}: {of:?} could be coarser");
                }
            }
        }
    }
}

#[test]
fn hits_are_those_of_the_triangles_that_were_chosen() {
    for (name, h) in models() {
        let scene = scene_of(&h);
        let (h, space) = (scene.decode(), ModelSpace::of(&scene));
        let (centre, radius) = (space.centre(), space.radius());
        let mut rng = Rng(7);
        let eye = [centre[0], centre[1] + 1.2 * radius, centre[2] + 0.6 * radius];
        let query = |_| {
            let at: [f64; 3] = std::array::from_fn(|k| centre[k] + 0.6 * radius * rng.signed());
            Query::new(eye, std::array::from_fn(|k| at[k] - eye[k])).with_cone(0.0, 1e-3)
        };
        let rays = RayFile::new((0..400).map(query).collect());
        let seen = Sight::new(&rays, &space, 1.0);
        for (chunk, shape) in [("object", ChunkShape::Object), ("1", ChunkShape::Splits(1)), ("3", ChunkShape::Splits(3))] {
            let knobs = Knobs::default().with(&CHUNK, chunk).unwrap().with(&knob::DELTA, "1").unwrap();
            let method = (METHOD.make)(&scene, &knobs, &NoStore).unwrap();
            let rows = cast(&*method, &scene, &rays, &seen, &|_| ());
            let ids = Chunks::new(&h, shape).chosen(&h, &seen);
            let triangles: Vec<_> = ids.iter().map(|&id| (cut_triangle(h.levels, id), corners(&h, id).map(Point::from_i32))).collect();
            let mut met = 0;
            for (query, row) in rays.queries().iter().zip(&rows) {
                let mut closest = ClosestHit::new(h.levels);
                let ray = space.enter(query, 1.0);
                for (id, points) in ray.iter().flat_map(|_| &triangles) {
                    let [p0, p1, p2] = *points;
                    let ray = &ray.as_ref().unwrap().ray;
                    let test = TriTest::eval(&tri_test::In { origin: ray.origin, direction: ray.direction, p0, p1, p2 });
                    if test.hit {
                        closest.offer(*id, points, &test, &Below::default());
                    }
                }
                let Some(hit) = closest.record() else {
                    assert_eq!(row.tree, -1, "{name}");
                    continue;
                };
                let own = [row.tree, row.level, row.node].map(|v| u64::from(v.cast_unsigned()));
                assert_eq!(own, [hit.tree.get(), hit.level.get(), hit.node.get()], "{name}, {chunk}");
                assert_eq!(row.t, ray.unwrap().distance(hit.t.get()));
                met += 1;
            }
            assert!(met > 50, "{name}, {chunk}: {met}");
        }
    }
}
