//! A shot's pictures and maps, and their files.

use super::facts::Facts;
use anyhow::Context;
use image::RgbImage;
use lodray::picture::{Legend, error_map, level_map, save_png};
use lodray::study::Shot;
use std::path::Path;

/// A map of a frame.
pub struct Map {
    /// Its file's name, without ending.
    pub name: &'static str,
    pub image: RgbImage,
    /// What its colours mean.
    pub legend: Legend,
}

/// The levels that were chosen.
pub fn levels(shot: &Shot, levels: u32) -> Map {
    Map { name: "levels", image: level_map(&shot.frame), legend: Legend::Levels(levels) }
}

/// Normals of what was met, as they were drawn.
pub fn normals(image: RgbImage) -> Map {
    Map { name: "normals", image, legend: Legend::Normals }
}

/// The error map against the true picture.
pub fn error(shot: &Shot, truth: &RgbImage) -> Map {
    Map { name: "error", image: error_map(&shot.image, truth), legend: Legend::Error }
}

/// Saves the shaded picture.
pub fn save_shot(shot: &Shot, folder: &Path, prefix: &str, facts: &Facts<'_>) -> anyhow::Result<()> {
    save(&shot.image, "image", folder, prefix, facts)
}

impl Map {
    /// Saves it with its legend below.
    pub fn save(&self, folder: &Path, prefix: &str, facts: &Facts<'_>) -> anyhow::Result<()> {
        save(&self.legend.below(&self.image), self.name, folder, prefix, facts)
    }
}

/// Saves a picture as `PREFIXNAME.png`.
fn save(image: &RgbImage, name: &str, folder: &Path, prefix: &str, facts: &Facts<'_>) -> anyhow::Result<()> {
    let path = folder.join(format!("{prefix}{name}.png"));
    save_png(image, &facts.notes(name), &path).with_context(|| format!("cannot write {}", path.display()))
}
