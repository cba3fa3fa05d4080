//! The structure read back, its bytes and lines, and its hits against those of other methods.

use super::map::{LEAVES, VERTICES};
use super::tree::{Kind, LEAF};
use super::*;
use crate::bvh::Box32;
use crate::format::Scene;
use crate::mesh::procedural::{Options, Scene as Kinds};
use crate::mesh::{Hierarchy, TriangleMesh, lattice, loop_surface};
use crate::method::bvh::{self, NoStore};
use crate::method::floats::FloatRay;
use crate::method::{Knobs, lod};
use crate::num::Random;
use crate::rays::{Camera, RaySource, View};
use crate::scene::BuildOptions;
use crate::step::{Act, NoSteps, Recorder, Step};

fn scene(kind: Kinds, base: u32, levels: u32) -> Scene {
    Scene::generate(&Options { levels: Some(levels), base: Some(base), ..Options::new(kind) }).unwrap()
}

/// A smooth ball of 8 x 4^levels triangles with coordinates that end in so many zero bits.
fn ball(levels: u32, zeros: u32) -> Scene {
    let positions = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
    let triangles = [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [5, 2, 1], [5, 3, 2], [5, 4, 3], [5, 1, 4]];
    let mesh = TriangleMesh::from_parts(&positions, &triangles, &[], Vec::new()).unwrap();
    let options = BuildOptions { coordinate_zeros: zeros, ..BuildOptions::own_triangles() };
    Scene::of_surface(&loop_surface(&mesh, levels).unwrap(), &options).unwrap()
}

/// Corners of a finest triangle by its number.
fn corners(hierarchy: &Hierarchy, id: u32) -> [[i32; 3]; 3] {
    let levels = hierarchy.levels;
    let (tree, node) = ((id >> (2 * levels)) as usize, id & ((1 << (2 * levels)) - 1));
    lattice::node(levels, levels, node).map(|place| hierarchy.tree(tree)[lattice::index(levels, place)])
}

/// A reader that knows the layout alone: where subtrees end, and which leaf is next.
struct Reader<'a> {
    tree: &'a Tree,
    hierarchy: &'a Hierarchy,
    seen: Vec<bool>,
    deepest: usize,
}

impl Reader<'_> {
    /// Reads the subtree at `node`, whose first leaf is `leaf`; its nodes, its leaves, and the least box around its triangles.
    fn subtree(&mut self, node: usize, leaf: usize, depth: usize) -> (usize, usize, Box32) {
        self.deepest = self.deepest.max(depth);
        let (nodes, leaves, bounds) = match self.tree.nodes[node].kind() {
            Kind::Leaf(count) => {
                assert!((1..=LEAF).contains(&count));
                let slots = LEAF * leaf..LEAF * leaf + count;
                let boxes = slots.map(|slot| {
                    let (triple, id) = (self.tree.triples[slot], self.tree.ids[slot]);
                    let stored = triple.map(|v| self.tree.vertices[v as usize]);
                    assert_eq!(stored, corners(self.hierarchy, id));
                    assert!(!std::mem::replace(&mut self.seen[id as usize], true), "{id} twice");
                    Box32::of_triangle(stored)
                });
                let bounds = boxes.reduce(|all, own| all.union(&own)).unwrap();
                let padding = LEAF * leaf + count..LEAF * (leaf + 1);
                assert!(padding.clone().all(|slot| self.tree.triples[slot] == [0; 3] && self.tree.ids[slot] == 0));
                (1, 1, bounds)
            }
            Kind::Inner { nodes, leaves } => {
                let left = self.subtree(node + 1, leaf, depth + 1);
                assert_eq!((left.0, left.1), (nodes as usize, leaves as usize));
                let right = self.subtree(node + 1 + left.0, leaf + left.1, depth + 1);
                let size = 1 + left.0 + right.0;
                (size, left.1 + right.1, left.2.union(&right.2))
            }
        };
        assert_eq!(self.tree.nodes[node].bounds, bounds);
        (nodes, leaves, bounds)
    }
}

