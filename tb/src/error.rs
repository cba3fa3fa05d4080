//! What can go wrong on the way to a comparison, or in it.

use crate::Failure;
use std::path::PathBuf;

/// One line for each way to fail; tests print it and fail.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// No Verilator, or no other tool, to be found.
    #[error("a tool is missing ({0}): run scripts/tools")]
    ToolMissing(String),
    /// The tool refused the sources.
    #[error("{top} is refused:\n{output}")]
    Refused {
        /// The top.
        top: String,
        /// What it said.
        output: String,
    },
    /// The compiler failed.
    #[error("the C++ compiler ({compiler}) fails:\n{output}")]
    Compiler {
        /// The command.
        compiler: String,
        /// What it said.
        output: String,
    },
    /// A file cannot be read, written or moved.
    #[error("{path}: {source}")]
    File {
        /// Which one.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The compiled model cannot be loaded.
    #[error("{path}: {source}")]
    Load {
        /// The shared library.
        path: PathBuf,
        /// Why.
        source: libloading::Error,
    },
    /// The model has no such port, or not of that width or kind.
    #[error("{top}: {what}")]
    Ports {
        /// The top.
        top: String,
        /// What is missing or different.
        what: String,
    },
    /// The RTL differs from the Rust block.
    #[error(transparent)]
    Failure(#[from] Box<Failure>),
    /// The setting of an environment variable is no number.
    #[error("{name}={value}: not a number")]
    Setting {
        /// The variable.
        name: &'static str,
        /// Its value.
        value: String,
    },
    /// A check without a single transaction.
    #[error("{0}: no transaction was played, so nothing was checked")]
    Nothing(String),
}

impl Error {
    /// An [`Error::Refused`] with what a tool said.
    pub(crate) fn refused(top: &str, out: &std::process::Output) -> Self {
        let output = format!("{}{}", String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr)).trim().to_owned();
        Self::Refused { top: top.to_owned(), output }
    }

    /// An [`Error::File`] for this path.
    pub(crate) fn file(path: impl Into<PathBuf>) -> impl FnOnce(std::io::Error) -> Self {
        let path = path.into();
        move |source| Self::File { path, source }
    }
}
