//! `render`: one view of a scene, or of several models, through one method.

mod files;
mod report;
mod several;

use super::aim::AimArgs;
use super::args::CameraArgs;
use super::bars::Bars;
use super::cache::CacheArgs;
use super::comparison::Against;
use super::facts::Facts;
use super::folder::{Overrule, RunFolder, one_run};
use super::made;
use super::method::PictureMethod;
use super::original::original;
use super::output::{explain, open, open_any, print_json, print_table, remark};
use super::pictures::{Map, levels, normals};
use anyhow::Context;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use files::{names, save};
use lodray::format::Scene;
use lodray::method::knob::DELTA;
use lodray::method::{Method, reference};
use lodray::picture::{Shader, Shading, normal_map};
use lodray::rays::{Camera, ModelSpace, Sight};
use lodray::study::pruned::check_normals;
use lodray::study::{Chosen, Shot, pruned};
use report::{PerRay, Report, Seconds, table};
use several::Several;
use std::path::PathBuf;
use std::process::ExitCode;
use std::time::Instant;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file (for --method original also a mesh file), or the description of several models (TOML; `paths --help` has the keys)
    scene: PathBuf,
    #[command(flatten)]
    method: PictureMethod,
    #[command(flatten)]
    camera: CameraArgs,
    #[command(flatten)]
    aim: AimArgs,
    #[command(flatten)]
    cache: CacheArgs,
    /// Folder for the pictures
    #[arg(short, long, default_value = "out", long_help = one_run("Folder for the pictures"))]
    out: PathBuf,
    #[command(flatten)]
    overrule: Overrule,
    /// Compare with full resolution, or with the mesh in --mesh: error map and figures
    #[arg(long)]
    compare: bool,
    /// The mesh that the scene was made from, for --compare or --method original
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Normals that the picture is shaded with
    #[arg(long, value_parser = shading(), default_value = Shading::default().name())]
    shading: Shading,
    /// Samples in each pixel of the picture, on a regular grid; maps and figures are those of one ray through its centre
    #[arg(long, value_parser = samples(), default_value = "1")]
    samples: u32,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

/// Shadings by name.
pub fn shading() -> impl TypedValueParser<Value = Shading> {
    let named = |name: String| Shading::ALL.into_iter().find(|shading| shading.name() == name).unwrap_or_default();
    PossibleValuesParser::new(Shading::ALL.map(|shading| PossibleValue::new(shading.name()).help(shading.help()))).map(named)
}

/// Sides of the grid of samples, by how many they are.
fn samples() -> impl TypedValueParser<Value = u32> {
    PossibleValuesParser::new(["1", "4", "16", "64"]).map(|count| count.parse::<u32>().map_or(1, u32::isqrt))
}

/// Geometry to trace.
struct Subject {
    scene: Scene,
    space: ModelSpace,
}

impl Subject {
    fn of(scene: Scene) -> Self {
        Self { space: ModelSpace::of(&scene), scene }
    }

    /// The frame of the first camera, the picture of the other.
    fn shoot(&self, method: &dyn Method, shading: Shading, cameras: [&Camera; 2], delta: f64, what: &str) -> Shot {
        Shot::of(method, &Shader::new(method.surface(&self.scene), &self.space, shading), &self.space, cameras, delta, (what, &Bars))
    }
}

