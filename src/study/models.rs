//! The models of a description, loaded.

use super::error::one_line;
use super::progress::{Progress, busy};
use super::pruned::{check_normals, check_whole};
use crate::format::Scene;
use crate::mesh::{RemeshOptions, read};
use crate::paths::{ModelTable, SceneFile};
use crate::scene::BuildOptions;
use std::error::Error;
use std::path::Path;

/// A model of a description that cannot be had.
#[derive(Debug, thiserror::Error)]
#[error("model[{number}]")]
pub struct ModelError {
    /// Which, from 0.
    pub number: usize,
    /// Why.
    pub source: Box<dyn Error + Send + Sync>,
}

/// The models of a description, in its order, for any rays that are shaded. Their files lie in the folder `beside`. What stands in several places is loaded once. What of a
/// mesh file is lost is noted.
///
/// # Errors
/// A file that cannot be read, a mesh that cannot be remeshed, a scene that was pruned or has splits of its own where the description has `levels`.
pub fn models(file: &SceneFile, beside: &Path, progress: &dyn Progress) -> Result<Vec<Scene>, ModelError> {
    let mut scenes: Vec<Scene> = Vec::new();
    for (number, model) in file.model.iter().enumerate() {
        let scene = match file.model[..number].iter().position(|before| model.is_of(before)) {
            Some(before) => scenes[before].clone(),
            None => load(model, beside, progress).map_err(|source| ModelError { number, source })?,
        };
        scenes.push(scene);
    }
    Ok(scenes)
}

/// The model of a table.
fn load(model: &ModelTable, beside: &Path, progress: &dyn Progress) -> Result<Scene, Box<dyn Error + Send + Sync>> {
    if let Some(options) = model.generate {
        return Ok(busy(progress, "generating", || Scene::generate(&options.into()))?);
    }
    let path = beside.join(model.file.as_deref().unwrap_or_default());
    let shown = path.display();
    let named = |error: &dyn Error| format!("{shown}: {}", one_line(error));
    if path.extension().is_some_and(|ending| ending == "lod") {
        if model.levels.is_some() {
            return Err(format!("levels is of mesh files; {shown} has its own").into());
        }
        let scene = busy(progress, "opening", || Scene::open(&path))?;
        check_whole(&scene).map_err(|error| named(&error))?;
        check_normals(&scene, "shading")?;
        return Ok(scene);
    }
    let mesh = busy(progress, "reading", || read(&path))?;
    mesh.warnings.iter().for_each(|lost| progress.note(&format!("warning: {shown}: {lost}")));
    let name = path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let remesh = Some(RemeshOptions { levels: model.levels, ..RemeshOptions::default() });
    let options = BuildOptions { name, remesh, ..BuildOptions::default() };
    let made = {
        let work = progress.begin("remeshing", None);
        // Nobody knows how many steps there are, but each is a place to stop.
        Scene::of_mesh(&mesh, &options, &|_, _, _| work.step(0))
    };
    let scene = made.map_err(|error| named(&error))?;
    if let Some(lost) = scene.meta().origin["remesh"]["warning"].as_str() {
        progress.note(&format!("warning: {shown}: {lost}"));
    }
    Ok(scene)
}
