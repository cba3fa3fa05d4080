//! `paths`: a picture by path tracing, from the description of a scene.

mod machine;
mod made;
mod print;

use super::args::{Change, Size, seed, whole};
use super::cache::{Cache, CacheArgs};
use super::folder::{Overrule, RunFolder, one_run};
use super::method::{Chosen, MachineMethod};
use super::names::named;
use super::output::{print_json, progress, write_file};
use anyhow::{Context, ensure};
use lodray::method::lod;
use lodray::paths::{Film, LightCount, PathCounts, Paths, Starts, light_count, picture_error};
use lodray::picture::{ImageError, compare, save_png};
use lodray::run::Compute;
use made::{camera, description, load, paths, world};
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// The pictures.
const PICTURE: &str = "paths.png";
const LIGHT: &str = "paths.exr";
const FULL_PICTURE: &str = "full.png";
const FULL_LIGHT: &str = "full.exr";
const FIGURES: &str = "paths.json";
/// Results of the simulator, one for each number of bounces.
const RESULTS: &str = "result.json";

/// Bits of the seed in which converged full resolution differs from the picture that it is compared with.
const OTHER_SEED: u64 = 0x5EED_0F0F_2B1D_9C37;

#[derive(clap::Args)]
pub struct Args {
    /// Description of a scene (TOML): the long help has the keys
    scene: PathBuf,
    #[command(flatten)]
    method: MachineMethod,
    /// Folder for the picture (PNG), its light (OpenEXR) and figures
    #[arg(short, long, default_value = "out/paths", long_help = one_run("Folder for the picture (PNG), its light (OpenEXR) and figures"))]
    out: PathBuf,
    #[command(flatten)]
    overrule: Overrule,
    /// Camera, by its name (default: the first)
    #[arg(long, value_name = "NAME")]
    camera: Option<String>,
    /// Picture size in pixels, in place of the description's
    #[arg(long, value_name = "WxH")]
    size: Option<Size>,
    /// Paths of a pixel, in place of the description's
    #[arg(long, value_name = "N", value_parser = whole::<u32>(1..=1 << 20), allow_negative_numbers = true)]
    samples: Option<u32>,
    /// Bounces, in place of the description's
    #[arg(long, value_name = "N", value_parser = whole::<u32>(0..=64), allow_negative_numbers = true)]
    depth: Option<u32>,
    /// Seed, in place of the description's
    #[arg(long, value_name = "N", value_parser = seed(), allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Spread of cones after a diffuse bounce, in place of the description's: the tangent of the half angle
    #[arg(long, value_name = "TANGENT", value_parser = not_negative, allow_negative_numbers = true)]
    diffuse_spread: Option<f64>,
    /// How rays leave surfaces: exact (the rule), independent (each ray decides for itself), or so far above the surface, in bounding radii of its model
    #[arg(long, value_name = "exact|independent|RADII", value_parser = starts, default_value = "exact", allow_negative_numbers = true)]
    starts: Starts,
    /// Also full resolution, by the same paths, and how far the picture is from it: error, and pixels whose light is wrong
    #[arg(long)]
    compare: bool,
    /// Also full resolution by other paths, so many of a pixel, and the error to it
    #[arg(long, value_name = "N", value_parser = whole::<u32>(1..=1 << 20), allow_negative_numbers = true)]
    converged: Option<u32>,
    /// Simulate the paths on a machine, the name of one that comes with the program or a file, in place of a picture, at all depths from 0 on: what each bounce adds; for scenes of one model
    #[arg(long, value_name = "NAME|FILE", conflicts_with_all = ["compare", "converged"])]
    machine: Option<String>,
    /// Change a value of the machine, such as l1.bytes=32768; may be repeated
    #[arg(long, value_name = "KEY=VALUE", requires = "machine")]
    set: Vec<Change>,
    /// How compute is simulated
    #[arg(long, value_parser = named::<Compute>(), default_value = Compute::Free.name(), requires = "machine")]
    compute: Compute,
    #[command(flatten)]
    cache: CacheArgs,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

fn not_negative(s: &str) -> Result<f64, String> {
    match s.parse::<f64>() {
        Ok(v) if v >= 0.0 && v.is_finite() => Ok(v),
        _ => Err(format!("'{s}' is not a number from 0 on")),
    }
}

fn starts(s: &str) -> Result<Starts, String> {
    match s {
        "exact" => Ok(Starts::Exact),
        "independent" => Ok(Starts::Independent),
        other => not_negative(other).map(Starts::Offset).map_err(|_| format!("'{s}' is not exact, independent, or a number from 0 on")),
    }
}

#[derive(Serialize)]
struct Report {
    method: &'static str,
    delta: f64,
    starts: String,
    size: [u32; 2],
    samples: u32,
    depth: u32,
    seed: u64,
    diffuse_spread: f64,
    counts: PathCounts,
    #[serde(skip)]
    seconds: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    against_full: Option<Against>,
    #[serde(skip_serializing_if = "Option::is_none")]
    against_converged: Option<Against>,
}

/// How far a picture is from another.
#[derive(Serialize)]
struct Against {
    samples: u32,
    /// Mean squared relative error of the light.
    light: f64,
    /// Of the picture for a screen.
    image: ImageError,
    /// Pixels whose first hits have the wrong light; only by the same paths.
    #[serde(skip_serializing_if = "Option::is_none")]
    pixels: Option<LightCount>,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let mut file = description(&args.scene)?;
    let beside = args.scene.parent().unwrap_or(Path::new(""));
    let shown = args.scene.display();
    if let Some(Size(width, height)) = args.size {
        (file.picture.width, file.picture.height) = (width, height);
    }
    file.picture.samples = args.samples.unwrap_or(file.picture.samples);
    file.picture.depth = args.depth.unwrap_or(file.picture.depth);
    file.picture.seed = args.seed.unwrap_or(file.picture.seed);
    file.cones.diffuse = args.diffuse_spread.unwrap_or(file.cones.diffuse);
    let named: Vec<_> = file.model.iter().filter_map(|model| model.file.as_ref()).map(|name| beside.join(name)).collect();
    for (k, model) in file.model.iter().enumerate() {
        let missing = model.file.as_ref().map(|name| beside.join(name)).filter(|path| !path.is_file());
        ensure!(missing.is_none(), "{shown}: model[{k}].file: there is no file {}", missing.unwrap_or_default().display());
    }
    let inputs: Vec<&Path> = named.iter().map(PathBuf::as_path).chain([args.scene.as_path()]).collect();
    let mut names = vec![FIGURES];
    names.extend(if args.machine.is_none() { &[PICTURE, LIGHT][..] } else { &[RESULTS] });
    if args.compare || args.converged.is_some() {
        names.extend([FULL_PICTURE, FULL_LIGHT]);
    }
    let folder = RunFolder::open(&args.out, names, &inputs, &args.overrule)?;
    let scenes = file
        .model
        .iter()
        .enumerate()
        .map(|(k, model)| load(model, beside).with_context(|| format!("{shown}: model[{k}]")))
        .collect::<anyhow::Result<Vec<_>>>()?;
    let camera = camera(&file, args.camera.as_deref(), &scenes).with_context(|| shown.to_string())?;
    let cache = Cache::new(&args.cache, None)?;
    let made = |chosen: &Chosen| scenes.iter().map(|scene| Ok(chosen.make(scene, &cache)?.0)).collect::<anyhow::Result<Vec<_>>>();
    let methods = made(&args.method.0)?;
    ensure!(methods.iter().all(|method| method.leaves()), "--method {}: rays cannot leave its surface", args.method.0.method.name);
    let own = world(&file, &scenes, &methods, &camera, args.method.0.delta(), args.starts);
    let paths = paths(&file, &own, camera);

