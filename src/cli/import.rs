//! `import`: a glTF scene as a description: each mesh a scene file, and a place for each node.

use super::args::levels;
use super::build::percent;
use super::folder::{Overrule, RunFolder, one_run};
use super::form::FormArgs;
use super::output::{print_json, progress, remark, warn};
use anyhow::Context;
use lodray::format::{Scene, write_and_rename};
use lodray::mesh::{DEFAULT_MAX_ERROR, MeshCamera, PlacedMeshes, RemeshOptions, read_placed};
use lodray::paths::{Pose, SceneFile};
use lodray::rays::{DEFAULT_DIRECTION, DEFAULT_VIEW_ANGLE_DEGREES, ModelSpace};
use lodray::scene::BuildOptions;
use lodray::study::count;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// The description.
const DESCRIPTION: &str = "scene.toml";

#[derive(clap::Args)]
pub struct Args {
    /// glTF or GLB file
    scene: PathBuf,
    /// Number of 1-to-4 splits of each mesh, 0 to 10 (default: as build has it)
    #[arg(long, value_parser = levels(), allow_negative_numbers = true)]
    levels: Option<u32>,
    /// Largest distance between a mesh and its result, both ways, in percent of the diagonal of the mesh's box
    #[arg(long, value_name = "PERCENT", default_value_t = DEFAULT_MAX_ERROR, value_parser = percent, allow_negative_numbers = true)]
    max_error: f64,
    #[command(flatten)]
    form: FormArgs,
    /// Folder for the description and the scene files
    #[arg(short, long, long_help = one_run("Folder for the description (scene.toml) and a scene file for each mesh (mesh-0.lod and so on)"))]
    out: PathBuf,
    #[command(flatten)]
    overrule: Overrule,
    /// Print the figures as JSON
    #[arg(long)]
    json: bool,
}

pub fn run(args: &Args) -> anyhow::Result<ExitCode> {
    let shown = args.scene.display();
    let mut read = read_placed(&args.scene)?;
    read.warnings.iter().for_each(|lost| warn(&format!("warning: {shown}: {lost}")));
    // What has no inverse is flat: no ray meets it.
    let flat: Vec<_> = read.places.extract_if(.., |place| Pose::affine(place.matrix).is_err()).map(|place| place.name).collect();
    if let Some(first) = flat.first() {
        let what = count(flat.len() as u64, "node");
        warn(&format!("warning: {shown}: {what} such as '{first}' are left out: they are flat, or stretched too far, where they stand"));
    }
    anyhow::ensure!(!read.places.is_empty(), "{shown}: no node is left");
    let files: Vec<String> = (0..read.meshes.len()).map(|mesh| format!("mesh-{mesh}.lod")).collect();
    let names = files.iter().map(String::as_str).chain([DESCRIPTION]);
    let folder = RunFolder::open(&args.out, names, &[&args.scene], &args.overrule)?;
    let remesh = RemeshOptions { levels: args.levels, max_error: args.max_error, ..RemeshOptions::default() };
    let bar = progress(files.len() as u64, "building");
    let mut scenes = Vec::new();
    for ((name, mesh), file) in read.meshes.iter().zip(&files) {
        let options = BuildOptions { remesh: Some(remesh), name: name.clone(), ..args.form.options() };
        let scene = Scene::of_mesh(mesh, &options, &|_, _, _| ()).with_context(|| format!("{shown}: {name}"))?;
        let lost = scene.meta().origin["remesh"]["warning"].as_str();
        mesh.warnings.iter().map(String::as_str).chain(lost).for_each(|lost| warn(&format!("warning: {shown}: {name}: {lost}")));
        scene.save(&folder.staging().join(file))?;
        scenes.push(ModelSpace::of(&scene));
        bar.inc(1);
    }
    bar.finish_and_clear();
    let text = description(&args.scene, &read, &files, &scenes);
    // A camera that cannot be, for instance.
    SceneFile::parse(&text, &format!("{shown}: as {DESCRIPTION}"))?;
    write_and_rename(&folder.staging().join(DESCRIPTION), |out| out.write_all(text.as_bytes()))?;
    folder.finish()?;
    let (meshes, places, cameras) = (files.len(), read.places.len(), read.cameras.len());
    if args.json {
        print_json(
            &serde_json::json!({ "description": args.out.join(DESCRIPTION), "meshes": meshes, "places": places, "cameras": cameras }),
        )?;
    } else {
        let [meshes, places] = [(meshes, "mesh file"), (places, "place")].map(|(n, what)| count(n as u64, what));
        remark(&format!("{}: {meshes}, {places}", args.out.join(DESCRIPTION).display()))?;
    }
    Ok(ExitCode::SUCCESS)
}

