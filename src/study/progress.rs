//! How far a study is: what a program shows while it waits.

/// Told what is being done.
pub trait Progress: Sync {
    /// Work begins that has so many steps, or of which nobody knows how long it takes.
    fn begin(&self, what: &str, steps: Option<u64>) -> Box<dyn Work + '_>;

    /// Something that a user should know of a study that goes well, such as a file that was set aside: one line, which begins with `note:` or `warning:`.
    fn note(&self, line: &str);
}

/// Work that has begun. It is over when it is dropped.
pub trait Work: Sync {
    /// So many more steps are done.
    fn step(&self, steps: u64);

    /// What is done now, in a line.
    fn say(&self, line: &str);
}

/// Tells nobody.
pub struct Silent;

impl Progress for Silent {
    fn begin(&self, _: &str, _: Option<u64>) -> Box<dyn Work + '_> {
        Box::new(Self)
    }

    fn note(&self, _: &str) {}
}

impl Work for Silent {
    fn step(&self, _: u64) {}

    fn say(&self, _: &str) {}
}

/// Does work of unknown length.
pub fn busy<T>(progress: &dyn Progress, what: &str, work: impl FnOnce() -> T) -> T {
    let _under_way = progress.begin(what, None);
    work()
}
