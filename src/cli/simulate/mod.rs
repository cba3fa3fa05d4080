//! `simulate`: a frame, or several after one another, on one or more machines.

mod ease;
mod files;
pub(super) mod plots;
mod several;
mod table;
mod units;

use super::aim::AimArgs;
use super::args::{CameraArgs, Change};
use super::cache::CacheArgs;
use super::common::is_quiet;
use super::folder::{Overrule, RunFolder, one_run};
use super::frames::FrameArgs;
use super::input::{InputArgs, with_input};
use super::machines::{machine, machine_files};
use super::made;
use super::method::MachineMethod;
use super::names::named;
use super::output::{check_target, explain, open_any, print_json, print_table, remark, warn, write_file};
use super::plan;
use super::report::PageArgs;
use crate::cli::bars::Bars;
use anyhow::Context;
use files::Files;
use lodray::method::packet::takes_packets;
use lodray::paths::SceneFile;
use lodray::plan::Plan;
use lodray::rays::{MOST_IN_TURN, ModelSpace, RayFile, may_be_in_turn};
use lodray::report::page::{Documents, Simulation};
use lodray::report::result::SimResult;
use lodray::run::{self, Compute};
use lodray::scene::{Outcome, Pass, PassRays, Target};
use lodray::sim::replay::Window;
use lodray::study::{grouped, in_machine, pruned};
use several::Several;
use std::path::PathBuf;
use std::process::ExitCode;

pub use table::amount;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file, or the description of several models (TOML; `paths --help` has the keys): a ray for each pixel of its camera, through all of them
    scene: PathBuf,
    #[command(flatten)]
    method: MachineMethod,
    /// Machine: the name of a built-in one, or a file; several with commas
    #[arg(long, value_name = "NAME|FILE", value_delimiter = ',', default_value = "haydel2023")]
    machine: Vec<String>,
    /// Change a value of the machines, such as l1.bytes=32768; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<Change>,
    /// Simulate the traversal units of this plan (from lodray plan -o); the scene and its rays must fit it
    #[arg(long, value_name = "PLAN", conflicts_with = "rays")]
    plan: Option<PathBuf>,
    /// How compute is simulated
    #[arg(long, value_parser = named::<Compute>(), default_value = Compute::Free.name())]
    compute: Compute,
    /// Also simulate the frame without each thing that rays wait for in units: blocks that are not free, latency, lines of splits; needs --compute units
    #[arg(long, conflicts_with = "vcd")]
    ease: bool,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    aim: AimArgs,
    #[command(flatten)]
    frames: FrameArgs,
    /// File of rays in place of a camera's (.npy); `cast --help` has the columns. Each starts at its own origin; one that names an earlier ray waits for that
    #[arg(long, value_name = "FILE", conflicts_with_all = CameraArgs::ids().into_iter().chain(FrameArgs::ids()).chain(AimArgs::camera_ids()))]
    rays: Option<PathBuf>,
    /// Tiles of 8 x 8 pixels that lie far apart and whose rays are handed out in turn, a power of two up to 64: a unit then has rays of sky and of surface at a time (default 1: tile by tile)
    #[arg(long, value_name = "N", default_value_t = 1, hide_default_value = true, value_parser = in_turn, allow_hyphen_values = true, conflicts_with = "rays")]
    tiles_in_turn: u32,
    #[command(flatten)]
    cache: CacheArgs,
    #[command(flatten)]
    input: InputArgs,
    /// Folder for the figures as JSON, what happened over time as CSV, and plots as SVG
    #[arg(short, long, long_help = one_run("Folder for the figures as JSON, what happened over time as CSV, and plots as SVG"))]
    out: Option<PathBuf>,
    #[command(flatten)]
    overrule: Overrule,
    /// File for a waveform (VCD) of the machine: queues, misses under way and cache events; needs --window
    #[arg(long, value_name = "FILE", requires = "window", conflicts_with_all = FrameArgs::ids())]
    vcd: Option<PathBuf>,
    /// First and last cycle of the waveform, counted from 0
    #[arg(long, value_name = "FROM:TO", requires = "vcd", value_parser = window)]
    window: Option<Window>,
    #[command(flatten)]
    page: PageArgs,
    /// Print the figures as JSON; of several machines as an array
    #[arg(long)]
    json: bool,
}

