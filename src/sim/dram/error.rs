//! What a DRAM description or configuration can have wrong.

use thiserror::Error;

/// Why a DRAM cannot be made.
#[derive(Debug, Error)]
pub enum DramError {
    /// Not TOML, a key missing or unknown, or a value of the wrong type.
    #[error("DRAM description: {0}")]
    Toml(#[from] toml::de::Error),
    /// A value that no DRAM can have.
    #[error("DRAM: {key} {rule}, but is {value}")]
    Invalid {
        /// The key.
        key: String,
        /// What it must be.
        rule: String,
        /// What it is.
        value: String,
    },
    /// No device of that name comes with the program.
    #[error("no DRAM preset {name:?}; there are: {known}")]
    NoPreset {
        /// The name.
        name: String,
        /// Those there are.
        known: String,
    },
    /// An address mapping that does not name every part once.
    #[error("DRAM: mapping {mapping:?}: {what}")]
    Mapping {
        /// The option.
        mapping: String,
        /// What is wrong with it.
        what: String,
    },
}

/// `key` breaks `rule` with `value`.
pub(super) fn invalid(key: &str, rule: impl Into<String>, value: impl ToString) -> DramError {
    DramError::Invalid { key: key.to_owned(), rule: rule.into(), value: value.to_string() }
}
