//! The RTL of the unit behind the ports of the model.

use lodray::hardware::Hardware;
use lodray::hardware::ports::{Corners, HitOut, MemoryAnswer, MemoryRequest, RayIn, SceneConfig, SecondaryIn};
use lodray::num::Wire;
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
    build.model().unwrap_or_else(|error| panic!("{error}"))
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
            sim: {
                let (reset, scene_i) = (input(&sim, "rst_ni", 1), input(&sim, "scene_i", SceneConfig::WIDTH));
                sim.poke(scene_i, scene);
                sim.poke(reset, &false);
                (0..RESET).for_each(|_| sim.clock());
                sim.poke(reset, &true);
                sim
            },
        };
        rtl.sim.eval();
        rtl
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
