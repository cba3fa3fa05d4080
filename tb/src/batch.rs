//! A batch of transactions at the ports of a block: its buffers, and its run in the shim.

use crate::library::RawBatch;
use crate::sim::c_path;
use crate::{Error, Sim};
use std::ops::Range;
use std::path::Path;

/// What the shim saw at the ports that no block may do.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Violation {
    ValidDropped,
    OutputChanged,
    Unexpected,
    Timeout,
    Assertion,
    Combinational,
}

impl Violation {
    fn of(code: u32) -> Option<Self> {
        match code {
            0 => None,
            1 => Some(Self::ValidDropped),
            2 => Some(Self::OutputChanged),
            3 => Some(Self::Unexpected),
            4 => Some(Self::Timeout),
            6 => Some(Self::Combinational),
            _ => Some(Self::Assertion),
        }
    }

    /// The rule broken.
    pub fn text(self) -> &'static str {
        match self {
            Self::ValidDropped => "valid_o fell before ready_i took the output",
            Self::OutputChanged => "out_o or tag_o changed before ready_i took the output",
            Self::Unexpected => "an output without an input",
            Self::Timeout => "no transfer on either side any more, though inputs or outputs are due",
            Self::Assertion => "an assertion of the RTL failed (Verilator has printed it)",
            Self::Combinational => "valid_o, out_o or tag_o depends on an input within the cycle",
        }
    }
}

/// Inputs, what the Rust block makes of them, and what came out.
#[derive(Default)]
pub(crate) struct Batch {
    /// Number of transactions.
    pub count: usize,
    /// Index of the first one.
    pub first: u64,
    pub seed: u64,
    pub inputs: Vec<u64>,
    pub expected: Vec<u64>,
    pub outputs: Vec<u64>,
    pub tags: Vec<u64>,
    pub out_tags: Vec<u64>,
    /// Cycle in which each input was first offered, and in which it was taken.
    pub presented: Vec<u64>,
    pub accepted: Vec<u64>,
    /// Cycle in which each output was first offered, and in which it was taken.
    pub offered: Vec<u64>,
    pub delivered: Vec<u64>,
    /// Cycles from the end of reset.
    pub cycles: u64,
    /// Outputs that came.
    pub received: usize,
    pub violation: Option<Violation>,
}

/// How batches of one check are played.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shape {
    pub in_words: usize,
    pub out_words: usize,
    pub stalled: bool,
    pub latency: u32,
}

impl Batch {
    /// Makes room for the results.
    pub fn prepare(&mut self, shape: Shape) {
        let cycles = [&mut self.presented, &mut self.accepted, &mut self.offered, &mut self.delivered].map(|cycles| (cycles, 1));
        for (results, words) in [(&mut self.outputs, shape.out_words), (&mut self.out_tags, 1)].into_iter().chain(cycles) {
            results.clear();
            results.resize(self.count * words, 0);
        }
    }

    /// Plays it: reset, all inputs in, all outputs out, and a few cycles more. `waves` asks for a waveform of some of its cycles.
    pub fn run(&mut self, sim: &mut Sim, shape: Shape, waves: Option<(&Path, Range<u64>)>) -> Result<(), Error> {
        self.prepare(shape);
        let (count, in_words, out_words) = (self.count, shape.in_words, shape.out_words);
        assert!(
            count > 0 && self.inputs.len() == count * in_words && self.tags.len() == count && self.outputs.len() == count * out_words,
            "a batch of {count} with buffers of other lengths"
        );
        let Some(run) = sim.model().functions.run else {
            return Err(Error::Ports { top: sim.model().top().to_owned(), what: "not the ports of a block".to_owned() });
        };
        let name = waves.as_ref().map(|(path, _)| c_path(path)).transpose()?;
        let window = waves.map_or(0..0, |(_, window)| window);
        let mut raw = RawBatch {
            input: self.inputs.as_ptr(),
            tags: self.tags.as_ptr(),
            out: self.outputs.as_mut_ptr(),
            out_tags: self.out_tags.as_mut_ptr(),
            presented: self.presented.as_mut_ptr(),
            accepted: self.accepted.as_mut_ptr(),
            offered: self.offered.as_mut_ptr(),
            delivered: self.delivered.as_mut_ptr(),
            in_stride: in_words as u64,
            out_stride: out_words as u64,
            count: count as u64,
            seed: self.seed,
            patience: 20_000 + 20 * u64::from(shape.latency),
            quiet: 4 + u64::from(shape.latency),
            vcd_from: window.start,
            vcd_to: window.end,
            vcd: name.as_ref().map_or(std::ptr::null(), |name| name.as_ptr()),
            stalled: u32::from(shape.stalled),
            violation: 0,
            cycles: 0,
            received: 0,
        };
        // SAFETY: the buffers hold `count` entries of the strides, which `check_block` compared with the model's port widths; the shim
        // keeps none of the pointers.
        unsafe { run(sim.instance(), &mut raw) };
        self.violation = Violation::of(raw.violation);
        self.cycles = raw.cycles;
        self.received = raw.received as usize; // at most `count`
        Ok(())
    }
}
