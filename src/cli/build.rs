//! `build`: a scene from a mesh file or standard input.

use super::args::{levels, whole};
use super::common::is_quiet;
use super::info;
use super::output::{busy, check_target, print_line, progress, warn};
use anyhow::Context;
use lodray::bvh::over_trees;
use lodray::format::{self, Scene, SceneInfo};
use lodray::mesh::{MeshFormat, RemeshOptions, Surface, TriangleMesh, read, read_as, read_bytes, remesh};
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What stands for standard input.
const STDIN: &str = "-";

#[derive(clap::Args)]
pub struct Args {
    /// Mesh file: OBJ, PLY, glTF, GLB or STL; - for standard input
    mesh: PathBuf,
    /// Format of the mesh, whatever the file's ending; files that it names are looked for beside it, for standard input in the current folder
    #[arg(long, value_enum, required_if_eq("mesh", STDIN))]
    format: Option<MeshFormat>,
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
    let stdin = args.mesh.as_os_str() == STDIN;
    let source = if stdin { Path::new("stdin") } else { &args.mesh };
    check_target(&args.out, (!stdin).then_some(source).as_slice())?;
    let mesh = busy("reading", || match args.format {
        Some(format) if stdin => read_stdin(format, source),
        Some(format) => Ok(read_as(source, format)?),
        None => Ok(read(source)?),
    })?;
    let options = RemeshOptions { levels: args.levels, base_triangles: args.base.map(|n| n as usize) };
    let bar = progress(1, "remeshing");
    let (surface, report) = remesh(&mesh, &options, &|what, done, of| {
        if bar.message() != what {
            bar.set_message(what.to_owned());
        }
        bar.set_length(of);
        bar.set_position(done);
    })
    .map_err(|e| anyhow::anyhow!("{}: {e}", source.display()))?;
    bar.finish_and_clear();
    let name = source.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let origin = serde_json::json!({ "mesh": mesh.report, "remesh": report });
    let scene = build_scene(&surface, &name, origin)?;
    drop(surface);
    finish(&scene, &args.out, args.json)
}

fn read_stdin(format: MeshFormat, name: &Path) -> anyhow::Result<TriangleMesh> {
    let mut bytes = Vec::new();
    std::io::stdin().lock().read_to_end(&mut bytes).context("cannot read standard input")?;
    Ok(read_bytes(&bytes, format, name, Path::new(""))?)
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
