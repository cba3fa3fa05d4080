//! Options of `error-time`.

use crate::cli::args::{Change, Size, radii};
use crate::cli::cache::CacheArgs;
use crate::cli::folder::{Overrule, one_run};
use crate::cli::frames::TurnArgs;
use crate::cli::input::{InputArgs, mesh_of, with_input_if_found};
use crate::cli::machines::{machine, machine_files};
use crate::cli::method::{Listed, compared_methods, machine_methods};
use crate::cli::names::named;
use crate::cli::output::open;
use crate::cli::plan::pixels;
use crate::cli::render::shading;
use crate::cli::shard::ShardArgs;
use crate::cli::sweep::read_views;
use anyhow::{Context, ensure};
use lodray::format::Scene;
use lodray::method::{METHODS, lod};
use lodray::picture::{PIXELS_PER_DEGREE, Shading};
use lodray::rays::{MAX_SIDE, ModelSpace};
use lodray::run::{self, Compute};
use lodray::scene::Target;
use lodray::study::{Chosen, ErrorTimePlan, Jobs, Measure, Origin, SceneJobs, ViewJob, least_converged};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Display;
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::xxh3_64;

/// Eight distances, the nearest just outside of the model, in bounding radii.
const DISTANCES: [f64; 8] = [1.0, 1.5, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0];
const QUICK_DISTANCES: [f64; 3] = [2.0, 8.0, 32.0];
const FOLDER: &str = "Folder for error-time.json, .csv and .tex, diagrams, pictures and report.html; a run that is started again goes on with the views that are \
there (views.jsonl), if they are of the same version of the program";

#[derive(clap::Args)]
pub struct Args {
    /// Scene files
    #[arg(value_name = "SCENE", required_unless_present = "jobs")]
    scenes: Vec<PathBuf>,
    /// List of jobs (TOML) in place of scenes and the options of views, methods and machines: docs/jobs-example.toml shows every key
    #[arg(long, value_name = "LIST", conflicts_with_all = ["scenes", "distances", "size", "methods", "machine", "set", "compute"])]
    jobs: Option<PathBuf>,
    /// Folder for the figures, diagrams, pictures and the page
    #[arg(short, long, long_help = one_run(FOLDER))]
    pub out: PathBuf,
    #[command(flatten)]
    pub overrule: Overrule,
    /// Size of the frame whose costs are simulated, in pixels, which errors are in as well
    #[arg(long, value_name = "WxH", default_value = "1920x1080")]
    size: Size,
    /// Most columns and rows of the frame that errors and pictures use, evenly spaced (default 384; 192 with --quick)
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_SIDE)))]
    error_size: Option<u32>,
    /// Distances of the eye in bounding radii, with commas (default: eight from 1 to 64; 2, 8 and 32 with --quick)
    #[arg(long, value_name = "RADII", value_delimiter = ',', value_parser = radii)]
    distances: Vec<f64>,
    /// Methods, with commas (default: all that are hardware, but grids, binary16, clusters and R-LODs)
    #[arg(long, value_name = "METHOD", value_delimiter = ',', value_parser = method)]
    methods: Vec<Listed>,
    /// Values of a knob by which methods trade error for cost, such as delta=0.5,1,2, in place of their own sweep; may be repeated
    #[arg(long, value_name = "KNOB=VALUES", value_parser = values)]
    values: Vec<(String, Vec<String>)>,
    /// Machine: the name of one that comes with the program, or a file; several with commas
    #[arg(long, value_name = "NAME|FILE", value_delimiter = ',', default_value = "haydel2023")]
    machine: Vec<String>,
    /// Change a value of the machines, such as l1.bytes=32768; may be repeated
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<Change>,
    /// How compute is simulated, one or both with commas (default: both; free with --quick)
    #[arg(long, value_delimiter = ',', value_parser = named::<Compute>())]
    compute: Vec<Compute>,
    /// Samples of a pixel, squares, with commas (default: 1,4; 1 with --quick)
    #[arg(long, value_name = "N", value_delimiter = ',', value_parser = samples)]
    samples: Vec<u32>,
    /// Normals that pictures are shaded with
    #[arg(long, value_parser = shading(), default_value = Shading::default().name())]
    shading: Shading,
    /// Pixels of a degree of sight, as FLIP has it: 67 is a screen of 0.7 m and 3840 pixels from 0.7 m
    #[arg(long, value_name = "N", default_value_t = PIXELS_PER_DEGREE, value_parser = pixels_per_degree)]
    pixels_per_degree: f64,
    /// Most samples of a pixel of the picture that stands for what a viewer should see; 0 leaves such a picture and its errors out (default: 1024; 64 with --quick)
    #[arg(long, value_name = "N", value_parser = samples_or_none)]
    most_samples: Option<u32>,
    /// Also what scenes and units for a view cost in error with less in them: lossless, and on the coarsest grids on which nothing moves by more than each of so many
    /// pixels, with commas
    #[arg(long, value_name = "PIXELS", value_delimiter = ',', value_parser = pixels, allow_negative_numbers = true)]
    within: Vec<f64>,
    #[command(flatten)]
    turn: TurnArgs,
    /// Do not time the host
    #[arg(long)]
    no_host: bool,
    /// A first look: fewer distances, samples and values, smaller pictures, the same size of the frame
    #[arg(long)]
    quick: bool,
    #[command(flatten)]
    pub input: InputArgs,
    #[command(flatten)]
    pub cache: CacheArgs,
    #[command(flatten)]
    pub shard: ShardArgs,
}

