//! `cast`: what the rays of a file meet.

use super::cache::CacheArgs;
use super::made;
use super::method::AnyMethod;
use super::output::{check_target, open_any, print_json, progress, remark};
use crate::cli::bars::Bars;
use anyhow::Context;
use lodray::format::write_and_rename;
use lodray::rays::{ModelSpace, RayFile, RaySource, Sight};
use lodray::run::{FollowError, Followed, HitRow, cast, cast_following, write_hits};
use lodray::study::pruned::check_normals;
use lodray::study::{count, grouped, pruned};
use serde_json::json;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file, or the description of several models (TOML; `paths --help` has the keys)
    scene: PathBuf,
    /// Rays: an array of NumPy's (.npy), a row for each; the long help (--help) has the columns
    rays: PathBuf,
    #[command(flatten)]
    method: AnyMethod,
    #[command(flatten)]
    cache: CacheArgs,
    /// File for the hits (.npy)
    #[arg(short, long)]
    out: PathBuf,
    /// Start a ray that names an earlier one (column 11) exactly at that one's hit; with false, at its own origin
    #[arg(long, value_name = "true|false", action = clap::ArgAction::Set, default_value_t = true)]
    follow: bool,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    if made::is_description(&args.scene) {
        return several(args);
    }
    check_target(&args.out, &[&args.scene, &args.rays])?;
    let scene = open_any(&args.scene)?;
    check_normals(&scene, "a hit's normal")?;
    let rays = RayFile::read(&args.rays)?;
    let chosen = &args.method.0;
    pruned::check_rays(&scene, &rays, chosen.delta())?;
    let (method, _) = chosen.make(&scene, &args.cache.cache(None)?, &Bars)?;
    let sight = Sight::new(&rays, &ModelSpace::of(&scene), chosen.delta());
    let Followed { hits, followed, crowded } = if args.follow && rays.is_ordered() {
        let bar = progress(rays.rays(), "casting");
        let met = cast_following(&*method, &scene, &rays, &sight, &|rays| bar.inc(rays));
        bar.finish_and_clear();
        met.map_err(|why| refusal(args, why))?
    } else {
        let bar = progress(rays.batches() as u64, "casting");
        let hits = cast(&*method, &scene, &rays, &sight, &|batches| bar.inc(batches));
        bar.finish_and_clear();
        Followed { hits, followed: 0, crowded: 0 }
    };
    let found = write(args, &hits)?;
    if args.json {
        let choices: BTreeMap<_, _> = method.choices(&sight).into_iter().collect();
        print_json(
            &json!({ "method": chosen.method.name, "choices": choices, "rays": rays.rays(), "hits": found, "followed": followed, "crowded": crowded }),
        )?;
    } else {
        let starts = if followed > 0 { format!(", {} start at an earlier hit", grouped(followed)) } else { String::new() };
        remark(&format!("{}: {}, {} hit{starts}", args.out.display(), count(rays.rays(), "ray"), grouped(found)))?;
        if crowded > 0 {
            let what = "start where more than two rays decide about the level of detail, and may meet the surface beside their start";
            remark(&format!("{} {what}", count(crowded, "ray")))?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Rays among several models.
fn several(args: &Args) -> anyhow::Result<ExitCode> {
    let file = made::description(&args.scene)?;
    let models = made::model_files(&args.scene, &file)?;
    let inputs: Vec<&Path> = models.iter().chain([&args.scene, &args.rays]).map(PathBuf::as_path).collect();
    check_target(&args.out, &inputs)?;
    let rays = RayFile::read(&args.rays)?;
    let starts = "among several models every ray starts at its own origin: --follow false says so";
    anyhow::ensure!(!(args.follow && rays.is_ordered()), "{}: some rays name earlier ones; {starts}", args.rays.display());
    let scenes = made::scenes(&args.scene, &file)?;
    let (chosen, cache) = (&args.method.0, args.cache.cache(None)?);
    scenes.iter().try_for_each(|scene| pruned::check_rays(scene, &rays, chosen.delta()))?;
    let methods = made::methods(&file, &scenes, chosen, &cache)?;
    let bar = progress(rays.batches() as u64, "casting");
    let hits = made::unshaded(&file, &scenes, &methods, chosen.delta()).cast(&rays, &|batches| bar.inc(batches));
    bar.finish_and_clear();
    let found = write(args, &hits)?;
    if args.json {
        print_json(&json!({ "method": chosen.method.name, "models": scenes.len(), "rays": rays.rays(), "hits": found }))?;
    } else {
        let among = count(scenes.len() as u64, "model");
        remark(&format!("{}: {} among {among}, {} hit", args.out.display(), count(rays.rays(), "ray"), grouped(found)))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// Writes the hits; how many there are.
fn write(args: &Args, hits: &[HitRow]) -> anyhow::Result<u64> {
    write_and_rename(&args.out, |out| write_hits(hits, out)).with_context(|| format!("cannot write {}", args.out.display()))?;
    Ok(hits.iter().filter(|hit| hit.tree >= 0).count() as u64)
}

/// Rays that cannot follow others, and what to do.
fn refusal(args: &Args, why: FollowError) -> anyhow::Error {
    let off = "--follow false starts every ray at its own origin";
    match why {
        FollowError::NoStarts => anyhow::anyhow!("--method {}: {why} ({off})", args.method.0.method.name),
        _ => anyhow::anyhow!("{}: {why} ({off})", args.rays.display()),
    }
}
