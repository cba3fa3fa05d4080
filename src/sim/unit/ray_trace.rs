//! One ray as text: what the unit does with it, step by step, from the cycle model.

use super::environment::UnitPort;
use super::{Inputs, Outputs, SceneMemory, TraversalUnit};
use crate::block::{lod_test, start_test};
use crate::hardware::State;
use crate::hardware::ports::HitOut;
use crate::method::{Entry, Op, is_beyond};
use crate::num::{LineAddress, U};
use std::fmt;

/// One thing that happened.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraceEvent {
    /// An entry is visited.
    Visit(Entry),
    /// A memory line was asked for: its address, what it holds, and its number within its section.
    Line(LineAddress, &'static str, u64),
    /// The LOD test of a node: level, node, edge states, and whether it goes down.
    Edges {
        /// Level.
        level: u64,
        /// Node on it.
        node: u64,
        /// Edge states, 256 = 1.
        s: [u64; 3],
        /// Goes down.
        refine: bool,
    },
    /// A child that is met, by its place in the order: the first is visited at once, the others wait on the stack.
    Child {
        /// Its place, 0 the nearest.
        place: usize,
        /// How many are met.
        of: usize,
        /// The child.
        entry: Entry,
    },
    /// No child is met.
    NoChild,
    /// A triangle was tested: level, node, and whether it was met.
    Triangle {
        /// Level.
        level: u64,
        /// Node on it.
        node: u64,
        /// The ray meets it.
        met: bool,
    },
    /// A triangle met was compared: its t, and whether it is the closest now.
    Compared {
        /// t in steps of 2^-32 of the direction.
        t: u64,
        /// The closest now.
        closer: bool,
    },
    /// An entry was taken from the stack, and dropped if its box lies behind the closest hit.
    Popped {
        /// The entry.
        entry: Entry,
        /// Not visited.
        dropped: bool,
    },
    /// The result.
    Hit(HitOut),
}

/// The name of what an entry stands for.
struct Named(Entry);

impl fmt::Display for Named {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Entry { kind, level, index, .. } = self.0;
        match kind.get() {
            Entry::BVH_NODE => write!(f, "quad-BVH node {index}"),
            Entry::TREE => write!(f, "tree {index}"),
            _ => write!(f, "level {level} node {index}"),
        }
    }
}

impl fmt::Display for TraceEvent {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Visit(entry) => write!(f, "visit {}", Named(*entry)),
            Self::Line(address, section, line) => write!(f, "  read line {:#x} ({section} {line})", address.get()),
            Self::Edges { level, node, s: [s0, s1, s2], refine } => {
                let decision = if *refine { "refine" } else { "serves" };
                write!(f, "  level {level} node {node}: edge states {s0} {s1} {s2} of 256: {decision}")
            }
            Self::Child { place, of, entry } => {
                let then = if *place == 0 { "next" } else { "pushed" };
                write!(f, "  child {} of {of}: {} from {}: {then}", place + 1, Named(*entry), entry.t_near)
            }
            Self::NoChild => write!(f, "  no child is met"),
            Self::Triangle { level, node, met } => {
                write!(f, "  triangle level {level} node {node}: {}", if *met { "met" } else { "missed" })
            }
            Self::Compared { t, closer } => write!(f, "  t {t}: {}", if *closer { "closest" } else { "not closer" }),
            Self::Popped { entry, dropped: true } => write!(f, "pop {}: dropped, behind the closest hit", Named(*entry)),
            Self::Popped { entry, dropped: false } => write!(f, "pop {}", Named(*entry)),
            Self::Hit(hit @ HitOut { found: false, .. }) => match hit.error() {
                Some(error) => write!(f, "ends early: {error}"),
                None => write!(f, "miss"),
            },
            Self::Hit(HitOut { hit: h, .. }) => {
                let side = if h.front { "front" } else { "back" };
                write!(
                    f,
                    "hit: t {}, {side} of tree {} level {} node {} at {} {} {}; full resolution: node {} at {} {} {}",
                    h.t, h.tree, h.level, h.node, h.b0, h.b1, h.b2, h.full_node, h.full_b0, h.full_b1, h.full_b2
                )
            }
        }
    }
}

