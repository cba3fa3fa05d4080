//! `compare`: two results of simulations side by side.

use super::output::{print_json, print_table, read_text};
use super::simulate::amount;
use crate::cli::bars::Bars;
use anyhow::Context;
use lodray::report::result::SimResult;
use lodray::study::{count, grouped, results};
use serde::Serialize;
use std::path::Path;
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Result of simulate, or a line of results.jsonl; FILE:N is the N-th of several
    #[arg(value_name = "FILE[:N]")]
    a: String,
    /// What to compare it with
    #[arg(value_name = "FILE[:N]")]
    b: String,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

/// A figure of both.
#[derive(Serialize)]
struct Figure {
    name: &'static str,
    a: f64,
    b: f64,
    /// B over A; none where A is 0.
    ratio: Option<f64>,
}

#[derive(Serialize)]
struct Report {
    a: String,
    b: String,
    figures: Vec<Figure>,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let (a, b) = (read(&args.a)?, read(&args.b)?);
    let (unit_a, unit_b) = (&a.energy.unit, &b.energy.unit);
    anyhow::ensure!(unit_a == unit_b, "energies of {} are in {unit_a}, of {} in {unit_b}: they cannot be compared", args.a, args.b);
    let report = Report { a: title(&a), b: title(&b), figures: figures(&a, &b) };
    if args.json {
        print_json(&report)?
    } else {
        print_table(&table(&report, unit_a))?
    }
    Ok(ExitCode::SUCCESS)
}

/// The result that `what` names.
fn read(what: &str) -> anyhow::Result<SimResult> {
    let numbered = what.rsplit_once(':').and_then(|(path, n)| Some((path, Some(n.parse::<usize>().ok()?))));
    let (path, wanted) = numbered.filter(|_| !Path::new(what).exists()).unwrap_or((what, None));
    let text = read_text(Path::new(path))?;
    let mut results = results(&text, path, &Bars).with_context(|| format!("{path}: not results of a simulation"))?;
    let among = results.len();
    let has = || format!("{path}: has {}", count(among, "result"));
    let number = match (wanted, among) {
        (Some(n), _) => n,
        (None, 1) => 1,
        (None, _) => anyhow::bail!("{}; name one, such as {path}:1", has()),
    };
    anyhow::ensure!((1..=among).contains(&number), "{}, no number {number}", has());
    results.swap_remove(number - 1).map(|found| found.result).with_context(|| format!("{path}: job {number} failed, it has no result"))
}

fn title(r: &SimResult) -> String {
    let setup = &r.setup;
    let delta = setup.method.delta.map_or_else(String::new, |delta| format!(" at delta {delta}"));
    let (method, compute) = (&setup.method.name, setup.compute.name());
    format!("{}, {method}{delta}, {}, {}, compute {compute}", setup.scene.name, setup.rays_in_words(), setup.machine.title())
}

fn figures(a: &SimResult, b: &SimResult) -> Vec<Figure> {
    let of = |name, value: &dyn Fn(&SimResult) -> f64| {
        let (a, b) = (value(a), value(b));
        Figure { name, a, b, ratio: (a != 0.0).then(|| b / a) }
    };
    vec![
        of("milliseconds", &|r| r.milliseconds),
        of("cycles", &|r| r.cycles as f64),
        of("L1 accesses", &|r| r.l1.requests as f64),
        of("L2 accesses", &|r| r.l2.requests as f64),
        of("DRAM accesses", &|r| (r.dram.reads + r.dram.writes) as f64),
        of("accesses per ray", &|r| r.accesses_per_ray),
        of("bytes per ray, L1", &|r| r.traffic.bytes_per_ray.l1),
        of("bytes per ray, L2", &|r| r.traffic.bytes_per_ray.l2),
        of("bytes per ray, DRAM", &|r| r.traffic.bytes_per_ray.dram),
        of("energy", &|r| r.energy.total),
        of("energy, L1", &|r| r.energy.l1.total),
        of("energy, L2", &|r| r.energy.l2.total),
        of("energy, DRAM", &|r| r.energy.dram.total),
        of("energy, compute", &|r| r.energy.compute.total),
        of("energy, leakage", &|r| r.energy.leakage.total),
    ]
}

/// A count, or another figure.
fn figure(value: f64) -> String {
    if value.fract() == 0.0 { grouped(value as u64) } else { amount(value) }
}

fn table(r: &Report, unit: &str) -> String {
    let mut text = format!("A: {}\nB: {}\nenergies in {unit}\n\n{:<22}{:>14}{:>14}{:>10}\n", r.a, r.b, "", "A", "B", "B / A");
    for f in &r.figures {
        let ratio = f.ratio.map_or_else(|| "-".to_owned(), |ratio| format!("{ratio:.3}"));
        text += &format!("{:<22}{:>14}{:>14}{ratio:>10}\n", f.name, figure(f.a), figure(f.b));
    }
    text.trim_end().to_owned()
}