/// What the camera stands around, and the original if it is something else.
fn subjects(args: &Args) -> anyhow::Result<(Subject, Option<Subject>)> {
    let is_original = args.method.original;
    anyhow::ensure!(!(is_original && args.compare), "--compare: the original is what the other methods are compared with");
    match &args.mesh {
        Some(_) if !is_original && !args.compare => anyhow::bail!("--mesh: goes with --compare or with --method original only"),
        Some(mesh) => Ok((Subject::of(open(&args.scene)?), Some(Subject::of(original(mesh)?)))),
        None if is_original => Ok((Subject::of(original(&args.scene)?), None)),
        None => Ok((Subject::of(open_any(&args.scene)?), None)),
    }
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    if made::is_description(&args.scene) {
        return several(args);
    }
    args.aim.check()?;
    let (seen, mesh) = subjects(args)?;
    let camera = args.camera.camera(&seen.space, None)?;
    let samples = camera.with_samples(args.samples).context("--samples")?;
    let cameras = [&camera, &samples];
    cameras.into_iter().try_for_each(|rays| pruned::check(&seen.scene, rays, args.method.chosen.delta()))?;
    check_normals(&seen.scene, "a picture")?;
    pruned::check_shading(&seen.scene, args.shading)?;
    args.method.chosen.check(&seen.scene)?;
    if args.compare && mesh.is_none() {
        Chosen::plain(&reference::METHOD).check(&seen.scene)?;
    }
    let inputs: Vec<_> = std::iter::once(&args.scene).chain(&args.mesh).map(PathBuf::as_path).collect();
    let folder = RunFolder::open(&args.out, names(args.compare), &inputs, &args.overrule)?;
    let cache = args.cache.cache(Some(&args.out))?;

    let shown = mesh.as_ref().filter(|_| args.method.original).unwrap_or(&seen);
    let begun = Instant::now();
    let (chosen, delta) = (&args.method.chosen, args.method.chosen.delta());
    let (method, cached) = chosen.make(&shown.scene, &cache, &Bars)?;
    let building = begun.elapsed().as_secs_f64();
    let begun = Instant::now();
    let shot = shown.shoot(&*method, args.shading, cameras, delta, "tracing");
    let seconds = Seconds { building, tracing: begun.elapsed().as_secs_f64() };
    let choices = method.choices(&Sight::new(&camera, &shown.space, delta));
    let surface = method.surface(&shown.scene).clone();
    drop(method);

    let truth = if args.compare {
        let (against, of) = mesh.as_ref().map_or((Against::FullResolution, &seen), |mesh| (Against::Original, mesh));
        let (reference, _) = Chosen::plain(&reference::METHOD).make(&of.scene, &cache, &Bars)?;
        let truth = of.shoot(&*reference, args.shading, cameras, delta, against.name());
        let error = shot.compared(&truth, &of.scene, &camera);
        Some((against, truth.image, error))
    } else {
        None
    };
    let facts = Facts {
        scene: &shown.scene.meta().name,
        method: args.method.name(),
        delta: chosen.method.has(DELTA.name).then_some(delta),
        choices: &choices,
        shading: (args.shading, args.samples * args.samples),
        camera: &camera,
        stats: &shot.stats,
        error: truth.as_ref().map(|(against, _, error)| (*against, error)),
    };
    let true_image = truth.as_ref().map(|(against, image, _)| (*against, image));
    let (levels, normals) = (|| levels(&shot, surface.levels()), || normals(normal_map(&shot.frame, &surface)));
    save(&shot, true_image, [&levels as &dyn Fn() -> Map, &normals], &facts, folder.staging())?;
    folder.finish()?;

    let (against, error) = truth.map(|(against, _, error)| (against, error)).unzip();
    let stats = shot.stats;
    let per_ray = PerRay::from(&stats);
    let report = Report {
        method: args.method.name(),
        delta,
        choices: choices.into_iter().collect(),
        shading: args.shading,
        samples: args.samples * args.samples,
        size: [camera.width, camera.height],
        eye: camera.eye.to_array(),
        distance: camera.radii,
        cached,
        seconds,
        stats,
        per_ray,
        against,
        error,
    };
    show(args, &report)?;
    Ok(ExitCode::SUCCESS)
}

/// Pictures of several models.
fn several(args: &Args) -> anyhow::Result<ExitCode> {
    anyhow::ensure!(args.mesh.is_none(), "--mesh: goes with one scene, and not with several models");
    anyhow::ensure!(!args.method.original, "--method original: is of one scene, and not of several models");
    let Args { scene, method, camera, aim, cache, out, overrule, compare, shading, samples, .. } = args;
    let all = Several {
        path: scene,
        chosen: &method.chosen,
        camera,
        aim,
        cache: &cache.cache(Some(out))?,
        compare: *compare,
        shading: *shading,
        samples: *samples,
    };
    let report = all.run(|inputs| RunFolder::open(out, names(*compare), inputs, overrule))?;
    show(args, &report)?;
    Ok(ExitCode::SUCCESS)
}

/// Says what was found out.
fn show(args: &Args, report: &Report) -> anyhow::Result<()> {
    if args.json {
        return print_json(report);
    }
    print_table(&table(report))?;
    explain("render")?;
    remark(&format!("pictures in {}", args.out.display()))
}
