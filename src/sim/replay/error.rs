//! What can go wrong in a run.

use crate::machine::MachineError;
use crate::sim::dram::DramError;
use thiserror::Error;

/// Why a run gave no result.
#[derive(Debug, Error)]
pub enum ReplayError {
    /// The machine's description.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// The description of its memory.
    #[error("{file}: {source}")]
    Dram {
        /// Which.
        file: String,
        /// Why.
        source: DramError,
    },
    /// More cores, contexts or banks than events can name.
    #[error("{what} of the machine are more than {most}: {count}")]
    TooLarge {
        /// Of what.
        what: &'static str,
        /// How many there may be.
        most: u64,
        /// How many there are.
        count: u64,
    },
    /// Traversal units hold no nodes.
    #[error("cores.pinned_nodes = {0}: must be 0 where compute takes time; traversal units hold no nodes")]
    PinnedNodes(u32),
    /// The rays of a traversal unit stay in the space of one model.
    #[error("the scene has {0} models, and rays of traversal units go through one: simulate it with compute free")]
    ModelsByUnits(usize),
    /// Traversal units do rays one by one.
    #[error("rays are traced {0} together, and traversal units take them one by one: simulate packets with compute free")]
    PacketsByUnits(usize),
    /// The waveform's writer.
    #[error("waveform: {0}")]
    Wave(#[from] std::io::Error),
    /// Nothing happens any more, but rays are under way.
    #[error("deadlock after cycle {cycle}:\n{state}")]
    Deadlock {
        /// The last cycle in which something happened.
        cycle: u64,
        /// What every unit does.
        state: String,
    },
}
