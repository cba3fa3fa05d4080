//! `demo`: a built-in scene from three distances: what ours, the best BVH and discrete level of detail cost there, and what a traversal unit for these views can leave out.

use super::bars::Bars;
use super::folder::{Overrule, RunFolder, one_run};
use super::form::FormArgs;
use super::generate;
use super::machines::machine;
use super::output::{busy, print_json, print_table, remark, write_file};
use super::pictures::{error, levels as level_map};
use super::report;
use super::simulate::amount;
use anyhow::Context;
use lodray::format::Scene;
use lodray::hardware::{Hardware, unit_gates};
use lodray::mesh::FinestSurface;
use lodray::mesh::procedural::{Options, Scene as Procedural};
use lodray::method::{Method, bvh, discrete, lod, reference};
use lodray::picture::{FullResolution, Sheet, SurfaceError, save_png};
use lodray::plan::{Data, Measure, Plan, RayNeeds, Reach};
use lodray::rays::{Camera, ModelSpace, View};
use lodray::report::page::{Documents, Simulation};
use lodray::report::result::SimResult;
use lodray::run::Compute;
use lodray::scene::{Pass, PassRays, Target};
use lodray::study::{Cache, Chosen, Shot, count, grouped};
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

/// Terrain of 512 base triangles and 524,288 at full resolution: seconds to build, and far finer than the pictures.
const LEVELS: u32 = 5;
const DISTANCES: [(&str, f64); 3] = [("near", 0.6), ("middle", 2.0), ("far", 8.0)];
const SIDE: u32 = 512;
/// Quality of level of detail.
const QUALITY: f64 = 1.0;
const MACHINE: &str = "haydel2023";
/// Errors are measured in every second column and row.
const STRIDE: u32 = 2;
const TABLE: &str = "table.txt";
const SHEET: &str = "sheet.png";
const PAGE: &str = "report.html";

#[derive(clap::Args)]
pub struct Args {
    /// Folder for the table, a sheet of pictures and a page
    #[arg(short, long, default_value = "out/demo", long_help = one_run("Folder for the table, a sheet of pictures and a page"))]
    out: PathBuf,
    #[command(flatten)]
    overrule: Overrule,
    /// Print the table as JSON
    #[arg(long)]
    json: bool,
}

/// A method in a view.
#[derive(Serialize)]
struct Row {
    view: &'static str,
    distance: f64,
    method: String,
    microseconds: f64,
    energy_uj: f64,
    dram_bytes: u64,
    bytes_per_triangle: f64,
    /// 99 of 100 hits are nearer to the full-resolution surface, in pixels.
    error_pixels: f64,
}

/// The scene, and full resolution to hold everything against.
struct Stage {
    scene: Scene,
    space: ModelSpace,
    surface: FinestSurface,
}

/// What a method gave in a view.
struct Outcome {
    name: &'static str,
    shot: Shot,
    result: SimResult,
    error: f64,
}

