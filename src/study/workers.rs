//! Frames at once: a replay keeps few threads busy, so several frames are at work, each with its own in memory.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::channel;
use std::thread;

/// `work` on each of `items`, by at most `workers` at once; `take` is given the results in the items' order, each as soon as those before it were taken.
/// Workers are threads of their own: they wait for replays, which a thread that traces must not. Once `take` fails, no more is begun.
///
/// # Errors
/// The first of `take`.
pub fn in_order<T: Sync, R: Send, E>(
    items: &[T],
    workers: usize,
    work: impl Fn(&T) -> R + Sync,
    mut take: impl FnMut(&T, R) -> Result<(), E>,
) -> Result<(), E> {
    let next = AtomicUsize::new(0);
    let (sender, results) = channel();
    thread::scope(|scope| {
        for _ in 0..workers.clamp(1, items.len().max(1)) {
            let sender = sender.clone();
            let (next, work) = (&next, &work);
            scope.spawn(move || {
                loop {
                    let at = next.fetch_add(1, Ordering::Relaxed);
                    let Some(item) = items.get(at) else { return };
                    if sender.send((at, work(item))).is_err() {
                        return;
                    }
                }
            });
        }
        drop(sender);
        let mut waiting = BTreeMap::new();
        let mut due = 0;
        // Dropped where `take` fails: workers end with the item that they have.
        for (at, result) in results {
            waiting.insert(at, result);
            while let Some(result) = waiting.remove(&due) {
                take(&items[due], result)?;
                due += 1;
            }
        }
        Ok(())
    })
}

/// The same with as many workers as there are threads, and all results at once.
pub fn at_once<T: Sync, R: Send>(items: &[T], work: impl Fn(&T) -> R + Sync) -> Vec<R> {
    let mut all = Vec::with_capacity(items.len());
    let keep = |_: &T, result| {
        all.push(result);
        Ok::<_, std::convert::Infallible>(())
    };
    match in_order(items, rayon::current_num_threads(), work, keep) {
        Ok(()) => all,
        Err(never) => match never {},
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Mutex;
    use std::time::Duration;

    #[test]
    fn every_item_has_its_result_in_its_place() {
        let items: Vec<u32> = (0..100).collect();
        assert_eq!(at_once(&items, |n| n * n), items.iter().map(|n| n * n).collect::<Vec<_>>());
        assert!(at_once(&[], |n: &u32| *n).is_empty());
    }

    #[test]
    fn no_more_are_at_work_than_workers_and_results_come_in_order() {
        let items: Vec<u64> = (0..24).collect();
        let (now, most) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let work = |n: &u64| {
            most.fetch_max(now.fetch_add(1, Ordering::SeqCst) + 1, Ordering::SeqCst);
            thread::sleep(Duration::from_millis(5 - n % 5)); // later ones are done earlier
            now.fetch_sub(1, Ordering::SeqCst);
            *n
        };
        let mut taken = Vec::new();
        let take = |of: &u64, result| {
            assert_eq!(*of, result);
            taken.push(result);
            Ok::<_, ()>(())
        };
        in_order(&items, 3, work, take).unwrap();
        assert_eq!(taken, items);
        assert!((2..=3).contains(&most.into_inner()));
    }

    #[test]
    fn a_result_that_cannot_be_taken_ends_the_work() {
        let items: Vec<u32> = (0..1000).collect();
        let begun = Mutex::new(0);
        let work = |_: &u32| {
            *begun.lock().unwrap() += 1;
            thread::sleep(Duration::from_millis(1));
        };
        let failed = in_order(&items, 2, work, |n, ()| if *n == 3 { Err("full") } else { Ok(()) });
        assert_eq!(failed, Err("full"));
        assert!(*begun.lock().unwrap() < 1000);
    }
}
