//! Lines by what they hold.

use super::memory::is_zero;
use super::ratio::ratio;
use crate::num::LINE_BYTES;
use crate::sim::replay::KindTraffic;
use crate::step::{MAX_SECTIONS, MemoryMap};
use serde::{Deserialize, Serialize};

/// Lines and bytes of a frame.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct TrafficResult {
    /// Bytes for each ray, of all kinds of data together.
    pub bytes_per_ray: LevelBytes,
    /// Share of the L1s' requests that read the L0 part: the quad-BVH over the base triangles, and their records. Of methods that have one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub l0_share_of_l1: Option<f64>,
    /// By kind of data; those that were read.
    pub kinds: Vec<KindResult>,
}

/// Bytes for each ray, by where they were asked for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LevelBytes {
    /// The L1s.
    pub l1: f64,
    /// The L2.
    pub l2: f64,
    /// Memory.
    pub dram: f64,
}

/// Lines of one kind of data.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KindResult {
    /// What they hold.
    pub kind: String,
    /// Requests to the L1s.
    pub l1: u64,
    /// Requests to the L2.
    pub l2: u64,
    /// Lines read from memory.
    pub dram: u64,
    /// Lines written to memory, of methods that write.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub written: u64,
    /// Bytes for each ray.
    pub bytes_per_ray: LevelBytes,
}

impl TrafficResult {
    /// Of a method with this memory.
    pub(super) fn new(map: &MemoryMap, traffic: &[KindTraffic; MAX_SECTIONS], rays: u64) -> Self {
        let bytes = |lines: u64| ratio((lines * LINE_BYTES) as f64, rays as f64);
        let level_bytes = |t: &KindTraffic| LevelBytes { l1: bytes(t.l1), l2: bytes(t.l2), dram: bytes(t.dram + t.written) };
        let sum = traffic.iter().fold(KindTraffic::default(), |a, b| KindTraffic {
            l1: a.l1 + b.l1,
            l2: a.l2 + b.l2,
            dram: a.dram + b.dram,
            written: a.written + b.written,
        });
        let base = map.sections().filter(|(_, section)| section.base).map(|(id, _)| traffic[id.place()].l1);
        let l0_share_of_l1 = base.reduce(|a, b| a + b).map(|lines| ratio(lines as f64, sum.l1 as f64));
        let kinds = map.sections().map(|(id, section)| (section.name, &traffic[id.place()])).filter(|(_, t)| t.l1 > 0);
        let kinds = kinds.map(|(name, t)| KindResult {
            kind: name.to_owned(),
            l1: t.l1,
            l2: t.l2,
            dram: t.dram,
            written: t.written,
            bytes_per_ray: level_bytes(t),
        });
        Self { bytes_per_ray: level_bytes(&sum), l0_share_of_l1, kinds: kinds.collect() }
    }
}
