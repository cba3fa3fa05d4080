//! Clusters read back; choices that cover the model once, whatever is chosen; what hits name; and the work before a frame.

use super::map::{CLUSTERS, GROUPS, ROOTS};
use super::*;
use crate::mesh::procedural::{Options, Scene as Kinds};
use crate::method::Knobs;
use crate::method::bvh::{LEAVES, NODES, NoStore};
use crate::num::Random;
use crate::rays::{Camera, CameraPath, View, ViewCone};
use crate::step::Act;
use crate::step::SectionId;
use std::collections::{HashMap, HashSet};

fn scene(kind: Kinds, levels: u32) -> Scene {
    Scene::generate(&Options { levels: Some(levels), ..Options::new(kind) }).unwrap()
}

const KINDS: [Kind; 2] = [Kind::Shipped, Kind::Paper];

fn graphs() -> Vec<(Kinds, Kind, Graph)> {
    let scenes = [(Kinds::Sphere, 4), (Kinds::Terrain, 3), (Kinds::Cloth, 3)];
    let all = scenes.into_iter().map(|(of, levels)| (of, scene(of, levels)));
    all.flat_map(|(of, scene)| KINDS.map(|kind| (of, kind, Graph::build(&scene, kind, 16).unwrap()))).collect()
}

/// A rule and eyes at random: errors and sizes of many octaves, from within the model to far outside, with a view or without.
fn any_choice(random: &mut Random, graph: &Graph) -> (Rule, Vec<Eye>) {
    let size = 65_535.0 * f64::from(graph.grid.step);
    let mut unit = || random.next() as f64 / u64::MAX as f64;
    let mut place = |far: f64| std::array::from_fn(|k| f64::from(graph.grid.lo[k]) + size * (0.5 + far * (unit() - 0.5)));
    let at = place(3.0);
    let axis: [f64; 3] = place(1.0);
    let length = axis.iter().map(|c| c * c).sum::<f64>().sqrt();
    let mut octave = |from: f64, to: f64| (from + (to - from) * unit()).exp2();
    let view = ViewCone { axis: axis.map(|c| c / length), tangent: octave(-3.0, 1.0) };
    let eye = Eye::at(at, octave(-14.0, -4.0));
    let eye = if octave(0.0, 1.0) > 1.4 { eye.looking(view) } else { eye };
    let (error, pixels, outside) = (octave(-4.0, 8.0), octave(0.0, 10.0), octave(0.0, 3.0));
    let which = (octave(0.0, 1.0) * 10.0) as u32 % 3;
    let rule = Rule { error: (which != 1).then_some(error), size: (which != 0).then_some(pixels), outside };
    (rule, vec![eye])
}

/// How often each edge is gone along each way, by the places of its ends.
fn edges<'a>(graph: &Graph, triangles: impl Iterator<Item = &'a [u32; 3]>) -> HashMap<[Place; 2], i32> {
    let mut count = HashMap::new();
    for t in triangles {
        for k in 0..3 {
            let [a, b] = [t[k], t[(k + 1) % 3]].map(|v| graph.places[v as usize]);
            let (key, way) = if a < b { ([a, b], 1) } else { ([b, a], -1) };
            *count.entry(key).or_insert(0) += way;
        }
    }
    count.retain(|_, ways| *ways != 0);
    count
}

fn chosen<'a>(graph: &'a Graph, cut: &'a Cut) -> impl Iterator<Item = &'a [u32; 3]> {
    cut.clusters.iter().flat_map(|&cluster| &graph.triangles[graph.clusters[cluster as usize].triangles()])
}

#[test]
fn graphs_hold_the_mesh_and_grow_coarser() {
    for (of, kind, graph) in graphs() {
        let finest: usize = graph.clusters.iter().filter(|own| own.refined.is_none()).map(|own| own.count as usize).sum();
        assert_eq!(finest, graph.finest, "{of:?} {kind:?}");
        let most = if kind == Kind::Shipped { 128 } else { 256 };
        for (number, group) in (0..).zip(&graph.groups) {
            for at in group.clusters() {
                let cluster = &graph.clusters[at];
                assert!(cluster.group == number && (1..=most).contains(&cluster.count));
                let vertices: HashSet<u32> = graph.triangles[cluster.triangles()].iter().flatten().copied().collect();
                assert!(vertices.len() <= 256);
                // What serves above serves below.
                if let Some(below) = cluster.refined {
                    let below = &graph.groups[below as usize];
                    let apart: f64 = (0..3).map(|k| (below.sphere.centre[k] - group.sphere.centre[k]).powi(2)).sum::<f64>().sqrt();
                    assert!(cluster.refined < Some(number) && below.error <= group.error && group.bounds.contains(&below.bounds));
                    assert!(apart + below.sphere.radius <= group.sphere.radius, "{of:?} {kind:?} {number}");
                }
            }
        }
        let [_, coarsest] = graph.roots();
        assert!(coarsest * 5 < graph.finest, "{of:?} {kind:?}: {coarsest} of {}", graph.finest);
    }
}

