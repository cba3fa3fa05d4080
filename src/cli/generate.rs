//! `generate`: a procedural scene.

use super::build::{build_scene, finish};
use super::output::check_target;
use lodray::mesh::procedural::{Options, Scene, generate};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// What to generate
    #[arg(value_enum)]
    scene: Scene,
    /// Number of 1-to-4 splits, 0 to 10
    #[arg(long)]
    levels: Option<u32>,
    /// Wanted number of base triangles; the next possible number is taken
    #[arg(long, value_name = "TRIANGLES")]
    base: Option<u32>,
    /// Seed
    #[arg(long, default_value_t = 0)]
    seed: u64,
    /// Terrain and sphere: amplitude of each octave relative to the one before; others: amount of fine detail. Between 0 and 1
    #[arg(long, allow_negative_numbers = true)]
    roughness: Option<f64>,
    /// Scene file to write
    #[arg(short, long)]
    out: PathBuf,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    check_target(&args.out)?;
    let options = Options { scene: args.scene, levels: args.levels, base: args.base, seed: args.seed, roughness: args.roughness };
    let surface = generate(&options)?;
    let origin = serde_json::json!({ "generate": options });
    let name = format!("{:?}", args.scene).to_lowercase();
    let scene = build_scene(&surface, &name, origin)?;
    drop(surface);
    finish(&scene, &args.out, args.json)
}
