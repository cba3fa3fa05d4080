//! One reader's round: its corpus, then damaged files until the time is over.

use super::damage::{File, damaged};
use super::memory;
use proptest::test_runner::{Config, RngAlgorithm, TestCaseError, TestError, TestRng, TestRunner};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Whoever is slower than this hangs. Cases take milliseconds; a busy machine may make them wait.
const HANGS: Duration = Duration::from_secs(20);
/// Cases between two looks at the clock, and the fewest of a round: those of a round without a time, which are the same on every machine.
const CASES: u32 = 32;
const FEWEST: u64 = 512;

/// What a reader may hold in memory: some bytes, and so many for each byte of the file.
#[derive(Clone, Copy)]
pub struct Limit {
    /// However short the file is.
    pub bytes: usize,
    /// For each of its bytes.
    pub each: usize,
}

/// Held by whoever measures: one at a time.
pub fn alone() -> MutexGuard<'static, ()> {
    static ALONE: Mutex<()> = Mutex::new(());
    ALONE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A number from the environment.
fn setting(name: &str, without: f64) -> f64 {
    std::env::var(name).map_or(without, |text| text.parse().unwrap_or_else(|_| panic!("{name} is no number: {text}")))
}

/// Where files are kept that a reader was at when it failed.
pub fn folder() -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("fuzz");
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// Ends the program if a case takes too long: nothing else ends a loop.
struct Watch(Arc<AtomicU64>);

impl Watch {
    fn new(what: String) -> Self {
        let case = Arc::new(AtomicU64::new(0));
        let seen = Arc::downgrade(&case);
        std::thread::spawn(move || {
            let mut last = (0, Instant::now());
            while let Some(case) = seen.upgrade().map(|case| case.load(Ordering::Relaxed)) {
                if case != last.0 || case % 2 == 0 {
                    last = (case, Instant::now());
                } else if last.1.elapsed() > HANGS {
                    eprintln!("{what} has been read for {HANGS:?}");
                    std::process::abort();
                }
                std::thread::sleep(Duration::from_millis(100));
            }
        });
        Self(case)
    }

    /// Odd while something is read.
    fn step(&self) {
        self.0.fetch_add(1, Ordering::Relaxed);
    }
}

/// Reads every file of the corpus, which must all be good, and then damaged ones; alone from the corpus on, as memory is counted of all threads. `read` is true for what was taken, false for what was refused.
pub fn round(reader: &str, corpus: impl FnOnce() -> Vec<File>, limit: Limit, read: impl Fn(&[u8]) -> bool) {
    let _alone = alone();
    let corpus = &corpus();
    let seconds = Duration::from_secs_f64(setting("LODRAY_FUZZ_SECONDS", 0.0));
    let case = folder().join(format!("{reader}.case"));
    let watch = Watch::new(format!("{}", case.display()));
    let most = Mutex::new((0.0, 0));
    let tried = |bytes: &[u8]| {
        fs::write(&case, bytes).unwrap();
        watch.step();
        let (taken, held) = memory::most(|| read(bytes));
        watch.step();
        let allowed = limit.bytes + limit.each * bytes.len();
        let mut most = most.lock().unwrap_or_else(PoisonError::into_inner);
        let share = held as f64 / allowed as f64;
        if share > most.0 {
            *most = (share, held);
        }
        assert!(held <= allowed, "{held} bytes are held for a file of {}, which may have {allowed}", bytes.len());
        taken
    };
    let mut seed = [0; 32];
    seed[..8].copy_from_slice(&setting("LODRAY_FUZZ_SEED", 50.0).to_bits().to_le_bytes());
    let config = Config { cases: CASES, failure_persistence: None, max_shrink_iters: 2000, ..Config::default() };
    let mut seeds = TestRunner::new_with_rng(config.clone(), TestRng::from_seed(RngAlgorithm::ChaCha, &seed));
    let (taken, refused) = (AtomicU64::new(0), AtomicU64::new(0));
    let strategy = damaged(corpus);
    let mut spent = Duration::ZERO;
    let mut first = true;
    let all = || taken.load(Ordering::Relaxed) + refused.load(Ordering::Relaxed);
    while spent < seconds || all() < FEWEST {
        let start = Instant::now();
        if std::mem::take(&mut first) {
            for file in corpus {
                assert!(tried(&file.bytes), "{reader}: {} of the corpus is refused", file.name);
            }
        }
        // A runner runs its cases once.
        let mut runner = TestRunner::new_with_rng(config.clone(), seeds.new_rng());
        let result = runner.run(&strategy, |file| {
            if tried(&file.0) { &taken } else { &refused }.fetch_add(1, Ordering::Relaxed);
            Ok::<(), TestCaseError>(())
        });
        if let Err(TestError::Fail(why, file)) = result {
            let kept = folder().join(format!("{reader}.failed"));
            fs::write(&kept, &file.0).unwrap();
            panic!("{reader}: {why}, with {}: {file:?}", kept.display());
        }
        spent += start.elapsed();
    }
    let (taken, refused) = (taken.into_inner(), refused.into_inner());
    let (share, held) = *most.lock().unwrap_or_else(PoisonError::into_inner);
    println!("{reader}: {taken} files taken, {refused} refused; at most {held} bytes held, {:.0} % of the limit", 100.0 * share);
    assert!(taken > 0 && refused > 0, "{reader}: {taken} taken, {refused} refused: this tries nothing");
    fs::remove_file(&case).unwrap();
}
