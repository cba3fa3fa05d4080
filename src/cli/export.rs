//! `export`: one level as a mesh.

use super::args::levels;
use super::output::{busy, check_target, open, print_json, remark};
use anyhow::Context;
use lodray::format::{export_level, write_and_rename};
use lodray::mesh::MeshFormat;
use lodray::study::{count, grouped};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// Level, 0 (base mesh) to N (default: N)
    #[arg(long, value_parser = levels(), allow_negative_numbers = true)]
    level: Option<u32>,
    /// OBJ file to write
    #[arg(short, long)]
    out: PathBuf,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    check_target(&args.out, &[&args.scene])?;
    let other = MeshFormat::of(&args.out).filter(|&format| format != MeshFormat::Obj);
    anyhow::ensure!(other.is_none(), "{}: export writes OBJ; let the name end in .obj", args.out.display());
    let scene = open(&args.scene)?;
    let level = args.level.unwrap_or(scene.levels());
    anyhow::ensure!(level <= scene.levels(), "--level {level} is beyond {}'s finest level {}", args.scene.display(), scene.levels());
    let mut counts = None;
    let fill = |out: &mut dyn std::io::Write| {
        counts = Some(export_level(&scene, level, out)?);
        Ok(())
    };
    busy("writing", || write_and_rename(&args.out, fill)).with_context(|| format!("cannot write {}", args.out.display()))?;
    if let Some(counts) = counts {
        if args.json {
            print_json(&serde_json::json!({ "level": level, "vertices": counts.vertices, "faces": counts.faces }))?;
            return Ok(ExitCode::SUCCESS);
        }
        remark(&format!("{}: {} vertices, {}", args.out.display(), grouped(counts.vertices), count(counts.faces, "triangle")))?;
    }
    Ok(ExitCode::SUCCESS)
}
