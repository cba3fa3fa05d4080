//! `refit`: a scene with its vertices elsewhere, or one for each frame of a sequence.

use super::args::whole;
use super::build::finish;
use super::names::named;
use super::output::{busy, check_target, open, print_json, progress, remark};
use anyhow::{Context, ensure};
use lodray::format::{Grid, Refit, RefitOptions, Shading};
use lodray::mesh::{Motion, PositionFrames, read_positions};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Most frames of a sequence.
const MOST_FRAMES: u64 = 100_000;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// Where its vertices go, in the order in which export writes those of the finest level: a NumPy array (.npy) of vertices x 3 floats, or of frames x vertices x 3; or a mesh with these vertices (.obj, .ply)
    #[arg(required_unless_present = "motion", conflicts_with = "motion")]
    positions: Option<PathBuf>,
    /// A motion in place of POSITIONS; each comes back after a time of 1
    #[arg(long, value_parser = named::<Motion>())]
    motion: Option<Motion>,
    /// The time of the motion, or of its first frame
    #[arg(long, default_value_t = 0.0, value_parser = time, requires = "motion", allow_negative_numbers = true)]
    time: f64,
    /// So many frames of the motion, a K-th of its time apart, each a file of its own
    #[arg(long, value_name = "K", requires = "motion", value_parser = whole::<u32>(1..=MOST_FRAMES), allow_negative_numbers = true)]
    frames: Option<u32>,
    /// Shading normals
    #[arg(long, value_parser = named::<Shading>(), default_value = Shading::default().name())]
    normals: Shading,
    /// Where units of coordinates lie
    #[arg(long, value_parser = named::<Grid>(), default_value = Grid::default().name())]
    grid: Grid,
    /// Scene file to write; of a sequence each has the frame's number behind its name: -o a.lod writes a-00000.lod, a-00001.lod, ...
    #[arg(short, long)]
    out: PathBuf,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    // clap drops `requires` where the two arguments conflict.
    anyhow::ensure!(args.frames.is_none() || args.motion.is_some(), "--frames: goes with --motion; POSITIONS have frames of their own");
    let inputs: Vec<&Path> = std::iter::once(&args.scene).chain(&args.positions).map(PathBuf::as_path).collect();
    check_target(&args.out, &inputs)?;
    let scene = open(&args.scene)?;
    let read = match &args.positions {
        Some(path) => Some(busy("reading", || read_positions(path))?),
        None => None,
    };
    let name = || args.positions.as_ref().unwrap_or(&args.scene).display().to_string();
    let mut refit = busy("preparing", || scene.refitting()).with_context(|| args.scene.display().to_string())?;
    drop(scene);
    let options = RefitOptions { shading: args.normals, grid: args.grid };
    let frames = Frames::new(args, read, &refit).with_context(name)?;
    let Some(count) = frames.sequence else {
        busy("refitting", || refit.move_to(&frames.at(0), options)).with_context(name)?;
        return finish(refit.scene(), &args.out, args.json);
    };
    let outs: Vec<PathBuf> = (0..count).map(|frame| numbered(&args.out, frame)).collect();
    for out in &outs {
        check_target(out, &inputs)?;
    }
    let bar = progress(count as u64, "refitting");
    for (frame, out) in outs.iter().enumerate() {
        refit.move_to(&frames.at(frame), options).with_context(|| format!("{}: frame {frame}", name()))?.save(out)?;
        bar.inc(1);
    }
    bar.finish_and_clear();
    if args.json {
        print_json(&serde_json::json!({ "frames": count, "files": outs }))?;
        return Ok(ExitCode::SUCCESS);
    }
    let last = outs.last().map_or_else(String::new, |last| format!(" to {}", last.display()));
    remark(&format!("{count} frames: {}{last}", outs[0].display())).map(|()| ExitCode::SUCCESS)
}

/// Where vertices are, frame by frame.
struct Frames {
    /// How many, if they are a sequence.
    sequence: Option<usize>,
    /// Of all frames; at rest, of a motion.
    positions: Vec<[f64; 3]>,
    /// How many make a frame.
    vertices: usize,
    motion: Option<(Motion, f64)>,
}

impl Frames {
    fn new(args: &Args, read: Option<PositionFrames>, refit: &Refit) -> anyhow::Result<Self> {
        let vertices = refit.vertices();
        if let Some(motion) = args.motion {
            let sequence = args.frames.map(|frames| frames as usize);
            return Ok(Self { sequence, positions: refit.positions(), vertices, motion: Some((motion, args.time)) });
        }
        // clap has seen that they are there.
        let PositionFrames { positions, vertices: found, is_sequence } = read.context("positions are needed")?;
        ensure!(
            found == vertices,
            "{found} positions, but the finest level of {} has {vertices} vertices (lodray export writes them in their order)",
            args.scene.display()
        );
        Ok(Self { sequence: is_sequence.then_some(positions.len() / vertices), positions, vertices, motion: None })
    }

    fn at(&self, frame: usize) -> Cow<'_, [[f64; 3]]> {
        match self.motion {
            Some((motion, start)) => {
                let time = start + frame as f64 / self.sequence.unwrap_or(1) as f64;
                Cow::Owned(motion.at(&self.positions, time))
            }
            None => Cow::Borrowed(&self.positions[frame * self.vertices..][..self.vertices]),
        }
    }
}

/// The file of a frame.
fn numbered(out: &Path, frame: usize) -> PathBuf {
    let (stem, ending) = (out.file_stem().unwrap_or_default().to_string_lossy(), out.extension());
    let name = format!("{stem}-{frame:05}");
    out.with_file_name(match ending {
        Some(ending) => format!("{name}.{}", ending.to_string_lossy()),
        None => name,
    })
}

/// A time.
fn time(s: &str) -> Result<f64, String> {
    match s.parse::<f64>() {
        Ok(v) if v.abs() <= 1e9 => Ok(v),
        _ => Err(format!("'{s}' is not a time from -1e9 to 1e9")),
    }
}
