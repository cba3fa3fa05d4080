//! Trees that have every triangle wherever it reaches; planes that end the way down; and what is written where.

use super::*;
use crate::mesh::procedural::{Options, Scene as Kinds};
use crate::method::bvh::NoStore;
use crate::num::Random;
use crate::rays::{Camera, View};
use crate::step::{Act, LineCounter, LineSets, Step, StepCounts};

fn scene(kind: Kinds, levels: u32) -> Scene {
    Scene::generate(&Options { levels: Some(levels), ..Options::new(kind) }).unwrap()
}

fn tree(scene: &Scene, every: u32) -> Arc<Tree> {
    let planes = Planes { every, ..RlodOptions::default().planes };
    Arc::new(Tree::new(scene, &RlodOptions { planes, ..RlodOptions::default() }).unwrap())
}

/// The leaves whose cells hold a point, borders included; rays visit both sides of a split as well where rounding leaves it open.
fn leaves_at(tree: &Tree, p: [f64; 3]) -> Vec<(u32, u32)> {
    let (mut waiting, mut found) = (vec![0u32], Vec::new());
    while let Some(node) = waiting.pop() {
        match tree.nodes[node as usize].kind() {
            Kind::Leaf { first, count } => found.push((first, count)),
            Kind::Inner { axis, at, left } => {
                let beyond = p[axis] - f64::from(at);
                waiting.extend((beyond <= 1e-4).then_some(left));
                waiting.extend((beyond >= -1e-4).then_some(left + 1));
            }
        }
    }
    found
}

#[test]
fn every_point_of_a_triangle_lies_in_a_leaf_that_names_it() {
    for (kind, levels) in [(Kinds::Sphere, 4), (Kinds::Terrain, 3), (Kinds::Cloth, 3), (Kinds::Street, 2)] {
        let scene = scene(kind, levels);
        let tree = tree(&scene, 3);
        let mut random = Random::new(1);
        assert_eq!(tree.leaves(), tree.nodes.iter().filter(|node| matches!(node.kind(), Kind::Leaf { .. })).count());
        for _ in 0..20_000 {
            let of = random.below(tree.triangles.len() as u64) as u32;
            let triangle = tree.triangles[of as usize].map(|p| p.map(f64::from));
            // Inside, on an edge or at a corner.
            let mut weights = [0; 3].map(|_| (random.below(5) as f64) * random.signed().abs());
            let sum: f64 = weights.iter().sum();
            weights = if sum > 0.0 { weights.map(|w| w / sum) } else { [1.0, 0.0, 0.0] };
            let p = std::array::from_fn(|k| (0..3).map(|c| weights[c] * triangle[c][k]).sum());
            let named = leaves_at(&tree, p);
            let names = |&(first, count): &(u32, u32)| tree.references[first as usize..][..count as usize].contains(&of);
            assert!(named.iter().any(names), "{kind:?} {triangle:?} {p:?}");
        }
    }
}

#[test]
fn both_orders_have_the_same_tree() {
    /// The tree from the root, whatever its order.
    fn shape(tree: &Tree, node: u32, out: &mut Vec<(Kind, Vec<u32>, Option<Rlod>)>) {
        let own = tree.nodes[node as usize];
        let rlod = own.rlod().map(|[_, number]| tree.rlods[number as usize]);
        match own.kind() {
            Kind::Leaf { first, count } => {
                let names = tree.references[first as usize..][..count as usize].iter().map(|&place| tree.ids[place as usize]).collect();
                out.push((Kind::Leaf { first: 0, count }, names, rlod));
            }
            Kind::Inner { axis, at, left } => {
                out.push((Kind::Inner { axis, at, left: 0 }, Vec::new(), rlod));
                shape(tree, left, out);
                shape(tree, left + 1, out);
            }
        }
    }
    let scene = scene(Kinds::Terrain, 3);
    let shapes = [KdOrder::Area, KdOrder::Depth].map(|order| {
        let tree = Tree::new(&scene, &RlodOptions { order, ..RlodOptions::default() }).unwrap();
        let mut out = Vec::new();
        shape(&tree, 0, &mut out);
        assert_eq!(out.len(), tree.nodes.len());
        out
    });
    assert_eq!(shapes[0], shapes[1]);
}

