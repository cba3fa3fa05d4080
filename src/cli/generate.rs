//! `generate`: a procedural scene, or the Loop surface of a mesh.

use super::args::{levels, seed, whole};
use super::build::{FormArgs, finish};
use super::loop_scene;
use super::memory::check_memory;
use super::mesh::{MeshArgs, Source};
use super::names::{Named, named};
use super::output::{busy, check_target};
use lodray::format;
use lodray::mesh::procedural::{MAX_TREES, MAX_WALLS, Options, Scene, generate};
use lodray::scene::BuildOptions;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

#[derive(clap::Args)]
pub struct Args {
    /// What to generate
    #[arg(value_parser = named::<What>())]
    scene: What,
    /// Of loop: the mesh to subdivide (OBJ, PLY, glTF, GLB or STL); - for standard input
    #[arg(required_if_eq("scene", LOOP))]
    mesh: Option<PathBuf>,
    /// Number of 1-to-4 splits, 0 to 10 (default 4 to 7, by the scene; of loop 3)
    #[arg(long, value_parser = levels(), allow_negative_numbers = true)]
    levels: Option<u32>,
    /// Number of base triangles, rounded to the next possible one
    #[arg(long, value_name = "TRIANGLES", value_parser = whole::<u32>(1..=MAX_TREES), allow_negative_numbers = true)]
    base: Option<u32>,
    /// Seed (default 0)
    #[arg(long, value_parser = seed(), allow_negative_numbers = true)]
    seed: Option<u64>,
    /// Terrain, sphere, wall and street: amplitude of each octave relative to the one before; others: amount of fine detail. Between 0 and 1
    #[arg(long, value_parser = share, allow_hyphen_values = true)]
    roughness: Option<f64>,
    /// Quads along each wall of a room (default: a quarter of those across its cloth)
    #[arg(long, value_name = "QUADS", value_parser = whole::<u32>(1..=MAX_WALLS.into()), allow_negative_numbers = true)]
    walls: Option<u32>,
    /// World units across a terrain: heights stay, so that a wider one is flatter (default 2)
    #[arg(long, value_name = "UNITS", allow_negative_numbers = true)]
    width: Option<f64>,
    #[command(flatten)]
    reading: MeshArgs,
    /// Make it an error, and write nothing, if anything of the mesh is lost
    #[arg(long, requires = "mesh")]
    strict: bool,
    #[command(flatten)]
    form: FormArgs,
    /// Scene file to write
    #[arg(short, long)]
    out: PathBuf,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

/// The name of the scene that is made of a mesh.
const LOOP: &str = "loop";

/// What can be generated.
#[derive(Clone, Copy)]
enum What {
    Procedural(Scene),
    Loop,
}

impl Named for What {
    const ALL: &'static [Self] = &{
        let mut all = [Self::Loop; Scene::ALL.len() + 1];
        let mut k = 0;
        while k < Scene::ALL.len() {
            all[k] = Self::Procedural(Scene::ALL[k]);
            k += 1;
        }
        all
    };

    fn name(self) -> &'static str {
        match self {
            Self::Procedural(scene) => Named::name(scene),
            Self::Loop => LOOP,
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Procedural(scene) => scene.about(),
            Self::Loop => {
                "Smooth surface that Loop's rules make of MESH: each of its triangles is a base triangle, and every vertex lies on the limit surface"
            }
        }
    }
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    match args.scene {
        What::Procedural(scene) => {
            anyhow::ensure!(args.mesh.is_none(), "{} is made of no mesh, only {LOOP} is", scene.name());
            procedural(scene, args)
        }
        What::Loop => of_mesh(args),
    }
}

fn procedural(scene: Scene, args: &Args) -> anyhow::Result<ExitCode> {
    check_target(&args.out, &[])?;
    let &Args { levels, base, seed, roughness, walls, width, .. } = args;
    let options = Options { scene, levels, base, seed: seed.unwrap_or(0), roughness, walls, width };
    finish(&make(&options, args.form)?, &args.out, args.json)
}

/// The Loop surface of a mesh.
fn of_mesh(args: &Args) -> anyhow::Result<ExitCode> {
    let others = [
        ("base", args.base.is_some()),
        ("seed", args.seed.is_some()),
        ("roughness", args.roughness.is_some()),
        ("walls", args.walls.is_some()),
        ("width", args.width.is_some()),
    ];
    if let Some((name, _)) = others.into_iter().find(|(_, given)| *given) {
        anyhow::bail!("--{name} is of procedural scenes: {LOOP} has the triangles of its mesh");
    }
    // clap has seen that it is there.
    let source = Source::new(args.mesh.as_deref().unwrap_or(Path::new("")));
    check_target(&args.out, source.files())?;
    let levels = args.levels.unwrap_or(loop_scene::DEFAULT_LEVELS);
    finish(&loop_scene::make(&source, &args.reading, levels, args.form, args.strict)?, &args.out, args.json)
}

/// Generates a scene.
pub fn make(options: &Options, form: FormArgs) -> anyhow::Result<format::Scene> {
    check(options)?;
    let surface = busy("generating", || generate(options))?;
    let form = BuildOptions { name: options.scene.name().to_owned(), ..form.options() }.with_origin("generate", serde_json::json!(options));
    Ok(busy("encoding", || format::Scene::of_surface(&surface, &form))?)
}

/// Refuses what cannot be generated, before any work is done.
pub fn check(options: &Options) -> anyhow::Result<()> {
    options.check()?;
    // Measured: the surface, its hierarchy and the scene's images together at their peak.
    const BYTES_PER_TRIANGLE: u64 = 48;
    let levels = options.levels.unwrap_or(options.scene.default_levels());
    let triangles = u64::from(options.base.unwrap_or(options.scene.default_base())) << (2 * levels);
    check_memory(levels, triangles, BYTES_PER_TRIANGLE, "take fewer levels or a smaller --base")
}

fn share(s: &str) -> Result<f64, String> {
    match s.parse::<f64>() {
        Ok(v) if (0.0..=1.0).contains(&v) => Ok(v),
        _ => Err(format!("'{s}' is not between 0 and 1")),
    }
}
