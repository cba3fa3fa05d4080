//! Cores whose compute takes no time, as in the paper: a ray asks for its next lines in the cycle in which the last of those before came.
//!
//! A core holds some rays and asks for one line a cycle, for the rays in the order in which they became ready.

use super::FrontEnd;
use super::counts::Supplier;
use super::event::{Ask, Asked, Happening};
use super::fed_ray::FedRay;
use super::feed::Feed;
use super::group_side::GroupSide;
use super::prefetch::prefetch;
use crate::block::{Operation, Operations};
use crate::machine::Machine;
use crate::step::{Act, Asking, Nodes, SectionId, Step};
use std::ops::Range;

/// Lines that a ray asks for at once; a leaf of more is read in parts.
const MOST_LINES: usize = 16;

/// No context.
const NONE: u32 = u32::MAX;

/// Contexts of a group.
pub fn contexts_of_group(machine: &Machine) -> u32 {
    machine.cores.per_group * machine.cores.rays_in_flight
}

/// What a core holds of a ray. (What most steps need lies in one cache line.)
#[derive(Clone)]
#[repr(C, align(64))]
struct CoreContext {
    ray: Option<FedRay>,
    /// When all that came, or is known to come, is there.
    ready: u64,
    /// Since when it waits for these lines, and where the one that came last was.
    since: u64,
    from: Supplier,
    count: u8,
    sent: u8,
    come: u8,
    /// The next with lines to ask for, of those of its port.
    next: u32,
    /// Bit k: the k-th line is written.
    stores: u16,
    lines: [u32; MOST_LINES],
    sections: [SectionId; MOST_LINES],
}

impl CoreContext {
    /// A line comes from the L1 in `cycle`: only of the last is the context told when it is there.
    #[inline(always)]
    fn comes<const TAG: u32>(&mut self, context: u32, cycle: u64, memory: &mut GroupSide) {
        self.ready = self.ready.max(cycle);
        if self.come + 1 == self.count {
            memory.answer_at(self.ready, TAG | context, Supplier::L1);
        } else {
            self.come += 1;
        }
    }
}

/// A core's way to its L1.
#[derive(Clone)]
struct CorePort {
    /// The first cycle in which it may ask.
    free: u64,
    /// First and last of the contexts with lines to ask for; the last counts only if there is a first.
    first: u32,
    last: u32,
    /// It will ask, or its request is held.
    awake: bool,
}

/// All cores. What others say of a core or a context has its number and the bits of `TAG`, which are above all numbers: none where there are cores alone.
pub struct FreeCores<const TAG: u32> {
    feed: Feed,
    contexts: Vec<CoreContext>,
    ports: Vec<CorePort>,
    rays_in_flight: u32,
    per_group: u32,
    /// Lines of nodes that cores hold for good.
    pinned: Range<u32>,
    under_way: u64,
    operations: Operations,
}

impl<const TAG: u32> FreeCores<TAG> {
    /// The cores of `machine`, whose groups are those from `first` on; they hold the first of `nodes`.
    pub fn new(machine: &Machine, first: u32, nodes: Nodes) -> Self {
        let cores = &machine.cores;
        let (lines, sections) = ([0; MOST_LINES], [SectionId::default(); MOST_LINES]);
        let context = CoreContext {
            ray: None,
            ready: 0,
            since: 0,
            from: Supplier::L1,
            count: 0,
            sent: 0,
            come: 0,
            next: NONE,
            stores: 0,
            lines,
            sections,
        };
        let port = CorePort { free: 0, first: NONE, last: NONE, awake: false };
        Self {
            feed: Feed::new(first, cores.groups, contexts_of_group(machine)),
            contexts: vec![context; (cores.total() * cores.rays_in_flight) as usize],
            ports: vec![port; cores.total() as usize],
            rays_in_flight: cores.rays_in_flight,
            per_group: cores.per_group,
            pinned: nodes.lines_of(cores.pinned_nodes),
            under_way: 0,
            operations: Operations::default(),
        }
    }

    fn next_ray(&mut self, context: u32, now: u64) {
        let group = context / self.rays_in_flight / self.per_group;
        let ray = self.feed.ray(group, now);
        self.under_way += u64::from(ray.is_some());
        self.operations.add(Operation::RaySetup, ray.as_ref().is_some_and(|ray| !ray.is_work()).into());
        self.contexts[context as usize].ray = ray;
    }

    /// Takes ray after ray up to the first lines that one asks for.
    #[inline]
    fn take_rays(&mut self, context: u32, memory: &mut GroupSide) {
        while self.contexts[context as usize].ray.is_some() && !self.asks(context, memory) {
            self.next_ray(context, memory.now());
        }
    }