#[test]
fn the_layout_is_read_back_and_has_every_triangle_once() {
    let scenes = [ball(0, 0), ball(1, 0), ball(5, 0), scene(Kinds::Terrain, 32, 4), scene(Kinds::Pot, 64, 3), scene(Kinds::Wall, 1456, 1)];
    for scene in &scenes {
        let hierarchy = scene.decode();
        let tree = Tree::new(&hierarchy).unwrap();
        let mut reader = Reader { tree: &tree, hierarchy: &hierarchy, seen: vec![false; tree.triangles], deepest: 0 };
        let (nodes, leaves, _) = reader.subtree(0, 0, 1);
        assert!(reader.seen.iter().all(|&seen| seen) && reader.deepest <= 41, "{} deep", reader.deepest);
        assert_eq!((nodes, leaves, nodes), (tree.nodes.len(), tree.leaves(), 2 * leaves - 1));
        assert_eq!(tree.triangles as u64, scene.finest_triangles());
        // More than a leaf holds is split until no more is left.
        assert!(leaves >= tree.triangles.div_ceil(LEAF) && (leaves == 1) == (tree.triangles <= LEAF));
    }
}

#[test]
fn bytes_follow_from_counts_and_sections_lie_apart() {
    for (scene, vertices) in [(ball(5, 0), 4 * 1024 + 2), (scene(Kinds::Terrain, 32, 4), 65 * 65)] {
        let method = (METHOD.make)(&scene, &Knobs::default(), &NoStore).unwrap();
        let tree = Tree::new(&scene.decode()).unwrap();
        let camera = Camera::new(&View::default(), &ModelSpace::of(&scene), 8, 8).unwrap();
        let map = method.map(&Sight::new(&camera, &ModelSpace::of(&scene), 1.0));
        assert_eq!(tree.vertices.len(), vertices);
        let parts = [32 * (2 * tree.leaves() as u64 - 1), 192 * tree.leaves() as u64, 12 * vertices as u64];
        assert_eq!(tree.bytes(), parts.iter().sum::<u64>());
        let sections: Vec<_> = map.sections().collect();
        assert_eq!(sections.iter().map(|(_, section)| section.lines).collect::<Vec<_>>(), parts.map(|bytes| bytes.div_ceil(32)));
        let ranges: Vec<_> = sections.iter().map(|&(id, section)| map.first(id)..map.first(id) + section.lines as u32).collect();
        assert!(ranges.windows(2).all(|two| two[0].end <= two[1].start) && ranges[2].end as u64 <= map.lines());
        assert_eq!((map.nodes().first, map.nodes().lines, map.nodes().count as usize), (0, 1, tree.nodes.len()));
    }
}

#[test]
fn coordinates_are_floats_where_all_of_them_are_numbers_of_single_precision() {
    for (zeros, has_floats) in [(0, false), (8, true)] {
        let scene = ball(3, zeros);
        let tree = Tree::new(&scene.decode()).unwrap();
        assert_eq!(tree.has_floats, has_floats);
        let exact = tree.vertices.iter().flatten().all(|&c| (c as f32) as i64 == i64::from(c));
        let boxes =
            tree.nodes.iter().flat_map(|node| [node.bounds.lo, node.bounds.hi]).flatten().all(|c| (c as f32) as i64 == i64::from(c));
        assert_eq!((exact, boxes), (has_floats, has_floats));
        let method = (METHOD.make)(&scene, &Knobs::default(), &NoStore).unwrap();
        let space = ModelSpace::of(&scene);
        let camera = Camera::new(&View::default(), &space, 8, 8).unwrap();
        let choices = method.choices(&Sight::new(&camera, &space, 1.0));
        assert_eq!(choices[0], ("coordinates", if has_floats { "floats" } else { "32-bit integers" }.to_owned()));
    }
}

