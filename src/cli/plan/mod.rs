//! `plan`: what scenes and a job need of a traversal unit, and what can be left out.

mod speed;

use super::args::{Size, radii};
use super::output::{busy, check_target, is_same_target, open, print_json, print_line, print_table, read_text, remark, write_file};
use super::sweep::{ListText, open_scene, read_jobs};
use super::unit::{UnitFacts, gates};
use anyhow::Context;
use lodray::format::{Job, Scene};
use lodray::hardware::Hardware;
use lodray::method::knob::{DELTA, quality};
use lodray::method::{Knobs, lod};
use lodray::plan::{Data, Measure, Narrowest, Part, Plan, RayNeeds, Reach, Saving, Within, savings};
use lodray::rays::{Camera, ModelSpace, RaySource};
use lodray::study::{Chosen, Jobs, Origin, SceneJobs, ViewJob, count, grouped};
use serde::Serialize;
use speed::{Frames, SpeedArgs};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Scene files that one unit shall serve: for any rays, or for the views of --distance
    #[arg(required_unless_present_any = ["job", "plan"], conflicts_with = "job")]
    scenes: Vec<PathBuf>,
    /// List of jobs, as for sweep: its scenes, its cameras or the regions that they stay in, and its qualities of lod
    #[arg(long, value_name = "LIST")]
    job: Option<PathBuf>,
    /// Plan only for views from these distances in bounding radii, with commas; the camera looks as in render
    #[arg(long, value_name = "RADII", value_delimiter = ',', requires = "scenes", value_parser = radii, allow_hyphen_values = true)]
    distance: Vec<f64>,
    /// Picture size of these views in pixels
    #[arg(long, value_name = "WxH", requires = "distance", default_value = "1024x1024", allow_hyphen_values = true)]
    size: Size,
    #[arg(long, help = DELTA.help, requires = "distance", default_value = "1", value_parser = quality, allow_hyphen_values = true)]
    delta: f64,
    /// Also find the coarsest grids of coordinates and directions that move nothing seen by more than this; `prune` puts scenes on them
    #[arg(long, value_name = "PIXELS", requires = "job", conflicts_with = "check", value_parser = pixels, allow_negative_numbers = true)]
    within: Option<f64>,
    /// Show this plan, or write its --package, instead of making one
    #[arg(long, value_name = "PLAN", conflicts_with_all = ["scenes", "job", "check", "out", "speed", "distance", "size", "delta", "within", "share", "machine", "set", "speed_size"])]
    plan: Option<PathBuf>,
    /// Write the plan (TOML) to this file
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Write the unit's rtl/lod_pkg.sv to this file; with it, rtl/ is that unit
    #[arg(long, value_name = "FILE", conflicts_with = "check")]
    package: Option<PathBuf>,
    /// Check the scenes against this plan instead of making one, and the rays of --job or --distance; without these the views that the plan has of a scene
    #[arg(long, value_name = "PLAN", conflicts_with_all = ["out", "json"])]
    check: Option<PathBuf>,
    #[command(flatten)]
    speed: SpeedArgs,
    /// Print the plan and what it saves as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Document<'a> {
    plan: &'a Plan,
    #[serde(skip_serializing_if = "Option::is_none")]
    data: Option<&'a Data>,
    savings: &'a [Saving],
    unit: UnitFacts,
    full_unit: UnitFacts,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let inputs: Vec<&Path> = args.scenes.iter().chain(&args.job).chain(&args.plan).map(PathBuf::as_path).collect();
    check_targets(args, &inputs)?;
    if let (Some(out), Some(package)) = (&args.out, &args.package) {
        anyhow::ensure!(!is_same_target(out, package), "--package {}: it is the file of the plan", package.display());
    }
    if let Some(path) = &args.plan {
        return say(args, &read(path)?, None);
    }
    let jobs = match &args.job {
        Some(list) => Some(read_jobs(list)?),
        None if args.distance.is_empty() => None,
        None => Some(seen(args)?),
    };
    let more: Vec<_> = jobs.iter().flat_map(|jobs| &jobs.files).chain(&args.speed.files()?).cloned().collect();
    check_targets(args, &more.iter().map(PathBuf::as_path).collect::<Vec<_>>())?;
    anyhow::ensure!(jobs.is_some() || !args.speed.is_wanted(), "--speed: give the views, with --distance or as a list with --job");
    let given = args.check.as_deref().map(read).transpose()?;
    let mut frames = args.speed.frames()?;
    let (mut plan, data) = made(args, jobs.as_ref(), given.as_ref(), frames.as_mut())?;
    if let Some(given) = &given {
        let scenes = plan.scenes.len();
        let rays = if given.rays.is_some() && plan.rays.is_some() { ", and so do the rays of the job" } else { "" };
        remark(&format!("{} {} the plan{rays}", count(scenes, "scene"), if scenes == 1 { "fits" } else { "fit" }))?;
        return Ok(ExitCode::SUCCESS);
    }
    plan.speed = frames.map(|frames| frames.speed(&plan.hardware(&Hardware::default()))).transpose()?;
    say(args, &plan, Some(&data))
}

