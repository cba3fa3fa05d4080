//! What pops between two frames of a moving camera.
//!
//! Wherever the first frame saw the surface, the second camera looks at that very place: where nothing has changed it is met there, exactly, as full resolution is. What pops is how far
//! the surface is from it then, across the surface. It changes smoothly where level of detail is continuous, less the less the camera moves, and at once where another level takes over. At
//! outlines the second camera may see another part of the model: places from which what is met is far are left out.

use super::frame::Frame;
use super::shading::{Light, Shader};
use crate::method::{Method, trace_together};
use crate::rays::{Camera, Query, Sight};
use crate::step::NoSteps;
use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// What is met farther along the ray, in widths of a pixel, is another part of the model.
const FAR: f64 = 16.0;

/// Pixels that go to a thread at once: as many packets.
const CHUNK: usize = 1024;

/// What pops of one quantity, over the pixels that count.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pop {
    /// Mean.
    pub mean: f64,
    /// 999 of 1000 pixels are below.
    pub percentile_999: f64,
    /// Largest.
    pub largest: f64,
}

/// What pops from one frame to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Pops {
    /// How far the surface moved, across itself, in widths of a pixel there.
    pub surface: Pop,
    /// Change of the colour, the largest of the three channels, in linear light from 0 to 255.
    pub colour: Pop,
    /// Pixels that count.
    pub pixels: u64,
    /// Pixels of the first frame whose places the second camera sees something else before or behind, or nothing.
    pub left_out: u64,
}

impl Pop {
    fn of(mut values: Vec<f64>) -> Self {
        let Some(last) = values.len().checked_sub(1) else { return Self::default() };
        // In their order: the sum is the same for every run.
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.sort_unstable_by(f64::total_cmp);
        Self { mean, percentile_999: values[(values.len() * 999 / 1000).min(last)], largest: values[last] }
    }
}

/// What pops of a method from `frame`, which the first camera took of it, to the second camera, whose rays see `sight`.
pub fn popping(method: &dyn Method, shader: &Shader<'_>, frame: &Frame, cameras: [&Camera; 2], sight: &Sight) -> Pops {
    let [first, second] = cameras;
    let width = frame.width as usize;
    let seen: Vec<usize> = (0..frame.pixels.len()).filter(|&at| frame.pixels[at].is_some()).collect();
    let chunks = seen.par_chunks(CHUNK).map_init(
        || method.tracer(sight),
        |tracer, chunk| {
            // Columns and rows are below 2^16.
            let before =
                chunk.iter().filter_map(|&at| Some((first.ray((at % width) as u32, (at / width) as u32), frame.pixels[at].as_ref()?)));
            let before: Vec<_> = before.collect();
            let place = |(ray, hit): &(Query, &crate::method::SurfaceHit)| {
                DVec3::from_array(ray.origin) + DVec3::from_array(ray.direction).normalize() * hit.distance
            };
            let ways: Vec<DVec3> = before.iter().map(|before| place(before) - second.eye).collect();
            let queries: Vec<Query> =
                ways.iter().map(|way| Query::new(second.eye.to_array(), way.to_array()).with_cone(0.0, second.tan_theta)).collect();
            let hits = trace_together(&mut **tracer, &queries, &mut NoSteps);
            let (mut surface, mut colour) = (Vec::new(), Vec::new());
            for (((old_ray, old), way), (ray, hit)) in before.iter().zip(&ways).zip(queries.iter().zip(&hits)) {
                let wide = 2.0 * second.tan_theta * way.length();
                let Some(hit) = hit.as_ref().filter(|hit| (hit.distance - way.length()).abs() <= FAR * wide) else { continue };
                let across = hit.plane_normal().map_or(1.0, |plane| plane.as_dvec3().normalize().dot(way.normalize()).abs());
                surface.push((hit.distance - way.length()).abs() * across / wide);
                let [before, after] = [(old_ray, *old), (ray, hit)].map(|(ray, hit)| {
                    let mut light = Light::default();
                    shader.add(&mut light, ray, Some(hit));
                    light.mean()
                });
                colour.push(255.0 * f64::from((after - before).abs().max_element()));
            }
            (surface, colour)
        },
    );
    let (surface, colour): (Vec<_>, Vec<_>) = chunks.collect::<Vec<_>>().into_iter().unzip();
    let (surface, colour) = (surface.concat(), colour.concat());
    let pixels = surface.len() as u64;
    Pops { pixels, left_out: seen.len() as u64 - pixels, surface: Pop::of(surface), colour: Pop::of(colour) }
}
