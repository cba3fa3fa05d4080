//! Renders a view with one method and saves its pictures.

use super::output::progress;
use anyhow::Context;
use image::RgbImage;
use lodray::format::Scene;
use lodray::render::{Camera, Frame, Method, error_map, level_map, normal_map, render, save_png, shaded};
use lodray::traverse::ModelSpace;
use std::path::Path;

/// A frame and its shaded picture.
pub struct Shot {
    pub frame: Frame,
    pub image: RgbImage,
}

/// Traces and shades one view.
pub fn shoot(method: &Method<'_>, scene: &Scene, space: &ModelSpace, camera: &Camera, delta: f64, what: &str) -> Shot {
    let bar = progress(u64::from(camera.height), what);
    let frame = render(method, space, camera, delta, &|| bar.inc(1));
    bar.finish_and_clear();
    let image = shaded(&frame, scene, camera);
    Shot { frame, image }
}

impl Shot {
    /// Saves the shaded picture and the level map, and the normals if wanted, as `PREFIXimage.png` and so on.
    pub fn save(&self, scene: &Scene, folder: &Path, prefix: &str, normals: bool) -> anyhow::Result<()> {
        save(&self.image, folder, &format!("{prefix}image.png"))?;
        save(&level_map(&self.frame), folder, &format!("{prefix}levels.png"))?;
        if normals {
            save(&normal_map(&self.frame, scene), folder, &format!("{prefix}normals.png"))?;
        }
        Ok(())
    }

    /// Saves the error map against the true picture.
    pub fn save_error(&self, truth: &Self, folder: &Path, prefix: &str) -> anyhow::Result<()> {
        save(&error_map(&self.image, &truth.image), folder, &format!("{prefix}error.png"))
    }
}

fn save(image: &RgbImage, folder: &Path, name: &str) -> anyhow::Result<()> {
    let path = folder.join(name);
    save_png(image, &path).with_context(|| format!("cannot write {}", path.display()))
}