/// A unit of one context that writes down what it does.
pub struct RayTrace<'a> {
    unit: TraversalUnit,
    memory: &'a SceneMemory<'a>,
    cycle: u64,
    events: Vec<(u64, TraceEvent)>,
}

impl<'a> RayTrace<'a> {
    /// Watches `unit`, which has one context, at `memory`.
    pub fn new(unit: TraversalUnit, memory: &'a SceneMemory<'a>) -> Self {
        Self { unit, memory, cycle: 0, events: Vec::new() }
    }

    /// What happened, with the cycle at whose end it did.
    pub fn events(&self) -> &[(u64, TraceEvent)] {
        &self.events
    }

    fn note(&mut self, event: TraceEvent) {
        self.events.push((self.cycle, event));
    }

    /// What is decided in this cycle, before its end.
    fn before(&mut self, inputs: &Inputs) {
        let outputs = self.unit.outputs();
        if let Some(request) = outputs.mem.filter(|_| inputs.mem_ready)
            && let Some((section, line)) = self.memory.locate(request.address)
        {
            self.note(TraceEvent::Line(request.address, self.memory.name(section), line));
        }
        let context = &self.unit.contexts[0];
        let (state, entry) = (context.state, context.entry.get());
        let [level, node] = [context.level.get().get(), context.node.get().get()];
        let popped = context.stack.clone().step(Op::Pop);
        let triangle = |(start_test::Out { test, .. }, tag): (start_test::Out, u16)| {
            let [_, level, node] = context.triangle_id(tag & 3);
            TraceEvent::Triangle { level, node, met: test.hit }
        };
        let triangle = self.unit.tri_test.offered().map(triangle);
        let compared =
            self.unit.hit_select.offered().map(|(out, _)| TraceEvent::Compared { t: self.unit.chosen.get().1.get(), closer: out.closer });
        let edges =
            |(out, _): (lod_test::Out, u16)| TraceEvent::Edges { level, node, s: [out.s0, out.s1, out.s2].map(U::get), refine: out.refine };
        let edges = self.unit.lod_test.offered().map(edges);
        let dropped = |entry: Entry| is_beyond(entry.t_near, context.closest.t_max.get());
        let step = match state {
            State::Visit => Some(TraceEvent::Visit(entry)),
            State::Pop => popped.map(|entry| TraceEvent::Popped { entry, dropped: dropped(entry) }),
            _ => None,
        };
        for event in [step, edges, triangle, compared, outputs.hit.filter(|_| inputs.hit_ready).map(TraceEvent::Hit)].into_iter().flatten()
        {
            self.note(event);
        }
    }

    /// The children that were just sorted.
    fn children(&mut self) {
        let context = &self.unit.contexts[0];
        let of = context.count.get().get() as usize; // three bits
        let children: Vec<TraceEvent> = (0..of).map(|place| TraceEvent::Child { place, of, entry: context.child_entry(place) }).collect();
        if of == 0 {
            self.note(TraceEvent::NoChild);
        }
        children.into_iter().for_each(|event| self.note(event));
    }
}

impl UnitPort for RayTrace<'_> {
    fn outputs(&mut self) -> Outputs {
        self.unit.outputs()
    }

    fn tick(&mut self, inputs: &Inputs) {
        self.before(inputs);
        let state = self.unit.contexts[0].state;
        self.unit.tick(inputs);
        if (state, self.unit.contexts[0].state) == (State::ChildWait, State::Push) {
            self.children();
        }
        self.cycle += 1;
    }

    fn describe(&mut self) -> String {
        self.unit.describe()
    }
}
