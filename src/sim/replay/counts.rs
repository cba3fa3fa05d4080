//! What a run counts.

use super::stalls::Stalls;
use crate::step::MAX_SECTIONS;
use serde::Serialize;

/// What was counted up to a cycle.
pub trait Earlier: Clone {
    /// What it was so many cycles earlier, if nothing happened between; what waits, waits for less long.
    fn earlier(&mut self, cycles: u64);
}

/// What few methods do is not in documents of all others.
fn is_zero(count: &u64) -> bool {
    *count == 0
}

/// A level of cache.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct CacheCounts {
    /// Requests looked up: hits, misses, merges and stores.
    pub requests: u64,
    /// Found.
    pub hits: u64,
    /// Not found: asked of the next level.
    pub misses: u64,
    /// Not found, but asked for already.
    pub merges: u64,
    /// Lines written that were read from the next level.
    pub fills: u64,
    /// Requests to write a line.
    #[serde(skip_serializing_if = "is_zero")]
    pub stores: u64,
    /// Lines that stores have written here: those that it had, and where what is written stays, all.
    #[serde(skip_serializing_if = "is_zero")]
    pub updates: u64,
    /// Lines written to memory, for others.
    #[serde(skip_serializing_if = "is_zero")]
    pub write_backs: u64,
    /// Requests that waited for their bank.
    pub conflicts: u64,
    /// Their cycles in its queue.
    pub queued_cycles: u64,
    /// Cycles of requesters whose bank's queue was full.
    pub refused_cycles: u64,
    /// Cycles of banks that could not go on for want of an MSHR, or of a target in one.
    pub blocked_cycles: u64,
    /// Cycles of miss registers in use.
    pub register_cycles: u64,
    /// Miss registers in use when this was counted.
    #[serde(skip)]
    pub registers_now: u64,
    /// Requests in queues when this was counted.
    #[serde(skip)]
    pub queued_now: u64,
    /// Most miss registers of a bank that were in use at once.
    pub most_registers: u64,
    /// Most requests that waited for a bank at once.
    pub longest_queue: u64,
}

impl CacheCounts {
    /// Lines read out of it: one for each request, and what goes back to memory.
    pub fn read(&self) -> u64 {
        self.requests + self.write_backs
    }

    /// Lines written into it.
    pub fn written(&self) -> u64 {
        self.fills + self.updates
    }

    /// Adds what another side counted.
    pub fn add(&mut self, other: &Self) {
        let Self {
            requests,
            hits,
            misses,
            merges,
            fills,
            stores,
            updates,
            write_backs,
            conflicts,
            queued_cycles,
            refused_cycles,
            blocked_cycles,
            register_cycles,
            registers_now,
            queued_now,
            most_registers: _,
            longest_queue: _,
        } = self;
        *requests += other.requests;
        *hits += other.hits;
        *misses += other.misses;
        *merges += other.merges;
        *fills += other.fills;
        *stores += other.stores;
        *updates += other.updates;
        *write_backs += other.write_backs;
        *conflicts += other.conflicts;
        *queued_cycles += other.queued_cycles;
        *refused_cycles += other.refused_cycles;
        *blocked_cycles += other.blocked_cycles;
        *register_cycles += other.register_cycles;
        *registers_now += other.registers_now;
        *queued_now += other.queued_now;
        self.most_registers = self.most_registers.max(other.most_registers);
        self.longest_queue = self.longest_queue.max(other.longest_queue);
    }
}

impl Earlier for CacheCounts {
    fn earlier(&mut self, cycles: u64) {
        self.register_cycles -= cycles * self.registers_now;
        self.queued_cycles -= cycles * self.queued_now;
    }
}

/// Where a line came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Supplier {
    /// The group's L1.
    L1,
    /// The L2.
    L2,
    /// Memory.
    Dram,
}

/// Lines of one section.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct KindTraffic {
    /// Requests to the L1s.
    pub l1: u64,
    /// Requests to the L2.
    pub l2: u64,
    /// Lines read from memory.
    pub dram: u64,
    /// Lines written to memory.
    #[serde(skip_serializing_if = "is_zero")]
    pub written: u64,
}

/// Cycles of the contexts that hold rays, by what they wait for: from asking for the lines of a step to having the last of them, by where that came from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Waits {
    /// The L1.
    pub l1: u64,
    /// The L2.
    pub l2: u64,
    /// Memory.
    pub dram: u64,
}

impl Waits {
    /// Adds `cycles` of waiting for a line from `source`.
    #[inline]
    pub fn add(&mut self, source: Supplier, cycles: u64) {
        match source {
            Supplier::L1 => self.l1 += cycles,
            Supplier::L2 => self.l2 += cycles,
            Supplier::Dram => self.dram += cycles,
        }
    }
}

/// Everything that a run counts but the memory's own counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Counts {
    /// Rays done.
    pub rays: u64,
    /// Of those, rays that hit.
    pub hits: u64,
    /// The L1s, all together.
    pub l1: CacheCounts,
    /// The L2.
    pub l2: CacheCounts,
    /// Cycles of misses that waited for the crossbar's ports.
    pub crossbar_cycles: u64,
    /// Cycles of answers that did.
    pub answer_cycles: u64,
    /// Cycles of misses that waited for room in a memory channel's queue.
    pub dram_refused_cycles: u64,
    /// What contexts waited for.
    pub waits: Waits,
    /// The same by cause.
    pub stalls: Stalls,
    /// By the place of their section.
    pub traffic: [KindTraffic; MAX_SECTIONS],
}

impl Earlier for Counts {
    fn earlier(&mut self, cycles: u64) {
        self.l1.earlier(cycles);
        self.l2.earlier(cycles);
    }
}

impl Counts {
    /// Adds what another side counted.
    pub fn add(&mut self, other: &Self) {
        self.rays += other.rays;
        self.hits += other.hits;
        self.l1.add(&other.l1);
        self.l2.add(&other.l2);
        self.crossbar_cycles += other.crossbar_cycles;
        self.answer_cycles += other.answer_cycles;
        self.dram_refused_cycles += other.dram_refused_cycles;
        self.waits.l1 += other.waits.l1;
        self.waits.l2 += other.waits.l2;
        self.waits.dram += other.waits.dram;
        self.stalls.iter_mut().zip(other.stalls).for_each(|(sum, cycles)| *sum += cycles);
        for (sum, more) in self.traffic.iter_mut().zip(&other.traffic) {
            sum.l1 += more.l1;
            sum.l2 += more.l2;
            sum.dram += more.dram;
            sum.written += more.written;
        }
    }
}
