//! `prune`: a scene without the levels that no ray of a plan's job goes down to.

use super::output::{busy, check_target, grouped, open, print_json, print_line, remark};
use super::plan::read;
use anyhow::Context;
use lodray::format::Scene;
use lodray::plan::Reach;
use lodray::rays::Camera;
use serde::Serialize;
use std::path::PathBuf;
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// Plan of a job (from lodray plan --job): its views of this scene are those that the new file serves, to the bit; others it refuses
    #[arg(long)]
    plan: PathBuf,
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
    trees: usize,
    /// Trees of each number of levels, from none on: before and after.
    depths: [Vec<usize>; 2],
    /// L0 records, bounds and vertices: before and after, and for each full-resolution triangle.
    bytes: [u64; 2],
    bytes_per_finest_triangle: [f64; 2],
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    check_target(&args.out, &[&args.scene, &args.plan])?;
    let plan = read(&args.plan)?;
    let scene = open(&args.scene)?;
    let name = &scene.meta().name;
    let shown = args.plan.display();
    anyhow::ensure!(
        plan.rays.is_some(),
        "{shown}: views: the plan is of no job, and a scene for any ray has no more levels than it needs (make it with lodray plan --job)"
    );
    let views = plan.views.get(name).with_context(|| {
        let names = plan.views.keys().map(String::as_str).collect::<Vec<_>>().join(", ");
        format!("{shown}: views: the plan has none of a scene that is called {name}, but of: {names}")
    })?;
    let reach = Reach::of(&scene);
    for view in views {
        let delta = view.quality().with_context(|| format!("{shown}: views: delta '{}' is no number", view.delta))?;
        let camera = Camera::of_job(view).with_context(|| format!("{shown}: views"))?;
        busy("looking at rays", || reach.add(&camera, delta));
    }
    let (stored, depths) = (scene.depths(), reach.depths());
    // As it is, it serves any ray.
    let job = if depths == stored { Vec::new() } else { views.clone() };
    let pruned = scene.pruned(&depths, job)?;
    pruned.save(&args.out)?;
    let figures = Figures::of(views.len(), [&scene, &pruned]);
    if args.json {
        print_json(&figures)?;
    } else {
        print_line(&figures.table())?;
        remark(&format!("scene in {}", args.out.display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

impl Figures {
    fn of(views: usize, scenes: [&Scene; 2]) -> Self {
        Self {
            views,
            trees: scenes[0].trees(),
            depths: scenes.map(Scene::trees_by_depth),
            bytes: scenes.map(|scene| scene.bytes_of(&scene.depths())),
            bytes_per_finest_triangle: scenes.map(Scene::bytes_per_triangle),
        }
    }

    fn table(&self) -> String {
        let [before, after] = self.bytes.map(grouped);
        let [per_before, per_after] = self.bytes_per_finest_triangle;
        let mut text = format!(
            "{} views; bytes of trees {before} -> {after}; for each triangle at full resolution {per_before:.3} -> {per_after:.3}",
            self.views
        );
        let [before, after] = &self.depths;
        for (levels, (before, after)) in before.iter().zip(after).enumerate().filter(|(_, (a, b))| **a + **b > 0) {
            text += &format!("\n{:>10} -> {:>10} trees of {levels} levels", grouped(*before as u64), grouped(*after as u64));
        }
        text
    }
}
