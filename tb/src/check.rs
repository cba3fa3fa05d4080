//! [`check_block`]: transactions through the RTL and the Rust block, compared bit for bit and cycle for cycle.

use crate::batch::{Batch, Shape};
use crate::failure::difference;
use crate::{Build, Error, Failure, Fault, Model, Sim};
use lodray::block::{Block, Timing};
use lodray::num::{Random, Wire};
use std::fmt::Debug;
use std::path::PathBuf;
use std::sync::{Arc, mpsc};

/// Transactions between two resets.
const BATCH: usize = 1 << 16;
/// Cycles of a waveform before and after the one asked for.
const WINDOW: (u64, u64) = (300, 40);

/// How the ports are driven.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    /// An input in every cycle that takes one, every output taken at once: latency and interval are exact.
    Free,
    /// Random pauses on both sides, from single cycles to long ones, and resets amid work. Ports carry rubbish where they are not valid.
    Stalled,
}

/// What a check does.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// How the ports are driven.
    pub mode: Mode,
    /// Seed of the stalls, tags and initial values; the caller makes its inputs from it too.
    pub seed: u64,
    /// The RTL's timing where a parameter makes it other than [`Block::TIMING`].
    pub timing: Option<Timing>,
}

impl Plan {
    /// With the block's own timing.
    pub fn new(mode: Mode, seed: u64) -> Self {
        Self { mode, seed, timing: None }
    }

    /// With the timing that the build's parameters give.
    pub fn timing(mut self, timing: Timing) -> Self {
        self.timing = Some(timing);
        self
    }
}

/// The seed to use: `default`, or that of `LODRAY_SEED` (decimal, or hexadecimal with `0x`).
pub fn seed(default: u64) -> Result<u64, Error> {
    let Ok(value) = std::env::var("LODRAY_SEED") else { return Ok(default) };
    let number = match value.strip_prefix("0x") {
        Some(digits) => u64::from_str_radix(digits, 16),
        None => value.parse(),
    };
    number.map_err(|_| Error::Setting { name: "LODRAY_SEED", value })
}

/// What a check that passed has seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Report {
    /// Transactions compared.
    pub transactions: u64,
    /// Cycles simulated, resets not counted.
    pub cycles: u64,
    /// Least cycles from input to output.
    pub min_latency: u64,
    /// Most of them.
    pub max_latency: u64,
    /// Least cycles from one input to the next.
    pub min_interval: u64,
    /// The seed.
    pub seed: u64,
}

/// Plays the inputs through the RTL and compares every output, tag and rule of the handshake with the Rust block; in [`Mode::Free`] also
/// latency and interval of every transaction, in [`Mode::Stalled`] that no output comes and no input goes later than those and the stalls make it. The first difference ends it; no input at all is an error.
pub fn check_block<B: Block>(build: &Build, plan: &Plan, inputs: impl IntoIterator<Item = B::In>) -> Result<Report, Error>
where
    B::In: Debug,
    B::Out: Debug,
{
    let model = build.model()?;
    let check = Check::<B>::new(build, plan, &model)?;
    let mut inputs = inputs.into_iter();
    let mut report = Report { transactions: 0, cycles: 0, min_latency: u64::MAX, max_latency: 0, min_interval: u64::MAX, seed: plan.seed };
    let shape = check.shape;
    let mut sim = Sim::new(&model, plan.seed);

    // The RTL plays one batch while this thread makes the next and compares the last.
    std::thread::scope(|scope| {
        let (to_rtl, work) = mpsc::sync_channel::<Batch>(1);
        let (from_rtl, done) = mpsc::channel();
        scope.spawn(move || {
            for mut batch in work {
                let result = batch.run(&mut sim, shape, None).map(|()| batch);
                if from_rtl.send(result).is_err() {
                    return;
                }
            }
        });
        let mut spare = Batch::default();
        let mut made = 0;
        let mut under_way = 0;
        loop {
            let more = check.fill(&mut spare, &mut inputs, made);
            if more {
                made += spare.count as u64;
                under_way += 1;
                // The other side ends only when this one hangs up.
                let _ = to_rtl.send(std::mem::take(&mut spare));
            }
            if under_way == 2 || (!more && under_way > 0) {
                under_way -= 1;
                let Ok(result) = done.recv() else { break };
                spare = result?;
                check.compare(&mut spare, &mut report)?;
            } else if !more {
                break;
            }
        }
        Ok::<(), Error>(())
    })?;
    match report.transactions {
        0 => Err(Error::Nothing(build.top().to_owned())),
        _ => Ok(report),
    }
}

struct Check<'a, B> {
    build: &'a Build,
    plan: &'a Plan,
    timing: Timing,
    tag_mask: u64,
    shape: Shape,
    block: std::marker::PhantomData<B>,
}

