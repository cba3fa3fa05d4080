//! The RTL of the unit behind the ports of the model.

use lodray::hardware::Hardware;
use lodray::hardware::ports::{
    ContextView, Corners, HitOut, MemoryAnswer, MemoryRequest, MemoryTest, RayIn, SceneConfig, SecondaryIn, UnitCounters,
};
use lodray::num::{U, Wire};
use lodray::sim::unit::environment::UnitPort;
use lodray::sim::unit::{Inputs, Outputs};
use std::sync::Arc;
use tb::{Build, Direction, Model, PortId, Sim};

/// Cycles of reset.
pub const RESET: u64 = 2;

/// The RTL of this hardware; `cargo test` compiles each once. That of the default's sizes takes contexts as a parameter, and the default none.
fn model(config: Hardware) -> Arc<Model> {
    let sizes = Hardware { contexts: Hardware::DEFAULT.contexts, ..config };
    let build = Build::rtl("traversal_unit");
    let build = if config == Hardware::default() {
        build
    } else if sizes == Hardware::default() {
        build.parameter("CONTEXTS", config.contexts)
    } else {
        build.hardware(&config).unwrap_or_else(|error| panic!("{error}"))
    };
    // The waveform's test needs units of one context too.
    let traced = Hardware { secondary: config.secondary, ..Hardware::one_context() };
    let build = if config == traced { build.trace() } else { build };
    let build = if is_bare(config) { build } else { build.parameter("WATCH", 1).parameter("MEMORY_PARITY", 1).parameter("CLOCK_GATES", 1) };
    build.model().unwrap_or_else(|error| panic!("{error}"))
}

/// A unit without counters, parity and clock gates: the default, whose netlist runs too, and those of one context. All others have them, and must behave as these do.
fn is_bare(config: Hardware) -> bool {
    config == Hardware::default() || config.contexts == 1
}

/// What a unit shows besides, with `WATCH`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Watched {
    /// Of the context that is looked at.
    pub view: ContextView,
    pub counters: UnitCounters,
}

/// The RTL's ports.
pub struct Rtl {
    pub sim: Sim,
    reset: PortId,
    flush: PortId,
    busy: PortId,
    ready: PortId,
    hit: (PortId, PortId),
    mem: (PortId, PortId),
    ray_in: (PortId, PortId),
    secondary: PortId,
    corners: PortId,
    hit_ready: PortId,
    mem_ready: PortId,
    answer: (PortId, PortId),
    memory_test: PortId,
    fault: PortId,
    view_context: PortId,
    view: PortId,
    clear: PortId,
    counters: PortId,
    bare: bool,
}

impl Rtl {
    /// A simulation behind its reset.
    pub fn new(config: Hardware, scene: &SceneConfig, seed: u64) -> Self {
        let mut sim = Sim::new(&model(config), seed);
        let port = |sim: &Sim, name, width, direction| sim.port(name, width, direction).unwrap_or_else(|error| panic!("{error}"));
        let input = |sim: &Sim, name, width| port(sim, name, width, Direction::In);
        let output = |sim: &Sim, name, width| port(sim, name, width, Direction::Out);
        let mut rtl = Self {
            reset: input(&sim, "rst_ni", 1),
            flush: input(&sim, "flush_i", 1),
            busy: output(&sim, "busy_o", 1),
            ready: output(&sim, "ready_o", 1),
            hit: (output(&sim, "valid_o", 1), output(&sim, "out_o", HitOut::WIDTH)),
            mem: (output(&sim, "mem_valid_o", 1), output(&sim, "mem_o", MemoryRequest::WIDTH)),
            ray_in: (input(&sim, "valid_i", 1), input(&sim, "in_i", RayIn::WIDTH)),
            secondary: input(&sim, "secondary_i", SecondaryIn::WIDTH),
            corners: output(&sim, "corners_o", Corners::WIDTH),
            hit_ready: input(&sim, "ready_i", 1),
            mem_ready: input(&sim, "mem_ready_i", 1),
            answer: (input(&sim, "mem_valid_i", 1), input(&sim, "mem_i", MemoryAnswer::WIDTH)),
            memory_test: input(&sim, "memory_test_i", MemoryTest::WIDTH),
            fault: output(&sim, "memory_fault_o", 1),
            view_context: input(&sim, "view_context_i", 6),
            view: output(&sim, "view_o", ContextView::WIDTH),
            clear: input(&sim, "counters_clear_i", 1),
            counters: output(&sim, "counters_o", UnitCounters::WIDTH),
            bare: is_bare(config),
            sim: {
                let (reset, scene_i) = (input(&sim, "rst_ni", 1), input(&sim, "scene_i", SceneConfig::WIDTH));
                sim.poke(scene_i, scene);
                sim.poke(reset, &false);
                (0..RESET).for_each(|_| sim.clock());
                sim.poke(reset, &true);
                sim
            },
        };
        rtl.sim.poke(rtl.clear, &false);
        rtl.memory_parity(true);
        rtl.sim.eval();
        rtl
    }

