//! `export`: one level as a mesh.

use super::output::{check_target, grouped, open, print_line};
use anyhow::Context;
use lodray::format::export_level;
use lodray::render::write_and_rename;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// Level, 0 (base mesh) to N (default: N)
    #[arg(long)]
    level: Option<u32>,
    /// OBJ file to write
    #[arg(short, long)]
    out: PathBuf,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    check_target(&args.out)?;
    let scene = open(&args.scene)?;
    let level = args.level.unwrap_or(scene.levels());
    anyhow::ensure!(level <= scene.levels(), "--level {level} is beyond the scene's finest level {}", scene.levels());
    let mut counts = None;
    write_and_rename(&args.out, |out| {
        counts = Some(export_level(&scene, level, out)?);
        Ok(())
    })
    .with_context(|| format!("cannot write {}", args.out.display()))?;
    if let Some(counts) = counts {
        print_line(&format!("{}: {} vertices, {} triangles", args.out.display(), grouped(counts.vertices), grouped(counts.faces)))?;
    }
    Ok(ExitCode::SUCCESS)
}
