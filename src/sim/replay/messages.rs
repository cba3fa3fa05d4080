//! What the sides of a replay tell each other: groups with their L1s, the side they share (crossbar, L2, memory), and the dispatcher of rays.

use super::event::{Ask, EventKind};
use super::fed_ray::FedRay;
use super::stalls::Path;
use crate::step::Batch;
use std::collections::VecDeque;
use std::sync::Arc;

/// A miss or a store of an L1, for the crossbar.
#[derive(Clone, Copy, Debug)]
pub struct Miss {
    /// The cycle in which it is known.
    pub cycle: u64,
    /// Its group.
    pub group: u32,
    /// The L1's register that keeps it, through all groups.
    pub register: u32,
    /// The line, read or written.
    pub ask: Ask,
}

/// A line for an L1.
#[derive(Clone, Copy, Debug)]
pub struct Fill {
    /// The cycle in which it is written.
    pub cycle: u64,
    /// The register that waits for it, through all groups.
    pub register: u32,
    /// Where it came from: [`EventKind::FillL1FromL2`] or [`EventKind::FillL1FromDram`].
    pub kind: EventKind,
    /// Its way.
    pub path: Path,
}

/// What a group tells the dispatcher.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Notice {
    /// It has few rays left.
    Asks,
    /// The ray of this number has ended, of a frame whose rays wait for others.
    Ended(u64),
}

/// A notice, when and by whom.
#[derive(Clone, Copy, Debug)]
pub struct Told {
    /// The cycle.
    pub cycle: u64,
    /// The group, through all.
    pub group: u32,
    /// What.
    pub notice: Notice,
}

/// What a group is given at once.
#[derive(Clone)]
pub enum Grant {
    /// A batch, none of whose rays waits for another.
    Batch(Arc<Batch>),
    /// Rays, of whatever batches.
    Rays(VecDeque<FedRay>),
}

impl Grant {
    /// It is work before a frame, and no rays.
    pub fn is_work(&self) -> bool {
        match self {
            Self::Batch(batch) => batch.is_work(),
            Self::Rays(rays) => rays.front().is_some_and(FedRay::is_work),
        }
    }
}

/// Rays for a group.
pub struct Granted {
    /// The cycle in which it has them.
    pub cycle: u64,
    /// The group, through all.
    pub group: u32,
    /// Which.
    pub grant: Grant,
}
