//! `export`: one level as a mesh.

use super::output::{check_target, grouped, open, print_line};
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
    write_and_rename(&args.out, |out| export_level(&scene, level, out))
        
    print_line(&format!("{}: {} triangles", args.out.display(), grouped((scene.trees() as u64) << (2 * level))))?;
    Ok(ExitCode::SUCCESS)
}