fn method(name: &str) -> Result<Listed, String> {
    let known = || machine_methods().map(|method| method.name).collect::<Vec<_>>().join(", ");
    machine_methods().find(|method| method.name == name).map(Listed).ok_or_else(|| format!("'{name}' is none of {}", known()))
}

/// `KNOB=A,B,C` of a knob by which a method trades error.
fn values(s: &str) -> Result<(String, Vec<String>), String> {
    let (name, values) = s.split_once('=').ok_or_else(|| format!("'{s}' is not a knob with values such as delta=0.5,1,2"))?;
    let knobs: BTreeMap<_, _> = METHODS.iter().filter_map(|method| method.error).map(|error| (error.knob.name, error.knob)).collect();
    let names = || knobs.keys().copied().collect::<Vec<_>>().join(", ");
    let knob = knobs.get(name).ok_or_else(|| format!("no method trades error by '{name}'; there are: {}", names()))?;
    let values: Vec<String> = values.split(',').map(|value| value.trim().to_owned()).collect();
    values.iter().try_for_each(|value| knob.check(value)).map_err(|why| why.why)?;
    Ok((name.to_owned(), values))
}

/// Samples along a side, of so many in all.
fn side(s: &str, least: u32) -> Result<u32, String> {
    let number: Option<u32> = s.parse().ok();
    let side = number.map(u32::isqrt).filter(|side| Some(side * side) == number && (least..=256).contains(side));
    side.ok_or_else(|| format!("'{s}' is not a square of at most 65536, such as 1, 4, 16 or 64"))
}

fn samples(s: &str) -> Result<u32, String> {
    side(s, 1)
}

fn samples_or_none(s: &str) -> Result<u32, String> {
    side(s, 0)
}

fn pixels_per_degree(s: &str) -> Result<f64, String> {
    s.parse().ok().filter(|v| (1.0..=1000.0).contains(v)).ok_or_else(|| format!("'{s}' is not a number from 1 to 1000"))
}

/// Refuses what an option names twice: it would be measured twice.
fn once<T: PartialEq + Display>(option: &str, given: &[T]) -> anyhow::Result<()> {
    match given.iter().enumerate().find(|(k, value)| given[..*k].contains(value)) {
        Some((_, twice)) => anyhow::bail!("{option}: {twice} is given twice"),
        None => Ok(()),
    }
}

impl Args {
    /// A scene with the mesh that it was built from at hand, where that can be found. It must be there if methods over it were named.
    pub fn with_input(&self, scene: Scene, path: &str) -> anyhow::Result<Scene> {
        if self.methods.iter().any(|Listed(method)| method.of_input()) {
            let input = mesh_of(&scene, Path::new(path), &self.input)?;
            return Ok(scene.with_input(input));
        }
        let without = "errors are against the finest level, and no BVH is over the input mesh";
        with_input_if_found(scene, Path::new(path), &self.input, without)
    }

