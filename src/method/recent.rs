//! What a method made for the sights that it saw last.

use crate::rays::Sight;
use std::sync::{Arc, Mutex, PoisonError};

/// What was made for the last sights, the latest at the end.
pub(super) struct Recent<T> {
    made: Mutex<Vec<(Sight, Arc<T>)>>,
    /// What something weighs, and what all that is kept for other sights weighs at most.
    weight: fn(&T) -> usize,
    most: usize,
}

impl<T: Send + Sync> Recent<T> {
    /// Nothing yet.
    pub fn new(weight: fn(&T) -> usize, most: usize) -> Self {
        Self { made: Mutex::default(), weight, most }
    }

    /// What `make` makes for a sight, now or before.
    pub fn get(&self, sight: &Sight, make: impl Fn() -> T + Send + Sync) -> Arc<T> {
        let mut made = self.made.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(at) = made.iter().position(|(of, _)| of == sight) {
            let seen = made.remove(at);
            let own = Arc::clone(&seen.1);
            made.push(seen);
            return own;
        }
        let own = Arc::new(apart(make));
        let mut kept = (self.weight)(&own);
        let newest = made.iter().rev().take_while(|(_, other)| {
            kept += (self.weight)(other);
            kept <= self.most
        });
        let others = made.len() - newest.count();
        made.drain(..others);
        made.push((sight.clone(), Arc::clone(&own)));
        own
    }
}

/// What `make` makes by as many threads of its own: those that trace wait for it, and would wait for themselves if they took part.
pub(super) fn apart<T: Send>(make: impl Fn() -> T + Send + Sync) -> T {
    let threads = rayon::current_num_threads();
    let run = || rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads can be made").install(make);
    std::thread::scope(|scope| scope.spawn(run).join()).unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}
