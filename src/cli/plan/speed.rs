//! How fast units must be: the frames of a job on a machine.

use crate::cli::args::{Change, Size};
use crate::cli::bars::Bars;
use crate::cli::machines::{machine, machine_files};
use crate::cli::output::{busy, progress};
use anyhow::Context;
use lodray::format::Scene;
use lodray::hardware::Hardware;
use lodray::plan::Speed;
use lodray::rays::{ModelSpace, RaySource, Sight};
use lodray::report::result::MachineFacts;
use lodray::run::{self, Compute, FrameRays, HeldFrame};
use lodray::study::{Cache, Chosen, ViewJob, count};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct SpeedArgs {
    /// Find by simulation how small the machine's traversal units can be for the views of --distance or --job; keeps all their frames in memory
    #[arg(long, conflicts_with = "check")]
    speed: bool,
    /// Frame rate to keep in every view, in percent of what the machine's memory allows
    #[arg(long, requires = "speed", value_name = "PERCENT", default_value = "95", value_parser = percent)]
    share: f64,
    /// Machine: the name of one that comes with the program, or a file
    #[arg(long, requires = "speed", value_name = "NAME|FILE", default_value = "haydel2023")]
    machine: String,
    /// Change a value of the machine, such as units.per_group=8, the most units that there can be; may be repeated
    #[arg(long, requires = "speed", value_name = "KEY=VALUE")]
    set: Vec<Change>,
    /// Size of the pictures that are simulated, in place of the job's
    #[arg(long, requires = "speed", value_name = "WxH", allow_hyphen_values = true)]
    speed_size: Option<Size>,
}

fn percent(s: &str) -> Result<f64, String> {
    s.parse().ok().filter(|&share: &f64| share > 0.0 && share <= 100.0).ok_or_else(|| format!("'{s}' is not above 0 and at most 100"))
}

/// The frames of a job, and the machine.
pub struct Frames<'a> {
    args: &'a SpeedArgs,
    machine: MachineFacts,
    frames: Vec<HeldFrame>,
}

impl SpeedArgs {
    /// Whether somebody wants to know.
    pub fn is_wanted(&self) -> bool {
        self.speed
    }

    /// The files that describe the machine, if somebody wants to know.
    pub fn files(&self) -> anyhow::Result<Vec<PathBuf>> {
        if !self.speed {
            return Ok(Vec::new());
        }
        let machine = machine(&self.machine, &self.set, "--set").with_context(|| format!("--machine {}", self.machine))?;
        Ok(machine_files(&self.machine, &machine)?)
    }

    /// Refuses a machine on which there are no frames; nothing if nobody wants to know.
    pub fn frames(&self) -> anyhow::Result<Option<Frames<'_>>> {
        if !self.speed {
            return Ok(None);
        }
        let of = || format!("--machine {}", self.machine);
        let machine = machine(&self.machine, &self.set, "--set").with_context(of)?;
        [Compute::Free, Compute::Units].into_iter().try_for_each(|compute| run::check(&machine.description, compute)).with_context(of)?;
        Ok(Some(Frames { args: self, machine, frames: Vec::new() }))
    }
}

impl Frames<'_> {
    /// Traces a view of a scene with a method.
    pub fn trace(&mut self, scene: &Scene, view: &ViewJob, chosen: &Chosen) -> anyhow::Result<()> {
        let (space, size) = (ModelSpace::of(scene), self.args.speed_size.map_or(view.size, |Size(width, height)| [width, height]));
        let camera = ViewJob { size, ..view.clone() }.frame(&space)?;
        let (method, _) = chosen.make(scene, &Cache::NONE, &Bars)?;
        let sight = Sight::new(&camera, &space, chosen.delta());
        let bar = progress(camera.batches() as u64, "tracing");
        let frame = FrameRays { method: &*method, rays: &camera, sight: &sight };
        self.frames.push(HeldFrame::of(&frame, &mut |traced| bar.inc(traced.batches.len() as u64)));
        bar.finish_and_clear();
        Ok(())
    }

    /// The units that are fast enough, in all else as `hardware`.
    pub fn speed(&self, hardware: &Hardware) -> anyhow::Result<Speed> {
        let (machine, share) = (&self.machine, self.args.share / 100.0);
        let find = || Speed::found(&self.frames, &machine.description, &machine.title(), share, hardware);
        Ok(busy("simulating smaller and smaller units", find)?)
    }
}

/// What was found, in words.
pub fn words(speed: &Speed) -> String {
    let percent = |share: f64| format!("{:.1} %", 100.0 * share);
    let Speed { frames, frames_of_units, .. } = speed;
    let frames = count(*frames as u64, "frame");
    let memory = match frames_of_units {
        0 => format!("{} or more of the frame rate that the memory allows", percent(speed.kept)),
        _ => format!(
            "in {frames_of_units} the machine's own units keep less than {} of what the memory allows and are the measure; {} or more of the measure, {} or more of the memory's frame rate",
            percent(speed.share),
            percent(speed.kept),
            percent(speed.kept_of_memory)
        ),
    };
    format!("speed: on {}, {frames}: {memory}", speed.machine)
}
