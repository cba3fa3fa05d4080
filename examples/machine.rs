//! A machine of one's own: the paper's with less L1, against its own. `cargo run --release --example machine`.

use lodray::bvh::over_trees;
use lodray::format::{self, SceneInfo};
use lodray::machine::Machine;
use lodray::mesh::procedural::{self, Options};
use lodray::method::bvh::NoStore;
use lodray::method::{Knobs, lod};
use lodray::rays::{Camera, ModelSpace, Sight, View};
use lodray::run::{Compute, FrameRays, Job, check, simulate};
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let surface = procedural::generate(&Options { levels: Some(4), ..Options::new(procedural::Scene::Terrain) })?;
    let scene = format::build(&surface, SceneInfo::default(), over_trees)?;
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View { distance: Some(2.0), ..View::default() }, &space, 256, 256)?;
    let method = (lod::METHOD.make)(&scene, &Knobs::default(), &NoStore)?;
    let sight = Sight::new(&camera, &space, 1.0);
    let frame = FrameRays { method: &*method, rays: &camera, sight: &sight };

    let paper = Machine::shipped("haydel2023")?;
    let mut small = paper.clone();
    small.set("l1.bytes", "8192")?;
    let machines = [("16 KB of L1", paper), ("8 KB of L1", small)];
    let job = |machine: &Machine| Job { machine: machine.clone(), compute: Compute::Units, window: None };
    for (_, machine) in &machines {
        check(machine, Compute::Units)?;
    }
    let jobs = machines.each_ref().map(|(_, machine)| job(machine));
    for ((name, _), run) in machines.iter().zip(simulate(&frame, &jobs, &mut |_| ())) {
        let run = run?;
        println!("{name}: {} cycles, {} of {} requests found in the L1s", run.cycles, run.counts.l1.hits, run.counts.l1.requests);
    }
    Ok(())
}
