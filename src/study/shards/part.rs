//! Some of a study's jobs.

use std::collections::HashSet;
use std::time::Duration;

/// What time was spent on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Spent<'a> {
    /// Opening or making the scene of this name.
    Opening(&'a str),
    /// The job of this name.
    Job(&'a str),
}

/// Some of a study's jobs, and who is told how long they took.
#[derive(Clone, Copy)]
pub struct Part<'a> {
    /// Their names; all jobs if none.
    pub keys: Option<&'a HashSet<String>>,
    /// Told what took how long, once it is done.
    pub spent: &'a dyn Fn(Spent<'_>, Duration),
}

impl Part<'_> {
    /// All jobs, and nobody is told anything.
    pub const ALL: Self = Self { keys: None, spent: &|_, _| () };

    /// Whether a job is one of them.
    pub fn has(&self, key: &str) -> bool {
        self.keys.is_none_or(|keys| keys.contains(key))
    }
}
