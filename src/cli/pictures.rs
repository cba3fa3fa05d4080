//! Renders a view with one method and saves its pictures.

use super::facts::Facts;
use super::output::progress;
use anyhow::Context;
use image::RgbImage;
use lodray::format::Scene;
use lodray::method::Method;
use lodray::picture::{Frame, FrameStats, Legend, Shader, Shading, error_map, level_map, normal_map, render, sampled, save_png, shaded};
use lodray::rays::{Camera, ModelSpace};
use std::path::Path;

/// A frame, what it took, and its shaded picture.
pub struct Shot {
    pub frame: Frame,
    pub stats: FrameStats,
    pub image: RgbImage,
}

/// Traces and shades one view with one sample in each pixel, by full-resolution normals: pictures of all methods, and of all reports, compare.
pub fn shoot(method: &dyn Method, scene: &Scene, space: &ModelSpace, camera: &Camera, delta: f64, what: &str) -> Shot {
    shoot_with(method, &Shader::new(scene, space, Shading::Full), space, [camera; 2], delta, what)
}

/// Traces one view: the frame with one ray in each pixel of the first camera, and the picture with the samples of the other.
pub fn shoot_with(
    method: &dyn Method,
    shader: &Shader<'_>,
    space: &ModelSpace,
    [camera, samples]: [&Camera; 2],
    delta: f64,
    what: &str,
) -> Shot {
    let is_one = samples.samples == camera.samples;
    let bar = progress(u64::from(camera.height) * (1 + u64::from(!is_one)), what);
    let (frame, stats) = render(method, space, camera, delta, &|| bar.inc(1));
    let image =
        if is_one { shaded(&frame, shader, camera) } else { sampled(method, shader, space, samples, delta, &|| bar.inc(1)).image() };
    bar.finish_and_clear();
    Shot { frame, stats, image }
}

/// A map of a frame.
pub struct Map {
    /// Its file's name, without ending.
    pub name: &'static str,
    pub image: RgbImage,
    /// What its colours mean.
    pub legend: Legend,
}

impl Shot {
    pub fn levels(&self, scene: &Scene) -> Map {
        Map { name: "levels", image: level_map(&self.frame), legend: Legend::Levels(scene.levels()) }
    }

    pub fn normals(&self, scene: &Scene) -> Map {
        Map { name: "normals", image: normal_map(&self.frame, scene), legend: Legend::Normals }
    }

    /// The error map against the true picture.
    pub fn error(&self, truth: &RgbImage) -> Map {
        Map { name: "error", image: error_map(&self.image, truth), legend: Legend::Error }
    }

    /// Saves the shaded picture.
    pub fn save(&self, folder: &Path, prefix: &str, facts: &Facts<'_>) -> anyhow::Result<()> {
        save(&self.image, "image", folder, prefix, facts)
    }
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
