//! Pictures by path tracing.

use crate::arrays::shaped;
use crate::errors::{raised, raised_by, refused};
use crate::scene::PyScene;
use crate::told::{Told, beside};
use crate::values::{Size, document, from_python, to_python, whole_or_none, within};
use lodray::format::Scene;
use lodray::paths::{Film, Instance, MOST_DEPTH, MOST_SAMPLES, Paths, SceneFile, Starts, World};
use lodray::rays::{Camera, ModelSpace, View};
use lodray::scene::SceneMethod;
use lodray::study::pruned::{check_normals, check_whole};
use lodray::study::{Progress, models};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use std::error::Error;
use std::path::{Path, PathBuf};

type Words = Box<dyn Error + Send + Sync>;

/// The description of a path, or of a dictionary, and what its files lie beside.
fn description(of: &Bound<'_, PyAny>) -> PyResult<(SceneFile, PathBuf)> {
    if of.is_instance_of::<PyDict>() {
        let text = toml::to_string(&from_python("description", of)?).map_err(raised)?;
        return Ok((SceneFile::parse(&text, "description").map_err(raised)?, PathBuf::new()));
    }
    let path: PathBuf = of.extract().map_err(|_| refused("description: neither a path nor a dictionary"))?;
    let file = SceneFile::read(&path).map_err(raised)?;
    Ok((file, path.parent().unwrap_or(Path::new("")).to_owned()))
}

/// How rays leave surfaces: exact, independent, or a number of bounding radii.
fn starts(of: &Bound<'_, PyAny>) -> PyResult<Starts> {
    match of.cast::<PyString>().ok().map(|text| text.to_string()).as_deref() {
        Some("exact") => Ok(Starts::Exact),
        Some("independent") => Ok(Starts::Independent),
        _ => {
            let radii = of.extract::<f64>().ok().filter(|radii| *radii >= 0.0 && radii.is_finite());
            radii.map(Starts::Offset).ok_or_else(|| refused(format!("starts: {of} is not exact, independent, or a number from 0 on")))
        }
    }
}

/// A picture by path tracing: a dictionary of `image` (uint8 of shape (height, width, 3), sRGB), `light` (float32, the same shape, linear) and `counts`.
///
/// description: the path of a description of models, materials, lights and cameras (TOML; docs/paths.md has the keys), or the same as a dictionary.
/// models: scenes in place of its models' files, one for each, in its order. camera: by its name; the first if None.
/// Scenes that were pruned for a job serve for neither: paths go anywhere.
/// size, samples, depth, seed: in place of the description's: (width, height) in pixels, 1 to 2^20 paths for each pixel, 0 to 64 bounces, 0 to 2^64 - 1.
/// time: where models stand that move, from 0 to 1. starts: how rays leave surfaces, "exact", "independent", or so many bounding radii above, 0 or more; "exact" if None.
/// method, knobs, progress: as for `Scene.cast`.
///
/// Raises LodrayError: the description cannot be, with file and key; a model that cannot be had, with its number, such as a scene that was pruned or
/// a scene file beside `levels`; a method whose surface rays cannot leave; LodrayFileError: a file that cannot be read. What is lost of a mesh is a UserWarning.
#[pyfunction]
#[pyo3(signature = (description, models=None, *, camera=None, size=None, samples=None, depth=None, seed=None, time=0.0, starts=None, method="lod", progress=None, **knobs))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn paths<'py>(
    description: &Bound<'py, PyAny>,
    models: Option<Vec<Bound<'py, PyScene>>>,
    camera: Option<&str>,
    size: Option<Size>,
    #[pyo3(from_py_with = whole_or_none)] samples: Option<i128>,
    #[pyo3(from_py_with = whole_or_none)] depth: Option<i128>,
    #[pyo3(from_py_with = whole_or_none)] seed: Option<i128>,
    time: f64,
    starts: Option<&Bound<'py, PyAny>>,
    method: &str,
    progress: Option<&Bound<'py, PyAny>>,
    knobs: Option<&Bound<'py, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    let py = description.py();
    let (mut file, folder) = self::description(description)?;
    if !(0.0..=1.0).contains(&time) {
        return Err(refused(format!("time: {time} is not from 0 to 1")));
    }
    file.time = time;
    let starts = starts.map_or(Ok(Starts::Exact), self::starts)?;
    if let Some(Size([width, height])) = size {
        (file.picture.width, file.picture.height) = (width, height);
    }
    // What the description says was checked when it was read.
    if let Some(samples) = samples {
        file.picture.samples = within("samples", samples, 1..=MOST_SAMPLES)?;
    }
    if let Some(depth) = depth {
        file.picture.depth = within("depth", depth, 0..=MOST_DEPTH)?;
    }
    if let Some(seed) = seed {
        file.picture.seed = within("seed", seed, 0..=u64::MAX)?;
    }
    let given: Option<Vec<Scene>> = models.map(|models| models.iter().map(|scene| scene.get().0.clone()).collect());
    if let Some(given) = given.as_ref().filter(|given| given.len() != file.model.len()) {
        return Err(refused(format!("models: {} scenes for {} models", given.len(), file.model.len())));
    }
    let turned = crate::arrays::knobs(knobs)?;
    let film = beside(py, progress, |told| film(&file, &folder, given, (camera, method, &turned, starts), told))?
        .map_err(|error| raised_by(&*error))?;
    let (width, height) = (film.width as usize, film.height as usize);
    let all = PyDict::new(py);
    all.set_item("image", shaped(py, film.image(file.picture.exposure).into_raw(), &[height, width, 3])?)?;
    all.set_item("light", shaped(py, film.light.iter().flat_map(|light| light.to_array()).collect::<Vec<f32>>(), &[height, width, 3])?)?;
    all.set_item("counts", document(py, &film.counts)?)?;
    all.set_item("size", to_python(py, &serde_json::json!([width, height]))?)?;
    Ok(all.into_any())
}

