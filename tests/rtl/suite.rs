//! What each block's test does with its categories and promises.

use crate::draw::Draw;
use lodray::block::{Block, Timing};
use std::fmt::Debug;
use tb::{Build, Mode, Plan, check_block};

/// A named way of drawing legal inputs.
pub type Category<B> = (&'static str, fn(&mut Draw) -> <B as Block>::In);
/// Something that must have happened among the transactions.
pub type Promise<B> = (&'static str, fn(&<B as Block>::In, &<B as Block>::Out) -> bool);

/// The test of one block.
pub struct Suite<B: Block> {
    pub build: Build,
    /// Where a parameter gives another than the block's own.
    pub timing: Timing,
    pub categories: Vec<Category<B>>,
    pub promises: Vec<Promise<B>>,
}

/// Ends a test in one line.
pub fn fail<T>(error: tb::Error) -> T {
    panic!("{error}")
}

/// Transactions a block and mode.
pub fn transactions() -> u64 {
    match std::env::var("LODRAY_TRANSACTIONS") {
        Ok(value) => value.parse().unwrap_or_else(|_| panic!("LODRAY_TRANSACTIONS={value} is not a number")),
        Err(_) => 1_000_000,
    }
}

impl<B: Block> Suite<B>
where
    B::In: Debug,
    B::Out: Debug,
{
    /// The block as it stands, with its own timing.
    pub fn new(categories: &[Category<B>], promises: &[Promise<B>]) -> Self {
        Self { build: Build::block::<B>(), timing: B::TIMING, categories: categories.to_vec(), promises: promises.to_vec() }
    }

    /// Runs both modes; what fails is told in one line.
    pub fn run(&self) {
        let seed = tb::seed(0x10d_4a75).unwrap_or_else(fail);
        let count = transactions();
        self.keep_promises(seed, count.min(20_000 * self.categories.len() as u64));
        for mode in [Mode::Free, Mode::Stalled] {
            let start = std::time::Instant::now();
            let plan = Plan::new(mode, seed).timing(self.timing);
            let report = check_block::<B>(&self.build, &plan, self.inputs(seed, count)).unwrap_or_else(fail);
            let rate = report.transactions as f64 / start.elapsed().as_secs_f64() / 1e6;
            println!("{} {mode:?}: {report:?}, {rate:.2} M/s with what was left to build", self.build.top());
            assert_eq!(report.transactions, count);
            if mode == Mode::Free {
                let seen = (report.min_latency, report.max_latency, report.min_interval);
                let (latency, interval) = (u64::from(self.timing.latency), u64::from(self.timing.interval));
                assert_eq!(seen, (latency, latency, interval), "{}: latency and interval at the ports", B::NAME);
            }
        }
    }

    /// `count` inputs, the categories in turn.
    fn inputs(&self, seed: u64, count: u64) -> impl Iterator<Item = B::In> {
        let mut draw = Draw::new(seed);
        let samples: Vec<_> = self.categories.iter().map(|c| c.1).collect();
        (0..count).zip(samples.into_iter().cycle()).map(move |(_, sample)| sample(&mut draw))
    }

    /// Counts what the promises say among the first inputs, and fails at zero.
    fn keep_promises(&self, seed: u64, count: u64) {
        let mut kept = vec![0u64; self.promises.len()];
        for input in self.inputs(seed, count) {
            let out = B::eval(&input);
            for (k, (_, holds)) in kept.iter_mut().zip(&self.promises) {
                *k += u64::from(holds(&input, &out));
            }
        }
        let names: Vec<_> = self.categories.iter().map(|c| c.0).collect();
        println!("{}: {count} inputs from {} categories: {}", B::NAME, names.len(), names.join(", "));
        for (k, (name, _)) in kept.iter().zip(&self.promises) {
            println!("{}: {name}: {k}", B::NAME);
            assert_ne!(*k, 0, "{}: no input with {name}", B::NAME);
        }
    }
}
