//! Pictures of a view of several models.

use super::progress::Progress;
use super::shot::{Comparison, Shot};
use crate::method::SurfaceHit;
use crate::paths::{World, WorldView};
use crate::picture::{Shader, cosine_to, normal_map_by, shaded_by};
use crate::rays::Camera;
use crate::step::MapError;
use image::RgbImage;

/// A frame of several models, what it took, and its shaded picture.
pub struct WorldShot {
    /// As of one model; hits are those of their own models, but for distances.
    pub shot: Shot,
    /// The model of each pixel that hit, by its place among the instances.
    pub instances: Vec<u32>,
}

impl WorldShot {
    /// Traces one view: the frame with one ray in each pixel of the first camera, and the picture with the samples of the other. `shaders` are those of the models
    /// ([`World::shaders`]); `told` says what is done, and whom.
    ///
    /// # Errors
    /// The models have more lines than can be numbered.
    pub fn of(
        world: &World<'_>,
        shaders: &[Shader<'_>],
        [camera, samples]: [&Camera; 2],
        (what, progress): (&str, &dyn Progress),
    ) -> Result<Self, MapError> {
        let is_one = samples.samples == camera.samples;
        let bar = progress.begin(what, Some(u64::from(camera.height) * (1 + u64::from(!is_one))));
        let (WorldView { frame, instances }, stats) = world.render(camera, &|| bar.step(1))?;
        let image = if is_one {
            shaded_by(&frame, camera, |index| &shaders[instances[index] as usize])
        } else {
            world.sampled(shaders, samples, &|| bar.step(1)).image()
        };
        Ok(Self { shot: Shot { frame, stats, image }, instances })
    }

    /// Normal of a pixel's hit in the scene, by the shaders of the models.
    fn normal(&self, shaders: &[Shader<'_>], index: usize, hit: &SurfaceHit) -> glam::Vec3 {
        shaders[self.instances[index] as usize].normal(hit)
    }

    /// Full-resolution normals as colours.
    pub fn normals(&self, shaders: &[Shader<'_>]) -> RgbImage {
        normal_map_by(&self.shot.frame, |index, hit| self.normal(shaders, index, hit))
    }

    /// How far its picture is from the true one of the same camera, whose models have these shaders.
    pub fn compared(&self, truth: &Self, shaders: &[Shader<'_>], camera: &Camera) -> Comparison {
        let cosine = |index, hit: &SurfaceHit| f64::from(cosine_to(truth.normal(shaders, index, hit), camera, index));
        self.shot.compared_by(&truth.shot, camera, cosine)
    }
}
