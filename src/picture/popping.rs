//! What pops between two frames of a moving camera.
//!
//! Wherever the first frame saw the surface, the second camera looks at that very place: where nothing has changed it is met there, exactly, as full resolution is. What pops is how far
//! the surface is from it then, across the surface. It changes smoothly where level of detail is continuous, less the less the camera moves, and at once where another level takes over. At
//! outlines the second camera may see another part of the model: places where it meets another point of the full resolution, or where the surface is seen edge-on, are left out.

use super::frame::Frame;
use super::shade::encoded;
use super::shading::{Light, Shader};
use crate::format::Scene;
use crate::method::{Method, SurfaceHit, trace_together};
use crate::rays::{Camera, ModelSpace, Query, Sight};
use crate::step::NoSteps;
use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Points of the full resolution that are farther apart, in widths of a pixel, are not one place: hits may be off by 1.5 each way at delta 1.
const APART: f64 = 4.0;

/// Least cosine between a ray and the normal of what it meets: flatter, a ray's rounding decides what it meets.
const EDGE_ON: f64 = 0.125;

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
    /// Change of the colour there, the largest of the three channels, in steps of 8 bits.
    pub colour: Pop,
    /// Pixels that count.
    pub pixels: u64,
    /// Pixels of the first frame whose places the second camera sees edge-on, or with something else before or behind, or nothing there.
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

/// The point of the full resolution that a hit stands for.
fn point(scene: &Scene, space: &ModelSpace, hit: &SurfaceHit) -> DVec3 {
    let corners = scene.full_resolution_triangle(hit.tree as usize, hit.full_node as usize);
    let own: DVec3 = corners.iter().zip(hit.full_bary).map(|(p, b)| DVec3::from_array(p.map(f64::from)) * f64::from(b)).sum();
    DVec3::from_array(space.placement.offset) + own * space.placement.scale
}

/// The cosine between a ray of length 1 and the normal of the triangle that it met.
fn across(hit: &SurfaceHit, ray: DVec3) -> f64 {
    hit.plane_normal().map_or(0.0, |plane| plane.as_dvec3().normalize_or_zero().dot(ray).abs())
}

/// What pops of a method from `frame`, which the first camera took of it, to the second camera, whose rays see `sight`. Its hits are on triangles of `scene`, which `shader` shades.
pub fn popping(method: &dyn Method, scene: &Scene, shader: &Shader<'_>, frame: &Frame, cameras: [&Camera; 2], sight: &Sight) -> Pops {
    let space = ModelSpace::of(scene);
    let [first, second] = cameras;
    let width = frame.width as usize;
    let seen: Vec<usize> = (0..frame.pixels.len()).filter(|&at| frame.pixels[at].is_some()).collect();
    let chunks = seen.par_chunks(CHUNK).map_init(
        || method.tracer(sight),
        |tracer, chunk| {
            // Columns and rows are below 2^16.
            let ray = |at: usize| first.ray((at % width) as u32, (at / width) as u32);
            let before: Vec<(Query, &SurfaceHit)> = chunk.iter().filter_map(|&at| Some((ray(at), frame.pixels[at].as_ref()?))).collect();
            let direction = |ray: &Query| DVec3::from_array(ray.direction).normalize();
            let place = |(ray, hit): &(Query, &SurfaceHit)| DVec3::from_array(ray.origin) + direction(ray) * hit.distance;
            let ways: Vec<DVec3> = before.iter().map(|before| place(before) - second.eye).collect();
            let query = |way: &DVec3| Query::new(second.eye.to_array(), way.normalize().to_array()).with_cone(0.0, second.tan_theta);
            let queries: Vec<Query> = ways.iter().map(query).collect();
            let hits = trace_together(&mut **tracer, &queries, &mut NoSteps);
            let (mut surface, mut colour) = (Vec::new(), Vec::new());
            for (((old_ray, old), way), (ray, hit)) in before.iter().zip(&ways).zip(queries.iter().zip(&hits)) {
                let Some(hit) = hit else { continue };
                let (wide, cosine) = (2.0 * second.tan_theta * way.length(), across(hit, direction(ray)));
                let apart = (point(scene, &space, hit) - point(scene, &space, old)).length();
                if apart > APART * wide || cosine < EDGE_ON || across(old, direction(old_ray)) < EDGE_ON {
                    continue;
                }
                surface.push((hit.distance - way.length()).abs() * cosine / wide);
                let [before, after] = [(old_ray, *old), (ray, hit)].map(|(ray, hit)| {
                    let mut light = Light::default();
                    shader.add(&mut light, ray, Some(hit));
                    encoded(light.mean()).0
                });
                colour.push((0..3).map(|k| f64::from(before[k].abs_diff(after[k]))).fold(0.0, f64::max));
            }
            (surface, colour)
        },
    );
    let (surface, colour): (Vec<_>, Vec<_>) = chunks.collect::<Vec<_>>().into_iter().unzip();
    let (surface, colour) = (surface.concat(), colour.concat());
    let pixels = surface.len() as u64;
    Pops { pixels, left_out: seen.len() as u64 - pixels, surface: Pop::of(surface), colour: Pop::of(colour) }
}
