//! Displacement maps: a picture of heights moves a split surface along its normals, so that its splits get detail that the mesh has not.
//!
//! A point moves by `amount * (height - middle)`. On a side that several trees share it goes to the mean of the places where they would take it: a seam of the map,
//! or a crease of the mesh, does not tear.

mod map;
#[cfg(feature = "exr")]
mod open_exr;

pub use map::{HeightMap, MapFault};

use super::Surface;
use super::subdivide::{SharedPoints, between, shade, weights};
use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;

/// What displaces a surface.
#[derive(Clone, Debug)]
pub struct Displacement {
    /// Heights over the unit square of texture coordinates, repeated beyond it.
    pub map: HeightMap,
    /// How far a height that is larger by 1 moves a point along its normal, in the mesh's own units.
    pub amount: f64,
    /// The height that moves nothing.
    pub middle: f64,
}

/// What was done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Displaced {
    /// The least that a point was moved along its normal, in the mesh's own units.
    pub least: f64,
    /// The most.
    pub most: f64,
    /// Points on shared sides where trees do not agree, by more than a millionth of the map's whole reach: seams of the map and creases.
    pub seam_points: u64,
    /// How far apart trees would take one of them, at most.
    pub seam_gap: f64,
}

/// Why a surface cannot be displaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum DisplaceError {
    /// There are no texture coordinates.
    #[error("it has no texture coordinates, which say where on a displacement map it lies")]
    NoTexture,
    /// Some are missing.
    #[error("triangle {first} has no texture coordinates, and {missing} in all have not three")]
    Missing {
        /// The first of them, counted from 0.
        first: usize,
        /// How many there are.
        missing: usize,
    },
}

/// How many splits give about one point to a texel, for triangles with these texture coordinates, at most `most`.
pub fn levels_for(texture: &[[[f32; 2]; 3]], map: &HeightMap, most: u32) -> u32 {
    let texels: f64 = texture.iter().map(|corners| area(corners, map)).filter(|texels| texels.is_finite()).sum();
    let points = |levels: u32| 0.5 * texture.len() as f64 * f64::from(1_u32 << (2 * levels));
    (0..most).find(|&levels| points(levels) >= texels).unwrap_or(most)
}

/// How many texels a triangle covers.
fn area(corners: &[[f32; 2]; 3], map: &HeightMap) -> f64 {
    let [[ax, ay], [bx, by], [cx, cy]] = corners.map(|uv| uv.map(f64::from));
    0.5 * ((bx - ax) * (cy - ay) - (cx - ax) * (by - ay)).abs() * map.texels() as f64
}

/// Moves the points of `surface`, whose trees have these texture coordinates at their corners, and gives them the normals of what they then are: where trees had one
/// normal at a shared point they have one again, where they had several (creases) each has its own.
///
/// # Errors
/// Texture coordinates are missing.
pub fn displace(surface: &mut Surface, texture: &[[[f32; 2]; 3]], by: &Displacement) -> Result<Displaced, DisplaceError> {
    if texture.len() != surface.triangles.len() {
        return Err(DisplaceError::NoTexture);
    }
    let is_missing = |corners: &[[f32; 2]; 3]| !corners.iter().flatten().all(|c| c.is_finite());
    if let Some(first) = texture.iter().position(is_missing) {
        return Err(DisplaceError::Missing { first, missing: texture.iter().filter(|corners| is_missing(corners)).count() });
    }
    let weights = weights(surface.levels);
    let len = weights.len();
    let moved =
        surface.positions.par_chunks_mut(len).zip(surface.normals.par_chunks(len)).zip(texture).map(|((points, normals), corners)| {
            let corners = corners.map(|uv| uv.map(f64::from));
            let mut range = (f64::INFINITY, f64::NEG_INFINITY);
            for ((point, normal), &weights) in points.iter_mut().zip(normals).zip(&weights) {
                let along = by.amount * (by.map.at(between(corners, weights)) - by.middle);
                range = (range.0.min(along), range.1.max(along));
                let way = DVec3::from_array(normal.map(f64::from)).normalize_or_zero();
                *point = (DVec3::from_array(*point) + along * way).to_array();
            }
            range
        });
    let (least, most) = moved.reduce(|| (f64::INFINITY, f64::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
    let mut done = Displaced { least, most, ..Displaced::default() };
    let shared = SharedPoints::new(&surface.triangles, surface.levels);
    let tolerance = 1e-6 * (by.amount * by.map.range()).abs();
    for group in shared.iter() {
        let places: Vec<DVec3> = group.iter().map(|&at| DVec3::from_array(surface.positions[at])).collect();
        let mean = places.iter().sum::<DVec3>() / places.len() as f64;
        let gap = places.iter().map(|place| place.distance(mean)).fold(0.0, f64::max) * 2.0;
        done.seam_points += u64::from(gap > tolerance);
        done.seam_gap = done.seam_gap.max(gap);
        group.iter().for_each(|&at| surface.positions[at] = mean.to_array());
    }
    shade(surface, &shared.with_one_normal(&surface.normals));
    Ok(done)
}

#[cfg(test)]
mod tests;
