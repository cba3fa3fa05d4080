//! Pictures of several models by the light of the eye, a ray for each pixel or several, and what the rays took.

use super::world::{Heard, Met, UNHEARD, World, WorldRay};
use crate::method::SurfaceHit;
use crate::picture::{Frame, FrameStats, Sampled, Shader, Shading};
use crate::rays::{Camera, TILE};
use crate::step::{LineCounter, LineSets, MapError, StepCounts};
use rayon::prelude::*;

/// What a camera's rays met among several models.
#[derive(Clone)]
pub struct WorldView {
    /// What each pixel found, in its model; distances are those of the scene.
    pub frame: Frame,
    /// The model of each pixel that found something, by its place among the instances; 0 elsewhere.
    pub instances: Vec<u32>,
}

impl Met {
    /// The hit, in its model but for the distance, which is that of the scene.
    fn hit(&self) -> SurfaceHit {
        SurfaceHit { distance: self.distance, ..self.landing.surface }
    }
}

impl World<'_> {
    /// Traces one ray per pixel; what they met, and what that took. `row_done` is called once for each finished row, from any thread.
    ///
    /// # Errors
    /// The models have more lines than can be numbered.
    pub fn render(&self, camera: &Camera, row_done: &(dyn Fn() + Sync)) -> Result<(WorldView, FrameStats), MapError> {
        let memory = self.memory()?;
        let (map, width) = (memory.map(), camera.width as usize);
        let sets = LineSets::new(map);
        let count = width * camera.height as usize;
        let (mut pixels, mut instances) = (vec![None; count], vec![0; count]);
        let band = width * TILE as usize;
        let counts = pixels
            .par_chunks_mut(band)
            .zip(instances.par_chunks_mut(band))
            .enumerate()
            .map_init(
                || self.tracers(),
                |tracers, (k, (pixels, instances))| {
                    let mut counter = LineCounter { counts: StepCounts::default(), sets: &sets };
                    for (at, (pixel, instance)) in pixels.iter_mut().zip(instances).enumerate() {
                        // Rows and columns are below 2^16.
                        let [x, y] = [at % width, k * TILE as usize + at / width].map(|at| at as u32);
                        let heard = Heard { memory: &memory, steps: &mut counter };
                        if let Some(met) = self.trace(tracers, &WorldRay::of(&camera.ray(x, y)), None, Some(heard)) {
                            (*pixel, *instance) = (Some(met.hit()), met.instance as u32); // few: a description's
                        }
                    }
                    (0..pixels.len() / width).for_each(|_| row_done());
                    counter.counts
                },
            )
            .reduce(StepCounts::default, |mut a, b| {
                a.add(&b);
                a
            });
        let stats = FrameStats::new(&pixels, &counts, map, &sets);
        Ok((WorldView { frame: Frame { width: camera.width, height: camera.height, pixels }, instances }, stats))
    }

    /// A shader for each model where it stands, with its own colours.
    pub fn shaders(&self, shading: Shading) -> Vec<Shader<'_>> {
        let own = self.instances().iter();
        own.map(|own| {
            let plain = Shader::new(own.scene, own.space(), shading);
            own.pose.outward().map_or(plain, |outward| plain.standing(outward))
        })
        .collect()
    }

    /// Traces and shades all samples of `camera` ([`Camera::with_samples`]) by the models' shaders. `row_done` is called once for each finished row of pixels, from any thread.
    pub fn sampled(&self, shaders: &[Shader<'_>], camera: &Camera, row_done: &(dyn Fn() + Sync)) -> Sampled {
        let (mut picture, side) = (Sampled::new(camera), camera.samples);
        picture.pixels.par_chunks_mut(picture.width as usize).enumerate().for_each_init(
            || self.tracers(),
            |tracers, (y, pixels)| {
                for (x, light) in (0..).zip(pixels) {
                    // Within the picture, which has at most 2^16 rows of samples.
                    for [x, y] in (0..side).flat_map(|j| (0..side).map(move |i| [x * side + i, y as u32 * side + j])) {
                        let ray = camera.ray(x, y);
                        let met = self.trace(tracers, &WorldRay::of(&ray), None, UNHEARD);
                        let hit = met.as_ref().map(Met::hit);
                        shaders[met.map_or(0, |met| met.instance)].add(light, &ray, hit.as_ref());
                    }
                }
                row_done();
            },
        );
        picture
    }
}
