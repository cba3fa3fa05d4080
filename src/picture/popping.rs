//! What pops between two frames of a moving camera: what a method changes beyond what full resolution changes.

use super::frame::Frame;
use crate::method::SurfaceHit;
use crate::rays::Camera;
use image::RgbImage;
use serde::{Deserialize, Serialize};

/// Depths of neighbours within so many pixels belong to one surface.
const SMOOTH: f64 = 8.0;

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
    /// Change of the depth of a pixel that full resolution does not have, in widths of a pixel there: 1 where it is as far as a pixel is wide.
    pub depth: Pop,
    /// The same of its colour, the largest of the three channels, in steps of 8 bits.
    pub colour: Pop,
    /// Pixels that count.
    pub pixels: u64,
    /// Pixels at an outline, where full resolution has another depth in a neighbour, in either frame: what they see changes however little the camera moves.
    pub outlines: u64,
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

/// A frame with its picture.
pub type Seen<'a> = (&'a Frame, &'a RgbImage);

/// What pops from the first frame to the second of a method, whose rays and full resolution's are those of the two cameras.
pub fn popping(own: [Seen<'_>; 2], full: [Seen<'_>; 2], cameras: [&Camera; 2]) -> Pops {
    let (width, height) = (full[0].0.width as usize, full[0].0.height as usize);
    let depth = |(frame, _): Seen<'_>, at: usize| frame.pixels[at].as_ref().map(|hit: &SurfaceHit| hit.distance);
    let wide = |camera: &Camera, depth: f64| 2.0 * camera.tan_theta * depth;
    // All neighbours, and the pixel, are of one surface in this frame.
    let is_smooth = |seen: Seen<'_>, camera: &Camera, at: usize| {
        let (x, y) = (at % width, at / width);
        let Some(own) = depth(seen, at) else { return false };
        let near = |v: usize, most: usize| v.saturating_sub(1)..(v + 2).min(most);
        near(y, height).all(|y| {
            near(x, width).all(|x| depth(seen, y * width + x).is_some_and(|other| (other - own).abs() <= SMOOTH * wide(camera, own)))
        })
    };
    let (mut depths, mut colours, mut outlines) = (Vec::new(), Vec::new(), 0);
    for at in 0..width * height {
        let [Some(a), Some(b)] = full.map(|seen| depth(seen, at)) else { continue };
        if !(0..2).all(|k| is_smooth(full[k], cameras[k], at)) {
            outlines += 1;
            continue;
        }
        // A hole of the method's pops as far as anything can.
        let [own_a, own_b] = own.map(|seen| depth(seen, at).unwrap_or(0.0));
        depths.push(((own_b - own_a) - (b - a)).abs() / wide(cameras[1], b));
        let colour = |(_, image): Seen<'_>| image.as_raw()[3 * at..3 * at + 3].iter().map(|&c| i32::from(c)).collect::<Vec<_>>();
        let [own, full] = [own, full].map(|two| two.map(colour));
        let channel = |k: usize| ((own[1][k] - own[0][k]) - (full[1][k] - full[0][k])).abs();
        colours.push(f64::from((0..3).map(channel).max().unwrap_or(0)));
    }
    Pops { pixels: depths.len() as u64, outlines, depth: Pop::of(depths), colour: Pop::of(colours) }
}