/// Rays of a camera, and rays at random through the model's surroundings.
fn queries(space: &ModelSpace, random: u64) -> Vec<Query> {
    let camera = Camera::new(&View::default(), space, 40, 40).unwrap();
    let mut all = Vec::new();
    (0..camera.batches()).for_each(|batch| camera.batch(batch, &mut |_, query| all.push(*query)));
    all.extend((0..random).map(|number| {
        let mut random = Random::of(3, number);
        let mut near = || [(); 3].map(|()| 1.2 * random.signed() * space.placement.scale * 2f64.powi(31));
        let (from, to) = (near(), near());
        let offset = space.placement.offset;
        let query = Query::new([0, 1, 2].map(|k| offset[k] + from[k]), [0, 1, 2].map(|k| to[k] - from[k]));
        Query { any: number % 5 == 0, ..query }
    }));
    all
}

#[test]
fn hits_are_those_of_the_quad_bvh_and_of_full_detail_in_every_field() {
    let scenes = [
        ("ball", ball(4, 0)),
        ("ball of floats", ball(4, 8)),
        ("terrain", scene(Kinds::Terrain, 32, 4)),
        ("spikes", scene(Kinds::Spikes, 32, 3)),
        ("pot", scene(Kinds::Pot, 64, 3)),
        ("room", scene(Kinds::Room, 64, 2)),
    ];
    for (name, scene) in scenes {
        let space = ModelSpace::of(&scene);
        let camera = Camera::new(&View::default(), &space, 8, 8).unwrap();
        let sight = Sight::new(&camera, &space, f64::INFINITY);
        let methods = [&METHOD, &bvh::METHOD, &lod::METHOD].map(|method| (method.make)(&scene, &Knobs::default(), &NoStore).unwrap());
        let [mut own, mut quad, mut full] = methods.each_ref().map(|method| method.tracer(&sight));
        let (mut hits, mut bounces, mut finest) = (0, 0, 0);
        for (number, query) in queries(&space, 1500).iter().enumerate() {
            let hit = own.hit(query);
            if query.any {
                // Whichever it is.
                assert_eq!(hit.is_some(), quad.hit(query).is_some(), "{name}: {query:?}");
                continue;
            }
            assert_eq!(hit, quad.hit(query), "{name}: {query:?}");
            let of_full = full.hit(query);
            assert_eq!(hit.map(|hit| hit.distance), of_full.map(|hit| hit.distance), "{name}: {query:?}");
            // Where the surface is flat full detail needs no finest triangles.
            if of_full.is_some_and(|hit| u32::from(hit.level) == scene.levels()) {
                assert_eq!(hit, of_full, "{name}: {query:?}");
                finest += 1;
            }
            hits += u32::from(hit.is_some());
            // A path that leaves the surface, to either side.
            let mut random = Random::of(4, number as u64);
            let [mut from, mut from_quad, mut from_full] = [None, None, None];
            let (mut next, mut is_finest) = (*query, true);
            for _ in 0..4 {
                let landing = own.follow(&next, from.as_ref(), None);
                let wanted = quad.follow(&next, from_quad.as_ref(), None);
                assert_eq!(landing, wanted, "{name}: {next:?}");
                if is_finest {
                    let of_full = full.follow(&next, from_full.as_ref(), None);
                    is_finest = of_full.is_none_or(|landing| u32::from(landing.surface.level) == scene.levels());
                    if is_finest {
                        assert_eq!(landing.map(|landing| landing.surface), of_full.map(|landing| landing.surface), "{name}: {next:?}");
                    }
                    from_full = of_full.map(|landing| landing.departure);
                }
                let Some(landing) = landing else { break };
                bounces += u32::from(from.is_some());
                (from, from_quad) = (Some(landing.departure), wanted.map(|landing| landing.departure));
                next = Query::new([0.0; 3], [(); 3].map(|()| random.signed()));
            }
        }
        println!("{name}: {hits} hits, {bounces} on the way from others, {finest} of finest triangles");
        assert!(hits > 500 && bounces > 200 && finest > 100, "{name}: {hits}, {bounces}, {finest}");
    }
}