#[test]
fn whatever_is_chosen_has_the_borders_of_the_mesh() {
    let (mut random, mut fewest, mut mixed) = (Random::new(7), usize::MAX, 0);
    for (of, kind, graph) in graphs() {
        let all = Cut::new(&graph, &Rule { error: Some(0.0), size: Some(0.0), outside: 1.0 }, &[Eye::ANYWHERE]);
        // Nothing but errors of 0 is taken.
        let exact = edges(&graph, chosen(&graph, &all));
        let coarsest = Cut::new(&graph, &Rule { error: Some(f64::INFINITY), size: None, outside: 1.0 }, &[Eye::NOWHERE]);
        assert!(coarsest.clusters.iter().all(|&own| graph.groups[graph.clusters[own as usize].group as usize].is_last()));
        assert_eq!(of == Kinds::Sphere, exact.is_empty());
        for _ in 0..if std::env::var_os("LODRAY_NIGHTLY").is_some() { 170 } else { 20 } {
            let (rule, eyes) = any_choice(&mut random, &graph);
            let cut = Cut::new(&graph, &rule, &eyes);
            let triangles: usize = chosen(&graph, &cut).count();
            fewest = fewest.min(triangles);
            mixed += usize::from(cut.clusters.len() > coarsest.clusters.len() && triangles < graph.finest);
            let open = edges(&graph, chosen(&graph, &cut));
            if of == Kinds::Sphere {
                assert!(open.is_empty(), "{kind:?}: {} open edges, {rule:?} {eyes:?}", open.len());
            } else {
                // Open borders may be simplified, and are all that is open: a box around them holds no less.
                assert!(open.len() <= exact.len(), "{of:?} {kind:?}: {} open edges of {}", open.len(), exact.len());
            }
            let asked: HashSet<_> = cut.asked.iter().collect();
            assert_eq!(asked.len(), cut.asked.len());
        }
    }
    println!("{mixed} mixed choices, {fewest} triangles at least");
    assert!(mixed > 40 && fewest < 1000, "{mixed} mixed choices, {fewest} triangles at least");
}

#[test]
fn packed_clusters_are_read_back_in_four_to_eight_bytes_a_triangle() {
    for (of, kind, graph) in graphs() {
        let mut bytes = [0; 2];
        for cluster in &graph.clusters {
            let (packed, (dense, _)) = (pack(&graph, cluster), pack_dense(&graph, cluster));
            bytes[0] += packed.len();
            bytes[1] += 128 * dense.len();
            let turned = |t: [Place; 3]| {
                let least = (0..3).min_by_key(|&k| t[k]).unwrap();
                [t[least], t[(least + 1) % 3], t[(least + 2) % 3]]
            };
            let places = |t: &[u32; 3]| turned(t.map(|v| graph.places[v as usize]));
            let mut own: Vec<_> = graph.triangles[cluster.triangles()].iter().map(places).collect();
            own.sort_unstable();
            for back in [unpack(&packed), unpack_dense(&dense)] {
                let mut back: Vec<_> = back.into_iter().map(turned).collect();
                back.sort_unstable();
                assert_eq!(own, back);
            }
        }
        let per = bytes.map(|bytes| bytes as f64 / graph.triangles.len() as f64);
        println!("{of:?} {kind:?}: {per:.2?} bytes a triangle");
        assert!(per.iter().all(|per| (4.0..=8.0).contains(per)), "{of:?} {kind:?}: {per:.2?} bytes a triangle");
    }
}

#[test]
fn names_of_hits_are_triangles_of_the_surface() {
    let scene = scene(Kinds::Sphere, 3);
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View::default(), &space, 32, 32).unwrap();
    let sight = Sight::new(&camera, &space, 1.0);
    let method = Clusters::of(&scene, &Knobs::default().with(&ERROR, "0").unwrap(), Kind::Shipped).unwrap();
    let whole = (bvh::METHOD.make)(&scene, &Knobs::default(), &NoStore).unwrap();
    let mut whole = whole.tracer(&sight);
    let surface = method.surface(&scene);
    assert_eq!((surface.levels(), surface.trees()), (0, method.shared.graph.triangles.len()));
    let mut tracer = method.tracer(&sight);
    let (mut met, mut alike) = (0, 0);
    for pixel in 0..32 * 32 {
        let query = camera.ray(pixel % 32, pixel / 32);
        let Some(hit) = tracer.hit(&query) else { continue };
        met += 1;
        let length = query.direction.iter().map(|c| c * c).sum::<f64>().sqrt();
        let point: [f64; 3] = std::array::from_fn(|k| query.origin[k] + hit.distance * query.direction[k] / length - space.centre()[k]);
        // Normals are those of the full resolution there; the surface has its triangles where the rays met them.
        let normal = whole.hit(&query).map(|full| full.normal(&scene).dot(hit.normal(surface)));
        alike += u32::from(normal.is_some_and(|cosine| cosine > 0.9));
        let placement = surface.meta().placement;
        let corners = surface.triangle(hit.tree as usize, 0, 0);
        for k in 0..3 {
            let own: f64 = (0..3).map(|c| f64::from(hit.bary[c]) * f64::from(corners[c][k])).sum();
            let world = placement.offset[k] + placement.scale * own - space.centre()[k];
            assert!((world - point[k]).abs() < 1e-4 * space.radius(), "{world} {}", point[k]);
        }
    }
    assert!(met > 200 && alike * 20 > met * 19, "{alike} of {met}");
}

