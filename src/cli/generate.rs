//! `generate`: a procedural scene.

use super::args::{levels, seed, whole};
use super::build::finish;
use super::form::FormArgs;
use super::memory::check_memory;
use super::names::named;
use super::output::{busy, check_target};
use lodray::format;
use lodray::mesh::procedural::{MAX_TREES, MAX_WALLS, Options, Scene, generate};
use lodray::scene::BuildOptions;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// What to generate
    #[arg(value_parser = named::<Scene>())]
    scene: Scene,
    /// Number of 1-to-4 splits, 0 to 10 (default 4 to 7, by the scene)
    #[arg(long, value_parser = levels(), allow_negative_numbers = true)]
    levels: Option<u32>,
    /// Number of base triangles, rounded to the next possible one
    #[arg(long, value_name = "TRIANGLES", value_parser = whole::<u32>(1..=MAX_TREES), allow_negative_numbers = true)]
    base: Option<u32>,
    /// Seed
    #[arg(long, default_value_t = 0, value_parser = seed(), allow_negative_numbers = true)]
    seed: u64,
    /// Terrain, sphere, wall and street: amplitude of each octave relative to the one before; others: amount of fine detail. Between 0 and 1
    #[arg(long, value_parser = share, allow_hyphen_values = true)]
    roughness: Option<f64>,
    /// Quads along each wall of a room (default: a quarter of those across its cloth)
    #[arg(long, value_name = "QUADS", value_parser = whole::<u32>(1..=MAX_WALLS.into()), allow_negative_numbers = true)]
    walls: Option<u32>,
    /// World units across a terrain: heights stay, so that a wider one is flatter (default 2)
    #[arg(long, value_name = "UNITS", allow_negative_numbers = true)]
    width: Option<f64>,
    #[command(flatten)]
    form: FormArgs,
    /// Scene file to write
    #[arg(short, long)]
    out: PathBuf,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    check_target(&args.out, &[])?;
    let &Args { scene, levels, base, seed, roughness, walls, width, .. } = args;
    let options = Options { scene, levels, base, seed, roughness, walls, width };
    finish(&make(&options, args.form)?, &args.out, args.json)
}

/// Generates a scene.
pub fn make(options: &Options, form: FormArgs) -> anyhow::Result<format::Scene> {
    check(options)?;
    let surface = busy("generating", || generate(options))?;
    let form = BuildOptions { name: options.scene.name().to_owned(), ..form.options() }.with_origin("generate", serde_json::json!(options));
    Ok(busy("encoding", || format::Scene::of_surface(&surface, &form))?)
}

/// Refuses what cannot be generated, before any work is done.
pub fn check(options: &Options) -> anyhow::Result<()> {
    options.check()?;
    // Measured: the surface, its hierarchy and the scene's images together at their peak.
    const BYTES_PER_TRIANGLE: u64 = 48;
    let levels = options.levels.unwrap_or(options.scene.default_levels());
    let triangles = u64::from(options.base.unwrap_or(options.scene.default_base())) << (2 * levels);
    check_memory(levels, triangles, BYTES_PER_TRIANGLE, "take fewer levels or a smaller --base")
}

fn share(s: &str) -> Result<f64, String> {
    match s.parse::<f64>() {
        Ok(v) if (0.0..=1.0).contains(&v) => Ok(v),
        _ => Err(format!("'{s}' is not between 0 and 1")),
    }
}
