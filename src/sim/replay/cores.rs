//! Cores whose compute takes no time, as in the paper: a ray asks for its next lines in the cycle in which the last of those before came.
//!
//! A core holds some rays and asks for one line a cycle, for the rays in the order in which they became ready.

use super::FrontEnd;
use super::counts::Source;
use super::feed::{self, Feed, Ray};
use super::hierarchy::Hierarchy;
use super::work::Work;
use crate::sim::machine::Cores;
use crate::sim::stream::Step;
use crate::traverse::Kind;
use std::collections::VecDeque;

/// Lines that a ray asks for at once; a leaf of more is read in parts.
const MOST_LINES: usize = 16;

/// What a core holds of a ray.
#[derive(Clone)]
struct Context {
    ray: Option<Ray>,
    lines: [(u32, Kind); MOST_LINES],
    count: u8,
    sent: u8,
    come: u8,
    /// Since when it waits for these lines, and where the one that came last was.
    since: u64,
    from: Source,
}

/// A core's way to its L1.
#[derive(Clone, Default)]
struct Port {
    /// Contexts with lines to ask for.
    ready: VecDeque<u32>,
    /// The first cycle in which it may ask.
    free: u64,
    /// It will, or its request is held.
    awake: bool,
}

/// All cores.
pub struct FreeCores<S> {
    feed: Feed<S>,
    contexts: Vec<Context>,
    ports: Vec<Port>,
    rays_in_flight: u32,
    per_group: u32,
    pinned_nodes: u32,
    under_way: u64,
    /// What the rays had blocks do.
    pub work: Work,
}

impl<S: feed::Source> FreeCores<S> {
    /// Cores that take rays from `source`.
    pub fn new(cores: &Cores, source: S) -> Self {
        let lines = [(0, Kind::BvhNode); MOST_LINES];
        let context = Context { ray: None, lines, count: 0, sent: 0, come: 0, since: 0, from: Source::L1 };
        Self {
            feed: Feed::new(source, cores.groups),
            contexts: vec![context; (cores.total() * cores.rays_in_flight) as usize],
            ports: vec![Port::default(); cores.total() as usize],
            rays_in_flight: cores.rays_in_flight,
            per_group: cores.per_group,
            pinned_nodes: cores.pinned_nodes,
            under_way: 0,
            work: Work::default(),
        }
    }

    fn next_ray(&mut self, context: u32) {
        let group = context / self.rays_in_flight / self.per_group;
        let ray = self.feed.ray(group);
        if ray.is_some() {
            self.under_way += 1;
            self.work.ray();
        }
        self.contexts[context as usize].ray = ray;
    }

    /// Takes ray after ray up to the first lines that one asks for.
    #[inline]
    fn go_on(&mut self, context: u32, memory: &mut Hierarchy) {
        while self.contexts[context as usize].ray.is_some() && !self.asks(context, memory) {
            self.next_ray(context);
        }
    }

    /// Takes the ray through all steps that ask for nothing, up to the lines that it asks for next, or its end: false.
    fn asks(&mut self, context: u32, memory: &mut Hierarchy) -> bool {
        let state = &mut self.contexts[context as usize];
        let Some(ray) = &mut state.ray else { return false };
        let (mut count, mut steps, mut end) = (0, 0, None);
        for event in ray.rest() {
            let step = event.step();
            // Asked for together: inserted vertices with the children's bound data, and the lines of a leaf.
            let joins = matches!(step, Step::Bounds { .. } | Step::Leaf { .. });
            let asks = step.lines().filter(|_| !is_pinned(step, self.pinned_nodes));
            if count > 0 && (!joins || count + asks.map_or(0, |(.., lines)| lines as usize) > MOST_LINES) {
                break;
            }
            self.work.step(step);
            steps += 1;
            if let Some((kind, first, lines)) = asks {
                for line in first..first + lines {
                    state.lines[count] = (line, kind);
                    count += 1;
                }
            }
            if let Step::End { found } = step {
                end = Some(found);
                break;
            }
        }
        ray.skip(steps);
        if let Some(found) = end {
            let counts = memory.counts_mut();
            counts.rays += 1;
            counts.hits += u64::from(found);
            self.under_way -= 1;
            return false;
        }
        (state.count, state.sent, state.come) = (count as u8, 0, 0);
        (state.since, state.from) = (memory.now(), Source::L1);
        let port = context / self.rays_in_flight;
        let state = &mut self.ports[port as usize];
        state.ready.push_back(context);
        if !state.awake {
            if state.free <= memory.now() {
                self.ask(port, memory);
            } else {
                state.awake = true;
                memory.wake_at(state.free, port);
            }
        }
        true
    }

    /// The port asks for a line.
    #[inline]
    fn ask(&mut self, port: u32, memory: &mut Hierarchy) {
        let state = &mut self.ports[port as usize];
        state.awake = false;
        let Some(&context) = state.ready.front() else { return };
        let asking = &mut self.contexts[context as usize];
        let (line, kind) = asking.lines[asking.sent as usize];
        asking.sent += 1;
        if asking.sent == asking.count {
            state.ready.pop_front();
        }
        state.free = memory.now() + 1;
        if !memory.request(port / self.per_group, port, context, line, kind) {
            state.awake = true;
        } else if !state.ready.is_empty() {
            state.awake = true;
            memory.wake_at(state.free, port);
        }
    }
}

/// Whether a step's node is one of the first `nodes`; the nodes are a memory's first lines.
#[inline(always)]
fn is_pinned(step: Step, nodes: u32) -> bool {
    matches!(step, Step::Node { line, wide, .. } if line >> (1 + u32::from(wide)) < nodes)
}

impl<S: feed::Source> FrontEnd for FreeCores<S> {
    fn start(&mut self, memory: &mut Hierarchy) {
        for context in 0..self.contexts.len() as u32 {
            self.next_ray(context);
            self.go_on(context, memory);
        }
    }

    fn wake(&mut self, port: u32, memory: &mut Hierarchy) {
        self.ask(port, memory);
    }

    #[inline]
    fn answer(&mut self, context: u32, from: Source, memory: &mut Hierarchy) {
        let state = &mut self.contexts[context as usize];
        state.come += 1;
        state.from = state.from.max(from);
        if state.come == state.count {
            let waited = memory.now() - state.since;
            memory.counts_mut().waits.add(state.from, waited);
            self.go_on(context, memory);
        }
    }

    fn is_busy(&self) -> bool {
        self.under_way > 0
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