#[test]
fn every_third_inner_node_of_a_path_has_a_plane_and_its_error_is_no_less() {
    let scene = scene(Kinds::Terrain, 3);
    for every in [1, 2, 3, 4] {
        let tree = tree(&scene, every);
        let mut waiting = vec![(0u32, 0u32, tree.cell)];
        let mut counted = 0;
        while let Some((node, depth, cell)) = waiting.pop() {
            let own = &tree.nodes[node as usize];
            let Kind::Inner { axis, at, left } = own.kind() else {
                assert!(own.rlod().is_none());
                continue;
            };
            assert_eq!(own.rlod().is_some(), depth.is_multiple_of(every), "node {node} at {depth}");
            if let Some([code, number]) = own.rlod() {
                counted += 1;
                let rlod = &tree.rlods[number as usize];
                assert!(tree.errors.error(code) >= rlod.radius);
                let half: f64 = (0..3).map(|k| (f64::from(cell.hi[k]) - f64::from(cell.lo[k])).powi(2)).sum::<f64>().sqrt() / 2.0;
                assert!(f64::from(rlod.radius) >= half, "the sphere is around the cell");
                assert!((0..3).all(|k| rlod.mean[k] >= cell.lo[k] as f32 && rlod.mean[k] <= cell.hi[k] as f32));
            }
            let (mut below, mut above) = (cell, cell);
            (below.hi[axis], above.lo[axis]) = (at, at);
            waiting.extend([(left, depth + 1, below), (left + 1, depth + 1, above)]);
        }
        assert_eq!(counted, tree.rlods.len());
    }
    assert!(tree(&scene, 0).rlods.is_empty());
}

/// Steps of a camera's rays, and how many hits were planes.
fn frame(scene: &Scene, tree: &Arc<Tree>, metric: Metric) -> (StepCounts, usize, usize) {
    let space = ModelSpace::of(scene);
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &space, 32, 32).unwrap();
    let mut tracer = RlodTracer::new(RlodTraverser::new(Arc::clone(tree), map(tree), metric), space);
    let sets = LineSets::new(&map(tree));
    let mut counter = LineCounter { counts: StepCounts::default(), sets: &sets };
    let (mut hits, mut planes) = (0, 0);
    for pixel in 0..32 * 32 {
        if let Some(hit) = tracer.counted(&camera.ray(pixel % 32, pixel / 32), &mut counter) {
            hits += 1;
            planes += usize::from(hit.tree as usize >= tree.triangles.len());
        }
    }
    (counter.counts, hits, planes)
}

#[test]
fn coarser_planes_are_fewer_visits_and_the_coarsest_is_the_roots() {
    let scene = scene(Kinds::Terrain, 4);
    let tree = tree(&scene, 3);
    let mut last = u64::MAX;
    let mut first_hits = 0;
    for pixels in [0.0, 1.0, 4.0, 16.0, 64.0, 256.0] {
        let (counts, hits, planes) = frame(&scene, &tree, Metric { pixels, reach: 1.0 });
        let nodes = counts.lines[NODES.place()];
        assert!(nodes <= last, "{pixels}: {nodes} after {last}");
        last = nodes;
        if pixels == 0.0 {
            first_hits = hits;
            assert_eq!((planes, counts.lines[RLODS.place()]), (0, 0));
        }
        if pixels == 4.0 {
            assert!(planes > hits / 4, "{planes} of {hits}");
            assert!(hits > first_hits * 9 / 10, "{hits} of {first_hits}: few holes");
        }
    }
    let (counts, hits, planes) = frame(&scene, &tree, Metric { pixels: f64::INFINITY, reach: 1.0 });
    assert_eq!(hits, planes);
    // Rays that enter the model's box read the root and its plane, and no more, whether the plane is met or not.
    assert_eq!((counts.lines[NODES.place()], counts.lines[TRIANGLES.place()]), (counts.lines[RLODS.place()], 0));
    assert!(counts.lines[NODES.place()] > hits as u64);
}

