//! What each block's test does with its categories and promises.

use crate::draw::Draw;
use lodray::block::{Block, Timing};
use lodray::hardware::Hardware;
use std::fmt::{Debug, Display};
use std::ops::RangeInclusive;
use std::time::Instant;
use tb::{Build, Mode, Plan, check_block};

/// The tests of a block's suite, free-running and with random stalls; of one of several in a module of its own.
macro_rules! modes {
    ($name:ident: $suite:expr) => {
        mod $name {
            use super::*;

            crate::suite::modes!($suite);
        }
    };
    ($suite:expr) => {
        #[test]
        fn free_running() {
            $suite.run(tb::Mode::Free);
        }

        #[test]
        fn stalled() {
            $suite.run(tb::Mode::Stalled);
        }
    };
}
pub(crate) use modes;

/// Events and spreads are looked for in so many inputs from the first on, and then in one of sixteen: they take long.
const ALL_SEEN: u64 = 50_000;

/// How many inputs of a category must keep its promise.
#[derive(Clone, Copy, PartialEq)]
enum Share {
    All,
    Eighth,
    One,
}

/// A named way of drawing legal inputs, and what its name promises.
pub struct Category<B: Block> {
    name: &'static str,
    make: fn(&mut Draw) -> B::In,
    holds: fn(&B::In, &B::Out) -> bool,
    share: Share,
}

impl<B: Block> Category<B> {
    /// Its name promises nothing.
    pub fn any(name: &'static str, make: fn(&mut Draw) -> B::In) -> Self {
        Self { name, make, holds: |_, _| true, share: Share::All }
    }

    /// Every input keeps the promise.
    pub fn all(name: &'static str, make: fn(&mut Draw) -> B::In, holds: fn(&B::In, &B::Out) -> bool) -> Self {
        Self { name, make, holds, share: Share::All }
    }

    /// At least one input in eight does.
    pub fn often(name: &'static str, make: fn(&mut Draw) -> B::In, holds: fn(&B::In, &B::Out) -> bool) -> Self {
        Self { name, make, holds, share: Share::Eighth }
    }

    /// Some inputs do.
    pub fn some(name: &'static str, make: fn(&mut Draw) -> B::In, holds: fn(&B::In, &B::Out) -> bool) -> Self {
        Self { name, make, holds, share: Share::One }
    }
}

