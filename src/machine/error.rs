//! What a machine description, or a table that it names, can have wrong.

use std::io;
use thiserror::Error;

/// Why a description was refused. `file` is its path, or its path below `machines` if it comes with the program.
#[derive(Debug, Error)]
pub enum MachineError {
    /// The file cannot be read.
    #[error("{file}: {source}")]
    Read {
        /// Which.
        file: String,
        /// Why.
        source: io::Error,
    },
    /// Not TOML, a key missing or unknown, or a value of the wrong type.
    #[error("{file}: {source}")]
    Toml {
        /// Which.
        file: String,
        /// Where and why.
        source: Box<toml::de::Error>,
    },
    /// A value that no machine can have.
    #[error("{file}: {key} {rule}, but is {value}")]
    Invalid {
        /// Which file.
        file: String,
        /// The key, dotted.
        key: String,
        /// What it must be.
        rule: String,
        /// What it is.
        value: String,
    },
    /// A line of a table of comma-separated values.
    #[error("{file}: line {line}: {field} {rule}, but is {value}")]
    Line {
        /// Which file.
        file: String,
        /// Which line, from 1.
        line: usize,
        /// Which of its values.
        field: String,
        /// What it must be.
        rule: String,
        /// What it is.
        value: String,
    },
    /// A cache of a geometry for which a table has no energies.
    #[error("{machine}: {table} has no energies for {level} of {geometry}; nearest: {nearest}")]
    NoEnergies {
        /// The machine's name.
        machine: String,
        /// Which cache.
        level: String,
        /// Its size and shape.
        geometry: String,
        /// The table.
        table: String,
        /// The most alike of those that it has.
        nearest: String,
    },
    /// No file of that name comes with the program.
    #[error("no {name} comes with the program; there are: {known}")]
    NotShipped {
        /// The name.
        name: String,
        /// Those there are.
        known: String,
    },
    /// An override that names no key, or has no value of its kind.
    #[error("{key} = {value}: {why}")]
    Override {
        /// The key, dotted.
        key: String,
        /// The value.
        value: String,
        /// What is wrong with it.
        why: String,
    },
}

/// A value that breaks a rule, before the file is known.
#[derive(Debug, Error)]
#[error("{key} {rule}, but is {value}")]
pub(crate) struct Breach {
    key: String,
    rule: String,
    value: String,
}

impl Breach {
    /// `key` breaks `rule` with `value`.
    pub fn new(key: &str, rule: impl Into<String>, value: impl ToString) -> Self {
        Self { key: key.to_owned(), rule: rule.into(), value: value.to_string() }
    }

    /// The breach in `file`.
    pub fn in_file(self, file: &str) -> MachineError {
        MachineError::Invalid { file: file.to_owned(), key: self.key, rule: self.rule, value: self.value }
    }
}

/// A value of a line that breaks a rule, before file and line are known.
#[derive(Debug)]
pub(crate) struct LineFault {
    field: String,
    rule: String,
    value: String,
}

impl LineFault {
    /// `field` breaks `rule` with `value`.
    pub fn new(field: &str, rule: impl Into<String>, value: impl ToString) -> Self {
        Self { field: field.to_owned(), rule: rule.into(), value: value.to_string() }
    }

    /// The fault in a line of `file`, counted from 1.
    pub fn in_line(self, file: &str, line: usize) -> MachineError {
        MachineError::Line { file: file.to_owned(), line, field: self.field, rule: self.rule, value: self.value }
    }
}
