//! `build`: a scene from a mesh file or standard input.

use super::args::{levels, whole};
use super::common::is_quiet;
use super::folder::with_named;
use super::form::FormArgs;
use super::info;
use super::input::InputFile;
use super::mesh::{MeshArgs, Source};
use super::output::{busy, check_target, print_line, progress, warn};
use super::subdivide::SubdivideArgs;
use anyhow::Context;
use lodray::format::{Meta, Scene};
use lodray::mesh::{DEFAULT_CREASE_ANGLE, DEFAULT_MAX_ERROR, RemeshOptions, TriangleMesh};
use lodray::scene::{BuildError, BuildOptions};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Mesh file: OBJ, PLY, glTF, GLB or STL; - for standard input
    mesh: PathBuf,
    #[command(flatten)]
    reading: MeshArgs,
    /// Number of 1-to-4 splits, 0 to 10 (default: as many as give the finest level once to twice the mesh's triangles; more triangles only where --max-error needs them; with --subdivide 3, with --displace
    /// as many as give a point for each texel)
    #[arg(long, value_parser = levels(), allow_negative_numbers = true)]
    levels: Option<u32>,
    /// Largest distance between mesh and result, both ways, in percent of the diagonal of the mesh's box: decides how fine the base mesh is
    #[arg(long, value_name = "PERCENT", default_value_t = DEFAULT_MAX_ERROR, value_parser = percent, allow_negative_numbers = true)]
    max_error: f64,
    /// A base mesh of so many triangles, whatever is lost
    #[arg(long, value_name = "TRIANGLES", value_parser = whole::<u32>(1..=u64::from(u32::MAX)), allow_negative_numbers = true)]
    base: Option<u32>,
    /// Edges that bend by more than this stay sharp lines, and are shaded so where the mesh has no normals of its own (default 50)
    #[arg(long, value_name = "DEGREES", value_parser = crease, allow_negative_numbers = true)]
    crease_angle: Option<f64>,
    #[command(flatten)]
    subdivide: SubdivideArgs,
    #[command(flatten)]
    form: FormArgs,
    /// Make it an error, and write nothing, if the result is further from the mesh than --max-error or has triangles that face away from it, or if anything of the file is lost
    #[arg(long)]
    strict: bool,
    /// Scene file to write
    #[arg(short, long)]
    out: PathBuf,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let source = Source::new(&args.mesh);
    let inputs: Vec<&Path> = source.files().iter().copied().chain(args.subdivide.map()).collect();
    check_target(&args.out, &with_named(&inputs).iter().map(PathBuf::as_path).collect::<Vec<_>>())?;
    let crease_angle = args.crease_angle.unwrap_or(DEFAULT_CREASE_ANGLE);
    if args.subdivide.is_wanted() {
        let is_used = args.crease_angle.is_none() || args.subdivide.has_creases();
        anyhow::ensure!(is_used, "--crease-angle: loop and catmull-clark have no creases");
        let scene = args.subdivide.make(&source, &args.reading, args.levels, crease_angle, args.form, args.strict)?;
        return finish(&scene, &args.out, args.json);
    }
    let mesh = args.reading.read(&source, args.strict)?;
    let mut origin = serde_json::Map::new();
    if let Some((format, weld)) = args.reading.found_again(&source) {
        origin.insert(Meta::FILE.to_owned(), serde_json::to_value(InputFile::of(source.path, format, weld)?)?);
    }
    let remesh = RemeshOptions {
        levels: args.levels,
        base_triangles: args.base.map(|n| n as usize),
        max_error: args.max_error,
        reserve: 0.0,
        crease_angle,
    };
    let options = BuildOptions { remesh: Some(remesh), name: source.name(), origin, ..args.form.options() };
    let scene = with_progress(&mesh, &options).with_context(|| source.path.display().to_string())?;
    if let Some(lost) = scene.meta().origin["remesh"]["warning"].as_str().filter(|_| args.strict) {
        anyhow::bail!("{}: {lost}", source.path.display());
    }
    finish(&scene, &args.out, args.json)
}

fn with_progress(mesh: &TriangleMesh, options: &BuildOptions) -> Result<Scene, BuildError> {
    let bar = progress(1, "remeshing");
    let made = Scene::of_mesh(mesh, options, &|what, done, of| {
        if bar.message() != what {
            bar.set_message(what.to_owned());
        }
        bar.set_length(of);
        bar.set_position(done);
    });
    bar.finish_and_clear();
    made
}

/// A largest error.
pub fn percent(s: &str) -> Result<f64, String> {
    match s.trim_end_matches('%').parse::<f64>() {
        Ok(v) if v > 0.0 && v <= 100.0 => Ok(v),
        _ => Err(format!("'{s}' is not above 0 and at most 100 percent")),
    }
}

/// A crease angle.
fn crease(s: &str) -> Result<f64, String> {
    match s.parse::<f64>() {
        Ok(v) if (0.0..=180.0).contains(&v) => Ok(v),
        _ => Err(format!("'{s}' is not from 0 to 180 degrees")),
    }
}

/// Saves a new scene and says what it holds.
pub fn finish(scene: &Scene, out: &Path, json: bool) -> anyhow::Result<ExitCode> {
    busy("writing", || scene.save(out))?;
    if !json && !is_quiet() {
        return print_line(&format!("{}:\n{}", out.display(), info::short(scene))).map(|()| ExitCode::SUCCESS);
    }
    // The short form says what was lost; otherwise it is said beside the results.
    info::warnings(scene).iter().for_each(|lost| warn(&format!("warning: {}: {lost}", out.display())));
    if json {
        info::json(scene)?;
    }
    Ok(ExitCode::SUCCESS)
}
