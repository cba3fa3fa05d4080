//! How far what rays hit is from the full-resolution surface, ray by ray.

use super::ErrorSpread;
use crate::format::Scene;
use crate::mesh::FinestSurface;
use crate::method::SurfaceHit;
use crate::rays::{Camera, ModelSpace};
use glam::DVec3;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// Errors of the surface. A pixel is the diameter of its cone at the hit.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SurfaceError {
    /// Distance from the full-resolution hit of the same ray, in pixels, where both hit.
    pub hit: Option<ErrorSpread>,
    /// Distance from the nearest point of the full-resolution surface, in pixels, of all that was hit.
    pub surface: Option<ErrorSpread>,
    /// Between the two hits' full-resolution shading normals, in degrees.
    pub normal_degrees: Option<ErrorSpread>,
    /// What one of them alone hits.
    pub silhouette: Silhouette,
}

/// Pixels hit by one only.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Silhouette {
    /// How many.
    pub pixels: u64,
    /// Of all pixels, 0 to 1.
    pub share: f64,
}

/// What errors are measured against.
pub struct FullResolution<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// Its place in the world.
    pub space: &'a ModelSpace,
    /// Its full-resolution surface.
    pub surface: &'a FinestSurface,
    /// What each pixel's ray met of it.
    pub pixels: &'a [Option<SurfaceHit>],
}

impl SurfaceError {
    /// The errors of what the rays of `camera`, one for each of its pixels, met of `scene`: that of the truth, or what is left of it; one of `stride` columns and rows is held against the nearest point of the surface.
    pub fn of(scene: &Scene, pixels: &[Option<SurfaceHit>], truth: &FullResolution<'_>, camera: &Camera, stride: u32) -> Self {
        let width = camera.width as usize;
        let both = || pixels.iter().zip(truth.pixels).filter_map(|(a, b)| Some(((*a)?, (*b)?)));
        let hit = both().map(|(a, b)| (a.distance - b.distance).abs() / (2.0 * camera.tan_theta * b.distance));
        let degrees: Vec<f64> = (pixels.par_iter().zip(truth.pixels))
            .filter_map(|(a, b)| {
                let [a, b] = [(scene, (*a)?), (truth.scene, (*b)?)].map(|(scene, hit)| hit.normal(scene).as_dvec3());
                // Of nearly equal directions the cosine says little.
                Some(2.0 * (0.5 * (a - b).length()).min(1.0).asin().to_degrees())
            })
            .collect();
        let surface: Vec<f64> = (0..pixels.len())
            .into_par_iter()
            .filter(|at| (at % width).is_multiple_of(stride as usize) && (at / width).is_multiple_of(stride as usize))
            .filter_map(|at| {
                let hit = pixels[at]?;
                let scale = truth.space.placement.scale;
                // Below 2^16 each.
                let ray = camera.ray((at % width) as u32, (at / width) as u32);
                let p = DVec3::from_array(ray.origin) + DVec3::from_array(ray.direction) * hit.distance;
                let guess = truth.pixels[at].map_or(f64::INFINITY, |full| (full.distance - hit.distance).abs() / scale + 1.0);
                let apart = truth.surface.distance(truth.space.to_units(p.to_array()), guess);
                Some(apart * scale / (2.0 * camera.tan_theta * hit.distance))
            })
            .collect();
        let alone = pixels.iter().zip(truth.pixels).filter(|(a, b)| a.is_some() != b.is_some()).count() as u64;
        Self {
            hit: ErrorSpread::of(hit),
            surface: ErrorSpread::of(surface),
            normal_degrees: ErrorSpread::of(degrees),
            silhouette: Silhouette { pixels: alone, share: alone as f64 / pixels.len().max(1) as f64 },
        }
    }
}
