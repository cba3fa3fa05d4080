//! `crack`: watertightness, measured.

use super::args::{MAX_RAYS, seed, whole};
use super::output::{busy, explain, open, print_json, print_table, progress};
use lodray::lab::crack::{Closedness, Row, closedness, measure};
use lodray::method::lod::LodImage;
use lodray::rays::ModelSpace;
use lodray::study::{count, grouped};
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file of a closed model
    scene: PathBuf,
    /// Number of rays
    #[arg(long, default_value_t = 10_000_000, value_parser = whole::<u64>(1..=MAX_RAYS), allow_negative_numbers = true)]
    rays: u64,
    /// Seed
    #[arg(long, default_value_t = 1, value_parser = seed(), allow_negative_numbers = true)]
    seed: u64,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let scene = open(&args.scene)?;
    let closed = closedness(scene.triangles());
    anyhow::ensure!(
        closed != Closedness::Open,
        "{}: the model has open borders, so crossings cannot be balanced; crack needs a closed model",
        args.scene.display()
    );
    let hierarchy = busy("decoding", || scene.decode());
    let bar = progress(args.rays, "shooting");
    let oriented = closed == Closedness::Oriented;
    let report = measure(&hierarchy, &LodImage::of(&scene), &ModelSpace::of(&scene), oriented, args.rays, args.seed, &|n| bar.inc(n));
    bar.finish_and_clear();

    if args.json {
        print_json(&report)?;
    } else {
        let mut text = format!(
            "{:<12}{:>14}{:>14}{:>14}{:>14}{:>8}{:>12}\n",
            "aimed at", "rays", "crossing", "axis-parallel", "mixed levels", "odd", "unbalanced"
        );
        for r in &report.rows {
            let name = format!("{:?}", r.target);
            let cells = [r.rays, r.crossing, r.axis_parallel, r.mixed_levels].map(grouped);
            text +=
                &format!("{name:<12}{:>14}{:>14}{:>14}{:>14}{:>8}{:>12}\n", cells[0], cells[1], cells[2], cells[3], r.odd, r.unbalanced);
        }
        let compared = if oriented { "front and back crossings compared" } else { "not consistently oriented: parity only" };
        text += &format!("{} misses or double hits in {} ({compared})", report.breaches(), count(report.rays(), "ray"));
        if let Some(number) = report.first_breach {
            text += &format!("; the first is ray {number} of seed {}", args.seed);
        }
        let count = |f: fn(&Row) -> u64| report.rows.iter().map(f).sum::<u64>();
        if count(|r| r.crossing) == 0 {
            text += "\nwarning: no ray met the surface, so nothing was shown";
        } else if scene.levels() > 1 && count(|r| r.mixed_levels) == 0 {
            text += "\nnote: all triangles met were of one level (a flat model?), so edge states did not differ";
        }
        print_table(&text)?;
        explain("crack")?;
    }
    Ok(if report.breaches() == 0 { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}
