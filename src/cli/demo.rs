//! `demo`: a built-in scene from three distances, LOD beside BVH and full resolution, and what a traversal unit for these views can leave out.

use super::build::{FormArgs, build_scene};
use super::cache::Cache;
use super::facts::Facts;
use super::folder::{Overrule, RunFolder, one_run};
use super::method::Chosen;
use super::output::{busy, count, grouped, print_json, print_table, remark, write_file};
use super::pictures::{Shot, shoot};
use super::render::{Against, Comparison, compare_shots};
use lodray::hardware::{Hardware, unit_gates};
use lodray::mesh::procedural::{Options, Scene, generate};
use lodray::method::knob::DELTA;
use lodray::method::{Registered, bvh, lod, reference};
use lodray::picture::Shading;
use lodray::plan::{Data, Measure, Plan, RayNeeds, Reach};
use lodray::rays::{Camera, ModelSpace, View};
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

/// Terrain of 512 base triangles and 524,288 at full resolution: seconds to build, and far finer than the pictures.
const LEVELS: u32 = 5;
const DISTANCES: [(&str, f64); 3] = [("near", 0.6), ("middle", 2.0), ("far", 8.0)];
const SIDE: u32 = 512;
/// Quality of level of detail.
const QUALITY: f64 = 1.0;
const TABLE: &str = "table.txt";
/// What a unit for the views needs.
const PLAN: &str = "plan.toml";
/// Pictures of each view.
const PICTURES: [&str; 8] = ["lod-image", "lod-levels", "lod-error", "bvh-image", "bvh-levels", "bvh-error", "full-image", "full-levels"];

#[derive(clap::Args)]
pub struct Args {
    /// Folder for pictures, table and plan
    #[arg(short, long, default_value = "out/demo", long_help = one_run("Folder for pictures, table and plan"))]
    out: PathBuf,
    #[command(flatten)]
    overrule: Overrule,
    /// Print the table as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Row {
    view: &'static str,
    distance: f64,
    method: &'static str,
    distinct_lines: u64,
    lines_per_ray: f64,
    nodes_per_ray: f64,
    triangles_per_ray: f64,
    mean_level: f64,
    error: Comparison,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let pictures = DISTANCES.iter().flat_map(|(view, _)| PICTURES.map(|picture| format!("{view}-{picture}.png")));
    let names: Vec<_> = pictures.chain([TABLE, PLAN].map(str::to_owned)).collect();
    let folder = RunFolder::open(&args.out, names.iter().map(String::as_str), &[], &args.overrule)?;
    let out = folder.staging();
    let options = Options { levels: Some(LEVELS), ..Options::new(Scene::Terrain) };
    let surface = busy("generating", || generate(&options))?;
    let scene = build_scene(&surface, "terrain", serde_json::json!({ "generate": options }), FormArgs::default())?;
    let space = ModelSpace::of(&scene);
    let methods: [&Registered; 3] = [&lod::METHOD, &bvh::METHOD, &reference::METHOD];
    let made = methods.iter().map(|method| Chosen::plain(method).make(&scene, &Cache::NONE)).collect::<anyhow::Result<Vec<_>>>()?;

    let (mut rows, mut rays) = (Vec::new(), RayNeeds::default());
    let (measure, reach) = (Measure::of(&scene), Reach::of(&scene));
    for (view, distance) in DISTANCES {
        let camera = Camera::new(&View { distance: Some(distance), ..View::default() }, &space, SIDE, SIDE)?;
        rays = rays.with(&measure.rays(&camera, QUALITY));
        reach.add(&camera, QUALITY);
        let shots: Vec<_> =
            methods.iter().zip(&made).map(|(method, (made, _))| shoot(&**made, &scene, &space, &camera, QUALITY, method.name)).collect();
        let full = &shots[2];
        for (method, shot) in methods.iter().zip(&shots) {
            let is_truth = *method == &reference::METHOD;
            let error = (!is_truth).then(|| compare_shots(shot, full, &scene, &camera));
            let facts = Facts {
                scene: &scene.meta().name,
                method: method.name,
                delta: method.has(DELTA.name).then_some(QUALITY),
                choices: &[],
                shading: (Shading::Full, 1),
                camera: &camera,
                stats: &shot.stats,
                error: error.as_ref().map(|error| (Against::FullResolution, error)),
            };
            let prefix = format!("{view}-{}-", if is_truth { "full" } else { method.name });
            shot.save(out, &prefix, &facts)?;
            shot.levels(&scene).save(out, &prefix, &facts)?;
            if let Some(error) = &error {
                shot.error(&full.image).save(out, &prefix, &facts)?;
                rows.push(row(view, distance, method.name, shot, error.clone()));
            }
        }
    }

    let mut plan = Plan::new(true);
    plan.add(&scene.meta().name, &measure.needs());
    plan.add_rays(&rays);
    let table = table(&rows, scene.finest_triangles()) + "\n\n" + &saving(&plan, &measure.data(&reach.depths()));
    write_file(&out.join(TABLE), format!("{table}\n"))?;
    write_file(&out.join(PLAN), toml::to_string(&plan)?)?;
    folder.finish()?;
    if args.json {
        print_json(&rows)?
    } else {
        print_table(&table)?;
        remark(&format!("pictures, table and plan in {}", args.out.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

fn row(view: &'static str, distance: f64, method: &'static str, shot: &Shot, error: Comparison) -> Row {
    let stats = &shot.stats;
    let mean = |n: u64| n as f64 / stats.rays as f64;
    Row {
        view,
        distance,
        method,
        distinct_lines: stats.distinct_lines(),
        lines_per_ray: mean(stats.lines_read()),
        nodes_per_ray: mean(stats.nodes),
        triangles_per_ray: mean(stats.triangles),
        mean_level: stats.mean_level,
        error,
    }
}

fn table(rows: &[Row], triangles: u64) -> String {
    let mut text = format!(
        "terrain, {} triangles at full resolution, {SIDE}x{SIDE} rays; errors against full resolution\n{:<8}{:>9}{:>8}{:>16}{:>11}{:>11}{:>15}{:>12}{:>9}{:>10}{:>12}\n",
        grouped(triangles),
        "view",
        "distance",
        "method",
        "distinct lines",
        "lines/ray",
        "nodes/ray",
        "triangles/ray",
        "mean level",
        "RMSE",
        "PSNR",
        "pixels off"
    );
    for r in rows {
        text += &format!(
            "{:<8}{:>9}{:>8}{:>16}{:>11.2}{:>11.2}{:>15.2}{:>12.2}{:>9.3}{:>10}{:>12}\n",
            r.view,
            r.distance,
            r.method,
            grouped(r.distinct_lines),
            r.lines_per_ray,
            r.nodes_per_ray,
            r.triangles_per_ray,
            r.mean_level,
            r.error.image.rmse,
            r.error.image.psnr_db.map_or("inf".to_owned(), |p| format!("{p:.1} dB")),
            r.error.geometry_pixels.map_or("-".to_owned(), |g| format!("{:.3}", g.mean))
        );
    }
    text.trim_end().to_owned()
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
