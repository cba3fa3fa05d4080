//! Distinct lines of leaf layouts that share a tree, counted in one go: rays take the same way through all of them.

use super::{Camera, LineSets};
use crate::bvh::{FullBvh, LINE_BYTES, Leaves};
use crate::traverse::{BvhTraverser, ClosestHit, Kind, ModelSpace, Probe, Section, bvh_sections};
use rayon::prelude::*;
use std::ops::Range;

/// Rows of a band, which is one unit of work, and columns of its tiles.
const ROWS: u32 = 8;
const COLUMNS: u32 = 32;

/// Marks the lines of a BVH, and of the leaves that could be in place of its own.
struct LayoutProbe<'a> {
    sets: &'a LineSets,
    others: &'a [(&'a Leaves, LineSets)],
}

impl Probe for LayoutProbe<'_> {
    #[inline(always)]
    fn line(&mut self, kind: Kind, line: u64) {
        self.sets.mark(kind, line);
    }

    #[inline(always)]
    fn leaf(&mut self, slots: Range<usize>) {
        for (leaves, set) in self.others {
            leaves.lines(slots.clone(), |address| set.mark(Kind::Leaf, address / LINE_BYTES));
        }
    }
}

/// Distinct 32-byte lines that a frame touches: of `bvh`, then of the same with each of `others`, which hold the same triangles, in place of its
/// leaves. `rows_done` is told of finished rows, from any thread.
pub fn distinct_lines(
    bvh: &FullBvh,
    others: &[&Leaves],
    space: &ModelSpace,
    camera: &Camera,
    rows_done: &(dyn Fn(u64) + Sync),
) -> Vec<u64> {
    let section = |leaves: &Leaves| Section { kind: Kind::Leaf, lines: leaves.bytes().div_ceil(LINE_BYTES) };
    let sets = LineSets::new(&bvh_sections(bvh));
    let others: Vec<_> = others.iter().map(|&leaves| (leaves, LineSets::new(&[section(leaves)]))).collect();
    let height = camera.height;
    let [columns, window_rows] = camera.window(space);
    (0..height.div_ceil(ROWS)).into_par_iter().for_each_init(
        || BvhTraverser::new(bvh),
        |traverser, band| {
            let rows = band * ROWS..height.min((band + 1) * ROWS);
            let mut probe = LayoutProbe { sets: &sets, others: &others };
            for left in columns.clone().step_by(COLUMNS as usize) {
                for y in rows.clone().filter(|y| window_rows.contains(y)) {
                    for x in left..columns.end.min(left + COLUMNS) {
                        // A BVH is at full resolution whatever the quality.
                        if let Some(ray) = space.enter(&camera.ray(x, y), 1.0) {
                            traverser.trace(&ray.ray, &mut probe, &mut ClosestHit::new(traverser.levels()));
                        }
                    }
                }
            }
            rows_done(rows.len() as u64);
        },
    );
    let counts = sets.counts();
    let nodes = counts[Kind::BvhNode as usize];
    let leaves = std::iter::once(counts[Kind::Leaf as usize]).chain(others.iter().map(|(_, set)| set.counts()[Kind::Leaf as usize]));
    leaves.map(|lines| nodes + lines).collect()
}