/// Refuses outputs that cannot be written, or that are among `inputs`.
fn check_targets(args: &Args, inputs: &[&Path]) -> anyhow::Result<()> {
    args.out.iter().chain(&args.package).try_for_each(|out| check_target(out, inputs))
}

/// The scenes, seen from the distances of the command line.
fn seen(args: &Args) -> anyhow::Result<Jobs> {
    let Size(width, height) = args.size;
    let camera = |&distance: &f64| ViewJob::at([width, height], distance);
    let views: Vec<_> = args.distance.iter().map(camera).collect();
    let scene = |file: &PathBuf| SceneJobs {
        name: file.display().to_string(),
        origin: Origin::File(file.clone()),
        content: 0,
        has_mesh: false,
        views: views.clone(),
        regions: Vec::new(),
    };
    let knobs = Knobs::default().with(&DELTA, &args.delta.to_string())?;
    Ok(Jobs {
        scenes: args.scenes.iter().map(scene).collect(),
        methods: vec![Chosen { method: &lod::METHOD, knobs }],
        targets: Vec::new(),
        deltas: Vec::new(),
        error: false,
        intervals: false,
        files: args.scenes.iter().cloned().collect(),
    })
}

/// What all of a plan saves, and of which unit.
fn total(plan: &Plan) -> String {
    let (whose, full) = match &plan.speed {
        Some(speed) => (speed.machine.clone(), speed.own.config()),
        None => (format!("rtl/, with {} contexts", Hardware::default().contexts), Hardware::default()),
    };
    let (own, full) = (gates(&plan.hardware(&Hardware::default())), gates(&full));
    let less = 100.0 * (1.0 - own / full);
    format!(
        "a unit for this has {} of {} GE (gate equivalents): {less:.1} % less\nthan the unit of {whose}",
        grouped(own.round() as u64),
        grouped(full.round() as u64)
    )
}

