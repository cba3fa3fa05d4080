//! Refit of the terrain of the paper's size (8,388,608 triangles) against its rivals over the same triangles: the quad-BVH built anew, that BVH refitted, and the BVHs of all levels of
//! discrete level of detail refitted. Each gets positions in world units or their points in units; leaves of BVHs are written anew too.
//!
//! `LODRAY_TERRAIN_LEVELS` makes the scene smaller for a quick look. What each reads and writes is printed first.

use criterion::{Criterion, SamplingMode, Throughput, criterion_group, criterion_main};
use lodray::bvh::{Box32, refit};
use lodray::format::{FileSection, Line, RefitOptions, Scene, Shading, VertexData};
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{Hierarchy, Motion, lattice};
use lodray::method::bvh::{FullBuilder, FullBvh, FullNodes, FullOptions, LeafLayout, NodeBoxes, cut_triangle, level_ids};
use lodray::num::Wire;
use rayon::prelude::*;
use std::hint::black_box;

/// The rival: boxes of 5 bits, leaves of up to four triangles, a line each.
fn options() -> FullOptions {
    FullOptions::new(4, NodeBoxes::Local, LeafLayout::Line)
}

/// A quad-BVH whose triangles move.
struct Rival {
    nodes: Vec<Line>,
    /// Points of its triangles, in the order of the leaves.
    corners: Vec<[u32; 3]>,
    leaves: Vec<Line>,
}

impl Rival {
    fn of_level(h: &Hierarchy, level: u32) -> Self {
        let builder = FullBuilder::of_cut(h, level_ids(h, level)).expect("a cut");
        let tree = builder.tree(&options()).expect("options");
        let leaves = tree.leaves(h, LeafLayout::Line).expect("its hierarchy");
        let (levels, len) = (h.levels, lattice::len(h.levels));
        let corners = |slot: usize| {
            let of = cut_triangle(levels, leaves.triangle(slot).1);
            // Fewer than 2^32 points.
            lattice::node(levels, of.level, of.node).map(|p| (of.tree as usize * len + lattice::index(levels, p)) as u32)
        };
        let corners: Vec<_> = (0..leaves.len()).into_par_iter().map(corners).collect();
        let FullNodes::Local(nodes) = &*tree.nodes() else { unreachable!("nodes of local boxes") };
        Self { nodes: nodes.clone(), leaves: vec![[0; 4]; corners.len()], corners }
    }

    /// Boxes anew, and leaves.
    fn refit(&mut self, h: &Hierarchy) {
        let at = |corners: &[u32; 3]| corners.map(|point| h.points[point as usize]);
        let leaf = |first: u32, count: u32| {
            let own = self.corners[first as usize..][..count as usize].iter().map(|corners| Box32::of_triangle(at(corners)));
            own.reduce(|a, b| a.union(&b)).expect("a leaf has triangles")
        };
        self.nodes = refit(&self.nodes, &leaf);
        let lines = self.leaves.par_iter_mut().zip(&self.corners);
        lines.with_min_len(1 << 12).for_each(|(line, corners)| VertexData::from_points(at(corners)).to_words(line));
    }

    fn bytes(&self) -> usize {
        size_of_val(self.nodes.as_slice()) + size_of_val(self.leaves.as_slice())
    }
}

fn benches(c: &mut Criterion) {
    let levels = std::env::var("LODRAY_TERRAIN_LEVELS").ok().and_then(|v| v.parse().ok());
    let scene = Scene::generate(&Options { levels, ..Options::new(procedural::Scene::Terrain) }).expect("options");
    let mut moving = scene.refitting().expect("whole");
    let rest = moving.positions();
    let moved = [0.1, 0.35].map(|time| Motion::Wave.at(&rest, time));
    let h = moving.move_to(&moved[0], RefitOptions::default()).expect("positions").decode();
    let mut rival = Rival::of_level(&h, h.levels);
    let triangles = h.finest_triangles();

    let parts = [FileSection::Nodes, FileSection::Records, FileSection::Splits, FileSection::Vertices];
    let own: usize = parts.map(|part| moving.scene().section(part).len()).iter().sum();
    let normals = moving.scene().section(FileSection::Normals).len();
    let positions = 12 * moving.vertices();
    println!("{triangles} triangles; positions as three floats of 32 bits: {positions} bytes");
    println!("refit writes {own} bytes, and {normals} of normals; the BVH's refit {}", rival.bytes());

    let mut group = c.benchmark_group("refit of the terrain");
    group.throughput(Throughput::Elements(triangles)).sample_size(10).sampling_mode(SamplingMode::Flat);
    for shading in Shading::ALL {
        let options = RefitOptions { shading, ..RefitOptions::default() };
        let mut turn = 0;
        group.bench_function(format!("scene, normals {}", shading.name()), |b| {
            b.iter(|| {
                turn += 1;
                black_box(moving.move_to(&moved[turn % 2], options).expect("positions").bytes().len())
            });
        });
    }
    group.bench_function("BVH built anew", |b| b.iter(|| black_box(FullBvh::build(&h, &options()).expect("a valid model"))));
    group.bench_function("BVH refitted", |b| b.iter(|| rival.refit(&h)));
    drop(rival);
    let mut levels: Vec<Rival> = (0..=h.levels).map(|level| Rival::of_level(&h, level)).collect();
    println!("all levels of discrete: {} bytes", levels.iter().map(Rival::bytes).sum::<usize>());
    group.bench_function("BVHs of all levels refitted", |b| b.iter(|| levels.iter_mut().for_each(|level| level.refit(&h))));
    group.finish();
}

criterion_group!(all, benches);
criterion_main!(all);
