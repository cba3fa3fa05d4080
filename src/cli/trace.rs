//! `trace`: one ray through the traversal unit, cycle by cycle.

use super::args::{CameraArgs, whole};
use super::output::{check_target, is_same_target, open_any, print_line, remark, write_file};
use super::plan;
use anyhow::Context;
use lodray::format::Scene;
use lodray::hardware::Hardware;
use lodray::hardware::ports::RayIn;
use lodray::method::knob::{DELTA, quality};
use lodray::method::lod::LodImage;
use lodray::num::{Ray, U, Wire};
use lodray::rays::{Camera, ModelSpace};
use lodray::sim::unit::environment::RunReport;
use lodray::sim::unit::ray_trace::RayTrace;
use lodray::sim::unit::wave::{Waves, gtkwave_save, one_ray, surfer_commands};
use lodray::sim::unit::{SceneMemory, TraversalUnit, file_config};
use lodray::study::{count, pruned};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::str::FromStr;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// Pixel whose ray is followed; 0,0 is the upper left one
    #[arg(long, value_name = "X,Y", allow_hyphen_values = true)]
    pixel: Place,
    #[arg(long, help = DELTA.help, default_value = "1", value_parser = quality, allow_hyphen_values = true)]
    delta: f64,
    #[command(flatten)]
    camera: CameraArgs,
    /// Cycles from a memory request to its answer
    #[arg(long, value_name = "CYCLES", default_value_t = 40, value_parser = whole::<u32>(1..=100_000), allow_negative_numbers = true)]
    memory_latency: u32,
    /// Waveform (VCD); save files for GTKWave and Surfer are written beside it; - is the same as --text
    #[arg(short, long, value_name = "FILE", required_unless_present_any = ["text", "ports"])]
    out: Option<PathBuf>,
    /// Use the unit of this plan (from lodray plan -o) instead of the full one
    #[arg(long)]
    plan: Option<PathBuf>,
    /// What goes over the unit's ports, as JSON: scene_i for the scene's file as memory, in_i, out_o
    #[arg(long, value_name = "FILE")]
    ports: Option<PathBuf>,
    /// Print each step: visits, memory lines, edge states, decisions
    #[arg(long)]
    text: bool,
}

/// A pixel, X,Y.
#[derive(Clone, Copy, Debug)]
struct Place(u32, u32);

impl FromStr for Place {
    type Err = String;
    fn from_str(s: &str) -> Result<Self, String> {
        let parts = s.split_once(',').and_then(|(x, y)| Some(Self(x.trim().parse().ok()?, y.trim().parse().ok()?)));
        parts.ok_or_else(|| format!("'{s}' is not a pixel such as 320,200: two whole numbers from 0"))
    }
}

/// The ray's unit.
struct Bench<'a> {
    memory: SceneMemory<'a>,
    latency: u32,
    ray: Ray,
    hardware: Hardware,
}

