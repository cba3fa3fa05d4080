//! The parts of a machine, field by field as in its file.

use crate::block::{BoxesPerCycle, EdgesPerCycle};
use crate::hardware::{Eased, Hardware};
use crate::sim::dram::{Controller, Scheduler};
use serde::{Deserialize, Serialize};

/// Picoseconds per cycle at 1 MHz.
const PS_MHZ: u128 = 1_000_000;

/// The cores, in groups that share an L1.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cores {
    /// Groups.
    pub groups: u32,
    /// Cores of a group.
    pub per_group: u32,
    /// Rays under way at once in a core.
    pub rays_in_flight: u32,
    /// Quad-BVH nodes, from the root on in memory order, that cores hold for good: nobody asks for their lines. Where compute takes no time only; 0 if absent.
    #[serde(default)]
    pub pinned_nodes: u32,
    /// Clock of cores, caches and crossbar, in MHz.
    pub clock_mhz: u32,
}

impl Cores {
    /// All cores.
    pub fn total(&self) -> u32 {
        self.groups * self.per_group
    }

    /// When `cycle` begins, in picoseconds, rounded down.
    pub fn start_ps(&self, cycle: u64) -> u64 {
        (u128::from(cycle) * PS_MHZ / u128::from(self.clock_mhz)) as u64
    }

    /// The first cycle that begins at or after `ps`. A cycle lasts at least 1 ps, so this gives back the cycle of [`Cores::start_ps`].
    pub fn cycle_at(&self, ps: u64) -> u64 {
        (u128::from(ps) * u128::from(self.clock_mhz)).div_ceil(PS_MHZ) as u64
    }
}

/// Which bits of a line's number choose the bank and the set of a cache.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Index {
    /// The lowest choose the bank, the next the set.
    #[default]
    Sliced,
    /// The exclusive or of these with all bits above them, taken in pieces of the same width: lines that a power of two parts spread over all sets.
    Xor,
}

impl Index {
    /// Whether it is the default, which files leave out.
    #[allow(clippy::trivially_copy_pass_by_ref)] // serde passes a reference
    fn is_sliced(&self) -> bool {
        *self == Self::Sliced
    }
}

/// A level of cache: what a group has of the first, the machine of the second. Lines go round the banks.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cache {
    /// Capacity of all banks.
    pub bytes: u64,
    /// Lines of a set.
    pub ways: u32,
    /// Banks, each of which takes a request per cycle.
    pub banks: u32,
    /// Bytes of a line.
    pub line_bytes: u32,
    /// Cycles of a hit, tags and data, from the request in the bank to its answer.
    pub latency_cycles: u32,
    /// Misses under way of a bank.
    pub mshrs: u32,
    /// Requests that one miss answers, the first included.
    pub targets: u32,
    /// Requests that may wait in front of a bank.
    pub queue: u32,
    /// How a line's number chooses bank and set.
    #[serde(default, skip_serializing_if = "Index::is_sliced")]
    pub index: Index,
}

impl Cache {
    /// Lines of all banks.
    pub fn lines(&self) -> u64 {
        self.bytes / u64::from(self.line_bytes)
    }

    /// Sets of a bank.
    pub fn sets_per_bank(&self) -> u64 {
        self.lines() / u64::from(self.ways) / u64::from(self.banks)
    }
}

/// What joins the L1s to the banks of the L2.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Crossbar {
    /// Cycles from an L1's miss to the queue of the L2's bank.
    pub request_cycles: u32,
    /// Cycles from the bank's answer to the L1.
    pub answer_cycles: u32,
    /// Requests that a bank of the L2 may be handed in a cycle.
    pub per_bank: u32,
    /// Requests that a group may send, and answers that it may get, in a cycle.
    pub per_group: u32,
}