    /// What is to be measured; every mistake is found before anything is traced.
    pub fn plan(&self) -> anyhow::Result<ErrorTimePlan> {
        let (mut jobs, deltas) = match &self.jobs {
            Some(list) => {
                let mut jobs = read_views(list)?;
                jobs.files.insert(list.clone());
                let deltas = std::mem::take(&mut jobs.deltas);
                // A sweep's own: errors are measured in any case, and figures over time are of no setting.
                (jobs.error, jobs.intervals) = (false, false);
                (jobs, deltas)
            }
            None => (self.listed()?, Vec::new()),
        };
        jobs.each_method_once();
        let mut values: BTreeMap<String, Vec<String>> = BTreeMap::new();
        if !deltas.is_empty() {
            values.insert("delta".to_owned(), deltas);
        } else if self.quick {
            values.insert("delta".to_owned(), ["0.25", "1", "4", "16"].map(str::to_owned).to_vec());
        }
        let named: BTreeSet<_> = self.values.iter().map(|(knob, _)| knob).collect();
        values.retain(|knob, _| !named.contains(knob));
        for (knob, more) in &self.values {
            values.entry(knob.clone()).or_default().extend(more.iter().cloned());
        }
        let mut sides = if !self.samples.is_empty() {
            self.samples.clone()
        } else if self.quick {
            vec![1]
        } else {
            vec![1, 2]
        };
        sides.sort_unstable();
        sides.dedup();
        let error_size = self.error_size.unwrap_or(if self.quick { 192 } else { 384 });
        let measure = Measure {
            shading: self.shading,
            pixels_per_degree: self.pixels_per_degree,
            host_rays: if self.no_host { 0 } else { 16_384 },
            ..Measure::of(error_size, self.most_samples.unwrap_or(least_converged(&sides).max(if self.quick { 8 } else { 32 })))
        };
        ensure!(
            self.within.is_empty() || jobs.methods.iter().any(|chosen| *chosen.method == lod::METHOD),
            "--within: what is left out is lod's, and lod is none of the methods"
        );
        let mut within = self.within.clone();
        within.sort_unstable_by(f64::total_cmp);
        within.dedup();
        let plan = ErrorTimePlan { jobs, values, sides, measure, turning: self.turn.turning(), within };
        plan.check()?;
        Ok(plan)
    }

    /// The jobs of the options.
    fn listed(&self) -> anyhow::Result<Jobs> {
        let Size(width, height) = self.size;
        let distances: &[f64] = match &self.distances[..] {
            [] if self.quick => &QUICK_DISTANCES,
            [] => &DISTANCES,
            given => given,
        };
        once("--distances", distances)?;
        let view = |&distance: &f64| ViewJob::at([width, height], distance);
        let views: Vec<_> = distances.iter().map(view).collect();
        let mut scenes: Vec<SceneJobs> = Vec::new();
        for path in &self.scenes {
            let scene = open(path)?;
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            ensure!(scenes.iter().all(|before| before.name != name), "{}: there is another scene of the name {name}", path.display());
            let space = ModelSpace::of(&scene);
            views.iter().try_for_each(|view| view.camera(&space).map(drop)).with_context(|| path.display().to_string())?;
            scenes.push(SceneJobs {
                name,
                origin: Origin::File(path.clone()),
                content: xxh3_64(scene.bytes()),
                has_mesh: false,
                views: views.clone(),
                regions: Vec::new(),
            });
        }
        let mut files: BTreeSet<PathBuf> = self.scenes.iter().cloned().collect();
        let compute = match &self.compute[..] {
            [] if self.quick => vec![Compute::Free],
            [] => Compute::ALL.to_vec(),
            given => given.to_vec(),
        };
        once("--machine", &self.machine)?;
        once("--compute", &compute.iter().map(|compute| compute.name()).collect::<Vec<_>>())?;
        let mut targets = Vec::new();
        for name in &self.machine {
            let machine = machine(name, &self.set, "--set").with_context(|| format!("--machine {name}"))?;
            for &compute in &compute {
                run::check(&machine.description, compute).with_context(|| format!("--machine {name}"))?;
                targets.push(Target { machine: machine.clone(), compute, window: None });
            }
            files.extend(machine_files(name, &machine)?);
        }
        let methods: Vec<_> = match &self.methods[..] {
            [] => compared_methods().map(Chosen::plain).collect(),
            given => given.iter().map(|&Listed(method)| Chosen::plain(method)).collect(),
        };
        Ok(Jobs { files, ..Jobs::new(scenes, methods, targets) })
    }
}