    /// What it shows of this context, and its counters; a bare one shows nothing.
    pub fn watched(&mut self, context: usize) -> Option<Watched> {
        self.sim.poke(self.view_context, &U::<6>::new(context as u64));
        self.sim.eval();
        let watched = Watched { view: self.sim.peek(self.view), counters: self.sim.peek(self.counters) };
        if self.bare {
            assert_eq!(watched, Watched { view: ContextView::default(), counters: UnitCounters::default() });
            return None;
        }
        Some(watched)
    }

    /// Whether memories write the right parity from now on.
    pub fn memory_parity(&mut self, right: bool) {
        self.sim.poke(self.memory_test, &MemoryTest { flip: !right, ..MemoryTest::default() });
    }

    /// `memory_fault_o`.
    pub fn memory_fault(&mut self) -> bool {
        self.sim.peek(self.fault)
    }

    /// `counters_clear_i` in the next cycle, and whether it stands.
    pub fn clear_counters(&mut self, clears: bool) {
        self.sim.poke(self.clear, &clears);
    }

    /// A cycle of reset.
    pub fn reset(&mut self) {
        self.sim.poke(self.reset, &false);
        self.sim.clock();
        self.sim.poke(self.reset, &true);
        self.sim.eval();
    }

    /// Another scene from now on.
    pub fn scene(&mut self, scene: &SceneConfig) {
        let port = self.sim.port("scene_i", SceneConfig::WIDTH, Direction::In).unwrap_or_else(|error| panic!("{error}"));
        self.sim.poke(port, scene);
    }
}

impl UnitPort for Rtl {
    fn outputs(&mut self) -> Outputs {
        // All of them come from registers, so they stand before the inputs of this cycle.
        let hit = if self.sim.peek(self.hit.0) { Some(self.sim.peek(self.hit.1)) } else { None };
        let mem = if self.sim.peek(self.mem.0) { Some(self.sim.peek(self.mem.1)) } else { None };
        // Beside no hit they are any.
        let corners = if hit.is_some() { self.sim.peek(self.corners) } else { Corners::default() };
        Outputs { ready: self.sim.peek(self.ready), hit, corners, mem, busy: self.sim.peek(self.busy) }
    }

    fn tick(&mut self, inputs: &Inputs) {
        self.sim.poke(self.flush, &inputs.flush);
        self.sim.poke(self.ray_in.0, &inputs.ray.is_some());
        self.sim.poke(self.ray_in.1, &inputs.ray.unwrap_or_default());
        self.sim.poke(self.secondary, &inputs.secondary);
        self.sim.poke(self.hit_ready, &inputs.hit_ready);
        self.sim.poke(self.mem_ready, &inputs.mem_ready);
        self.sim.poke(self.answer.0, &inputs.answer.is_some());
        self.sim.poke(self.answer.1, &inputs.answer.unwrap_or_default());
        self.sim.clock();
    }

    fn describe(&mut self) -> String {
        "(the RTL)".to_owned()
    }
}