/// A number of tiles.
fn in_turn(s: &str) -> Result<u32, String> {
    s.parse().ok().filter(|&tiles| may_be_in_turn(tiles)).ok_or_else(|| format!("must be a power of two from 1 to {MOST_IN_TURN}"))
}

/// A stretch of cycles.
fn window(s: &str) -> Result<Window, String> {
    let ends = s.split_once(':').and_then(|(from, to)| Some((from.parse().ok()?, to.parse().ok()?)));
    match ends {
        Some((from, to)) if from <= to => Ok(Window { from, to }),
        _ => Err(format!("'{s}' is not a stretch of cycles such as 1000:2000: two whole numbers, the first not above the second")),
    }
}

/// Refuses a window that begins after the frame's last cycle, and says if it ends there, unless nobody wants remarks.
fn check_window(window: Window, last: u64) -> anyhow::Result<()> {
    let Window { from, to } = window;
    let last_shown = grouped(last);
    anyhow::ensure!(from <= last, "--window {from}:{to}: begins beyond the frame's end; its cycles are 0 to {last_shown}");
    if to > last && !is_quiet() {
        warn(&format!("note: --window {from}:{to} ends beyond the frame's end; the waveform has cycles {from} to {last_shown}"));
    }
    Ok(())
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let read = |name: &String| machine(name, &args.set, "--set").with_context(|| format!("--machine {name}"));
    anyhow::ensure!(!args.ease || args.compute == Compute::Units, "--ease: eases parts of traversal units, which --compute units has");
    anyhow::ensure!(args.tiles_in_turn == 1 || !takes_packets(&args.method.0.knobs), "--tiles-in-turn: packets take the rays of one tile");
    let mut machines = args.machine.iter().map(read).collect::<anyhow::Result<Vec<_>>>()?;
    let plan = args.plan.as_deref().map(plan::read).transpose()?;
    if let (Some(plan), Some(path)) = (&plan, &args.plan) {
        machines.iter_mut().for_each(|machine| in_machine(plan, &path.display().to_string(), machine));
    }
    for (k, machine) in machines.iter().enumerate() {
        run::check(&machine.description, args.compute).with_context(|| format!("--machine {}", args.machine[k]))?;
        anyhow::ensure!(!args.ease || machine.description.units.eased.is_none(), "--ease: {} has eased parts already", machine.label);
        anyhow::ensure!(machines[..k].iter().all(|before| before.label != machine.label), "--machine: {} is given twice", machine.label);
    }
    let read =
        args.machine.iter().zip(&machines).map(|(name, machine)| machine_files(name, machine)).collect::<Result<Vec<_>, _>>()?.concat();
    let description = made::is_description(&args.scene).then(|| made::description(&args.scene)).transpose()?;
    let models = description.as_ref().map(|file| made::model_files(&args.scene, file)).transpose()?.unwrap_or_default();
    let inputs: Vec<_> = std::iter::once(&args.scene)
        .chain(&models)
        .chain(&args.rays)
        .chain(args.frames.input())
        .chain(&args.input.mesh)
        .chain(&args.plan)
        .chain(&read)
        .map(PathBuf::as_path)
        .collect();
    if let Some(vcd) = &args.vcd {
        anyhow::ensure!(machines.len() == 1, "--vcd: takes one machine, not {}", machines.len());
        check_target(vcd, &inputs)?;
    }
    args.page.check(&inputs)?;
    let labels: Vec<_> = machines.iter().map(|machine| machine.label.as_str()).collect();
    let files = Files::new(&labels);
    let names = files.names();
    let open_folder = |out: &PathBuf| {
        let folder = RunFolder::open(out, names.iter().map(String::as_str), &inputs, &args.overrule)?;
        folder.spares(args.page.file())?;
        anyhow::Ok(folder)
    };
    let open = || args.out.as_ref().map(open_folder).transpose();
    let mut targets: Vec<_> = machines.into_iter().map(|machine| Target { machine, compute: args.compute, window: args.window }).collect();
    if args.ease {
        targets = ease::targets(&targets);
    }
    let (folder, outcomes) = match description {
        Some(file) => several(args, file, &targets, open)?,
        None => one(args, plan.as_ref(), &targets, open)?,
    };
    let outcomes = if args.ease { ease::joined(outcomes) } else { outcomes };
    let outcomes = outcomes.into_iter().collect::<Result<Vec<_>, _>>()?;
    let (results, mut waves): (Vec<SimResult>, Vec<_>) = outcomes.into_iter().unzip();
    if let (Some(window), Some(result)) = (&args.window, results.first()) {
        check_window(*window, result.cycles.saturating_sub(1))?;
    }
    if let (Some(vcd), Some(wave)) = (&args.vcd, waves.pop().flatten()) {
        write_file(vcd, &wave)?;
    }

    let mut notes = Vec::new();
    if let Some(mut folder) = folder {
        notes = files.write(folder.staging(), &results)?;
        notes.iter().for_each(|note| folder.note(note.clone()));
        folder.finish()?;
    }
    let simulation = |result: &SimResult| Simulation { scene: None, result: result.clone(), image: None };
    let page = Documents { simulations: results.iter().map(simulation).collect(), ..Documents::default() };
    match (args.json, results.as_slice()) {
        (true, [one]) => print_json(one)?,
        (true, several) => print_json(&several)?,
        (false, several) => {
            print_table(&several.iter().map(table::table).collect::<Vec<_>>().join("\n\n"))?;
            explain("simulate")?;
            if let Some(out) = &args.out {
                remark(&format!("figures and plots in {}", out.display()))?;
                notes.iter().try_for_each(|note| remark(note))?;
            }
        }
    }
    args.page.write(page, &inputs)?;
    Ok(ExitCode::SUCCESS)
}

