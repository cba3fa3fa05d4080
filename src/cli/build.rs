//! `build`: a scene from a mesh file.

use super::args::{levels, whole};
use super::common::is_quiet;
use super::info;
use super::output::{busy, check_target, print_line, progress, warn};
use lodray::bvh::over_trees;
use lodray::format::{self, Scene, SceneInfo};
use lodray::mesh::{RemeshOptions, Surface, read, remesh};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Mesh file: OBJ or PLY
    mesh: PathBuf,
    /// Number of 1-to-4 splits, 0 to 10
    #[arg(long, default_value_t = 5, value_parser = levels(), allow_negative_numbers = true)]
    levels: u32,
    /// Wanted number of base triangles (default: 1/64 of the mesh, at least 512)
    #[arg(long, value_name = "TRIANGLES", value_parser = whole::<u32>(1..=u64::from(u32::MAX)), allow_negative_numbers = true)]
    base: Option<u32>,
    /// Scene file to write
    #[arg(short, long)]
    out: PathBuf,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    check_target(&args.out, &[&args.mesh])?;
    let mesh = busy("reading", || read(&args.mesh))?;
    let options = RemeshOptions { levels: args.levels, base_triangles: args.base.map(|n| n as usize) };
    let bar = progress(1, "remeshing");
    let (surface, report) = remesh(&mesh, &options, &|what, done, of| {
        if bar.message() != what {
            bar.set_message(what.to_owned());
        }
        bar.set_length(of);
        bar.set_position(done);
    })
    .map_err(|e| anyhow::anyhow!("{}: {e}", args.mesh.display()))?;
    bar.finish_and_clear();
    let name = args.mesh.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let origin = serde_json::json!({ "mesh": mesh.report, "remesh": report });
    let scene = build_scene(&surface, &name, origin)?;
    drop(surface);
    finish(&scene, &args.out, args.json)
}

/// The scene of a surface; `origin` says how it was made.
pub fn build_scene(surface: &Surface, name: &str, origin: serde_json::Value) -> anyhow::Result<Scene> {
    Ok(busy("encoding", || format::build(surface, SceneInfo { name: name.to_owned(), origin }, over_trees))?)
}

/// Saves a new scene and says what it holds.
pub fn finish(scene: &Scene, out: &Path, json: bool) -> anyhow::Result<ExitCode> {
    busy("writing", || scene.save(out))?;
    match (json, is_quiet()) {
        (true, _) => info::json(scene)?,
        (false, true) => info::warnings(scene).iter().for_each(|lost| warn(&format!("warning: {}: {lost}", out.display()))),
        (false, false) => print_line(&format!("{}:\n{}", out.display(), info::short(scene)))?,
    }
    Ok(ExitCode::SUCCESS)
}