/// The text of the description.
fn description(file: &Path, read: &PlacedMeshes, files: &[String], spaces: &[ModelSpace]) -> String {
    let name = file.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned());
    let mut text = format!("# {} at {} of {name}.\n", count(files.len() as u64, "mesh file"), count(read.places.len() as u64, "place"));
    let default = [around(read, spaces)];
    for camera in if read.cameras.is_empty() { &default[..] } else { &read.cameras } {
        let MeshCamera { name, eye, target, up, fov } = camera;
        let name = toml::Value::from(name.as_str());
        _ = write!(text, "\n[[camera]]\nname = {name}\neye = {eye:?}\ntarget = {target:?}\nup = {up:?}\nfov = {fov:?}\n");
    }
    for place in &read.places {
        // Adding 0 leaves no zero with a sign.
        _ = write!(
            text,
            "\n# {}\n[[model]]\nfile = {:?}\nmatrix = {:?}\n",
            one_line(&place.name),
            files[place.mesh],
            place.matrix.map(|row| row.map(|c| c + 0.0))
        );
    }
    text += "\n[[light]]\nkind = \"sun\"\ndirection = [0.5, 0.8, 0.35]\nhalf_angle = 0.5\nirradiance = [2.0, 1.9, 1.7]\n";
    text + "\n[environment]\nzenith = [0.3, 0.4, 0.6]\nhorizon = [0.6, 0.62, 0.66]\nground = [0.2, 0.18, 0.15]\n"
}

/// A name without what would end a comment.
fn one_line(name: &str) -> String {
    name.chars().filter(|c| !c.is_control()).collect()
}

/// A camera that sees all.
fn around(read: &PlacedMeshes, spaces: &[ModelSpace]) -> MeshCamera {
    let (mut least, mut most) = ([f64::INFINITY; 3], [f64::NEG_INFINITY; 3]);
    for place in &read.places {
        let (centre, radius) = (spaces[place.mesh].centre(), spaces[place.mesh].radius());
        for (k, [x, y, z, w]) in place.matrix.into_iter().enumerate() {
            // Of a sphere: as far along an axis as its row is long.
            let (at, reach) = (x * centre[0] + y * centre[1] + z * centre[2] + w, radius * (x * x + y * y + z * z).sqrt());
            least[k] = least[k].min(at - reach);
            most[k] = most[k].max(at + reach);
        }
    }
    let target: [f64; 3] = std::array::from_fn(|k| least[k].midpoint(most[k]));
    let radius = (0..3).map(|k| (most[k] - least[k]).powi(2)).sum::<f64>().sqrt() / 2.0;
    let fov = DEFAULT_VIEW_ANGLE_DEGREES;
    let length = DEFAULT_DIRECTION.iter().map(|c| c * c).sum::<f64>().sqrt();
    let distance = radius / (0.5 * fov.to_radians()).sin() / length;
    let eye = std::array::from_fn(|k| target[k] + distance * DEFAULT_DIRECTION[k]);
    MeshCamera { name: "all".to_owned(), eye, target, up: [0.0, 1.0, 0.0], fov }
}
