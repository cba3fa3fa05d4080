//! Settings at once: a replay is one thread's work, so as many as there are threads are at work, each with a frame of its own in memory.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

/// `work` on each of `items`, by as many workers as there are threads; results in the items' order. Workers are threads of their own: they wait for
/// replays, which a thread that traces must not.
pub fn at_once<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let next = AtomicUsize::new(0);
    let worker = || {
        let mut done = Vec::new();
        loop {
            let at = next.fetch_add(1, Ordering::Relaxed);
            let Some(item) = items.get(at) else { return done };
            done.push((at, work(item)));
        }
    };
    let workers = rayon::current_num_threads().clamp(1, items.len().max(1));
    let mut all: Vec<(usize, R)> = thread::scope(|scope| {
        let workers: Vec<_> = (0..workers).map(|_| scope.spawn(worker)).collect();
        let join = |worker: thread::ScopedJoinHandle<'_, _>| worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        workers.into_iter().flat_map(join).collect()
    });
    all.sort_by_key(|(at, _)| *at);
    all.into_iter().map(|(_, result)| result).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_item_has_its_result_in_its_place() {
        let items: Vec<u32> = (0..100).collect();
        assert_eq!(at_once(&items, |n| n * n), items.iter().map(|n| n * n).collect::<Vec<_>>());
        assert!(at_once(&[], |n: &u32| *n).is_empty());
    }
}