/// What work reads, writes and does.
#[derive(Debug, Default, PartialEq)]
struct Sum {
    read: HashMap<SectionId, HashSet<u32>>,
    written: HashMap<SectionId, Vec<u32>>,
    works: [u64; 4],
}

fn sum(before: &dyn Before) -> Sum {
    let mut sum = Sum::default();
    for batch in (0..before.batches()).map(|batch| before.batch(batch)) {
        assert!(batch.is_work() && batch.rays() > 0);
        for step in batch.words().iter().map(|word| word.step()) {
            if let Act::Work { work, count } = step.act {
                sum.works[work as usize] += u64::from(count);
            }
            let Some(fetch) = step.fetch else { continue };
            let lines = fetch.line..fetch.line + fetch.lines;
            if fetch.stores {
                sum.written.entry(fetch.section).or_default().extend(lines);
            } else {
                sum.read.entry(fetch.section).or_default().extend(lines);
            }
        }
    }
    sum
}

#[test]
fn what_is_read_before_a_frame_is_chosen_and_every_line_of_its_bvh_is_written_once() {
    let scene = scene(Kinds::Terrain, 4);
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &space, 64, 64).unwrap();
    for kind in KINDS {
        let method = Clusters::of(&scene, &Knobs::default(), kind).unwrap();
        let sight = Sight::new(&camera, &space, 1.0);
        let (map, frame) = (method.map(&sight), method.frame(&sight, None));
        let found = sum(&*method.before(&sight, 0).unwrap());
        for (section, lines) in map.sections().map(|(section, of)| (section, of.lines)) {
            let mut written = found.written.get(&section).cloned().unwrap_or_default();
            written.sort_unstable();
            let all: Vec<u32> = (0..lines).map(|line| map.line(section, line)).collect();
            match section {
                NODES | LEAVES | ROOTS => assert_eq!(written, all, "{kind:?} {section:?}"),
                _ => assert!(written.is_empty()),
            }
        }
        let sizes = &method.shared.sizes;
        let packed: u32 = frame.cut.clusters.iter().map(|&own| sizes[own as usize].bytes.div_ceil(32)).sum();
        assert_eq!(found.read[&CLUSTERS].len(), packed as usize);
        assert_eq!((found.read[&GROUPS].len(), found.works[0]), (frame.cut.asked.len(), frame.cut.asked.len() as u64));
        let vertices: u64 = frame.cut.clusters.iter().map(|&own| u64::from(sizes[own as usize].vertices)).sum();
        assert_eq!(found.works[1], vertices);
    }
}

#[test]
fn a_frame_that_stays_costs_nothing_and_one_that_moves_what_changed() {
    let scene = scene(Kinds::Terrain, 4);
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View { distance: Some(1.5), ..View::default() }, &space, 64, 64).unwrap();
    let method = Clusters::of(&scene, &Knobs::default(), Kind::Shipped).unwrap();
    let frames = |cameras: Vec<Camera>| Sight::new(&CameraPath::new(cameras), &space, 1.0);
    let still = frames(vec![camera, camera, camera]);
    assert!(method.before(&still, 0).is_some() && method.before(&still, 1).is_none() && method.before(&still, 2).is_none());
    let unpacked = |sight: &Sight, frame| sum(&*method.before(sight, frame).unwrap()).read.get(&CLUSTERS).map_or(0, HashSet::len);
    let (slow, jump) = (frames(vec![camera, camera.turned(2.0)]), frames(vec![camera, camera.turned(180.0)]));
    let [first, small, large] = [unpacked(&slow, 0), unpacked(&slow, 1), unpacked(&jump, 1)];
    assert!(small * 4 < first && small < large && large * 8 > first, "{first} {small} {large}");
    // Each frame's rays go through its own.
    let [own, other] = [0, 1].map(|frame| method.frame(&jump, Some(frame)).cut.clusters.clone());
    assert_ne!(own, other);
}