impl<'a, B: Block> Check<'a, B>
where
    B::In: Debug,
    B::Out: Debug,
{
    fn new(build: &'a Build, plan: &'a Plan, model: &Arc<Model>) -> Result<Self, Error> {
        let wrong = |what: String| Error::Ports { top: build.top().to_owned(), what };
        let (input, output, tag) = model.block().ok_or_else(|| wrong("not the ports of a block".to_owned()))?;
        if (input, output) != (B::In::WIDTH, B::Out::WIDTH) {
            let (rust_in, rust_out) = (B::In::WIDTH, B::Out::WIDTH);
            return Err(wrong(format!("in_i and out_o have {input} and {output} bits, {} has {rust_in} and {rust_out}", B::NAME)));
        }
        let timing = plan.timing.unwrap_or(B::TIMING);
        let shape =
            Shape { in_words: words(input), out_words: words(output), stalled: plan.mode == Mode::Stalled, latency: timing.latency };
        Ok(Self { build, plan, timing, tag_mask: u64::MAX >> (64 - tag), shape, block: std::marker::PhantomData })
    }

    /// The next batch with its expected outputs; false if no input is left.
    fn fill(&self, batch: &mut Batch, inputs: &mut impl Iterator<Item = B::In>, first: u64) -> bool {
        let Shape { in_words, out_words, .. } = self.shape;
        batch.inputs.clear();
        batch.expected.clear();
        batch.tags.clear();
        batch.first = first;
        batch.seed = mix(self.plan.seed ^ mix(first));
        batch.count = 0;
        for input in inputs.take(BATCH) {
            let (at, to) = (batch.inputs.len(), batch.expected.len());
            batch.inputs.resize(at + in_words, 0);
            batch.expected.resize(to + out_words, 0);
            input.to_words(&mut batch.inputs[at..]);
            B::eval(&input).to_words(&mut batch.expected[to..]);
            batch.tags.push(mix(batch.seed.wrapping_add(batch.count as u64)) & self.tag_mask);
            batch.count += 1;
        }
        batch.count > 0
    }

    fn compare(&self, batch: &mut Batch, report: &mut Report) -> Result<(), Error> {
        if let Some((index, cycle, fault)) = self.fault(batch) {
            let waves = self.waves(batch, cycle)?;
            let input = &batch.inputs[index * self.shape.in_words..];
            return Err(Error::Failure(Box::new(Failure {
                top: self.build.top().to_owned(),
                mode: self.plan.mode,
                seed: self.plan.seed,
                index: batch.first + index as u64,
                cycle,
                input: format!("{:?}", B::In::from_words(input)),
                fault,
                waves,
            })));
        }
        if batch.first == 0 {
            self.waves(batch, 0)?;
        }
        report.transactions += batch.count as u64;
        report.cycles += batch.cycles;
        for k in 0..batch.count {
            let latency = batch.offered[k] - batch.accepted[k];
            report.min_latency = report.min_latency.min(latency);
            report.max_latency = report.max_latency.max(latency);
            if k > 0 {
                report.min_interval = report.min_interval.min(batch.accepted[k] - batch.accepted[k - 1]);
            }
        }
        Ok(())
    }

    /// The first fault of a batch: transaction, cycle, and what it is.
    fn fault(&self, batch: &Batch) -> Option<(usize, u64, Fault)> {
        let words = self.shape.out_words;
        let free = self.plan.mode == Mode::Free;
        let Timing { latency, interval } = self.timing;
        for k in 0..batch.received {
            let cycle = batch.offered[k];
            let (expected, got) = (&batch.expected[k * words..][..words], &batch.outputs[k * words..][..words]);
            if expected != got {
                return Some((k, cycle, Fault::Output(difference::<B::Out>(expected, got))));
            }
            if batch.tags[k] != batch.out_tags[k] {
                return Some((k, cycle, Fault::Tag { expected: batch.tags[k], got: batch.out_tags[k] }));
            }
            let taken = batch.accepted[k];
            let got = cycle - taken;
            if if free { got != u64::from(latency) } else { got < u64::from(latency) } {
                return Some((k, cycle, Fault::Latency { expected: latency, got }));
            }
            if let (false, Some(before)) = (free, k.checked_sub(1)) {
                let (latency, interval) = (u64::from(latency), u64::from(interval));
                let least = (taken + latency).max(batch.delivered[before] + interval);
                if cycle > least {
                    return Some((k, cycle, Fault::Late { least, got: cycle }));
                }
                let (from, room) = (batch.presented[k].max(batch.accepted[before] + interval), latency.div_ceil(interval));
                if taken > from {
                    // In the last cycle that refused it: there were never fewer inside.
                    let refused = taken - 1;
                    let inside = (k - batch.delivered[..k].partition_point(|&at| at < refused)) as u64;
                    if inside < room {
                        return Some((k, refused, Fault::Refused { inside, least: room }));
                    }
                }
            }
            if free && k > 0 && taken - batch.accepted[k - 1] != u64::from(interval) {
                return Some((k, taken, Fault::Interval { expected: interval, got: taken - batch.accepted[k - 1] }));
            }
        }
        let violation = batch.violation?;
        Some((batch.received.min(batch.count - 1), batch.cycles, Fault::Rule(violation.text())))
    }

    /// Plays the batch again with a waveform around a cycle, if `LODRAY_WAVES` names a folder for it.
    fn waves(&self, batch: &mut Batch, cycle: u64) -> Result<Option<PathBuf>, Error> {
        let Some(folder) = std::env::var_os("LODRAY_WAVES") else { return Ok(None) };
        let folder = crate::root().join(folder);
        std::fs::create_dir_all(&folder).map_err(Error::file(&folder))?;
        let path = folder.join(format!("{}-{:?}-{}.vcd", self.build.top(), self.plan.mode, self.plan.seed).to_lowercase());
        let model = self.build.clone().trace().model()?;
        let window = cycle.saturating_sub(WINDOW.0)..cycle + if cycle == 0 { WINDOW.0 } else { WINDOW.1 };
        batch.run(&mut Sim::new(&model, self.plan.seed), self.shape, Some((&path, window)))?;
        Ok(Some(path))
    }
}

fn words(width: u32) -> usize {
    width.div_ceil(64) as usize // at most 2^26
}

/// Another number for each number.
fn mix(x: u64) -> u64 {
    Random::new(x).next()
}
