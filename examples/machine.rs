//! A machine of one's own: the paper's with less L1, against its own. `cargo run --release --example machine`.

use lodray::format::Scene;
use lodray::machine::Machine;
use lodray::mesh::procedural::{self, Options};
use lodray::rays::{Camera, ModelSpace, View};
use lodray::run::Compute;
use lodray::scene::PassRays;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::generate(&Options { levels: Some(4), ..Options::new(procedural::Scene::Terrain) })?;
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &ModelSpace::of(&scene), 256, 256)?;
    let method = scene.method("lod")?;
    let paper = Machine::shipped("haydel2023")?;
    let mut small = paper.clone();
    small.set("l1.bytes", "8192")?;
    for (name, machine) in [("16 KB of L1", paper), ("8 KB of L1", small)] {
        let result = method.simulate(PassRays::Camera(camera), &machine, name, Compute::Units)?;
        println!(
            "{name}: {} cycles, {:.1} uJ, {} of {} requests found in the L1s",
            result.cycles, result.energy.total, result.l1.hits, result.l1.requests
        );
    }
    Ok(())
}