/// The traversal units, where compute takes time.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Units {
    /// Units of a group.
    pub per_group: u32,
    /// Rays under way at once in a unit.
    pub contexts: u32,
    /// Edge functions that the triangle test evaluates in a cycle: 3 or 1.
    pub edges_per_cycle: u32,
    /// Edges of a triangle that the LOD test takes in a cycle: 3 or 1.
    #[serde(default = "Units::lod_edges_per_cycle")]
    pub lod_edges_per_cycle: u32,
    /// Bits of a quotient that the division of hits finds in a cycle: 1 to 3.
    #[serde(default = "Units::divide_bits")]
    pub divide_bits: u32,
    /// Bits of a reciprocal that the constants of a ray take in a cycle: 1 to 3.
    #[serde(default = "Units::setup_bits")]
    pub setup_bits: u32,
    /// Blocks of the constants of a ray that take turns: 1 to 4.
    #[serde(default = "Units::one")]
    pub setup_copies: u32,
    /// Blocks of the division of hits that take turns: 1 to 4.
    #[serde(default = "Units::one")]
    pub divide_copies: u32,
    /// Boxes of a node of four that are tested in a cycle: 4, 2 or 1.
    #[serde(default = "Units::boxes_per_cycle")]
    pub boxes_per_cycle: u32,
    /// Rays can start on a surface: blocks for exact starts, and for rays that decide for others.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub secondary: bool,
    /// What rays do not wait for, to see what it costs that they do: names as `simulate --ease` prints them, joined by `+`. No unit is so.
    #[serde(default, skip_serializing_if = "Eased::is_none")]
    pub eased: Eased,
    /// A unit of a plan: what the keys above do not say is as there. Machine files have none.
    #[serde(skip)]
    pub like: Option<Hardware>,
}

impl Units {
    /// The hardware of a unit: what the machine does not say is as in a plan's, or as in `rtl/`.
    pub fn config(&self) -> Hardware {
        // Machines with other counts are refused before.
        let usual = self.like.unwrap_or_default();
        let edges_per_cycle = EdgesPerCycle::new(self.edges_per_cycle).unwrap_or(usual.edges_per_cycle);
        let lod_edges_per_cycle = EdgesPerCycle::new(self.lod_edges_per_cycle).unwrap_or(usual.lod_edges_per_cycle);
        let boxes_per_cycle = BoxesPerCycle::new(self.boxes_per_cycle).unwrap_or(usual.boxes_per_cycle);
        let Self { divide_bits, setup_bits, setup_copies, divide_copies, .. } = *self;
        Hardware {
            contexts: self.contexts as usize,
            edges_per_cycle,
            lod_edges_per_cycle,
            boxes_per_cycle,
            divide_bits,
            setup_bits,
            setup_copies,
            divide_copies,
            secondary: self.secondary || usual.secondary,
            ..usual
        }
    }

    /// Where a file does not say.
    const fn lod_edges_per_cycle() -> u32 {
        Hardware::DEFAULT.lod_edges_per_cycle.count()
    }

    /// Likewise.
    const fn divide_bits() -> u32 {
        Hardware::DEFAULT.divide_bits
    }

    /// Likewise.
    const fn boxes_per_cycle() -> u32 {
        Hardware::DEFAULT.boxes_per_cycle.count()
    }

    /// Likewise.
    const fn setup_bits() -> u32 {
        Hardware::DEFAULT.setup_bits
    }

    /// Blocks of a kind that take turns, likewise.
    const fn one() -> u32 {
        1
    }
}

/// The memory behind the L2.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Memory {
    /// File of the device, relative to the machine's own.
    pub device: String,
    /// Channels.
    pub channels: u32,
    /// Reads that may wait in a channel.
    pub queue: u32,
    /// Bits of a line number that choose channel, bank, row and column, as the DRAM model writes them; its default if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mapping: Option<String>,
    /// Which request of a channel goes first.
    #[serde(default)]
    pub scheduler: Scheduler,
    /// How many hits of an open row go before others, as the scheduler counts them.
    #[serde(default = "hit_cap")]
    pub hit_cap: u32,
}

fn hit_cap() -> u32 {
    Controller::default().hit_cap
}

/// The energy tables, each `energy/NAME.toml`.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Tables {
    /// Energies of the caches.
    pub caches: String,
    /// Energies of the hardware blocks; compute costs nothing if absent.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub blocks: Option<String>,
}
