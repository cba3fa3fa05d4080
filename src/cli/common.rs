//! What all subcommands have in common: threads, silence, and the command line as it was given.

use super::args::whole;
use super::terminal::set_color;
use clap::ColorChoice;
use serde::{Deserialize, Serialize};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

/// Most threads: far above what a machine has, and far below where the system has none left.
pub const MAX_THREADS: u64 = 1024;

/// Options that every subcommand takes.
#[derive(clap::Args)]
#[command(next_help_heading = "All commands")]
pub struct Common {
    /// Threads, 1 to 1024 (default: as many as the machine runs at once); the results are the same with any number
    #[arg(long, global = true, value_name = "N", value_parser = whole::<usize>(1..=MAX_THREADS), allow_hyphen_values = true)]
    threads: Option<usize>,
    /// No progress and no closing remarks (where files went, what was built); tables, --json, warnings and errors remain
    #[arg(long, global = true)]
    quiet: bool,
    /// Colours in help and errors: auto (on a terminal), always or never
    #[arg(long, global = true, value_name = "WHEN", value_enum, default_value_t = ColorChoice::Auto, hide_possible_values = true)]
    color: ColorChoice,
}

static QUIET: AtomicBool = AtomicBool::new(false);

impl Common {
    /// Sets them for this process.
    pub fn apply(&self) -> anyhow::Result<()> {
        set_color(self.color);
        QUIET.store(self.quiet, Ordering::Relaxed);
        if let Some(threads) = self.threads {
            rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
        }
        Ok(())
    }
}

/// Whether nothing but results is wanted.
pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// The command line of the run that this process finishes, if that is another than its own.
static FINISHED: OnceLock<Invocation> = OnceLock::new();

/// A command line, without what no file depends on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Invocation {
    /// Subcommand.
    pub command: String,
    /// Its arguments.
    pub arguments: Vec<String>,
}

impl Invocation {
    /// That of this process, or of the run that it finishes.
    pub fn of_process() -> Self {
        if let Some(finished) = FINISHED.get() {
            return finished.clone();
        }
        Self::new(std::env::args_os().skip(1).map(|word| word.to_string_lossy().into_owned()))
    }

    /// From here on this process finishes the run of that command line: its files say so.
    pub fn finish(self) {
        // A process finishes one run.
        let _ = FINISHED.set(self);
    }

    /// Leaves out the folder (the record is in it), how many threads there are, which shard this is and what weighs it, where BVHs and a page go, what is printed and in which
    /// colours, and what may be replaced.
    fn new(words: impl IntoIterator<Item = String>) -> Self {
        let mut words = words.into_iter();
        let mut kept = Vec::new();
        while let Some(word) = words.next() {
            match word.as_str() {
                "--" => kept.extend(std::iter::once(word).chain(words.by_ref())),
                "--quiet" | "--json" | "--force" => {}
                // Their value is the next word.
                "-o" | "--out" | "--threads" | "--color" | "--at-once" | "--cache" | "--report" | "--shard" | "--costs" => {
                    drop(words.next())
                }
                one if ["-o", "--out=", "--threads=", "--color=", "--at-once=", "--cache=", "--report=", "--shard=", "--costs="]
                    .iter()
                    .any(|option| one.starts_with(option)) => {}
                _ => kept.push(word),
            }
        }
        let command = if kept.is_empty() { String::new() } else { kept.remove(0) };
        Self { command, arguments: kept }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_no_file_depends_on_is_left_out() {
        let of = |line: &str| {
            let Invocation { command, arguments } = Invocation::new(line.split_whitespace().map(str::to_owned));
            (command, arguments.join(" "))
        };
        let plain = ("render".to_owned(), "a.lod --size 8x8".to_owned());
        for line in [
            "render a.lod --size 8x8",
            "--threads 3 render a.lod --quiet --size 8x8 -o out",
            "--threads=3 render -oout a.lod --json --size 8x8",
            "render a.lod --out out --size 8x8 --force",
            "render a.lod --size 8x8 --out=out",
            "render a.lod --size 8x8 -o=out",
            "--color never render a.lod --size 8x8 --color=always",
            "render --cache none a.lod --size 8x8 --cache=some",
            "render a.lod --shard 3/20 --size 8x8 --costs=before",
        ] {
            assert_eq!(of(line), plain, "{line}");
        }
        assert_eq!(of("render --size 8x8 -- -o"), ("render".to_owned(), "--size 8x8 -- -o".to_owned()));
        assert_eq!(of(""), (String::new(), String::new()));
    }
}
