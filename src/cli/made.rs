//! What a description comes to: models, a camera, a world.

use crate::cli::bars::Bars;
use crate::cli::folder::with_named;
use crate::cli::generate;
use crate::cli::output::toml_in_one_line;
use anyhow::{Context, ensure};
use glam::DVec3;
use lodray::format::Scene;
use lodray::mesh::Placement;
use lodray::method::Method;
use lodray::paths::{CameraTable, Instance, Paths, Pose, SceneFile, SceneFileError, Starts, World};
use lodray::rays::{Camera, ModelSpace, View};
use lodray::report::result::SceneFacts;
use lodray::study::{Cache, Chosen, models};
use std::collections::HashSet;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use xxhash_rust::xxh3::Xxh3Default;

/// Whether a file is the description of several models, by its name.
pub fn is_description(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "toml")
}

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
    for (k, model) in file.model.iter().enumerate() {
        let generated = model.generate.map_or(Ok(()), |options| generate::check(&options.into()));
        generated.with_context(|| format!("{}: model[{k}]", description.display()))?;
    }
    models(file, beside(description), &Bars).with_context(|| description.display().to_string())
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
    ensure!(
        methods.iter().all(|method| method.leaves()),
        "--method {}: rays cannot leave its surface, or go from one model to the next",
        chosen.method.name
    );
    Ok(methods)
}

/// The models for rays from anywhere that are not shaded.
pub fn unshaded<'a>(file: &SceneFile, scenes: &'a [Scene], methods: &'a [Arc<dyn Method>], delta: f64) -> World<'a> {
    let instances = file.places().into_iter().map(|(k, pose)| Instance::for_any_ray(&scenes[k], &*methods[k], pose, delta));
    World::new(instances.collect(), Starts::Exact)
}

/// The models for rays of cameras, each of one frame, that are not shaded; for rays from anywhere if there are none. One world for each frame if models move, the first at time 0 and the last
/// at time 1; else one for all, as it is for one camera, at the description's time.
pub fn seen<'a>(file: &SceneFile, scenes: &'a [Scene], methods: &'a [Arc<dyn Method>], cameras: &[Camera], delta: f64) -> Vec<World<'a>> {
    if cameras.is_empty() {
        return vec![unshaded(file, scenes, methods, delta)];
    }
    let places: Vec<_> = if file.moves() && cameras.len() > 1 {
        (0..cameras.len()).map(|frame| file.at(frame as f64 / (cameras.len() - 1) as f64).places()).collect()
    } else {
        vec![file.places(); cameras.len()]
    };
    let mut frames: Vec<Vec<Instance<'a>>> = cameras.iter().map(|_| Vec::with_capacity(places[0].len())).collect();
    for (place, &(k, _)) in places[0].iter().enumerate() {
        let seen: Vec<_> = places.iter().zip(cameras).map(|(places, &camera)| (places[place].1, camera)).collect();
        let own = Instance::for_cameras(&scenes[k], &*methods[k], &seen, delta);
        frames.iter_mut().zip(own).for_each(|(frame, own)| frame.push(own));
    }
    if !file.moves() {
        frames.truncate(1);
    }
    frames.into_iter().map(|instances| World::new(instances, Starts::Exact)).collect()
}

/// What results say of the models of a description.
pub fn facts(description: &Path, file: &SceneFile, scenes: &[Scene]) -> anyhow::Result<SceneFacts> {
    let (mut hash, mut known) = (Xxh3Default::new(), HashSet::new());
    for path in std::iter::once(description.to_owned()).chain(with_named(&model_files(description, file)?)) {
        if !known.contains(&path) {
            let copied = File::open(&path).and_then(|mut file| std::io::copy(&mut file, &mut hash));
            copied.with_context(|| format!("cannot read {}", path.display()))?;
        }
        known.insert(path);
    }
    let mut places = vec![0; scenes.len()];
    file.places().into_iter().for_each(|(k, _)| places[k] += 1);
    let models: Vec<_> = scenes.iter().zip(places).collect();
    let mut name = description.file_name().unwrap_or_default().to_string_lossy().into_owned();
    if file.time > 0.0 {
        name += &format!(" at time {}", file.time);
    }
    Ok(SceneFacts::of_models(&name, format!("{:016x}", hash.digest()), &models))
}

/// The space of all models as they stand first, so that cameras do not move with them: the box around theirs. Of a model alone that is not moved it is that one's.
pub fn space(file: &SceneFile, scenes: &[Scene]) -> ModelSpace {
    let places = file.at(0.0).places();
    let unmoved = Pose::new([0.0; 3], 1.0, [0.0; 3]);
    if let [(k, pose)] = places[..]
        && pose == unmoved
    {
        return ModelSpace::of(&scenes[k]);
    }
    let corners = places.iter().flat_map(|&(k, pose)| corners(&ModelSpace::of(&scenes[k])).map(|corner| pose.out(corner)));
    let none = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let (lo, hi) = corners.fold(none, |(lo, hi), corner| (lo.min(corner), hi.max(corner)));
    let longest = (hi - lo).max_element();
    // Any number of units will do for a point.
    let scale = if longest > 0.0 { longest / f64::from(UNITS) } else { 1.0 };
    let hi = ((hi - lo) / scale).round().to_array().map(|side| side as i32); // at most UNITS
    ModelSpace { placement: Placement { offset: lo.to_array(), scale }, lo: [0; 3], hi, zeros: [0; 2] }
}

/// Along the longest side of the box around models.
const UNITS: i32 = 1 << 30;

/// Corners of a model's box, in its own world.
fn corners(space: &ModelSpace) -> [DVec3; 8] {
    std::array::from_fn(|corner| {
        let side = |k: usize| f64::from(if corner >> k & 1 == 1 { space.hi[k] } else { space.lo[k] });
        DVec3::from_array([0, 1, 2].map(|k| space.placement.offset[k] + space.placement.scale * side(k)))
    })
}

/// What the description says of the camera that was asked for.
pub fn camera_table<'a>(file: &'a SceneFile, name: Option<&str>) -> anyhow::Result<&'a CameraTable> {
    let known = || file.camera.iter().map(|camera| camera.name.as_str()).collect::<Vec<_>>().join(", ");
    file.camera(name).with_context(|| format!("there is no camera '{}'; there are: {}", name.unwrap_or_default(), known()))
}

/// The camera that was asked for.
pub fn camera(file: &SceneFile, name: Option<&str>, scenes: &[Scene]) -> anyhow::Result<Camera> {
    let table = camera_table(file, name)?;
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
