//! An input mesh as it is: what `render --method original` shows, and `--mesh` compares with.

use super::output::{busy, warn};
use anyhow::Context;
use lodray::format::Scene;
use lodray::mesh::read;
use lodray::scene::BuildOptions;
use std::path::Path;

/// The scene of a mesh file: its own triangles, normals and colours, nothing simplified and nothing split.
pub fn original(path: &Path) -> anyhow::Result<Scene> {
    anyhow::ensure!(
        Scene::open(path).is_err(),
        "{}: is a scene, which does not hold the mesh that it was made from: name that with --mesh",
        path.display()
    );
    let mesh = busy("reading", || read(path))?;
    mesh.warnings.iter().for_each(|lost| warn(&format!("warning: {}: {lost}", path.display())));
    let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
    let options = BuildOptions { name, ..BuildOptions::own_triangles() };
    busy("encoding", || Scene::of_mesh(&mesh, &options, &|_, _, _| ())).with_context(|| path.display().to_string())
}
