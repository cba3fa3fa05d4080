//! `simulate`: a frame on one or more machines.

mod files;
pub(super) mod plots;
mod table;
mod units;

use super::args::{CameraArgs, Change, LeafArgs, SimMethod, delta};
use super::cache::{Cache, CacheArgs};
use super::output::{check_target, folder, open, print_json, print_line};
use super::pass::{Pass, Target, machine};
use super::render::Built;
use anyhow::Context;
use files::Files;
use lodray::format::write_and_rename;
use lodray::report::result::{Compute, SimResult};
use lodray::sim::replay::Window;
use lodray::traverse::ModelSpace;
use std::path::PathBuf;
use std::process::ExitCode;

pub use table::amount;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// How rays find their hits
    #[arg(long, value_enum, default_value_t = SimMethod::Lod)]
    method: SimMethod,
    /// Machine: the name of one that comes with the program, or a file; several, repeated or with commas, share the tracing
    #[arg(long, value_name = "NAME|FILE", value_delimiter = ',', default_value = "haydel2023")]
    machine: Vec<String>,
    /// Change a value of the machines, such as l1.bytes=32768; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<Change>,
    /// How compute is simulated
    #[arg(long, value_enum, default_value_t = Compute::Free)]
    compute: Compute,
    /// Quality of the LOD method: 1 keeps a level's displacement under a pixel, 0 is the base mesh, inf full detail
    #[arg(long, default_value = "1", value_parser = delta, allow_hyphen_values = true)]
    delta: f64,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    leaves: LeafArgs,
    #[command(flatten)]
    cache: CacheArgs,
    /// Folder for the figures as JSON, what happened over time as CSV, and plots as SVG
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// File for a waveform (VCD) of the machine: queues, misses under way and cache events; needs --window
    #[arg(long, value_name = "FILE", requires = "window")]
    vcd: Option<PathBuf>,
    /// Cycles of the waveform, first and last
    #[arg(long, value_name = "FROM:TO", requires = "vcd", value_parser = window)]
    window: Option<Window>,
    /// Print the figures as JSON; of several machines as an array
    #[arg(long)]
    json: bool,
}

/// A stretch of cycles.
fn window(s: &str) -> Result<Window, String> {
    let ends = s.split_once(':').and_then(|(from, to)| Some((from.parse().ok()?, to.parse().ok()?)));
    match ends {
        Some((from, to)) if from <= to => Ok(Window { from, to }),
        _ => Err(format!("'{s}' is not a stretch of cycles such as 1000:2000")),
    }
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let machines = args.machine.iter().map(|name| machine(name, &args.set)).collect::<anyhow::Result<Vec<_>>>()?;
    for (k, machine) in machines.iter().enumerate() {
        anyhow::ensure!(machines[..k].iter().all(|before| before.label != machine.label), "--machine: {} is given twice", machine.label);
    }
    if let Some(vcd) = &args.vcd {
        anyhow::ensure!(machines.len() == 1, "--vcd: takes one machine, not {}", machines.len());
        check_target(vcd, Some(&args.scene))?;
    }
    let scene = open(&args.scene)?;
    let space = ModelSpace::of(&scene);
    let camera = args.camera.camera(&space, None)?;
    let labels: Vec<_> = machines.iter().map(|machine| machine.label.as_str()).collect();
    let files = args.out.as_ref().map(|folder| Files::new(folder, &labels));
    if let Some(files) = &files {
        folder(files.folder(), files.names().iter().map(String::as_str), Some(&args.scene))?;
    }

    let built = Built::new(args.method.into(), &scene, args.leaves, &Cache::new(&args.cache)?)?;
    let pass = Pass {
        scene: &scene,
        space: &space,
        method: args.method,
        built: &built,
        leaves: args.leaves,
        camera,
        distance: args.camera.radii(),
        delta: args.delta,
    };
    let targets: Vec<_> = machines.into_iter().map(|machine| Target { machine, compute: args.compute, window: args.window }).collect();
    let outcomes = pass.run(&targets)?.into_iter().collect::<anyhow::Result<Vec<_>>>()?;
    let (results, mut waves): (Vec<SimResult>, Vec<_>) = outcomes.into_iter().unzip();
    if let (Some(vcd), Some(wave)) = (&args.vcd, waves.pop().flatten()) {
        write_and_rename(vcd, |out| out.write_all(&wave)).with_context(|| format!("cannot write {}", vcd.display()))?;
    }

    if let Some(files) = &files {
        files.write(&results)?;
    }
    match (args.json, results.as_slice()) {
        (true, [one]) => print_json(one)?,
        (true, several) => print_json(&several)?,
        (false, several) => {
            print_line(&several.iter().map(table::table).collect::<Vec<_>>().join("\n\n"))?;
            if let Some(files) = &files {
                print_line(&format!("\nfigures and plots in {}", files.folder().display()))?;
            }
        }
    }
    Ok(ExitCode::SUCCESS)
}