impl Stage {
    fn outcome(&self, chosen: &Chosen, method: &dyn Method, camera: &Camera, truth: &Shot) -> anyhow::Result<Outcome> {
        let name = chosen.method.name;
        let shot = Shot::plain(method, &self.scene, &self.space, camera, QUALITY, (name, &Bars));
        let full = FullResolution { scene: &self.scene, space: &self.space, surface: &self.surface, pixels: &truth.frame.pixels };
        let error =
            SurfaceError::of(&self.scene, &shot.frame.pixels, &full, camera, STRIDE).surface.map_or(0.0, |error| error.percentile_99);
        let pass = Pass {
            scene: &self.scene,
            space: &self.space,
            registered: chosen.method,
            knobs: &chosen.knobs,
            method,
            rays: PassRays::Camera(*camera),
        };
        let target = Target { machine: machine(MACHINE, &[], "")?, compute: Compute::Free, window: None };
        let (result, _) = lodray::study::simulate(&pass, &[target], &Bars).pop().context("no result")??;
        Ok(Outcome { name, shot, result, error })
    }
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let folder = RunFolder::open(&args.out, [TABLE, SHEET, PAGE], &[], &args.overrule)?;
    let out = folder.staging();
    let options = Options { levels: Some(LEVELS), ..Options::new(Procedural::Terrain) };
    let scene = generate::make(&options, FormArgs::default())?;
    let surface = busy("full-resolution surface", || FinestSurface::new(&scene.decode()));
    let stage = Stage { space: ModelSpace::of(&scene), surface, scene };
    let (scene, space) = (&stage.scene, &stage.space);
    let make = |chosen: Chosen| chosen.make(scene, &Cache::NONE, &Bars).map(|(method, _)| (chosen, method));
    let truth = make(Chosen::plain(&reference::METHOD))?.1;
    let whole = [&lod::METHOD, &bvh::METHOD, &bvh::METHOD_SIX, &discrete::METHOD].map(|method| make(Chosen::plain(method)));
    let [ours, bvh, bvh6, rule] = whole;
    let (ours, bvhs, rule) = (ours?, [bvh?, bvh6?], rule?);
    let level = |level: u32| -> anyhow::Result<_> {
        let knobs = rule.0.knobs.clone().with(&discrete::LEVEL, &level.to_string())?;
        let method = rule.1.again(&knobs).context("no method of a level")?;
        Ok((Chosen { method: rule.0.method, knobs }, method))
    };
    let levels = (0..=LEVELS).map(level).collect::<anyhow::Result<Vec<_>>>()?;

    let (mut rows, mut simulations, mut sheet, mut rays) = (Vec::new(), Vec::new(), Sheet::default(), RayNeeds::default());
    let (measure, reach) = (Measure::of(scene), Reach::of(scene));
    for (view, distance) in DISTANCES {
        let camera = Camera::new(&View { distance: Some(distance), ..View::default() }, space, SIDE, SIDE)?;
        rays = rays.with(&measure.rays(&camera, QUALITY));
        reach.add(&camera, QUALITY);
        let full = Shot::plain(&*truth, scene, space, &camera, f64::INFINITY, ("full resolution", &Bars));
        let outcome = |(chosen, method): &(Chosen, Box<dyn Method>)| stage.outcome(chosen, &**method, &camera, &full);
        let own = outcome(&ours)?;
        let best = bvhs.iter().map(outcome).collect::<anyhow::Result<Vec<_>>>()?.into_iter().min_by_key(|bvh| bvh.result.cycles);
        let rule = outcome(&rule)?;
        let levels = levels.iter().map(outcome).collect::<anyhow::Result<Vec<_>>>()?;
        let near = levels.into_iter().filter(|level| level.error <= own.error).min_by_key(|level| level.result.cycles);
        sheet.add(&format!("{view}: ours"), &own.shot.image, None);
        for map in [level_map(&own.shot, scene.levels()), error(&own.shot, &full.image)] {
            sheet.add(&format!("{view}: {}", map.name), &map.image, Some(map.legend));
        }
        let chose = |outcome: &Outcome| {
            outcome.result.setup.method.choices.iter().map(|(name, value)| format!("{name} {value}")).collect::<String>()
        };
        let named = [
            Some((format!("ours, delta {QUALITY}"), own)),
            best.map(|best| (format!("best BVH ({})", best.name), best)),
            Some((format!("discrete, own rule ({})", chose(&rule)), rule)),
            near.map(|near| (format!("discrete, hindsight ({})", chose(&near)), near)),
        ];
        for (method, Outcome { result, error, .. }) in named.into_iter().flatten() {
            rows.push(row(view, distance, &method, &result, error, scene.finest_triangles()));
            simulations.push(Simulation { scene: Some(format!("terrain, {view}")), result, image: None });
        }
    }

