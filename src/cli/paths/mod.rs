//! `paths`: a picture by path tracing, from the description of a scene.

mod figures;
mod machine;
mod print;

use super::aim::TimeArg;
use super::args::{Change, Size, seed, whole};
use super::cache::CacheArgs;
use super::folder::{Overrule, RunFolder, one_run};
use super::made::{camera, description, facts, methods, model_files, paths, scenes, world};
use super::method::MachineMethod;
use super::names::named;
use super::output::{print_json, progress, write_file};
use anyhow::{Context, ensure};
use figures::{Against, Report};
use lodray::format::Scene;
use lodray::method::{Method, lod, packet};
use lodray::paths::{Film, MOST_DEPTH, MOST_SAMPLES, Paths, SceneFile, Starts, light_count, picture_error};
use lodray::picture::{compare, save_png};
use lodray::rays::Camera;
use lodray::run::Compute;
use lodray::study::Cache;
use lodray::study::Chosen;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Instant;

/// The pictures.
const PICTURE: &str = "paths.png";
const LIGHT: &str = "paths.exr";
const FULL_PICTURE: &str = "full.png";
const FULL_LIGHT: &str = "full.exr";
const CONVERGED_PICTURE: &str = "converged.png";
const CONVERGED_LIGHT: &str = "converged.exr";
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
    #[command(flatten)]
    time: TimeArg,
    /// Picture size in pixels, in place of the description's
    #[arg(long, value_name = "WxH")]
    size: Option<Size>,
    /// Paths of a pixel, in place of the description's
    #[arg(long, value_name = "N", value_parser = whole::<u32>(1..=MOST_SAMPLES.into()), allow_negative_numbers = true)]
    samples: Option<u32>,
    /// Bounces, in place of the description's
    #[arg(long, value_name = "N", value_parser = whole::<u32>(0..=MOST_DEPTH.into()), allow_negative_numbers = true)]
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
    #[arg(long, value_name = "N", value_parser = whole::<u32>(1..=MOST_SAMPLES.into()), allow_negative_numbers = true)]
    converged: Option<u32>,
    /// Simulate the paths on a machine, the name of one that comes with the program or a file, in place of a picture, at all depths from 0 on: what each bounce adds; of several models only where compute is free
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

