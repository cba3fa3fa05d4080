//! Work before a frame for models that move: the tree over them is built anew.

use crate::block::{INSTANCE_BIN, INSTANCE_BOX};
use crate::method::Before;
use crate::step::{Act, Batch, Fetch, MAX_FETCH_LINES, MemoryMap, Recorder, SectionId, Step, StepSink};
use std::ops::Range;

/// Places of a piece of work, and pieces of a batch.
const PIECE: usize = 16;
const PIECES: usize = 64;

/// Every place is read once and written where its model moved; every node is written once, spread evenly over the pieces. What is kept between levels of the tree stays on the chip.
pub(super) struct Rebuild {
    pub map: MemoryMap,
    /// The section of nodes, and lines of each; the section of places, and lines of each.
    pub nodes: (SectionId, u32),
    pub places: (SectionId, u32),
    /// How many nodes are written.
    pub count: usize,
    /// By place, whether it moved.
    pub moved: Vec<bool>,
}

impl Rebuild {
    /// The lines of things `which` of a section, asked for at once.
    fn run(&self, (section, each): (SectionId, u32), which: Range<usize>, stores: bool, steps: &mut Recorder) {
        let (first, end) = (which.start as u64 * u64::from(each), which.end as u64 * u64::from(each));
        for line in (first..end).step_by(MAX_FETCH_LINES as usize) {
            let count = (end - line).min(MAX_FETCH_LINES.into()) as u32; // at most 7
            let fetch = Fetch::new(section, self.map.line(section, line), count);
            let fetch = if stores { fetch.storing() } else { fetch };
            steps.step(Step::on(if line == first { fetch } else { fetch.joining() }, Act::Fetch));
        }
    }

    fn pieces(&self) -> usize {
        self.moved.len().div_ceil(PIECE)
    }

    fn piece(&self, piece: usize, steps: &mut Recorder) {
        let own = PIECE * piece..self.moved.len().min(PIECE * (piece + 1));
        self.run(self.places, own.clone(), false, steps);
        // A place is binned once on each level of a balanced binary tree.
        let levels = usize::BITS - self.moved.len().leading_zeros();
        let places = own.len() as u32; // at most 16
        steps.step(Step::of(Act::Work { work: INSTANCE_BOX, count: places }));
        steps.step(Step::of(Act::Work { work: INSTANCE_BIN, count: places * levels }));
        own.filter(|&k| self.moved[k]).for_each(|k| self.run(self.places, k..k + 1, true, steps));
        let share = |piece: usize| self.count * piece / self.pieces();
        self.run(self.nodes, share(piece)..share(piece + 1), true, steps);
        steps.step(Step::end(false, false));
    }
}

impl Before for Rebuild {
    fn batches(&self) -> usize {
        self.pieces().div_ceil(PIECES)
    }

    fn batch(&self, batch: usize) -> Batch {
        let mut recorder = Recorder::default();
        (batch * PIECES..self.pieces().min((batch + 1) * PIECES)).for_each(|piece| self.piece(piece, &mut recorder));
        recorder.work()
    }
}