/// Prints a plan and writes what was asked for.
fn say(args: &Args, plan: &Plan, data: Option<&Data>) -> anyhow::Result<ExitCode> {
    let savings = savings(plan, &Hardware::default(), data);
    if args.json {
        let full = plan.speed.as_ref().map_or(Hardware::default(), |speed| speed.own.config());
        let (unit, full_unit) = (UnitFacts::of(&plan.hardware(&Hardware::default())), UnitFacts::of(&full));
        print_json(&Document { plan, data, savings: &savings, unit, full_unit })?;
    } else {
        print_line(&total(plan))?;
        print_table(&table(&savings))?;
        plan.speed.iter().try_for_each(|speed| print_line(&speed::words(speed)))?;
    }
    if let Some(out) = &args.out {
        write_file(out, toml::to_string(plan)?)?;
        remark(&format!("plan in {}", out.display()))?;
    }
    if let Some(package) = &args.package {
        write_file(package, plan.hardware(&Hardware::default()).package())?;
        remark(&format!("the RTL's sizes in {}", package.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// A number of pixels.
pub fn pixels(s: &str) -> Result<f64, String> {
    s.parse().ok().filter(|v: &f64| *v > 0.0 && v.is_finite()).ok_or_else(|| format!("'{s}' is no number of pixels above 0"))
}

/// Refuses a scene or rays that a plan is too narrow for.
pub fn check(plan: &Plan, path: &Path, scene: &Scene, rays: &dyn RaySource, delta: f64) -> anyhow::Result<()> {
    let measure = busy("measuring", || Measure::of(scene));
    plan.check(&path.display().to_string(), &measure.needs())?;
    let mut needs = busy("measuring rays", || measure.rays(rays, delta));
    // What a ray can do in the whole model says less than what it can in each tree, and is found sooner.
    if plan.rays.is_some_and(|planned| needs.deepest_level > planned.deepest_level) {
        let reach = Reach::of(scene);
        busy("looking at rays", || reach.add(rays, delta));
        needs.deepest_level = reach.deepest();
    }
    plan.check_rays("the view", &needs)?;
    Ok(())
}

/// A plan from its file.
pub fn read(path: &Path) -> anyhow::Result<Plan> {
    let text = read_text(path)?;
    let plan: Plan = ListText { path, text: &text }.parse()?;
    plan.possible().with_context(|| path.display().to_string())?;
    Ok(plan)
}

/// The plan of all scenes, or of all scenes of a list and their views; each is checked against the plan that was given. The views are traced for `frames`.
fn made(args: &Args, jobs: Option<&Jobs>, given: Option<&Plan>, mut frames: Option<&mut Frames<'_>>) -> anyhow::Result<(Plan, Data)> {
    let mut within: Option<Within> = None;
    let mut plan = Plan::new(jobs.is_some());
    let mut all: Option<Data> = None;
    let mut add = |name: &str, measure: &Measure, depths: &[u32]| -> anyhow::Result<()> {
        let needs = measure.needs();
        given.map_or(Ok(()), |given| given.check(name, &needs))?;
        plan.add(name, &needs);
        let data = measure.data(depths);
        all = Some(all.map_or(data, |all| all.with(data)));
        Ok(())
    };
    for file in args.scenes.iter().filter(|_| jobs.is_none()) {
        let scene = open(file)?;
        let measure = busy("measuring", || Measure::of(&scene));
        add(&file.display().to_string(), &measure, &scene.depths())?;
        given.map_or(Ok(()), |given| check_own_views(given, file, &scene, &measure))?;
    }
    let mut rays = Vec::new();
    let mut jobs_of = Vec::new();
    for job in jobs.iter().flat_map(|jobs| &jobs.scenes) {
        let scene = open_scene(job)?;
        let measure = busy("measuring", || Measure::of(&scene));
        let lod = jobs.map_or_else(Vec::new, Jobs::lod);
        let reach = Reach::of(&scene);
        let (needs, of_job) = rays_of(job, &lod, &measure, &reach, &ModelSpace::of(&scene))?;
        given.map_or(Ok(()), |given| given.check_rays(&format!("the job of scene {}", job.name), &needs))?;
        add(&job.name, &measure, &reach.depths())?;
        rays.push(needs);
        jobs_of.push((scene.meta().name.clone(), of_job));
        if let Some(pixels) = args.within {
            let of = Within::of(&scene, &narrowest(job, &ModelSpace::of(&scene))?, pixels);
            within = Some(within.map_or(of, |within| within.with(of)));
        }
        if let Some(frames) = &mut frames {
            let each = job.views.iter().flat_map(|view| lod.iter().map(move |chosen| (view, chosen)));
            each.into_iter().try_for_each(|(view, chosen)| frames.trace(&scene, view, chosen))?;
        }
    }
    rays.iter().for_each(|needs| plan.add_rays(needs));
    for (name, of_job) in jobs_of {
        of_job.views.into_iter().for_each(|view| plan.add_view(&name, view));
        of_job.regions.into_iter().for_each(|region| plan.add_region(&name, region));
    }
    within.into_iter().for_each(|within| plan.coarsen(within));
    Ok((plan, all.context("no scene to plan for")?))
}

/// Checks the rays that a plan has of a scene, and says which they are.
fn check_own_views(given: &Plan, file: &Path, scene: &Scene, measure: &Measure) -> anyhow::Result<()> {
    if given.rays.is_none() {
        return Ok(());
    }
    let (shown, name) = (file.display(), &scene.meta().name);
    match given.job(name) {
        Some(job) => {
            given.check_rays(&format!("the plan's own job, on scene {shown},"), &needs_of(&job, measure, &Reach::of(scene))?)?;
            let parts = [(job.views.len(), "view"), (job.regions.len(), "region")].into_iter().filter(|&(n, _)| n > 0);
            let parts = parts.map(|(n, one)| count(n, one)).collect::<Vec<_>>().join(" and ");
            remark(&format!("{shown}: the rays of {parts} of the plan fit; others are not promised"))
        }
        None => remark(&format!(
            "{shown}: the plan has no views of a scene named {name}; no rays were checked: give them with --job or --distance"
        )),
    }
}

/// The narrowest cones of all rays of a scene's job.
fn narrowest(job: &SceneJobs, space: &ModelSpace) -> anyhow::Result<Narrowest> {
    let mut least = Narrowest::NONE;
    for view in &job.views {
        least = least.with(Narrowest::of(space, &view.camera(space).with_context(|| format!("scene {}", job.name))?));
    }
    for region in &job.regions {
        least = least.with(Narrowest::of_region(space, &region.at(1.0)));
    }
    Ok(least)
}

/// What all rays of a scene's job need, at all qualities of the list, and the job; `reach` learns how deep they go.
fn rays_of(job: &SceneJobs, lod: &[&Chosen], measure: &Measure, reach: &Reach, space: &ModelSpace) -> anyhow::Result<(RayNeeds, Job)> {
    anyhow::ensure!(!lod.is_empty(), "the list of jobs has no job of lod");
    let mut of_job = Job::default();
    for view in &job.views {
        let camera = view.camera(space).with_context(|| format!("scene {}", job.name))?;
        of_job.views.extend(lod.iter().map(|chosen| camera.job_view(chosen.delta())));
    }
    of_job.regions.extend(job.regions.iter().flat_map(|region| lod.iter().map(|chosen| region.at(chosen.delta()))));
    Ok((needs_of(&of_job, measure, reach)?, of_job))
}

/// What all rays of a job need.
fn needs_of(job: &Job, measure: &Measure, reach: &Reach) -> anyhow::Result<RayNeeds> {
    let mut needs = RayNeeds::default();
    for view in &job.views {
        let (camera, delta) = (Camera::of_job(view)?, view.quality().context("delta is no number")?);
        needs = needs.with(&busy("measuring rays", || measure.rays(&camera, delta)));
        busy("looking at rays", || reach.add(&camera, delta));
    }
    job.regions.iter().for_each(|region| reach.add_region(region));
    for region in &job.regions {
        needs = needs.with(&measure.region(region, reach.deepest()));
    }
    // What a ray can do in each tree says more than what it can in the whole model.
    needs.deepest_level = needs.deepest_level.min(reach.deepest());
    Ok(needs)
}

/// A line for each saving, in columns.
fn table(savings: &[Saving]) -> String {
    let mut rows = vec![["", "needed", "of", "", "saves"].map(str::to_owned)];
    let mut part: Option<Part> = None;
    for line in savings {
        if part.replace(line.part) != Some(line.part) {
            rows.push([format!("{:?}", line.part).to_lowercase(), String::new(), String::new(), String::new(), String::new()]);
        }
        let saved = if line.saved.is_empty() { "-" } else { &line.saved };
        rows.push([format!("  {}", line.what), line.needed.clone(), line.full.clone(), line.reason.clone(), saved.to_owned()]);
    }
    let width = |column: usize| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; 5] = std::array::from_fn(width);
    let row = |row: &[String; 5]| {
        let [what, needed, full, reason, saved] = row;
        let line = format!("{what:0$}  {needed:>1$}  {full:>2$}  {reason:3$}  {saved}", widths[0], widths[1], widths[2], widths[3]);
        line.trim_end().to_owned()
    };
    rows.iter().map(row).collect::<Vec<_>>().join("\n")
}
