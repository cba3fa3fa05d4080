//! What a unit must not do.

use thiserror::Error;

/// What a unit did wrong.
#[derive(Clone, Debug, PartialEq, Eq, Error)]
pub enum UnitError {
    /// It asked for a line that no section holds.
    #[error("cycle {cycle}: line {address:#x} (tag {tag:#x}) is outside of the model")]
    Address {
        /// When.
        cycle: u64,
        /// The line.
        address: u64,
        /// Tag of the request.
        tag: u64,
    },
    /// A request bears the tag of one not yet answered.
    #[error("cycle {cycle}: tag {tag:#x} is already outstanding")]
    TagInUse {
        /// When.
        cycle: u64,
        /// The tag.
        tag: u64,
    },
    /// A port changed what it offered before it was taken.
    #[error("cycle {cycle}: the {port} port did not hold what it offered")]
    NotHeld {
        /// When.
        cycle: u64,
        /// Which port.
        port: &'static str,
    },
    /// A hit bears the tag of no ray under way.
    #[error("cycle {cycle}: a hit with tag {tag} of no ray under way")]
    StrayHit {
        /// When.
        cycle: u64,
        /// The tag.
        tag: u64,
    },
    /// No port moved for too long.
    #[error("cycle {cycle}: nothing moved for {quiet} cycles\n{contexts}")]
    Deadlock {
        /// When.
        cycle: u64,
        /// For how long.
        quiet: u64,
        /// What every context is doing.
        contexts: String,
    },
}