    /// Takes the ray through all steps that ask for nothing, up to the lines that it asks for next, or its end: false.
    fn asks(&mut self, context: u32, memory: &mut GroupSide) -> bool {
        let state = &mut self.contexts[context as usize];
        let Some(ray) = &mut state.ray else { return false };
        // Lines of the steps so far are there: the blocks do what they do with them in this cycle.
        ray.count(&mut self.operations);
        let counts = memory.counts_mut();
        let (mut count, mut steps, mut written) = (0, 0, 0);
        for &word in ray.rest() {
            let Asking { first, mut lines, section, joins, stores, ends } = word.asking();
            if ends {
                if count > 0 {
                    break;
                }
                ray.skip(steps + 1);
                ray.count(&mut self.operations);
                if let (Step { act: Act::End { found, .. }, lanes, .. }, false) = (word.step(), ray.is_work()) {
                    counts.rays += u64::from(lanes);
                    counts.hits += u64::from(found);
                }
                self.under_way -= 1;
                memory.ray_ends(ray.started, ray.is_work());
                self.feed.ended(ray, context / self.rays_in_flight / self.per_group, memory.now());
                return false;
            }
            if self.pinned.contains(&first) && !stores {
                lines = 0;
            }
            if count > 0 && (!joins || count + lines as usize > MOST_LINES) {
                break;
            }
            steps += 1;
            for line in first..first + lines {
                (state.lines[count], state.sections[count]) = (line, section);
                written |= u16::from(stores) << count;
                count += 1;
            }
            counts.traffic[section.place()].l1 += u64::from(lines);
        }
        ray.skip(steps);
        (state.count, state.sent, state.come, state.ready, state.stores) = (count as u8, 0, 0, 0, written);
        (state.since, state.from, state.next) = (memory.now(), Supplier::L1, NONE);
        let port = context / self.rays_in_flight;
        let state = &mut self.ports[port as usize];
        let last = std::mem::replace(&mut state.last, context);
        if state.first == NONE {
            state.first = context;
        } else {
            self.contexts[last as usize].next = context;
        }
        if !state.awake {
            if state.free <= memory.now() {
                self.ask(port, memory);
            } else {
                state.awake = true;
                memory.wake_at(state.free, TAG | port);
            }
        }
        true
    }

    /// The port asks for a line.
    #[inline]
    fn ask(&mut self, port: u32, memory: &mut GroupSide) {
        let state = &mut self.ports[port as usize];
        state.awake = false;
        let context = state.first;
        if context == NONE {
            return;
        }
        let asking = &mut self.contexts[context as usize];
        let sent = asking.sent as usize;
        let ask = Ask { line: asking.lines[sent], section: asking.sections[sent], stores: asking.stores >> sent & 1 == 1 };
        asking.sent += 1;
        if asking.sent == asking.count {
            state.first = asking.next;
        }
        state.free = memory.now() + 1;
        let asked = memory.request(port / self.per_group, TAG | port, TAG | context, ask);
        if let Asked::Comes(cycle) = asked {
            memory.look_up(TAG | context, cycle);
            asking.comes::<TAG>(context, cycle, memory);
        }
        if asked == Asked::Held {
            state.awake = true;
        } else if state.first != NONE {
            state.awake = true;
            memory.wake_at(state.free, TAG | port);
        }
    }
}

impl<const TAG: u32> FrontEnd for FreeCores<TAG> {
    fn slots(&self) -> (usize, fn(u32) -> usize) {
        (self.contexts.len(), |context| (context & !TAG) as usize)
    }

    fn wake(&mut self, port: u32, memory: &mut GroupSide) {
        self.ask(port & !TAG, memory);
    }

    #[inline]
    fn comes(&mut self, context: u32, cycle: u64, memory: &mut GroupSide) {
        let context = context & !TAG;
        self.contexts[context as usize].comes::<TAG>(context, cycle, memory);
    }

    #[inline(always)]
    fn prefetch(&self, happening: Happening, soon: [Option<u32>; 2]) {
        let [far, near] = soon.map(|id| id.map(|id| id & !TAG));
        if let Happening::Wake(_) = happening {
            if let Some(port) = far {
                prefetch(&self.ports, port as usize);
            }
            if let Some(port) = near {
                prefetch(&self.contexts, self.ports[port as usize].first as usize);
            }
            return;
        }
        if let Some(context) = far {
            prefetch(&self.contexts, context as usize);
        }
        if let Some(ray) = near.and_then(|context| self.contexts[context as usize].ray.as_ref()) {
            ray.prefetch();
        }
    }

    #[inline]
    fn answer(&mut self, context: u32, from: Supplier, memory: &mut GroupSide) {
        let context = context & !TAG;
        let state = &mut self.contexts[context as usize];
        state.from = state.from.max(from);
        if state.come + 1 == state.count && state.ready > memory.now() {
            // Another line, found at once, is not there yet.
            let (ready, from) = (state.ready, state.from);
            return memory.answer_at(ready, TAG | context, from);
        }
        state.come += 1;
        if state.come == state.count {
            let waited = memory.now() - state.since;
            memory.counts_mut().waits.add(state.from, waited);
            memory.charge(TAG | context, state.since);
            self.take_rays(context, memory);
        }
    }

    fn granted(&mut self, group: u32, memory: &mut GroupSide) {
        self.feed.came(group);
        let own = self.rays_in_flight * self.per_group;
        for context in group * own..(group + 1) * own {
            if self.contexts[context as usize].ray.is_none() {
                self.next_ray(context, memory.now());
                self.take_rays(context, memory);
            }
        }
    }

    fn feed(&mut self) -> &mut Feed {
        &mut self.feed
    }

    fn under_way(&self) -> u64 {
        self.under_way
    }

    fn operations(&self) -> Operations {
        self.operations.clone()
    }

    fn describe(&self) -> String {
        let waiting = self.contexts.iter().filter(|context| context.ray.is_some()).count();
        let first = self.contexts.iter().enumerate().filter_map(|(k, context)| {
            let ray = context.ray.as_ref()?;
            Some(format!("context {k}: {} of {} lines came, then {:?}", context.come, context.count, ray.peek()))
        });
        format!("{waiting} contexts hold rays\n{}", first.take(16).collect::<Vec<_>>().join("\n"))
    }
}
