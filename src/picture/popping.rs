//! What pops between two frames of a moving camera.
//!
//! A hit stands for a point of the full resolution, from which it is off by a little. While the camera moves, that little changes: smoothly where level of detail is continuous,
//! at once where another level takes over. So what pops of the surface is how much it changes in a pixel that sees nearly the same point of the full resolution in both frames; what pixels
//! at outlines see changes however little the camera moves, and is left out.

use super::frame::Frame;
use crate::format::Scene;
use crate::method::SurfaceHit;
use crate::rays::{Camera, ModelSpace};
use glam::DVec3;
use image::RgbImage;
use serde::{Deserialize, Serialize};

/// How far apart two points of the full resolution may be that are nearly the same, in widths of a pixel, beyond how far the camera moved.
const SAME: f64 = 1.0;

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
    /// Change of how far, and which way, the surface is off the full resolution, in widths of a pixel there.
    pub surface: Pop,
    /// Change of the colour beyond that of full resolution, the largest of the three channels, in steps of 8 bits.
    pub colour: Pop,
    /// Pixels that count.
    pub pixels: u64,
    /// Pixels that see the model in both frames, but other points of it.
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

/// A frame of a method, its picture, and that of full resolution.
#[derive(Clone, Copy)]
pub struct Seen<'a> {
    /// What its rays met.
    pub frame: &'a Frame,
    /// Its picture.
    pub image: &'a RgbImage,
    /// The picture of full resolution.
    pub full: &'a RgbImage,
    /// Where both were taken from.
    pub camera: &'a Camera,
}

/// The point of the full resolution that a hit stands for, and how far the hit is off it.
fn places(scene: &Scene, space: &ModelSpace, seen: &Seen<'_>, at: usize) -> Option<(DVec3, DVec3)> {
    let hit: &SurfaceHit = seen.frame.pixels[at].as_ref()?;
    let width = seen.frame.width as usize;
    // Columns and rows are below 2^16.
    let ray = seen.camera.ray((at % width) as u32, (at / width) as u32);
    let met = DVec3::from_array(ray.origin) + DVec3::from_array(ray.direction).normalize() * hit.distance;
    let corners = scene.full_resolution_triangle(hit.tree as usize, hit.full_node as usize);
    let own: DVec3 = corners.iter().zip(hit.full_bary).map(|(p, b)| DVec3::from_array(p.map(f64::from)) * f64::from(b)).sum();
    let full = DVec3::from_array(space.placement.offset) + own * space.placement.scale;
    Some((full, met - full))
}

/// What pops from the first frame to the second, whose hits are on triangles of `scene`.
pub fn popping(scene: &Scene, space: &ModelSpace, seen: [Seen<'_>; 2]) -> Pops {
    let moved = (seen[1].camera.eye - seen[0].camera.eye).length();
    let (mut surface, mut colours, mut left_out) = (Vec::new(), Vec::new(), 0);
    for at in 0..seen[0].frame.pixels.len() {
        let [Some((before, off_before)), Some((after, off_after))] = seen.map(|seen| places(scene, space, &seen, at)) else { continue };
        let wide = 2.0 * seen[1].camera.tan_theta * (after - seen[1].camera.eye).length();
        if (after - before).length() > SAME * wide + moved {
            left_out += 1;
            continue;
        }
        surface.push((off_after - off_before).length() / wide);
        let change = |images: [&RgbImage; 2], k: usize| {
            let [before, after] = images.map(|image| i32::from(image.as_raw()[3 * at + k]));
            after - before
        };
        let (own, full) = (seen.map(|seen| seen.image), seen.map(|seen| seen.full));
        let channel = |k| (change(own, k) - change(full, k)).abs();
        colours.push(f64::from((0..3).map(channel).max().unwrap_or(0)));
    }
    Pops { pixels: surface.len() as u64, left_out, surface: Pop::of(surface), colour: Pop::of(colours) }
}