/// Something that must happen among the transactions.
pub type Event<B> = (&'static str, fn(&<B as Block>::In, &<B as Block>::Out) -> bool);
/// A number of which each value of a range must occur, and no other.
pub type Spread<B> = (&'static str, RangeInclusive<u64>, fn(&<B as Block>::In, &<B as Block>::Out) -> u64);

/// An input with so many zero bits at the bottom of all coordinates and directions.
pub type Coarsen<B> = fn(<B as Block>::In, [u32; 2]) -> <B as Block>::In;

/// The test of one block.
pub struct Suite<B: Block> {
    pub build: Build,
    /// Where a parameter gives another than the block's own.
    pub timing: Timing,
    pub hardware: Hardware,
    /// Takes from inputs the bits that the hardware leaves out. They are no longer what their category says then, nor what must happen.
    pub coarsen: Option<Coarsen<B>>,
    /// The legal inputs, as the head of the block's file states them.
    pub legal: fn(&B::In) -> bool,
    pub categories: Vec<Category<B>>,
    pub events: Vec<Event<B>>,
    pub spreads: Vec<Spread<B>>,
}

/// Ends a test with one line, without the words of a panic around it.
pub fn fail<T>(error: impl Display) -> T {
    eprintln!("{error}");
    std::panic::resume_unwind(Box::new(()))
}

/// Transactions a block and mode: enough for every category, event and spread, and for what [`ALL_SEEN`] says; `scripts/nightly` has a million.
pub fn transactions() -> u64 {
    match std::env::var("LODRAY_TRANSACTIONS") {
        Ok(value) => value.parse().unwrap_or_else(|_| fail(format!("LODRAY_TRANSACTIONS={value}: not a number"))),
        Err(_) => 200_000,
    }
}

impl<B: Block> Suite<B>
where
    B::In: Debug,
    B::Out: Debug,
{
    /// The block as it stands, with its own timing.
    pub fn new(legal: fn(&B::In) -> bool, categories: Vec<Category<B>>, events: Vec<Event<B>>, spreads: Vec<Spread<B>>) -> Self {
        Self {
            build: Build::block::<B>(),
            timing: B::TIMING,
            hardware: Hardware::default(),
            coarsen: None,
            legal,
            categories,
            events,
            spreads,
        }
    }

    /// With inputs as such hardware takes them.
    pub fn coarsened(self, coarsen: Coarsen<B>) -> Self {
        Self { coarsen: Some(coarsen), events: Vec::new(), spreads: Vec::new(), ..self }
    }

    /// The same for other hardware.
    pub fn of(self, hardware: Hardware) -> Self {
        Self { build: self.build.hardware(&hardware).unwrap_or_else(fail), timing: hardware.timing::<B>(), hardware, ..self }
    }

    /// Plays the block's transactions at the ports, each of them drawn from a random category, and holds the categories to their promises.
    pub fn run(&self, mode: Mode) {
        self.run_some(mode, transactions());
    }

    /// [`Suite::run`] with so many transactions.
    pub fn run_some(&self, mode: Mode, count: u64) {
        let seed = tb::seed(0x10d_4a75).unwrap_or_else(fail);
        let Timing { latency, interval } = self.timing;
        let name = format!("{} (latency {latency}, interval {interval}) {mode:?}", self.build.top());
        self.build.model().unwrap_or_else(fail);

        let start = Instant::now();
        // The two modes see different inputs.
        let mut inputs = Inputs::new(self, seed ^ u64::from(mode == Mode::Stalled) << 63, count);
        let played = check_block::<B>(&self.build, &Plan::new(mode, seed).timing(self.timing), &mut inputs);
        if let Some(fault) = &inputs.fault {
            fail(format!("{name}: {fault}; replay: LODRAY_SEED={seed}"))
        }
        let report = played.unwrap_or_else(fail);
        let rate = report.transactions as f64 / start.elapsed().as_secs_f64() / 1e6;
        println!(
            "{name}: seed {seed}, {} transactions in {} cycles, {rate:.2} M/s; up to {} cycles to an output",
            report.transactions, report.cycles, report.max_latency
        );
        let lacking = inputs.report();
        if !lacking.is_empty() || report.transactions != count {
            fail(format!("{name}: {} of {count} transactions; not seen: {}", report.transactions, lacking.join(", ")))
        }
        if mode == Mode::Free {
            let seen = (report.min_latency, report.max_latency, report.min_interval);
            let (latency, interval) = (u64::from(latency), u64::from(interval));
            assert_eq!(seen, (latency, latency, interval), "{name}: latency and interval at the ports");
        }
    }
}

/// The inputs of one run, with a count of what happens in them.
struct Inputs<'a, B: Block> {
    suite: &'a Suite<B>,
    draw: Draw,
    left: u64,
    made: u64,
    /// Drawn from each category, and how many of them kept its promise.
    drawn: Vec<(u64, u64)>,
    seen: Vec<u64>,
    spread: Vec<Vec<u64>>,
    /// An illegal input or a broken promise: the generator is wrong, whatever the RTL does.
    fault: Option<String>,
}

impl<'a, B: Block> Inputs<'a, B> {
    fn new(suite: &'a Suite<B>, seed: u64, count: u64) -> Self {
        let spread = suite.spreads.iter().map(|(_, range, _)| vec![0; (range.end() - range.start() + 1) as usize]).collect();
        let (drawn, seen) = (vec![(0, 0); suite.categories.len()], vec![0; suite.events.len()]);
        let mut draw = Draw::new(seed);
        draw.levels = u64::from(suite.hardware.levels);
        draw.zeros = u64::from(suite.hardware.coordinate_zeros);
        Self { suite, draw, left: count, made: 0, drawn, seen, spread, fault: None }
    }

    /// Looks for the events and notes the spreads; true if one is outside of its range.
    fn observe(&mut self, input: &B::In, out: &B::Out) -> bool {
        for (seen, (_, holds)) in self.seen.iter_mut().zip(&self.suite.events) {
            *seen += u64::from(holds(input, out));
        }
        let mut outside = false;
        for (counts, (_, range, value)) in self.spread.iter_mut().zip(&self.suite.spreads) {
            match usize::try_from(value(input, out).wrapping_sub(*range.start())).ok().and_then(|at| counts.get_mut(at)) {
                Some(count) => *count += 1,
                None => outside = true,
            }
        }
        outside
    }

    /// Prints every count; gives what is lacking.
    fn report(&self) -> Vec<String> {
        let mut lacking = Vec::new();
        let mut line = |ok: bool, text: String| {
            println!("  {text}");
            if !ok {
                lacking.push(text);
            }
        };
        for (category, &(drawn, kept)) in self.suite.categories.iter().zip(&self.drawn) {
            let enough = match category.share {
                Share::All => drawn > 0,
                Share::Eighth => drawn > 0 && 8 * kept >= drawn,
                Share::One => kept > 0,
            };
            let share = if category.share == Share::All { String::new() } else { format!(", {kept} of them so") };
            line(enough, format!("{}: {drawn}{share}", category.name));
        }
        for ((name, _), &seen) in self.suite.events.iter().zip(&self.seen) {
            line(seen > 0, format!("- {name}: {seen}"));
        }
        for ((name, range, _), counts) in self.suite.spreads.iter().zip(&self.spread) {
            line(counts.iter().all(|&n| n > 0), format!("- {name}, each of {range:?}: {counts:?}"));
        }
        lacking
    }
}

impl<B: Block> Iterator for Inputs<'_, B>
where
    B::In: Debug,
    B::Out: Debug,
{
    type Item = B::In;

    fn next(&mut self) -> Option<B::In> {
        if self.left == 0 || self.fault.is_some() {
            return None;
        }
        self.left -= 1;
        let k = self.draw.below(self.suite.categories.len() as u64) as usize;
        let category = &self.suite.categories[k];
        let input = (category.make)(&mut self.draw);
        if let Some(coarsen) = self.suite.coarsen {
            self.drawn[k].0 += 1;
            self.drawn[k].1 += 1;
            let Hardware { coordinate_zeros, direction_zeros, .. } = self.suite.hardware;
            return Some(coarsen(input, [coordinate_zeros, direction_zeros]));
        }
        let out = B::eval(&input);

        let kept = (category.holds)(&input, &out);
        self.drawn[k].0 += 1;
        self.drawn[k].1 += u64::from(kept);
        let mut outside = false;
        self.made += 1;
        if self.made <= ALL_SEEN || self.made.is_multiple_of(16) {
            outside = self.observe(&input, &out);
        }
        let legal = (self.suite.legal)(&input);
        if !legal || outside || (category.share == Share::All && !kept) {
            let what = if !legal { "an illegal input" } else { "a broken promise" };
            self.fault = Some(format!("{what} of \"{}\": {input:?} -> {out:?}", category.name));
            return None;
        }
        Some(input)
    }
}
