//! `generate loop`: the Loop surface of a mesh as a scene.

use super::build::FormArgs;
use super::memory::check_memory;
use super::mesh::{MeshArgs, Source};
use super::output::busy;
use anyhow::Context;
use lodray::format::Scene;
use lodray::mesh::{check_loop, loop_surface};
use lodray::scene::BuildOptions;
use serde_json::json;

/// Splits if none are asked for.
pub const DEFAULT_LEVELS: u32 = 3;

/// Makes the scene, each triangle of the mesh split `levels` times; what is lost of the mesh is an error if `strict`.
pub fn make(source: &Source, reading: &MeshArgs, levels: u32, form: FormArgs, strict: bool) -> anyhow::Result<Scene> {
    let mesh = reading.read(source, strict)?;
    if !mesh.normals.is_empty() {
        source.lost("its shading normals are not kept: the subdivided surface has its own", strict)?;
    }
    let triangles = mesh.triangles.len() as u64;
    let name = || source.path.display().to_string();
    check_loop(triangles, levels).with_context(name)?;
    // The last net, its limit and the surface together at their peak: 101 were measured on a scan of 69,451 triangles, split three times.
    const BYTES_PER_TRIANGLE: u64 = 105;
    check_memory(levels, triangles << (2 * levels), BYTES_PER_TRIANGLE, "take fewer levels or a smaller mesh").with_context(name)?;
    let surface = busy("subdividing", || loop_surface(&mesh, levels)).with_context(name)?;
    let form = BuildOptions { name: source.name(), ..form.options() }
        .with_origin("generate", json!({ "scene": "loop", "levels": levels }))
        .with_origin("mesh", json!(mesh.report));
    drop(mesh);
    busy("encoding", || Scene::of_surface(&surface, &form)).with_context(name)
}
