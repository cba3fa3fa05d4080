//! Traversal units whose rays wait for work before their frame, which the group's cores do: a front end of both.
//!
//! The rays wait until all of that work is done, so one of both is busy at a time. What cores compute takes no time, as without units: the work takes what memory takes.

use super::FrontEnd;
use super::cores::FreeCores;
use super::counts::Supplier;
use super::event::Happening;
use super::feed::Feed;
use super::group_side::GroupSide;
use super::messages::Grant;
use super::units::{self, Units};
use crate::block::Operations;
use crate::machine::Machine;
use crate::step::Nodes;

/// What the memory hierarchy knows of cores has this bit; what it knows of units has numbers below.
const CORES: u32 = 1 << 27;

/// Most units beside cores: half as many as alone, for that bit.
pub const MOST_UNITS: u64 = units::MOST_UNITS / 2;

/// Cores and units of some groups.
pub struct WorkThenRays {
    cores: FreeCores<CORES>,
    /// The units.
    pub units: Units,
    /// What was given last is work.
    is_work: bool,
}

impl WorkThenRays {
    /// The cores and units of `machine`, whose groups are those from `first` on.
    pub fn new(machine: &Machine, first: u32, nodes: Nodes) -> Self {
        Self { cores: FreeCores::new(machine, first, nodes), units: Units::new(machine, first), is_work: false }
    }

    /// Lets the cores do something. What they wait for is no context's of a unit, and is not among the stalls.
    fn by_cores(&mut self, memory: &mut GroupSide, act: impl FnOnce(&mut FreeCores<CORES>, &mut GroupSide)) {
        let stalls = memory.counts_mut().stalls;
        act(&mut self.cores, memory);
        memory.counts_mut().stalls = stalls;
    }
}

impl FrontEnd for WorkThenRays {
    fn slots(&self) -> (usize, fn(u32) -> usize) {
        // Even places are units', odd ones cores'.
        let place = |waiter| if waiter & CORES == 0 { 2 * units::slot(waiter) } else { 2 * (waiter & !CORES) as usize + 1 };
        (2 * self.cores.slots().0.max(self.units.slots().0), place)
    }

    fn feed(&mut self) -> &mut Feed {
        if self.is_work { self.cores.feed() } else { self.units.feed() }
    }

    fn grant(&mut self, group: u32, grant: Grant) {
        // The other has had all of its own before, and told so.
        self.is_work = grant.is_work();
        self.feed().comes(group, grant);
    }

    fn granted(&mut self, group: u32, memory: &mut GroupSide) {
        if self.is_work {
            self.by_cores(memory, |cores, memory| cores.granted(group, memory));
        } else {
            self.units.granted(group, memory);
        }
    }

    fn wake(&mut self, id: u32, memory: &mut GroupSide) {
        if id & CORES == 0 {
            self.units.wake(id, memory);
        } else {
            self.by_cores(memory, |cores, memory| cores.wake(id, memory));
        }
    }

    fn comes(&mut self, waiter: u32, cycle: u64, memory: &mut GroupSide) {
        if waiter & CORES == 0 {
            self.units.comes(waiter, cycle, memory);
        } else {
            self.by_cores(memory, |cores, memory| cores.comes(waiter, cycle, memory));
        }
    }

    fn answer(&mut self, waiter: u32, from: Supplier, memory: &mut GroupSide) {
        if waiter & CORES == 0 {
            self.units.answer(waiter, from, memory);
        } else {
            self.by_cores(memory, |cores, memory| cores.answer(waiter, from, memory));
        }
    }

    fn prefetch(&self, happening: Happening, soon: [Option<u32>; 2]) {
        if self.is_work {
            self.cores.prefetch(happening, soon.map(|id| id.filter(|id| id & CORES != 0)));
        }
    }

    fn under_way(&self) -> u64 {
        self.cores.under_way() + self.units.under_way()
    }

    fn operations(&self) -> Operations {
        let mut sum = self.cores.operations();
        sum.join(&self.units.operations());
        sum
    }

    fn describe(&self) -> String {
        format!("{}\n{}", self.cores.describe(), self.units.describe())
    }
}