#[test]
fn rays_that_leave_a_plane_ignore_what_is_as_near_as_it_may_be_off() {
    let scene = scene(Kinds::Terrain, 4);
    let (tree, space) = (tree(&scene, 3), ModelSpace::of(&scene));
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &space, 32, 32).unwrap();
    let metric = Metric { pixels: 32.0, reach: 1.0 };
    let mut tracer = RlodTracer::new(RlodTraverser::new(Arc::clone(&tree), map(&tree), metric), space);
    let mut left = 0;
    for pixel in 0..32 * 32 {
        let query = camera.ray(pixel % 32, pixel / 32);
        let Some(landing) = Tracer::follow(&mut tracer, &query, None, None) else { continue };
        let plane = (landing.surface.tree as usize).checked_sub(tree.triangles.len());
        assert_eq!(landing.departure.clear > 0, plane.is_some());
        let Some(plane) = plane else { continue };
        // It starts where the ray met the plane.
        let start = space.start(&landing.departure.start);
        let length = query.direction.iter().map(|c| c * c).sum::<f64>().sqrt();
        for k in 0..3 {
            let expected = query.origin[k] + landing.surface.distance * query.direction[k] / length;
            // No coordinate is beyond the limit, where a plane may reach.
            let limit = space.placement.scale * f64::from(crate::num::COORD_LIMIT);
            let within = expected.clamp(space.placement.offset[k] - limit, space.placement.offset[k] + limit);
            assert!((start[k] - within).abs() < 1e-6 * space.radius(), "{start:?}, {expected}");
        }
        for direction in [[0.0, 0.0, 1.0], [1.0, 0.2, 0.01], [-0.3, 1.0, -0.02]] {
            let next = Query { radius: landing.surface.distance * camera.tan_theta, ..Query::new(start, direction) };
            if let Some(hit) = Tracer::follow(&mut tracer, &next, Some(&landing.departure), None) {
                let bound = f64::from(tree.rlods[plane].radius) * space.placement.scale;
                assert!(hit.surface.distance >= bound * 0.999, "{} nearer than {bound}", hit.surface.distance);
                left += 1;
            }
        }
    }
    assert!(left > 20, "{left}");
}

#[test]
fn all_hits_name_each_triangle_once_and_a_surface_has_every_plane() {
    let scene = scene(Kinds::Sphere, 4);
    let knobs = Knobs::default().with(&PIXELS, "0").unwrap();
    let method = (METHOD.make)(&scene, &knobs, &NoStore).unwrap();
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &ModelSpace::of(&scene), 32, 32).unwrap();
    let sight = Sight::new(&camera, &ModelSpace::of(&scene), 1.0);
    let mut tracer = method.tracer(&sight);
    let mut doubled = 0;
    for pixel in 0..32 * 32 {
        let mut hits = Vec::new();
        assert!(tracer.all(&camera.ray(pixel % 32, pixel / 32), &mut hits));
        // A closed model is entered as often as it is left.
        assert_eq!(hits.iter().filter(|hit| hit.front).count(), hits.iter().filter(|hit| !hit.front).count());
        doubled += hits.windows(2).filter(|two| two[0].tree == two[1].tree).count();
    }
    assert_eq!(doubled, 0);
    let own = tree(&scene, 3);
    let surface = method.surface(&scene);
    assert_eq!(surface.trees(), own.triangles.len() + own.rlods.len());
    // The last of them is the plane's own, within what the format rounds.
    let last = own.rlods.len() as u32 - 1;
    let [x, y, z, _] = own.rlods[last as usize].plane;
    let hit = SurfaceHit { tree: own.triangles.len() as u32 + last, full_bary: [1.0 / 3.0; 3], ..SurfaceHit::default() };
    assert!(hit.normal(surface).dot(glam::Vec3::new(x, y, z)) > 0.999);
}

#[test]
fn steps_name_works_and_lines_of_their_own() {
    struct Kept(Vec<Step>);
    impl StepSink for Kept {
        fn step(&mut self, step: Step) {
            self.0.push(step);
        }
    }
    let scene = scene(Kinds::Terrain, 3);
    let tree = tree(&scene, 3);
    let (space, own) = (ModelSpace::of(&scene), map(&tree));
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &space, 32, 32).unwrap();
    let mut tracer = RlodTracer::new(RlodTraverser::new(Arc::clone(&tree), own, Metric { pixels: 2.0, reach: 1.0 }), space);
    let mut kept = Kept(Vec::new());
    let ray = camera.ray(16, 17);
    assert!(tracer.trace(&ray, &mut kept).is_some());
    for step in &kept.0 {
        if let Act::Work { work, .. } = step.act {
            assert!((work as usize) < works::WORKS.len() && step.fetch.is_none());
        }
        if let Some(fetch) = step.fetch {
            assert!((fetch.line..fetch.line + fetch.lines).all(|line| own.locate(line.into()).is_some_and(|(id, _)| id == fetch.section)));
        }
    }
    assert!(kept.0.iter().any(|step| step.visits));
    assert_eq!(own.bytes(), tree.bytes().iter().map(|bytes| bytes.next_multiple_of(32)).sum::<u64>());
}