/// Simulates a frame of one scene.
fn one(
    args: &Args,
    plan: Option<&Plan>,
    targets: &[Target],
    open: impl FnOnce() -> anyhow::Result<Option<RunFolder>>,
) -> anyhow::Result<(Option<RunFolder>, Vec<Outcome>)> {
    args.aim.check()?;
    let chosen = &args.method.0;
    let scene = with_input(open_any(&args.scene)?, &args.scene, &args.input, [chosen])?;
    let space = ModelSpace::of(&scene);
    let rays = match &args.rays {
        Some(path) => PassRays::File(RayFile::read(path)?, path.clone()),
        None => args.frames.rays(&args.camera, &space)?.in_turn(args.tiles_in_turn),
    };
    let folder = open()?;
    match &rays {
        PassRays::File(rays, _) => pruned::check_rays(&scene, rays, chosen.delta())?,
        cameras => cameras.cameras().iter().try_for_each(|camera| pruned::check(&scene, camera, chosen.delta()))?,
    }
    if let Some(plan) = plan {
        anyhow::ensure!(chosen.method.name == "lod", "--plan: is of units for lod, not for {}", chosen.method.name);
        plan::check(plan, &args.scene, &scene, rays.source(), chosen.delta())?;
    }
    let (method, _) = chosen.make(&scene, &args.cache.cache(args.out.as_deref())?, &Bars)?;
    let pass = Pass { scene: &scene, space: &space, registered: chosen.method, knobs: &chosen.knobs, method: &*method, rays };
    let outcomes = lodray::study::simulate(&pass, targets, &Bars);
    Ok((folder, outcomes))
}

/// Simulates a frame of several models.
fn several(
    args: &Args,
    file: SceneFile,
    targets: &[Target],
    open: impl FnOnce() -> anyhow::Result<Option<RunFolder>>,
) -> anyhow::Result<(Option<RunFolder>, Vec<Outcome>)> {
    anyhow::ensure!(args.plan.is_none(), "--plan: is of one scene, and not of several models");
    anyhow::ensure!(args.input.mesh.is_empty(), "--mesh: goes with one scene, and not with several models");
    let Args { scene, method, rays, camera, aim, frames, cache, out, .. } = args;
    let cache = cache.cache(out.as_deref())?;
    let all = Several {
        path: scene,
        chosen: &method.0,
        rays: rays.as_ref(),
        camera,
        aim,
        frames,
        tiles_in_turn: args.tiles_in_turn,
        cache: &cache,
    };
    all.run(file, targets, open)
}
