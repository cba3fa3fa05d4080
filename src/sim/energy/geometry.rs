//! Which cache: its level, and its geometry, on which its energies depend.

use crate::machine::{Cache, Machine};
use serde::Deserialize;
use std::fmt;

/// A level of cache.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// The cache of a group of cores.
    L1,
    /// The cache of all.
    L2,
}

/// Size and shape of a cache, all its banks together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Geometry {
    /// Capacity of all banks.
    pub bytes: u64,
    /// Lines of a set.
    pub ways: u32,
    /// Banks.
    pub banks: u32,
    /// Bytes of a line.
    pub line_bytes: u32,
}

impl Level {
    /// Both levels.
    pub const BOTH: [Self; 2] = [Self::L1, Self::L2];

    /// The cache of this level of a machine.
    pub fn of(self, machine: &Machine) -> &Cache {
        match self {
            Self::L1 => &machine.l1,
            Self::L2 => &machine.l2,
        }
    }
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::L1 => "l1",
            Self::L2 => "l2",
        })
    }
}

impl Geometry {
    /// How unlike two geometries are: how many times one must be doubled or halved, in bytes, ways, banks and bytes of a line together, to be the other.
    pub fn doublings_to(&self, other: &Self) -> f64 {
        let numbers = |g: &Self| [g.bytes as f64, f64::from(g.ways), f64::from(g.banks), f64::from(g.line_bytes)];
        numbers(self).into_iter().zip(numbers(other)).map(|(a, b)| (a / b).log2().abs()).sum()
    }
}

impl From<&Cache> for Geometry {
    fn from(cache: &Cache) -> Self {
        Self { bytes: cache.bytes, ways: cache.ways, banks: cache.banks, line_bytes: cache.line_bytes }
    }
}

impl fmt::Display for Geometry {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { bytes, ways, banks, line_bytes } = self;
        let plural = if *banks == 1 { "" } else { "s" };
        write!(f, "{bytes} bytes, {ways}-way, {banks} bank{plural}, {line_bytes}-byte lines")
    }
}
