//! `refit`: a scene with its vertices elsewhere, or one for each frame of a sequence.

use super::args::whole;
use super::build::finish;
use super::folder::with_named;
use super::names::named;
use super::output::{busy, check_target, open, print_json, progress, remark};
use anyhow::{Context, ensure};
use lodray::format::{Grid, Refit, RefitOptions, Shading};
use lodray::mesh::{Binding, MeshFormat, Motion, MovingMesh, PositionFrames, read_positions};
use std::borrow::Cow;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Most frames of a sequence.
const MOST_FRAMES: u64 = 100_000;

#[derive(clap::Args)]
pub struct Args {
    /// Scene file
    scene: PathBuf,
    /// Where its vertices go, in the order in which export writes those of the finest level: a NumPy array (.npy) of vertices x 3 floats, or of frames x vertices x 3; or a mesh with these vertices (.obj, .ply). Or the mesh that the scene was built from, with animations (.gltf, .glb): vertices move along with it
    #[arg(required_unless_present = "motion", conflicts_with = "motion")]
    positions: Option<PathBuf>,
    /// A motion in place of POSITIONS; each comes back after a time of 1
    #[arg(long, value_parser = named::<Motion>())]
    motion: Option<Motion>,
    /// The animation of a glTF file, by its name or its number from 0; the first by default
    #[arg(long, value_name = "NAME", conflicts_with = "motion")]
    clip: Option<String>,
    /// The time of the motion or, in seconds, of the animation, or of its first frame (default 0)
    #[arg(long, value_parser = time, allow_negative_numbers = true)]
    time: Option<f64>,
    /// So many frames of the motion or animation, a K-th of its time apart, each a file of its own
    #[arg(long, value_name = "K", value_parser = whole::<u32>(1..=MOST_FRAMES), allow_negative_numbers = true)]
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
    let is_moving = args.positions.as_ref().is_some_and(|path| matches!(MeshFormat::of(path), Some(MeshFormat::Gltf | MeshFormat::Glb)));
    for (option, is_given) in [("--frames", args.frames.is_some()), ("--time", args.time.is_some())] {
        ensure!(
            !is_given || is_moving || args.motion.is_some(),
            "{option}: goes with --motion or a glTF file; other POSITIONS have frames of their own"
        );
    }
    ensure!(args.clip.is_none() || is_moving, "--clip: goes with a glTF file");
    let inputs = with_named(&std::iter::once(&args.scene).chain(&args.positions).collect::<Vec<_>>());
    let inputs: Vec<&Path> = inputs.iter().map(PathBuf::as_path).collect();
    check_target(&args.out, &inputs)?;
    let scene = open(&args.scene)?;
    let read = match (&args.positions, args.motion) {
        (Some(path), _) if is_moving => Read::Moving(busy("reading", || MovingMesh::read(path))?),
        (Some(path), _) => Read::Given(busy("reading", || read_positions(path))?),
        (None, Some(motion)) => Read::Motion(motion),
        // clap has seen that one of them is there.
        (None, None) => anyhow::bail!("positions or a motion are needed"),
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

/// What says where vertices go.
enum Read {
    Given(PositionFrames),
    Motion(Motion),
    Moving(MovingMesh),
}

/// Where vertices are, frame by frame.
struct Frames {
    /// How many, if they are a sequence.
    sequence: Option<usize>,
    source: Source,
}

enum Source {
    /// Positions of all frames, and how many make one.
    Given(Vec<[f64; 3]>, usize),
    /// A motion of positions at rest, from a time on.
    Motion(Motion, Vec<[f64; 3]>, f64),
    /// An animation of a mesh that they are bound to, from a time on, and its duration.
    Moving { mesh: MovingMesh, binding: Binding, clip: usize, start: f64, duration: f64 },
}

impl Frames {
    fn new(args: &Args, read: Read, refit: &Refit) -> anyhow::Result<Self> {
        let (sequence, start) = (args.frames.map(|frames| frames as usize), args.time.unwrap_or(0.0));
        match read {
            Read::Motion(motion) => Ok(Self { sequence, source: Source::Motion(motion, refit.positions(), start) }),
            Read::Moving(mesh) => {
                let (clip, duration) = chosen(&mesh, args.clip.as_deref())?;
                let binding = busy("binding", || Binding::new(mesh.rest(), mesh.triangles(), &refit.positions()))?;
                if !args.json {
                    remark(&format!("vertices are at most {:.4} from the file's mesh at rest", binding.farthest()))?;
                }
                Ok(Self { sequence, source: Source::Moving { mesh, binding, clip, start, duration } })
            }
            Read::Given(PositionFrames { positions, vertices: found, is_sequence }) => {
                let vertices = refit.vertices();
                ensure!(
                    found == vertices,
                    "{found} positions, but the finest level of {} has {vertices} vertices (lodray export writes them in their order)",
                    args.scene.display()
                );
                let sequence = is_sequence.then_some(positions.len() / vertices);
                Ok(Self { sequence, source: Source::Given(positions, vertices) })
            }
        }
    }

    fn at(&self, frame: usize) -> Cow<'_, [[f64; 3]]> {
        let part = frame as f64 / self.sequence.unwrap_or(1) as f64;
        match &self.source {
            Source::Given(positions, vertices) => Cow::Borrowed(&positions[frame * vertices..][..*vertices]),
            Source::Motion(motion, rest, start) => Cow::Owned(motion.at(rest, start + part)),
            Source::Moving { mesh, binding, clip, start, duration } => Cow::Owned(binding.moved(&mesh.at(*clip, start + part * duration))),
        }
    }
}

/// The animation of that name or number, or the first, and how long it is.
fn chosen(mesh: &MovingMesh, clip: Option<&str>) -> anyhow::Result<(usize, f64)> {
    let clips: Vec<(&str, f64)> = mesh.clips().collect();
    let by_number = |name: &str| name.parse::<usize>().ok().filter(|&number| number < clips.len());
    let number = match clip {
        None => Some(0),
        Some(name) => clips.iter().position(|clip| clip.0 == name).or_else(|| by_number(name)),
    };
    let number = number.with_context(|| {
        let names: Vec<&str> = clips.iter().map(|clip| clip.0).collect();
        format!("--clip {}: no animation has this name; there are {}", clip.unwrap_or_default(), names.join(", "))
    })?;
    Ok((number, clips[number].1))
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