/// The description with what the command line says in its place.
fn overruled(args: &Args) -> anyhow::Result<SceneFile> {
    let mut file = args.time.of(description(&args.scene)?);
    if let Some(Size(width, height)) = args.size {
        (file.picture.width, file.picture.height) = (width, height);
    }
    file.picture.samples = args.samples.unwrap_or(file.picture.samples);
    file.picture.depth = args.depth.unwrap_or(file.picture.depth);
    file.picture.seed = args.seed.unwrap_or(file.picture.seed);
    file.cones.diffuse = args.diffuse_spread.unwrap_or(file.cones.diffuse);
    Ok(file)
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    ensure!(packet::chosen(&args.method.0.knobs) == 1, "--packet: paths are traced one by one");
    let file = overruled(args)?;
    let shown = args.scene.display();
    let models = model_files(&args.scene, &file)?;
    let inputs: Vec<&Path> = models.iter().map(PathBuf::as_path).chain([args.scene.as_path()]).collect();
    let mut names = vec![FIGURES];
    names.extend(if args.machine.is_none() { &[PICTURE, LIGHT][..] } else { &[RESULTS] });
    if args.compare {
        names.extend([FULL_PICTURE, FULL_LIGHT]);
    }
    if args.converged.is_some() {
        names.extend([CONVERGED_PICTURE, CONVERGED_LIGHT]);
    }
    let folder = RunFolder::open(&args.out, names, &inputs, &args.overrule)?;
    let scenes = scenes(&args.scene, &file)?;
    let camera = camera(&file, args.camera.as_deref(), &scenes).with_context(|| shown.to_string())?;
    let cache = args.cache.cache(None)?;
    let subject = Subject { args, file: &file, scenes: &scenes, camera, cache: &cache, folder: &folder };
    match &args.machine {
        Some(name) => {
            let bounces = subject.simulate(name)?;
            folder.finish()?;
            if args.json { print_json(&bounces)? } else { print::bounces(&bounces)? }
        }
        None => {
            let report = subject.picture()?;
            folder.finish()?;
            if args.json { print_json(&report)? } else { print::report(&report, &args.out)? }
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// What there is to trace, and where its files go.
struct Subject<'a> {
    args: &'a Args,
    file: &'a SceneFile,
    scenes: &'a [Scene],
    camera: Camera,
    cache: &'a Cache,
    folder: &'a RunFolder,
}

impl Subject<'_> {
    /// The models by the method that was asked for.
    fn methods(&self) -> anyhow::Result<Vec<Arc<dyn Method>>> {
        self.made(&self.args.method.0)
    }

    /// The same by another.
    fn made(&self, chosen: &Chosen) -> anyhow::Result<Vec<Arc<dyn Method>>> {
        methods(self.file, self.scenes, chosen, self.cache)
    }

    /// What each bounce costs on the machine of that name.
    fn simulate(&self, name: &str) -> anyhow::Result<Vec<machine::Bounces>> {
        let Self { args, file, scenes, camera, folder, .. } = *self;
        let chosen = &args.method.0;
        let methods = self.methods()?;
        let own = world(file, scenes, &methods, &camera, chosen.delta(), args.starts);
        let mut machine = super::machines::machine(name, &args.set, "--set").with_context(|| format!("--machine {name}"))?;
        // Paths need such units, whatever the machine's are for.
        machine.description.units.secondary = true;
        let shown = args.scene.display().to_string();
        let models = facts(&args.scene, file, scenes)?;
        let results = machine::run(&paths(file, &own, camera), chosen, &models, &machine, args.compute, &shown)?;
        let bounces = machine::bounces(&results);
        let write = |name: &str, text: String| write_file(&folder.staging().join(name), text + "\n");
        write(FIGURES, serde_json::to_string_pretty(&bounces)?)?;
        write(RESULTS, serde_json::to_string_pretty(&results)?)?;
        Ok(bounces)
    }

    /// The picture, and how far it is from full resolution.
    fn picture(&self) -> anyhow::Result<Report> {
        let Self { args, file, scenes, camera, folder, .. } = *self;
        let chosen = &args.method.0;
        let methods = self.methods()?;
        let own = world(file, scenes, &methods, &camera, chosen.delta(), args.starts);
        let start = Instant::now();
        let film = shoot(&paths(file, &own, camera), "tracing");
        let seconds = start.elapsed().as_secs_f64();
        self.save(&film, PICTURE, LIGHT, chosen.method.name)?;

        let mut report = Report {
            method: chosen.method.name,
            delta: chosen.delta(),
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
            self.compare(&film, &mut report)?;
        }
        write_file(&folder.staging().join(FIGURES), serde_json::to_string_pretty(&report)? + "\n")?;
        Ok(report)
    }

    /// How far the film is from full resolution by the same paths and by others.
    fn compare(&self, film: &Film, report: &mut Report) -> anyhow::Result<()> {
        let Self { args, file, scenes, camera, .. } = *self;
        let methods = self.made(&Chosen::plain(&lod::METHOD))?;
        let full = world(file, scenes, &methods, &camera, f64::INFINITY, Starts::Exact);
        let same = paths(file, &full, camera);
        let exposure = file.picture.exposure;
        let against = |truth: &Film, samples: u32, by_same: bool| Against {
            samples,
            light: picture_error(film, truth),
            image: compare(&film.image(exposure), &truth.image(exposure)),
            pixels: by_same.then(|| light_count(film, truth)),
        };
        if args.compare {
            let truth = shoot(&same, "tracing full resolution");
            self.save(&truth, FULL_PICTURE, FULL_LIGHT, "full resolution")?;
            report.against_full = Some(against(&truth, same.samples, true));
        }
        if let Some(samples) = args.converged {
            let truth = shoot(&Paths { samples, seed: same.seed ^ OTHER_SEED, ..same }, "tracing full resolution, converged");
            self.save(&truth, CONVERGED_PICTURE, CONVERGED_LIGHT, "full resolution, converged")?;
            report.against_converged = Some(against(&truth, samples, false));
        }
        Ok(())
    }

    /// Writes a film as a picture and as light.
    fn save(&self, film: &Film, picture: &str, light: &str, what: &str) -> anyhow::Result<()> {
        let notes = [("Software", format!("lodray {}", env!("CARGO_PKG_VERSION"))), ("Description", what.to_owned())];
        let notes = notes.map(|(key, text)| (key.to_owned(), text));
        save_png(&film.image(self.file.picture.exposure), &notes, &self.folder.staging().join(picture))?;
        Ok(film.save_exr(&notes[0].1, what, &self.folder.staging().join(light))?)
    }
}

fn shoot(paths: &Paths<'_>, what: &str) -> Film {
    let bar = progress(u64::from(paths.camera.height), what);
    let film = Film::of(paths, &|| bar.inc(1));
    bar.finish_and_clear();
    film
}
