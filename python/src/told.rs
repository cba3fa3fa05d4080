//! Work while the interpreter is free: who waits is told how far it is, and may stop it.

use crate::errors::of_arguments;
use lodray::study::{Progress, Work};
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use std::ffi::CString;
use std::mem::take;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::sync::{Mutex, PoisonError};
use std::thread::{self, Builder};
use std::time::Duration;

/// How often Python is asked whether somebody wants to stop, and told how far the work is.
const PAUSE: Duration = Duration::from_millis(50);

/// Of a worker: what a program's first thread has.
const STACK: usize = 8 << 20;

/// Rays below which a thread would take longer than they do.
pub const FEW: u64 = 1 << 14;

/// How far work is, whether it is to go on, and what is to be said of it.
#[derive(Default)]
pub struct Told {
    stopped: AtomicBool,
    done: AtomicU64,
    now: Mutex<(String, Option<u64>)>,
    /// Lines on what was lost or set aside.
    noted: Mutex<Vec<String>>,
}

/// What unwinds through work that somebody stopped: no panic, and nothing is printed.
struct Stopped;

impl Told {
    /// So many more steps are done.
    pub fn step(&self, steps: u64) {
        self.done.fetch_add(steps, Ordering::Relaxed);
        self.go_on();
    }

    /// What is being done, how many steps of it are done, and of how many, where that is known.
    pub fn say(&self, what: &str, done: u64, of: Option<u64>) {
        let mut now = self.now.lock().unwrap_or_else(PoisonError::into_inner);
        if now.0 != what || now.1 != of {
            *now = (what.to_owned(), of);
        }
        drop(now);
        self.done.store(done, Ordering::Relaxed);
        self.go_on();
    }

    /// Does not return if somebody wants to stop.
    fn go_on(&self) {
        if self.stopped.load(Ordering::Relaxed) {
            resume_unwind(Box::new(Stopped));
        }
    }

    /// Calls `progress(what, done, of)`, and raises what was raised meanwhile, such as `KeyboardInterrupt`.
    fn show(&self, py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<()> {
        py.check_signals()?;
        let Some(progress) = progress else { return Ok(()) };
        let (what, of) = self.now.lock().unwrap_or_else(PoisonError::into_inner).clone();
        if !what.is_empty() {
            progress.call1(py, (what, self.done.load(Ordering::Relaxed), of))?;
        }
        Ok(())
    }

    /// Raises what was noted as warnings at the line of Python that called. One that a filter makes an error of is the last.
    fn warn(&self, py: Python<'_>) -> PyResult<()> {
        let noted = take(&mut *self.noted.lock().unwrap_or_else(PoisonError::into_inner));
        let category = py.get_type::<PyUserWarning>();
        for line in noted {
            let words = line.strip_prefix("warning: ").or_else(|| line.strip_prefix("note: ")).unwrap_or(&line);
            PyErr::warn(py, &category, &CString::new(of_arguments(words).replace('\0', " "))?, 1)?;
        }
        Ok(())
    }
}

impl Progress for Told {
    fn begin(&self, what: &str, steps: Option<u64>) -> Box<dyn Work + '_> {
        self.say(what, 0, steps);
        Box::new(Part(self))
    }

    fn note(&self, line: &str) {
        self.noted.lock().unwrap_or_else(PoisonError::into_inner).push(line.to_owned());
    }
}

/// Work that has begun.
struct Part<'a>(&'a Told);

impl Work for Part<'_> {
    fn step(&self, steps: u64) {
        self.0.step(steps);
    }

    fn say(&self, _: &str) {
        self.0.go_on();
    }
}

/// Does short work, of which nothing is noted, while other threads of Python may run.
pub fn at_once<T: Send>(py: Python<'_>, work: impl FnOnce(&Told) -> T + Send) -> T {
    py.detach(|| work(&Told::default()))
}

/// Does work on another thread, while this one calls `progress` and listens to signals. What is noted of it is raised as warnings when it is over, however it ends.
///
/// # Errors
/// What was raised meanwhile: the work is stopped then. A warning that a filter makes an error of.
pub fn beside<T: Send>(py: Python<'_>, progress: Option<&Bound<'_, PyAny>>, work: impl FnOnce(&Told) -> T + Send) -> PyResult<T> {
    let (told, progress) = (Told::default(), progress.map(|progress| progress.clone().unbind()));
    let (told, progress) = (&told, progress.as_ref());
    py.detach(|| {
        let (sender, receiver) = sync_channel(1);
        thread::scope(|scope| {
            let work = move || {
                let done = catch_unwind(AssertUnwindSafe(|| work(told)));
                // Nobody listens any more if this fails.
                let _ = sender.send(());
                done
            };
            let worker = Builder::new().stack_size(STACK).spawn_scoped(scope, work)?;
            let mut raised = None;
            while receiver.recv_timeout(PAUSE) == Err(RecvTimeoutError::Timeout) {
                if raised.is_none() {
                    raised = Python::attach(|py| told.show(py, progress)).err();
                    told.stopped.store(raised.is_some(), Ordering::Relaxed);
                }
            }
            let done = worker.join().unwrap_or_else(Err);
            let warned = Python::attach(|py| told.warn(py));
            match (raised, done) {
                (Some(raised), _) => Err(raised),
                (None, Ok(done)) => Python::attach(|py| told.show(py, progress)).and(warned).map(|()| done),
                (None, Err(panic)) => resume_unwind(panic),
            }
        })
    })
}
