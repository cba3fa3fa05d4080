//! What a description comes to: models, a camera, a world.

use crate::cli::bars::Bars;
use crate::cli::build::FormArgs;
use crate::cli::common::is_quiet;
use crate::cli::generate;
use crate::cli::output::{busy, open, toml_in_one_line, warn};
use anyhow::{Context, ensure};
use lodray::format::Scene;
use lodray::mesh::{RemeshOptions, read};
use lodray::method::Method;
use lodray::paths::{Instance, ModelTable, Paths, SceneFile, SceneFileError, Starts, World};
use lodray::rays::{Camera, ModelSpace, View};
use lodray::scene::BuildOptions;
use lodray::study::pruned::check_normals;
use lodray::study::{Cache, Chosen};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Reads a description; what is wrong with it is said in one line.
pub fn description(path: &Path) -> anyhow::Result<SceneFile> {
    SceneFile::read(path).map_err(|error| match error {
        SceneFileError::Toml { file, source } => toml_in_one_line(&file, &source),
        other => other.into(),
    })
}

/// The files that a description names, beside its own; each is there.
pub fn model_files(description: &Path, file: &SceneFile) -> anyhow::Result<Vec<PathBuf>> {
    let beside = beside(description);
    let names = file.model.iter().enumerate().filter_map(|(k, model)| Some((k, beside.join(model.file.as_ref()?))));
    names
        .map(|(k, path)| {
            ensure!(path.is_file(), "{}: model[{k}].file: there is no file {}", description.display(), path.display());
            Ok(path)
        })
        .collect()
}

fn beside(description: &Path) -> &Path {
    description.parent().unwrap_or(Path::new(""))
}

/// The models of a description, in its order. What stands in several places is loaded once.
pub fn scenes(description: &Path, file: &SceneFile) -> anyhow::Result<Vec<Scene>> {
    let mut scenes: Vec<Scene> = Vec::new();
    for (k, model) in file.model.iter().enumerate() {
        let scene = match file.model[..k].iter().position(|before| model.is_of(before)) {
            Some(before) => scenes[before].clone(),
            None => load(model, beside(description)).with_context(|| format!("{}: model[{k}]", description.display()))?,
        };
        scenes.push(scene);
    }
    Ok(scenes)
}

/// The models by a method whose hits rays can leave. What stands in several places is built once.
pub fn methods(file: &SceneFile, scenes: &[Scene], chosen: &Chosen, cache: &Cache) -> anyhow::Result<Vec<Arc<dyn Method>>> {
    let mut methods: Vec<Arc<dyn Method>> = Vec::new();
    for (k, (model, scene)) in file.model.iter().zip(scenes).enumerate() {
        let method = match file.model[..k].iter().position(|before| model.is_of(before)) {
            Some(before) => Arc::clone(&methods[before]),
            None => Arc::from(chosen.make(scene, cache, &Bars)?.0),
        };
        methods.push(method);
    }
    ensure!(methods.iter().all(|method| method.leaves()), "--method {}: rays cannot leave its surface", chosen.method.name);
    Ok(methods)
}

/// The models for rays from anywhere that are not shaded.
pub fn unshaded<'a>(file: &SceneFile, scenes: &'a [Scene], methods: &'a [Arc<dyn Method>], delta: f64) -> World<'a> {
    let instances = file.places().into_iter().map(|(k, pose)| Instance::for_any_ray(&scenes[k], &*methods[k], pose, delta));
    World::new(instances.collect(), Starts::Exact)
}

/// The model of a table.
fn load(model: &ModelTable, beside: &Path) -> anyhow::Result<Scene> {
    if let Some(options) = model.generate {
        return generate::make(&options.into(), FormArgs::default());
    }
    let path = beside.join(model.file.as_deref().unwrap_or_default());
    if path.extension().is_some_and(|ending| ending == "lod") {
        ensure!(model.levels.is_none(), "levels is of mesh files; {} has its own", path.display());
        let scene = open(&path)?;
        check_normals(&scene, "shading")?;
        return Ok(scene);
    }
    let mesh = busy("reading", || read(&path))?;
    mesh.warnings.iter().for_each(|lost| warn(&format!("warning: {}: {lost}", path.display())));
    let name = path.file_stem().map_or_else(String::new, |s| s.to_string_lossy().into_owned());
    let remesh = Some(RemeshOptions { levels: model.levels, ..RemeshOptions::default() });
    let options = BuildOptions { name, remesh, ..BuildOptions::default() };
    let scene = busy("remeshing", || Scene::of_mesh(&mesh, &options, &|_, _, _| ())).with_context(|| path.display().to_string())?;
    if let Some(lost) = scene.meta().origin["remesh"]["warning"].as_str().filter(|_| !is_quiet()) {
        warn(&format!("warning: {}: {lost}", path.display()));
    }
    Ok(scene)
}

/// The camera that was asked for.
pub fn camera(file: &SceneFile, name: Option<&str>, scenes: &[Scene]) -> anyhow::Result<Camera> {
    let known = || file.camera.iter().map(|camera| camera.name.as_str()).collect::<Vec<_>>().join(", ");
    let table = file.camera(name).with_context(|| format!("there is no camera '{}'; there are: {}", name.unwrap_or_default(), known()))?;
    let view = View { eye: Some(table.eye), target: Some(table.target), up: Some(table.up), fov: table.fov, ..View::default() };
    Ok(Camera::new(&view, &ModelSpace::of(&scenes[0]), file.picture.width, file.picture.height)?)
}

/// The models through their methods.
pub fn world<'a>(
    file: &SceneFile,
    scenes: &'a [Scene],
    methods: &'a [Arc<dyn Method>],
    camera: &Camera,
    delta: f64,
    starts: Starts,
) -> World<'a> {
    let place = |(k, pose): (usize, _)| Instance::new(&scenes[k], &*methods[k], pose, file.materials(&file.model[k]), camera, delta);
    let instances = file.places().into_iter().map(place);
    World::new(instances.collect(), starts)
}

/// The paths of a description.
pub fn paths<'a>(file: &'a SceneFile, world: &'a World<'a>, camera: Camera) -> Paths<'a> {
    let picture = file.picture;
    Paths {
        world,
        camera,
        lights: &file.light,
        environment: file.environment,
        cones: file.cones,
        depth: picture.depth,
        shadow_rays: picture.shadow_rays,
        samples: picture.samples,
        seed: picture.seed,
    }
}