/// What is chosen of a picture.
type Choice<'a> = (Option<&'a str>, &'a str, &'a [(String, String)], Starts);

fn film(
    file: &SceneFile,
    folder: &Path,
    given: Option<Vec<Scene>>,
    (camera, method, knobs, starts): Choice<'_>,
    told: &Told,
) -> Result<Film, Words> {
    let scenes = match given {
        Some(given) => {
            for (k, scene) in given.iter().enumerate() {
                let checked = check_whole(scene).and_then(|()| check_normals(scene, "shading"));
                checked.map_err(|error| format!("models[{k}]: {error}"))?;
            }
            given
        }
        None => models(file, folder, told)?,
    };
    let table = file.camera(camera).ok_or_else(|| format!("camera: there is no '{}'", camera.unwrap_or_default()))?;
    let view = View { eye: Some(table.eye), target: Some(table.target), up: Some(table.up), fov: table.fov, ..View::default() };
    let camera = Camera::new(&view, &ModelSpace::of(&scenes[0]), file.picture.width, file.picture.height)?;
    let turned: Vec<_> = knobs.iter().map(|(name, value)| (name.as_str(), value.as_str())).collect();
    let methods = scenes.iter().map(|scene| scene.method_with(method, &turned)).collect::<Result<Vec<SceneMethod>, _>>()?;
    if methods.iter().any(|own| own.registered().of_input() || !own.method().leaves()) {
        return Err(format!("method: no path goes on from what {method} meets").into());
    }
    let delta = methods[0].knobs().delta();
    let instances = file
        .places()
        .into_iter()
        .map(|(k, pose)| Instance::new(&scenes[k], methods[k].method(), pose, file.materials(&file.model[k]), &camera, delta));
    let world = World::new(instances.collect(), starts);
    let picture = file.picture;
    let paths = Paths {
        world: &world,
        camera,
        lights: &file.light,
        environment: file.environment,
        cones: file.cones,
        depth: picture.depth,
        shadow_rays: picture.shadow_rays,
        samples: picture.samples,
        seed: picture.seed,
    };
    let work = told.begin("tracing", Some(u64::from(camera.height)));
    Ok(Film::of(&paths, &|| work.step(1)))
}