#[test]
fn steps_say_what_is_read() {
    let scene = ball(4, 0);
    let space = ModelSpace::of(&scene);
    let tree = Tree::new(&scene.decode()).unwrap();
    let map = memory(&tree);
    let mut rays = Rays { traverser: Traverser::new(&tree, map), levels: tree.levels, space };
    let (mut visits, mut tests) = (0, 0);
    for query in &queries(&space, 200) {
        let mut recorder = Recorder::default();
        let hit = Tracer::recorded(&mut rays, query, &mut recorder);
        let batch = recorder.batch();
        let steps: Vec<Step> = batch.words().iter().map(|word| word.step()).collect();
        let Some(Act::End { found, mapped: false }) = steps.last().map(|step| step.act) else { panic!("{steps:?}") };
        let found = found > 0;
        assert_eq!(found, hit.is_some());
        // The root is read, and then at each visit either both children, or a leaf's triples and, when these are there, its vertices.
        for (k, step) in steps.iter().enumerate() {
            let Some(fetch) = step.fetch else { continue };
            assert_eq!(map.locate(fetch.line.into()).map(|(section, _)| section), Some(fetch.section));
            visits += usize::from(step.visits);
            if fetch.section == LEAVES {
                assert!(step.visits && !fetch.joins && (fetch.line - map.first(LEAVES)).is_multiple_of(6) && fetch.lines <= 6);
                let rest = steps[k + 1..].iter().take_while(|step| step.fetch.is_some_and(|fetch| fetch.section == VERTICES));
                let rest: Vec<_> = rest.filter_map(|step| step.fetch).collect();
                assert!(!rest.is_empty() && !rest[0].joins && rest[1..].iter().all(|fetch| fetch.joins));
                let Act::Triangles { count, .. } = steps[k + 1 + rest.len()].act else { panic!("{steps:?}") };
                assert_eq!(fetch.lines, (12 * count).div_ceil(32));
                // Each line once, and no more than the triangles' vertices can have.
                let mut lines: Vec<_> = rest.iter().map(|fetch| fetch.line).collect();
                lines.sort_unstable();
                lines.dedup();
                assert!(lines.len() == rest.len() && lines.len() <= 6 * count as usize);
                tests += count;
            }
        }
    }
    assert!(visits > 1000 && tests > 1000, "{visits} visits, {tests} tests");
}

#[test]
fn floats_meet_nearly_what_is_met_exactly() {
    for (name, scene) in [("ball of floats", ball(4, 8)), ("terrain", scene(Kinds::Terrain, 32, 4)), ("pot", scene(Kinds::Pot, 64, 3))] {
        let space = ModelSpace::of(&scene);
        let tree = Tree::new(&scene.decode()).unwrap();
        let (mut exact, mut float) = (Traverser::new(&tree, memory(&tree)), FloatTree::new(&tree));
        let rays: Vec<_> = queries(&space, 1500).iter().filter_map(|query| space.enter(query, 1.0)).collect();
        let (mut same, mut met) = (0, 0);
        for ray in &rays {
            let mut hit = ClosestHit::new(tree.levels);
            exact.trace(&ray.ray, None, &mut NoSteps, &mut hit);
            // Steps of t are 2^-32 of the direction.
            let length = ray.ray.direction.get().map(|c| (c as f64).powi(2)).iter().sum::<f64>().sqrt();
            let wanted = hit.record().map(|hit| hit.t.get() as f64 / 2f64.powi(32) * length);
            let found = float.trace(&FloatRay::new(&ray.ray));
            met += usize::from(wanted.is_some());
            // Within a millionth of the model's width.
            same += usize::from(match (wanted, found) {
                (None, None) => true,
                (Some(wanted), Some(found)) => (wanted - f64::from(found)).abs() < 2f64.powi(32) * 1e-6,
                _ => false,
            });
        }
        let floats: Vec<_> = rays.iter().map(|ray| FloatRay::new(&ray.ray)).collect();
        let hits = float.hits(&floats);
        println!("{name}: {same} of {} rays the same, {met} hits, {hits} in floats", rays.len());
        assert!(met > 700 && 1000 * same >= 995 * rays.len(), "{name}: {same} of {}", rays.len());
        assert!(met.abs_diff(hits) * 200 <= rays.len(), "{name}: {met} and {hits} hits");
    }
}
