//! Registers without reset, elastic registers and pipelines: what `rtl/` is made of, around the functions of [`crate::block`].

use crate::block::{Block, Timing};
use crate::hardware::Hardware;
use std::collections::VecDeque;

/// A register without reset: unknown until it is first written, and then it keeps what it holds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Register<T>(Option<T>);

impl<T: Copy + Default> Register<T> {
    /// What it holds; zero while that is unknown, as where a simulation starts from zero. What is unknown is never used to decide.
    pub fn get(&self) -> T {
        self.0.unwrap_or_default()
    }

    /// What it holds, if it was ever written.
    pub fn known(&self) -> Option<T> {
        self.0
    }

    /// Writes it.
    pub fn set(&mut self, value: T) {
        self.0 = Some(value);
    }

    /// Something else takes its place.
    pub fn forget(&mut self) {
        self.0 = None;
    }
}

/// The elastic register of `rtl/pipe_stage.sv`: takes an item when it is empty or its item leaves in the same cycle.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stage<T>(Option<T>);

impl<T: Copy> Stage<T> {
    /// The item offered.
    pub fn offered(&self) -> Option<T> {
        self.0
    }

    /// It would take an item in this cycle.
    pub fn ready(&self, consumer_ready: bool) -> bool {
        consumer_ready || self.0.is_none()
    }

    /// The end of a cycle.
    pub fn tick(&mut self, input: Option<T>, consumer_ready: bool) {
        if self.ready(consumer_ready) {
            self.0 = input;
        }
    }
}

/// What a block did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlockCounts {
    /// Inputs taken.
    pub taken: u64,
    /// Cycles in which an input was offered and not taken.
    pub refused: u64,
    /// Cycles with an item inside.
    pub busy: u64,
    /// Items inside, summed over all cycles.
    pub occupancy: u64,
}

/// A block as a pipeline: the function of `B` at its entry, and `latency` elastic registers behind.
///
/// A chain of elastic registers squeezes its bubbles out while its end waits. A block with an interval takes an input and then none for
/// `interval` - 1 cycles; its consumer must always be ready (for iterative blocks that is: the next input in the very cycle the result leaves).
pub struct Pipeline<B: Block> {
    timing: Timing,
    /// Items under way with their tags and the registers they are in, 1 to `latency`, the oldest first.
    items: VecDeque<(u32, B::Out, u16)>,
    /// Cycles until the next input can be taken.
    wait: u32,
    counts: BlockCounts,
}

impl<B: Block> Pipeline<B>
where
    B::Out: Copy,
{
    /// An empty pipeline of the block's timing in this hardware.
    pub fn new(hardware: &Hardware) -> Self {
        Self::of(hardware.timing::<B>())
    }

    /// The same with the registers of its way from the contexts and back ([`Hardware::link_registers`]): as these hold nothing up, a longer pipeline.
    pub fn linked(hardware: &Hardware) -> Self {
        Self::in_turns(hardware, 1)
    }

    /// The same of so many blocks that take turns: as they take an item every so many cycles, one pipeline with a shorter interval.
    pub fn in_turns(hardware: &Hardware, copies: u32) -> Self {
        let timing = hardware.linked(hardware.timing::<B>());
        Self::of(Timing { interval: timing.interval.div_ceil(copies), ..timing })
    }

    fn of(timing: Timing) -> Self {
        Self { timing, items: VecDeque::new(), wait: 0, counts: BlockCounts::default() }
    }

    /// Whether it would take an input in this cycle.
    pub fn ready(&self, consumer_ready: bool) -> bool {
        // Full to the last register, it moves only if its end does.
        self.wait == 0 && (consumer_ready || self.items.len() < self.timing.latency as usize)
    }

    /// The result offered, with its tag.
    pub fn offered(&self) -> Option<(B::Out, u16)> {
        self.items.front().filter(|item| item.0 == self.timing.latency).map(|&(_, out, tag)| (out, tag))
    }

    /// What it did so far.
    pub fn counts(&self) -> BlockCounts {
        self.counts
    }

    /// The end of a cycle; `input` is taken if the pipeline is ready.
    pub fn tick(&mut self, input: Option<(&B::In, u16)>, consumer_ready: bool) {
        debug_assert!(consumer_ready || self.timing.interval == 1, "{}: only pipelines of interval 1 can wait", B::NAME);
        let ready = self.ready(consumer_ready);
        self.counts.busy += u64::from(!self.items.is_empty());
        self.counts.occupancy += self.items.len() as u64;
        if consumer_ready && self.offered().is_some() {
            self.items.pop_front();
        }
        // Each item moves on, at most to right behind the one before it.
        let mut room = self.timing.latency;
        for (place, ..) in &mut self.items {
            if *place < room {
                *place += 1;
            }
            room = *place - 1;
        }
        self.wait = self.wait.saturating_sub(1);
        match input {
            Some((input, tag)) if ready => {
                self.items.push_back((1, B::eval(input), tag));
                self.wait = self.timing.interval - 1;
                self.counts.taken += 1;
            }
            Some(_) => self.counts.refused += 1,
            None => (),
        }
    }
}