impl Bench<'_> {
    fn unit(&self) -> TraversalUnit {
        TraversalUnit::new(self.hardware, self.memory.config())
    }
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let scene = open_any(&args.scene)?;
    let space = ModelSpace::of(&scene);
    let camera = args.camera.camera(&space, None)?;
    pruned::check(&scene, &camera, args.delta)?;
    let Place(x, y) = args.pixel;
    let (width, height) = (camera.width, camera.height);
    anyhow::ensure!(
        x < width && y < height,
        "--pixel {x},{y}: outside of the picture of {width}x{height} pixels, the last of which is {},{} (see --size)",
        width - 1,
        height - 1
    );
    let file = args.out.as_deref().filter(|path| *path != Path::new("-"));
    let inputs: Vec<&Path> = std::iter::once(&args.scene).chain(&args.plan).map(PathBuf::as_path).collect();
    let files = file.map(|vcd| Files::beside(vcd, &inputs)).transpose()?;
    if let Some(path) = &args.ports {
        check_target(path, &inputs)?;
        let clash = files.as_ref().is_some_and(|files| files.all().iter().any(|of| is_same_target(of, path)));
        anyhow::ensure!(!clash, "cannot write {}: it is a file of the waveform", path.display());
    }
    let entered = space.enter(&camera.ray(x, y), args.delta);
    let ray = entered.with_context(|| format!("the ray of pixel {x},{y} misses the model's box, so the unit never gets it"))?.ray;

    // For one ray at a time.
    let hardware =
        Hardware { contexts: 1, ..args.plan.as_deref().map_or(Ok(Hardware::one_context()), |plan| planned(plan, args, &scene, &camera))? };
    let bench = Bench { memory: SceneMemory::new(LodImage::of(&scene), 0), latency: args.memory_latency, ray, hardware };
    if let Some(files) = files {
        let report = files.write(&bench)?;
        if !args.text {
            let (ray, requests) = (&report.rays[0], count(report.requests, "memory line"));
            let found = match ray.hit.error() {
                Some(error) => format!("ended early ({error})"),
                None if ray.hit.found => "hit".to_owned(),
                None => "miss".to_owned(),
            };
            remark(&format!("{found} after {}, {requests}; waveform in {}", count(ray.cycles(), "cycle"), files.vcd.display()))?;
        }
    }
    if let Some(path) = &args.ports {
        write_file(path, ports(&bench, &scene)?)?;
        remark(&format!("ports in {}", path.display()))?;
    }
    if args.text || (file.is_none() && (args.out.is_some() || args.ports.is_none())) {
        print_line(&text(&bench)?)?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The unit of a plan that the scene and the camera's rays fit.
fn planned(path: &Path, args: &Args, scene: &Scene, camera: &Camera) -> anyhow::Result<Hardware> {
    let plan = plan::read(path)?;
    plan::check(&plan, &args.scene, scene, camera, args.delta)?;
    Ok(plan.hardware(&Hardware::one_context()))
}

/// What goes over the ports of a unit whose memory holds the scene's file as it is, from line 0 on.
fn ports(bench: &Bench<'_>, scene: &Scene) -> anyhow::Result<String> {
    let report = one_ray(&mut bench.unit(), &bench.memory, bench.latency, &bench.ray)?;
    let ports = serde_json::json!({
        "scene_i": bits(&file_config(scene)),
        "in_i": bits(&RayIn { tag: U::default(), ray: bench.ray }),
        "out_o": bits(&report.rays[0].hit),
        "lines": report.requests,
    });
    Ok(serde_json::to_string_pretty(&ports)? + "\n")
}

/// A port's word: its width, and its bits as a hexadecimal number.
fn bits(word: &impl Wire) -> serde_json::Value {
    let bits = word.to_bits();
    let digits: String = bits.words().iter().rev().map(|word| format!("{word:016x}")).collect();
    let above = digits.len() - bits.width().div_ceil(4) as usize; // of whole words
    serde_json::json!({ "width": bits.width(), "bits": format!("0x{}", &digits[above..]) })
}

/// The ray's steps.
fn text(bench: &Bench<'_>) -> anyhow::Result<String> {
    let mut trace = RayTrace::new(bench.unit(), &bench.memory);
    let report = one_ray(&mut trace, &bench.memory, bench.latency, &bench.ray)?;
    let Ray { origin, direction, cone } = bench.ray;
    let mut text = format!(
        "ray from {:?} along {:?}, cone ({} + l {}) / 2^{}\n   cycle  step\n",
        origin.get(),
        direction.get(),
        cone.offset,
        cone.slope,
        cone.shift
    );
    for (cycle, step) in trace.events() {
        text += &format!("{cycle:>8}  {step}\n");
    }
    Ok(text + &format!("{}, {}", count(report.rays[0].cycles(), "cycle"), count(report.requests, "memory line")))
}

/// The waveform and its save files.
struct Files {
    vcd: PathBuf,
    gtkw: PathBuf,
    surfer: PathBuf,
}

impl Files {
    /// The files beside `vcd`, refused if they cannot be written.
    fn beside(vcd: &Path, inputs: &[&Path]) -> anyhow::Result<Self> {
        let with = |extension| vcd.with_extension(extension);
        let files = Self { vcd: vcd.to_owned(), gtkw: with("gtkw"), surfer: with("sucl") };
        for path in files.all() {
            check_target(path, inputs)?;
        }
        let clash = files.all().iter().skip(1).any(|path| *path == vcd);
        anyhow::ensure!(!clash, "cannot write {}: the ending is that of a save file; use .vcd", vcd.display());
        Ok(files)
    }

    fn all(&self) -> [&Path; 3] {
        [&self.vcd, &self.gtkw, &self.surfer]
    }

    fn write(&self, bench: &Bench<'_>) -> anyhow::Result<RunReport> {
        let mut waves = Waves::new(bench.unit())?;
        let report = one_ray(&mut waves, &bench.memory, bench.latency, &bench.ray)?;
        // GTKWave looks for files from the folder that it was started in.
        let gtkw = gtkwave_save(&std::path::absolute(&self.vcd)?.to_string_lossy(), waves.widths());
        let contents = [waves.finish()?, gtkw.into_bytes(), surfer_commands().into_bytes()];
        for (path, content) in self.all().into_iter().zip(contents) {
            write_file(path, &content)?;
        }
        Ok(report)
    }
}