    let mut plan = Plan::new(true);
    plan.add(&scene.meta().name, &measure.needs());
    plan.add_rays(&rays);
    let table = format!("{}\n\n{}\n\n{}", table(&rows, scene), sentence(&rows), saving(&plan, &measure.data(&reach.depths())));
    write_file(&out.join(TABLE), format!("{table}\n"))?;
    let heading = format!("terrain, {} triangles, ours at delta {QUALITY}, {SIDE}x{SIDE}", grouped(scene.finest_triangles()));
    save_png(&sheet.draw(&heading, &[]), &[], &out.join(SHEET)).with_context(|| format!("cannot write {SHEET}"))?;
    report::save(&out.join(PAGE), &report::titled(Documents { simulations, runs: vec![report::this_run(&[])?], ..Documents::default() }))?;
    folder.finish()?;
    if args.json {
        print_json(&rows)?
    } else {
        print_table(&table)?;
        remark(&format!("table, sheet of pictures and page in {}", args.out.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn row(view: &'static str, distance: f64, method: &str, result: &SimResult, error: f64, triangles: u64) -> Row {
    Row {
        view,
        distance,
        method: method.to_owned(),
        microseconds: 1e3 * result.milliseconds,
        energy_uj: result.energy.total,
        dram_bytes: result.dram.bytes,
        bytes_per_triangle: result.setup.method.bytes as f64 / triangles as f64,
        error_pixels: error,
    }
}

fn table(rows: &[Row], scene: &Scene) -> String {
    let mut text = format!(
        "terrain, {} triangles; frames of {SIDE}x{SIDE} on {MACHINE}, compute free\n{:<7}{:>6}  {:<34}{:>9}{:>12}{:>10}{:>16}{:>15}\n",
        grouped(scene.finest_triangles()),
        "view",
        "radii",
        "method",
        "time, us",
        "energy, uJ",
        "DRAM, KB",
        "bytes/triangle",
        "error, pixels"
    );
    for r in rows {
        text += &format!(
            "{:<7}{:>6}  {:<34}{:>9}{:>12}{:>10}{:>16.1}{:>15.2}\n",
            r.view,
            r.distance,
            r.method,
            amount(r.microseconds),
            amount(r.energy_uj),
            grouped(r.dram_bytes / 1000),
            r.bytes_per_triangle,
            r.error_pixels
        );
    }
    text.trim_end().to_owned()
}

/// What the table shows, in one sentence.
fn sentence(rows: &[Row]) -> String {
    let times = |begin: &str| {
        let of =
            |view: &str, begin: &str| rows.iter().find(|row| row.view == view && row.method.starts_with(begin)).map(|row| row.microseconds);
        let over = |(view, _): (&str, f64)| match (of(view, begin), of(view, "ours")) {
            (Some(theirs), Some(ours)) => format!("{:.2}", theirs / ours),
            _ => "-".to_owned(),
        };
        DISTANCES.map(over).join(" / ")
    };
    format!(
        "Near / middle / far, times over ours: the best BVH {}, discrete level of detail by its own rule {}, and by the level that nobody knows before the frame, the cheapest with no more error than ours, {}.",
        times("best BVH"),
        times("discrete, own rule"),
        times("discrete, hindsight")
    )
}

/// What a unit for the views can leave out, and what of the scene they do not read.
fn saving(plan: &Plan, data: &Data) -> String {
    let (full, own) = (Hardware::default(), plan.hardware(&Hardware::default()));
    let gates = |hardware: &Hardware| lod::METHOD.unit.and_then(|unit| unit_gates(unit, hardware)).map_or(0, |gates| gates.round() as u64);
    let (of, needed) = (gates(&full), gates(&own));
    format!(
        "a traversal unit for these views needs {} of {} levels, {} of {} nodes on a path, {} of {} stack entries\n\
         without the rest its {} are smaller: {} of {} gate equivalents, {} fewer\n\
         their rays go down to level {} at most and read no more than {} of the scene's {} bytes, {} fewer",
        own.levels,
        full.levels,
        own.bvh_depth,
        full.bvh_depth,
        own.stack_entries(),
        full.stack_entries(),
        count(full.contexts, "context"),
        grouped(needed),
        grouped(of),
        grouped(of - needed),
        plan.rays.as_ref().map_or(0, |rays| rays.deepest_level),
        grouped(data.reached),
        grouped(data.stored),
        grouped(data.stored - data.reached)
    )
}
