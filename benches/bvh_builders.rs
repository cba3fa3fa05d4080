//! Our builder of BVHs against the best of crate obvhs (PLOC, insertion of nodes elsewhere), both collapsed alike to the same nodes and leaves: cost by the surface
//! area heuristic, nodes, and nodes and lines read by a ray; and what each took. Prints a table; theirs over ours.
//!
//! `LODRAY_TERRAIN_LEVELS` sets the number of splits: 6, unless it is stated.

use lodray::bvh::{BinaryNode, over_trees};
use lodray::format::{self, SceneInfo};
use lodray::mesh::procedural::{self, Options, Scene};
use lodray::mesh::{Hierarchy, lattice};
use lodray::method::ClosestHit;
use lodray::method::bvh::{BvhTraverser, FullBuilder, FullOptions, LeafLayout, NodeBoxes};
use lodray::num::Ray;
use lodray::rays::{Camera, ModelSpace, View};
use lodray::step::StepCounts;
use obvhs::BvhBuildParams;
use obvhs::bvh2::builder::build_bvh2_from_tris;
use obvhs::triangle::Triangle;
use std::time::{Duration, Instant};

const SIDE: u32 = 512;

/// Triangles of full resolution, by their ids.
fn triangles(hierarchy: &Hierarchy) -> Vec<Triangle> {
    let levels = hierarchy.levels;
    let tree = |tree: usize| {
        let points = hierarchy.tree(tree);
        (0..1u32 << (2 * levels)).map(move |node| {
            let [v0, v1, v2] = lattice::node(levels, levels, node).map(|p| points[lattice::index(levels, p)].map(|c| c as f32).into());
            Triangle { v0, v1, v2 }
        })
    };
    (0..hierarchy.triangles.len()).flat_map(tree).collect()
}

/// Their tree: the slowest of their presets, a triangle a leaf.
fn theirs(triangles: &[Triangle]) -> Vec<BinaryNode> {
    let params = BvhBuildParams { max_prims_per_leaf: 1, pre_split: false, ..BvhBuildParams::very_slow_build() };
    let bvh = build_bvh2_from_tris(triangles, params, &mut Duration::default());
    let node = |node: &obvhs::bvh2::node::Bvh2Node| match node.prim_count {
        0 => BinaryNode::Inner([node.first_index, node.first_index + 1]),
        _ => BinaryNode::Leaf(bvh.primitive_indices[node.first_index as usize]),
    };
    bvh.nodes.iter().map(node).collect()
}

/// All rays of a frame that meet the model's box.
fn rays(space: &ModelSpace) -> Vec<Ray> {
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, space, SIDE, SIDE).expect("a view");
    let pixels = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y)));
    pixels.filter_map(|(x, y)| Some(space.enter(&camera.ray(x, y), 1.0)?.ray)).collect()
}

fn main() {
    let levels = std::env::var("LODRAY_TERRAIN_LEVELS").ok().and_then(|v| v.parse().ok()).unwrap_or(6);
    println!("{:<10}{:<28}{:>10}{:>10}{:>12}{:>12}{:>10}", "scene", "nodes and leaves", "cost", "nodes", "nodes/ray", "lines/ray", "time");
    for of in [Scene::Terrain, Scene::Cloth, Scene::Sphere, Scene::Room] {
        let surface = procedural::generate(&Options { levels: Some(levels), ..Options::new(of) }).expect("options");
        let scene = format::build(&surface, SceneInfo::default(), over_trees).expect("a scene");
        drop(surface);
        let (hierarchy, rays) = (scene.decode(), rays(&ModelSpace::of(&scene)));
        let begun = Instant::now();
        let ours = FullBuilder::new(&hierarchy).expect("a valid model");
        let our_time = begun.elapsed();
        let triangles = triangles(&hierarchy);
        let begun = Instant::now();
        let tree = theirs(&triangles);
        let their_time = begun.elapsed();
        drop(triangles);
        let builders = [ours, FullBuilder::with_binary(&hierarchy, &tree).expect("their tree")];
        for (boxes, layout, size) in
            [(NodeBoxes::Local, LeafLayout::Block, 16), (NodeBoxes::Codes, LeafLayout::Line, 1), (NodeBoxes::Six, LeafLayout::Block, 16)]
        {
            let options = FullOptions::new(size, boxes, layout);
            let [ours, theirs] = builders.each_ref().map(|builder| {
                let bvh = builder.tree(&options).and_then(|tree| tree.with_leaves(&hierarchy, layout)).expect("a valid model");
                let (mut traverser, mut counts) = (BvhTraverser::new(&bvh), StepCounts::default());
                for ray in &rays {
                    traverser.trace(ray, &mut counts, &mut ClosestHit::new(hierarchy.levels));
                }
                let lines: u64 = counts.lines.iter().sum();
                let each = |count: u64| count as f64 / rays.len() as f64;
                [builder.sah_cost(&options).expect("a valid model"), bvh.nodes.len() as f64, each(counts.nodes), each(lines)]
            });
            let [cost, nodes, visits, lines] = std::array::from_fn(|k| theirs[k] / ours[k]);
            let time = their_time.as_secs_f64() / our_time.as_secs_f64();
            let of_leaves = format!("{boxes:?}, {layout:?}, {size}");
            println!("{:<10}{of_leaves:<28}{cost:>10.3}{nodes:>10.3}{visits:>12.3}{lines:>12.3}{time:>10.2}", format!("{of:?}"));
        }
    }
}
