//! Statistics of one's own, from the steps that a traversal states: how many entries of their stacks rays drop, method by method. `cargo run --release --example statistics`.

use lodray::format::Scene;
use lodray::mesh::procedural::{self, Options};
use lodray::method::METHODS;
use lodray::rays::{Camera, ModelSpace, Sight, View};
use lodray::step::{Act, Step, StepSink};
use std::error::Error;

/// What rays did.
#[derive(Default)]
struct Runs {
    steps: u64,
    lines: u64,
    pops: u64,
    dropped: u64,
}

impl StepSink for Runs {
    fn step(&mut self, step: Step) {
        self.steps += 1;
        self.lines += step.fetch.map_or(0, |fetch| u64::from(fetch.lines));
        if let Act::Pop { dropped } = step.act {
            self.pops += 1;
            self.dropped += u64::from(dropped);
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::generate(&Options { levels: Some(4), ..Options::new(procedural::Scene::Terrain) })?;
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &space, 64, 64)?;
    let sight = Sight::new(&camera, &space, 1.0);
    for registered in METHODS.iter().filter(|method| !method.of_input()) {
        let method = scene.method(registered.name)?;
        let mut tracer = method.method().tracer(&sight);
        let mut runs = Runs::default();
        for (x, y) in (0..camera.height).flat_map(|y| (0..camera.width).map(move |x| (x, y))) {
            tracer.heard(&camera.ray(x, y), &mut runs);
        }
        let Runs { steps, lines, pops, dropped } = runs;
        println!(
            "{:<10} {steps:>8} steps, {lines:>8} lines, {pops:>7} entries taken from stacks, {dropped:>7} of them dropped",
            registered.name
        );
    }
    Ok(())
}
