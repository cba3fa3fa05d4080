//! The machine as a waveform (VCD): queues, misses under way and cache events, for a window of cycles.
//!
//! Values are those at the end of a cycle and stand from the time at which it begins. Events (`hits`, `misses`, ...) are how many happened in that cycle.

use super::counts::Counts;
use crate::machine::Cores;
use std::io;
use vcd::{IdCode, TimescaleUnit, Value, VarType};

/// Bits of every value: no queue is longer.
const BITS: u32 = 16;

/// A stretch of cycles, both ends included.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// Its first.
    pub from: u64,
    /// Its last.
    pub to: u64,
}

/// The waveform of a window.
pub(super) struct Wave {
    writer: vcd::Writer<Vec<u8>>,
    window: Window,
    signals: Vec<(IdCode, Option<u64>)>,
    /// The cycle of the last look, counts at its start, and counts then.
    looked: u64,
    before: Events,
    latest: Events,
    /// The last cycle that was written.
    sampled: Option<u64>,
}

/// Counts whose growth in a cycle is shown.
type Events = [u64; 10];

/// Their names.
const EVENTS: [&str; 10] =
    ["l1_hits", "l1_misses", "l1_merges", "l1_stores", "l2_hits", "l2_misses", "l2_merges", "l2_write_backs", "dram_reads", "rays_done"];

fn events(c: &Counts) -> Events {
    let reads = c.traffic.iter().map(|kind| kind.dram).sum();
    [c.l1.hits, c.l1.misses, c.l1.merges, c.l1.stores, c.l2.hits, c.l2.misses, c.l2.merges, c.l2.write_backs, reads, c.rays]
}

/// Takes a signal: its scope, name and value.
pub(super) type Shown<'a> = dyn FnMut(&str, &str, u64) + 'a;

/// What a machine is like at the end of a cycle.
pub(super) struct Look<'a> {
    /// The cycle.
    pub now: u64,
    /// What was counted so far.
    pub counts: Counts,
    /// Gives scope, name and value of every signal, always in the same order; a scope's signals follow each other.
    pub show: &'a dyn Fn(&mut Shown<'_>),
}

impl Wave {
    /// The waveform of `window`, not begun.
    pub fn new(window: Window) -> Self {
        Self {
            writer: vcd::Writer::new(Vec::new()),
            window,
            signals: Vec::new(),
            looked: 0,
            before: Events::default(),
            latest: Events::default(),
            sampled: None,
        }
    }

    /// The end of this cycle, after which nothing happens until `next`, if anything does; a cycle may have several ends, when memory answers
    /// at once.
    ///
    /// # Errors
    /// Only what the writer of waveforms says; memory takes everything.
    pub fn sample(&mut self, look: &Look<'_>, cores: &Cores, next: Option<u64>) -> io::Result<()> {
        let (now, after) = (look.now, events(&look.counts));
        if now > self.looked {
            (self.looked, self.before) = (now, self.latest);
        }
        self.latest = after;
        if now < self.window.from {
            // The window may begin, and end, where nothing happens.
            if next.is_some_and(|next| next > self.window.from) {
                self.sampled = Some(self.window.from);
                self.show(self.window.from, Events::default(), look, cores)?;
            }
            return Ok(());
        }
        if now > self.window.to && self.sampled.is_none_or(|last| last >= self.window.to) {
            return Ok(());
        }
        // Nothing happened between two samples.
        if let Some(quiet) = self.sampled.map(|last| last + 1).filter(|&next| next < now) {
            self.writer.timestamp(cores.start_ps(quiet))?;
            for k in 0..EVENTS.len() {
                self.set(k, 0)?;
            }
        }
        self.sampled = Some(now);
        if now > self.window.to {
            return Ok(());
        }
        let events = std::array::from_fn(|k| after[k] - self.before[k]);
        self.show(now, events, look, cores)
    }

    /// Writes what is so in a cycle.
    fn show(&mut self, cycle: u64, events: Events, look: &Look<'_>, cores: &Cores) -> io::Result<()> {
        if self.signals.is_empty() {
            self.declare(look)?;
        }
        self.writer.timestamp(cores.start_ps(cycle))?;
        for (k, count) in events.into_iter().enumerate() {
            self.set(k, count)?;
        }
        let mut values = Vec::with_capacity(self.signals.len());
        (look.show)(&mut |_, _, value| values.push(value));
        for (k, value) in values.into_iter().enumerate() {
            self.set(EVENTS.len() + k, value)?;
        }
        Ok(())
    }

    fn declare(&mut self, look: &Look<'_>) -> io::Result<()> {
        let writer = &mut self.writer;
        writer.version("lodray, replay")?;
        writer.timescale(1, TimescaleUnit::PS)?;
        writer.add_module("machine")?;
        writer.add_module("events")?;
        for name in EVENTS {
            self.signals.push((writer.add_var(VarType::Wire, BITS, name, None)?, None));
        }
        let mut names: Vec<(String, String)> = Vec::new();
        (look.show)(&mut |scope, name, _| names.push((scope.to_owned(), name.to_owned())));
        let mut open = "events".to_owned();
        for (scope, name) in names {
            if scope != open {
                writer.upscope()?;
                writer.add_module(&scope)?;
                open = scope;
            }
            self.signals.push((writer.add_var(VarType::Wire, BITS, &name, None)?, None));
        }
        writer.upscope()?;
        writer.upscope()?;
        writer.enddefinitions()
    }

    fn set(&mut self, signal: usize, value: u64) -> io::Result<()> {
        let (id, last) = &mut self.signals[signal];
        if last.replace(value) == Some(value) {
            return Ok(());
        }
        let shown = value.min((1 << BITS) - 1);
        let bits = (0..BITS).rev().map(|bit| if shown >> bit & 1 == 1 { Value::V1 } else { Value::V0 });
        self.writer.change_vector(*id, bits)
    }

    /// The file's bytes.
    pub fn into_bytes(mut self) -> Vec<u8> {
        std::mem::take(self.writer.writer())
    }
}
