//! `prune`: a scene without the levels that no ray of a plan's job goes down to, or on the coarser grids of a plan.

use super::output::{busy, check_target, open, print_json, print_line, print_table, remark};
use super::plan::read;
use anyhow::Context;
use lodray::bvh::over_trees;
use lodray::format::Scene;
use lodray::plan::{Reach, Within};
use lodray::rays::Camera;
use lodray::study::{count, grouped};
use serde::Serialize;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// Plan with views or regions of this scene (from lodray plan): the new file serves their rays, to the bit, and refuses others
    #[arg(long)]
    plan: PathBuf,
    /// Leave out shading normals too: enough for simulations; pictures of the new file are then refused
    #[arg(long)]
    no_normals: bool,
    /// File to write
    #[arg(short, long)]
    out: PathBuf,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

/// What was left out.
#[derive(Serialize)]
struct Figures {
    /// Views of the job.
    views: usize,
    regions: usize,
    trees: usize,
    /// Trees of each number of levels, from none on: before and after.
    depths: [Vec<usize>; 2],
    /// L0 records, splits and vertices: before and after, and for each full-resolution triangle.
    bytes: [u64; 2],
    bytes_per_finest_triangle: [f64; 2],
    /// Shading normals.
    bytes_of_normals: [u64; 2],
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    check_target(&args.out, &[&args.scene, &args.plan])?;
    let plan = read(&args.plan)?;
    let scene = open(&args.scene)?;
    if let Some(within) = plan.within {
        anyhow::ensure!(!args.no_normals, "--no-normals: goes with a plan that takes levels away; coarser grids keep normals");
        return coarser(args, &scene, within);
    }
    let name = &scene.meta().name;
    let shown = args.plan.display();
    anyhow::ensure!(
        plan.rays.is_some(),
        "{shown}: views: the plan is of no job, and a scene for any ray has no more levels than it needs (make it with lodray plan --job)"
    );
    let mut job = plan.job(name).with_context(|| {
        let names: BTreeSet<&str> = plan.views.keys().chain(plan.regions.keys()).map(String::as_str).collect();
        let names = names.into_iter().collect::<Vec<_>>().join(", ");
        format!("{shown}: views: the plan has none of a scene that is called {name}, but of: {names}")
    })?;
    job.unshaded = args.no_normals;
    let reach = Reach::of(&scene);
    for view in &job.views {
        let delta = view.quality().context("read as a number")?;
        let camera = Camera::of_job(view).with_context(|| format!("{shown}: views"))?;
        busy("looking at rays", || reach.add(&camera, delta));
    }
    job.regions.iter().for_each(|region| reach.add_region(region));
    let (views, regions) = (job.views.len(), job.regions.len());
    let pruned = reach.pruned(job)?;
    pruned.save(&args.out)?;
    let figures = Figures::of([views, regions], [&scene, &pruned]);
    if args.json {
        print_json(&figures)?;
    } else {
        print_table(&figures.table())?;
        remark(&format!("scene in {}", args.out.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// What coarser grids are, and how far they moved anything.
#[derive(Serialize)]
struct Coarser {
    coordinate_zeros: u32,
    direction_zeros: u32,
    /// Largest distance of a vertex from where the surface had it, in the scene's units of length: before and after.
    moved: [f64; 2],
}

/// The scene on a plan's grids: for any rays, as the levels that the job's need are known only on it.
fn coarser(args: &Args, scene: &Scene, within: Within) -> anyhow::Result<ExitCode> {
    anyhow::ensure!(
        scene.meta().is_whole(),
        "{}: levels were taken away for a job; coarser grids are for the scene as it was before",
        args.scene.display()
    );
    let Within { pixels, coordinate_zeros, direction_zeros } = within;
    let made = busy("encoding", || scene.coarsened([coordinate_zeros, direction_zeros], over_trees))?;
    made.save(&args.out)?;
    let figures = Coarser { coordinate_zeros, direction_zeros, moved: [scene.meta().moved, made.meta().moved] };
    if args.json {
        print_json(&figures)?;
    } else {
        let Coarser { moved: [before, after], .. } = figures;
        print_line(&format!(
            "{coordinate_zeros} zero bits of coordinates, {direction_zeros} of directions: nothing that the job sees moves by more than {pixels} pixels; no vertex is further than {after:.3e} from its place on the surface ({before:.3e} before)"
        ))?;
        remark(&format!("scene in {}; plan it again for its unit", args.out.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

impl Figures {
    fn of([views, regions]: [usize; 2], scenes: [&Scene; 2]) -> Self {
        Self {
            views,
            regions,
            trees: scenes[0].trees(),
            depths: scenes.map(Scene::trees_by_depth),
            bytes: scenes.map(|scene| scene.bytes_of(&scene.depths())),
            bytes_per_finest_triangle: scenes.map(Scene::bytes_per_triangle),
            bytes_of_normals: scenes.map(|scene| size_of_val(scene.normals()) as u64),
        }
    }

    fn table(&self) -> String {
        let [before, after] = self.bytes.map(grouped);
        let [per_before, per_after] = self.bytes_per_finest_triangle;
        let regions = if self.regions > 0 { format!(", {}", count(self.regions, "region")) } else { String::new() };
        let mut text = format!(
            "{}{regions}; bytes of trees {before} -> {after}; for each triangle at full resolution {per_before:.3} -> {per_after:.3}",
            count(self.views, "view")
        );
        if let [before, 0] = self.bytes_of_normals {
            text += &format!("\nno normals: {} bytes less", grouped(before));
        }
        let [before, after] = &self.depths;
        for (levels, (before, after)) in before.iter().zip(after).enumerate().filter(|(_, (a, b))| **a + **b > 0) {
            text += &format!("\n{:>10} -> {:>10} trees of {}", grouped(*before as u64), grouped(*after as u64), count(levels, "level"));
        }
        text
    }
}
