//! stub
use super::info;
use super::output::print_line;
use lodray::bvh::over_trees;
use lodray::format::{self, Scene, SceneInfo};
use lodray::mesh::Surface;
use std::path::Path;
use std::process::ExitCode;
pub fn build_scene(surface: &Surface, name: &str, origin: serde_json::Value) -> anyhow::Result<Scene> {
    Ok(format::build(surface, SceneInfo { name: name.to_owned(), origin }, over_trees)?)
}
/// Saves a new scene and says what it holds.
pub fn finish(scene: &Scene, out: &Path, json: bool) -> anyhow::Result<ExitCode> {
    scene.save(out)?;
    if !json {
        print_line(&format!("{}:", out.display()))?;
    }
    info::print(scene, json)?;
    Ok(ExitCode::SUCCESS)
}
