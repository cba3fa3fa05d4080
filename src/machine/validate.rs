//! What the values of a machine description must satisfy.

use super::Machine;
use super::error::Breach;
use super::parts::{Cache, Memory, Tables, Units};
use crate::block::{BoxesPerCycle, EdgesPerCycle, MOST_DIVIDE_BITS};
use crate::hardware::{MAX_CONTEXTS, MOST_COPIES};
use crate::num::LINE_BYTES;

/// Groups, and cores of a group.
const MOST_CORES: u32 = 1 << 12;
/// Capacity of a cache: 1 GiB. Far below it products of bytes, ways and banks would overflow nothing either.
const MOST_BYTES: u64 = 1 << 30;
/// A cycle lasts at least 10 ps.
const MOST_MHZ: u32 = 100_000;
/// Latencies, queues and other counts.
const MOST: u32 = 1 << 16;
/// Most requests that wait in a channel.
const MOST_QUEUED: u32 = 1 << 12;

impl Machine {
    pub(super) fn validate(&self) -> Result<(), Breach> {
        if self.name.is_empty() {
            return Err(Breach::new("name", "must not be empty", "\"\""));
        }
        let counts = [
            ("cores.groups", self.cores.groups, MOST_CORES),
            ("cores.per_group", self.cores.per_group, MOST_CORES),
            ("cores.rays_in_flight", self.cores.rays_in_flight, MOST),
            ("cores.clock_mhz", self.cores.clock_mhz, MOST_MHZ),
            ("crossbar.request_cycles", self.crossbar.request_cycles, MOST),
            ("crossbar.answer_cycles", self.crossbar.answer_cycles, MOST),
            ("crossbar.per_bank", self.crossbar.per_bank, MOST),
            ("crossbar.per_group", self.crossbar.per_group, MOST),
            ("dram.queue", self.dram.queue, MOST_QUEUED),
        ];
        counts.iter().try_for_each(|&(key, value, most)| count(key, value, most))?;
        self.units.validate("units")?;
        self.l1.validate("l1")?;
        self.l2.validate("l2")?;
        if self.l1.bytes > self.l2.bytes {
            return Err(Breach::new("l1.bytes", format!("must be at most l2.bytes = {}", self.l2.bytes), self.l1.bytes));
        }
        self.dram.validate()?;
        self.energy.validate()
    }
}

impl Units {
    /// `at` is where they stand, dotted.
    pub(crate) fn validate(&self, at: &str) -> Result<(), Breach> {
        let key = |name: &str| format!("{at}.{name}");
        let counts = [
            ("per_group", self.per_group, MOST),
            ("contexts", self.contexts, MAX_CONTEXTS as u32),
            ("divide_bits", self.divide_bits, MOST_DIVIDE_BITS),
            ("setup_bits", self.setup_bits, MOST_DIVIDE_BITS),
            ("setup_copies", self.setup_copies, MOST_COPIES),
            ("divide_copies", self.divide_copies, MOST_COPIES),
        ];
        counts.iter().try_for_each(|&(name, value, most)| count(&key(name), value, most))?;
        if BoxesPerCycle::new(self.boxes_per_cycle).is_none() {
            return Err(Breach::new(&key("boxes_per_cycle"), "must be 4, 2 or 1", self.boxes_per_cycle));
        }
        let edges = [("edges_per_cycle", self.edges_per_cycle), ("lod_edges_per_cycle", self.lod_edges_per_cycle)];
        let wrong = edges.into_iter().find(|&(_, count)| EdgesPerCycle::new(count).is_none());
        wrong.map_or(Ok(()), |(name, count)| Err(Breach::new(&key(name), "must be 3 or 1", count)))
    }
}

impl Cache {
    fn validate(&self, level: &str) -> Result<(), Breach> {
        let key = |name: &str| format!("{level}.{name}");
        if u64::from(self.line_bytes) != LINE_BYTES {
            let rule = format!("must be {LINE_BYTES}, the line that traversal reads");
            return Err(Breach::new(&key("line_bytes"), rule, self.line_bytes));
        }
        let counts = [
            ("ways", self.ways),
            ("banks", self.banks),
            ("latency_cycles", self.latency_cycles),
            ("mshrs", self.mshrs),
            ("targets", self.targets),
            ("queue", self.queue),
        ];
        counts.iter().try_for_each(|&(name, value)| count(&key(name), value, MOST))?;
        if !self.banks.is_power_of_two() {
            return Err(Breach::new(&key("banks"), "must be a power of two", self.banks));
        }
        if !(1..=MOST_BYTES).contains(&self.bytes) {
            return Err(Breach::new(&key("bytes"), format!("must be 1 to {MOST_BYTES}"), self.bytes));
        }
        let row = u64::from(self.line_bytes) * u64::from(self.ways) * u64::from(self.banks);
        if !self.bytes.is_multiple_of(row) || !(self.bytes / row).is_power_of_two() {
            let rule = format!("must be line_bytes x ways x banks = {row} times a power of two");
            return Err(Breach::new(&key("bytes"), rule, self.bytes));
        }
        Ok(())
    }
}

impl Memory {
    fn validate(&self) -> Result<(), Breach> {
        if !self.channels.is_power_of_two() || self.channels > MOST {
            return Err(Breach::new("dram.channels", format!("must be a power of two up to {MOST}"), self.channels));
        }
        if !self.device.ends_with(".toml") {
            return Err(Breach::new("dram.device", "must be a file's path, with .toml", format!("{:?}", self.device)));
        }
        if self.mapping.as_ref().is_some_and(String::is_empty) {
            return Err(Breach::new("dram.mapping", "must not be empty", "\"\""));
        }
        Ok(())
    }
}

impl Tables {
    fn validate(&self) -> Result<(), Breach> {
        let names = [("energy.caches", Some(&self.caches)), ("energy.blocks", self.blocks.as_ref())];
        for (key, name) in names {
            let plain = |name: &str| !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || "-_.".contains(c));
            if let Some(name) = name.filter(|name| !plain(name)) {
                return Err(Breach::new(key, "must be a name of letters, digits, - _ and .", format!("{name:?}")));
            }
        }
        Ok(())
    }
}

/// `value` is at least 1 and at most `most`.
fn count(key: &str, value: u32, most: u32) -> Result<(), Breach> {
    if (1..=most).contains(&value) { Ok(()) } else { Err(Breach::new(key, format!("must be 1 to {most}"), value)) }
}
