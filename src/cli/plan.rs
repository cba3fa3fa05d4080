//! `plan`: what scenes and a job need of a traversal unit, and what can be left out.

use super::method::Chosen;
use super::output::{busy, check_target, open, print_json, print_line, remark, write_file};
use super::sweep::{Jobs, ListText, SceneJobs};
use anyhow::Context;
use lodray::format::JobView;
use lodray::hardware::Hardware;
use lodray::plan::{Data, Measure, Part, Plan, RayNeeds, Reach, Saving, savings};
use lodray::rays::ModelSpace;
use serde::Serialize;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Scene files that one unit is to serve, with any rays
    #[arg(required_unless_present = "job", conflicts_with = "job")]
    scenes: Vec<PathBuf>,
    /// What will be done: a list of jobs as for sweep, of which the scenes, the cameras and the qualities of lod count
    #[arg(long, value_name = "LIST")]
    job: Option<PathBuf>,
    /// Write the plan (TOML) to this file
    #[arg(short, long)]
    out: Option<PathBuf>,
    /// Write rtl/lod_pkg.sv of the unit to this file: with it in place of the other, the RTL is that unit
    #[arg(long, value_name = "FILE", conflicts_with = "check")]
    package: Option<PathBuf>,
    /// Check the scenes (and the job's rays) against this plan in place of making one
    #[arg(long, value_name = "PLAN", conflicts_with = "out")]
    check: Option<PathBuf>,
    /// Print the plan and what it saves as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Serialize)]
struct Document<'a> {
    plan: &'a Plan,
    data: &'a Data,
    savings: &'a [Saving],
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let inputs: Vec<&Path> = args.scenes.iter().chain(&args.job).map(PathBuf::as_path).collect();
    for out in args.out.iter().chain(&args.package) {
        check_target(out, &inputs)?;
    }
    let jobs = args.job.as_deref().map(Jobs::read).transpose()?;
    let given = args.check.as_deref().map(read).transpose()?;
    let (plan, data) = made(&args.scenes, jobs.as_ref(), given.as_ref())?;
    if given.is_some() {
        let scenes = plan.scenes.len();
        remark(&format!("{scenes} {} the plan", if scenes == 1 { "scene fits" } else { "scenes fit" }))?;
        return Ok(ExitCode::SUCCESS);
    }
    let savings = savings(&plan, &Hardware::default(), Some(&data));
    if args.json {
        print_json(&Document { plan: &plan, data: &data, savings: &savings })?;
    } else {
        print_line(&table(&savings))?;
    }
    if let Some(out) = &args.out {
        write_file(out, toml::to_string(&plan)?)?;
        remark(&format!("plan in {}", out.display()))?;
    }
    if let Some(package) = &args.package {
        write_file(package, plan.hardware(&Hardware::default()).package())?;
        remark(&format!("the RTL's sizes in {}", package.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// A plan from its file.
pub fn read(path: &Path) -> anyhow::Result<Plan> {
    let text = std::fs::read_to_string(path).with_context(|| format!("cannot read {}", path.display()))?;
    ListText { path, text: &text }.parse()
}

/// The plan of all scenes, or of all scenes of a list and their views; each is checked against the plan that was given.
fn made(files: &[PathBuf], jobs: Option<&Jobs>, given: Option<&Plan>) -> anyhow::Result<(Plan, Data)> {
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
    for file in files {
        let scene = open(file)?;
        let measure = busy("measuring", || Measure::of(&scene));
        add(&file.display().to_string(), &measure, &scene.depths())?;
    }
    let mut rays = Vec::new();
    let mut all_views = Vec::new();
    for job in jobs.iter().flat_map(|jobs| &jobs.scenes) {
        let scene = job.open()?;
        let measure = busy("measuring", || Measure::of(&scene));
        let reach = Reach::of(&scene);
        let (needs, views) = views(job, jobs.map_or(&[], |jobs| jobs.methods.as_slice()), &measure, &reach, &ModelSpace::of(&scene))?;
        given.map_or(Ok(()), |given| given.check_rays(&format!("the job of scene {}", job.name), &needs))?;
        add(&job.name, &measure, &reach.depths())?;
        rays.push(needs);
        all_views.extend(views.into_iter().map(|view| (scene.meta().name.clone(), view)));
    }
    rays.iter().for_each(|needs| plan.add_rays(needs));
    all_views.into_iter().for_each(|(name, view)| plan.add_view(&name, view));
    Ok((plan, all.context("no scene to plan for")?))
}

/// What all views of a scene need, at all qualities of the list, and the views; `reach` learns how deep they go.
fn views(
    job: &SceneJobs,
    methods: &[Chosen],
    measure: &Measure,
    reach: &Reach,
    space: &ModelSpace,
) -> anyhow::Result<(RayNeeds, Vec<JobView>)> {
    let lod: Vec<_> = methods.iter().filter(|chosen| chosen.method.name == "lod").collect();
    anyhow::ensure!(!lod.is_empty(), "the list of jobs has no job of lod");
    let (mut needs, mut views) = (RayNeeds::default(), Vec::new());
    for view in &job.views {
        let camera = view.camera(space).with_context(|| format!("scene {}", job.name))?;
        for chosen in &lod {
            needs = needs.with(&busy("measuring rays", || measure.rays(&camera, chosen.delta())));
            busy("looking at rays", || reach.add(&camera, chosen.delta()));
            views.push(camera.job_view(chosen.delta()));
        }
    }
    Ok((needs, views))
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
        rows.push([format!("  {}", line.what), line.needed.clone(), line.full.clone(), line.reason.to_owned(), saved.to_owned()]);
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
