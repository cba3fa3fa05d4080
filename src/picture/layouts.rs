//! Distinct lines of leaf layouts that share a tree, counted in one go: rays take the same way through all of them.

use crate::method::ClosestHit;
use crate::method::bvh::{BvhTraverser, FullBvh, LEAVES, Leaf, Leaves, NODES, bvh_map};
use crate::num::LINE_BYTES;
use crate::rays::{Camera, ModelSpace};
use crate::step::{LineSets, MemoryMap, Section, Step, StepSink};
use rayon::prelude::*;

/// Rows of a band, which is one unit of work, and columns of its tiles.
const ROWS: u32 = 8;
const COLUMNS: u32 = 32;

/// Marks the lines of a BVH.
struct Marker<'a>(&'a LineSets);

impl StepSink for Marker<'_> {
    #[inline(always)]
    fn step(&mut self, step: Step) {
        self.0.mark_step(&step);
    }
}

/// Distinct 32-byte lines that a frame touches: of `bvh`, then of the same with each of `others`, which hold the same triangles and are no blocks, in place of its
/// leaves. `rows_done` is told of finished rows, from any thread.
pub fn distinct_lines(
    bvh: &FullBvh,
    others: &[&Leaves],
    space: &ModelSpace,
    camera: &Camera,
    rows_done: &(dyn Fn(u64) + Sync),
) -> Vec<u64> {
    // Leaves that could be in place of its own: a memory of theirs alone.
    let alone = |leaves: &Leaves| MemoryMap::new(&[Section::of_bytes("leaf", leaves.bytes())], None).map(|map| LineSets::new(&map));
    let sets = LineSets::new(&bvh_map(&[bvh]));
    let others: Vec<_> = others.iter().map(|&leaves| (leaves, alone(leaves).expect("at most 2^28 triangles"))).collect();
    let height = camera.height;
    let [columns, window_rows] = camera.window(space);
    (0..height.div_ceil(ROWS)).into_par_iter().for_each_init(
        || BvhTraverser::new(bvh),
        |traverser, band| {
            let rows = band * ROWS..height.min((band + 1) * ROWS);
            let others = |leaf: &Leaf| {
                for (leaves, set) in &others {
                    // Below 2^32 lines.
                    leaves.lines(leaf, |address| set.mark((address / LINE_BYTES) as u32));
                }
            };
            for left in columns.clone().step_by(COLUMNS as usize) {
                for y in rows.clone().filter(|y| window_rows.contains(y)) {
                    for x in left..columns.end.min(left + COLUMNS) {
                        // A BVH is at full resolution whatever the quality.
                        if let Some(ray) = space.enter(&camera.ray(x, y), 1.0) {
                            let mut closest = ClosestHit::new(traverser.levels());
                            traverser.trace_with(&ray.ray, &mut Marker(&sets), &mut closest, others);
                        }
                    }
                }
            }
            rows_done(rows.len() as u64);
        },
    );
    let counts = sets.counts();
    let nodes = counts[NODES.place()];
    let leaves = std::iter::once(counts[LEAVES.place()]).chain(others.iter().map(|(_, set)| set.counts()[0]));
    leaves.map(|lines| nodes + lines).collect()
}
