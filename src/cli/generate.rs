//! `generate`: a procedural scene.

use super::args::{levels, seed, whole};
use super::build::{FormArgs, finish};
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
    /// Number of 1-to-4 splits, 0 to 10
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
    let options = Options {
        scene: args.scene,
        levels: args.levels,
        base: args.base,
        seed: args.seed,
        roughness: args.roughness,
        walls: args.walls,
        width: args.width,
    };
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
    check_memory(options)
}

fn share(s: &str) -> Result<f64, String> {
    match s.parse::<f64>() {
        Ok(v) if (0.0..=1.0).contains(&v) => Ok(v),
        _ => Err(format!("'{s}' is not between 0 and 1")),
    }
}

/// Refuses what this machine has no memory for, where it says how much it has: an allocation that fails ends the program on the spot.
fn check_memory(options: &Options) -> anyhow::Result<()> {
    // Measured: the surface, its hierarchy and the scene's images together at their peak.
    const BYTES_PER_TRIANGLE: u64 = 48;
    let levels = options.levels.unwrap_or(options.scene.default_levels());
    let needed = (u64::from(options.base.unwrap_or(options.scene.default_base())) << (2 * levels)) * BYTES_PER_TRIANGLE;
    let Some(available) = available_memory() else { return Ok(()) };
    let gigabytes = |bytes: u64| bytes as f64 / 1e9;
    anyhow::ensure!(
        needed <= available,
        "--levels {levels}: this scene needs about {:.1} GB of memory, {:.1} GB are free; take fewer levels or a smaller --base",
        gigabytes(needed),
        gigabytes(available)
    );
    Ok(())
}

fn available_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("MemAvailable:"))?;
    Some(line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok()? * 1024)
}