    if let Some(name) = &args.machine {
        let machine = super::pass::machine(name, &args.set, "--set").with_context(|| format!("--machine {name}"))?;
        let results = machine::run(&paths, &args.method.0, &scenes[0], &machine, args.compute, &shown.to_string())?;
        let bounces = machine::bounces(&results);
        let write = |name: &str, text: String| write_file(&folder.staging().join(name), text + "\n");
        write(FIGURES, serde_json::to_string_pretty(&bounces)?)?;
        write(RESULTS, serde_json::to_string_pretty(&results)?)?;
        folder.finish()?;
        return if args.json { print_json(&bounces) } else { print::bounces(&bounces) }.map(|()| ExitCode::SUCCESS);
    }

    let exposure = file.picture.exposure;
    let start = Instant::now();
    let film = shoot(&paths, "tracing");
    let seconds = start.elapsed().as_secs_f64();
    let save = |film: &Film, picture: &str, light: &str, what: &str| -> anyhow::Result<()> {
        let notes = [("Software", format!("lodray {}", env!("CARGO_PKG_VERSION"))), ("Description", what.to_owned())];
        let notes = notes.map(|(key, text)| (key.to_owned(), text));
        save_png(&film.image(exposure), &notes, &folder.staging().join(picture))?;
        Ok(film.save_exr(&notes[0].1, what, &folder.staging().join(light))?)
    };
    save(&film, PICTURE, LIGHT, args.method.0.method.name)?;

    let mut report = Report {
        method: args.method.0.method.name,
        delta: args.method.0.delta(),
        starts: match args.starts {
            Starts::Exact => "exact".to_owned(),
            Starts::Independent => "independent".to_owned(),
            Starts::Offset(radii) => radii.to_string(),
        },
        size: camera.pixels(),
        samples: file.picture.samples,
        depth: file.picture.depth,
        seed: file.picture.seed,
        diffuse_spread: file.cones.diffuse,
        counts: film.counts.clone(),
        seconds,
        against_full: None,
        against_converged: None,
    };
    if args.compare || args.converged.is_some() {
        let finest = Chosen::plain(&lod::METHOD);
        let methods = made(&finest)?;
        let full = world(&file, &scenes, &methods, &camera, f64::INFINITY, Starts::Exact);
        let same = Paths { world: &full, ..made::paths(&file, &full, camera) };
        let against = |truth: &Film, samples: u32, by_same: bool| Against {
            samples,
            light: picture_error(&film, truth),
            image: compare(&film.image(exposure), &truth.image(exposure)),
            pixels: by_same.then(|| light_count(&film, truth)),
        };
        if args.compare {
            let truth = shoot(&same, "tracing full resolution");
            save(&truth, FULL_PICTURE, FULL_LIGHT, "full resolution")?;
            report.against_full = Some(against(&truth, same.samples, true));
        }
        if let Some(samples) = args.converged {
            let other = Paths { samples, seed: same.seed ^ OTHER_SEED, ..same };
            let truth = shoot(&other, "tracing full resolution, converged");
            save(&truth, FULL_PICTURE, FULL_LIGHT, "full resolution, converged")?;
            report.against_converged = Some(against(&truth, samples, false));
        }
    }
    write_file(&folder.staging().join(FIGURES), serde_json::to_string_pretty(&report)? + "\n")?;
    folder.finish()?;
    if args.json {
        print_json(&report)?;
    } else {
        print::report(&report, &args.out)?;
    }
    Ok(ExitCode::SUCCESS)
}

fn shoot(paths: &Paths<'_>, what: &str) -> Film {
    let bar = progress(u64::from(paths.camera.height), what);
    let film = Film::of(paths, &|| bar.inc(1));
    bar.finish_and_clear();
    film
}
