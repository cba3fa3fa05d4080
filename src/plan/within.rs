//! Grids so coarse that nothing that is seen moves by more than some pixels.
//!
//! On a grid of Z zero bits a vertex moves by [`coarsened_by`] units, an origin by sqrt(3)/2 2^Z, and what morphing rounds by 3 2^(N+Z) in all (docs/error-bound.md, "Roundings and
//! nearness"): together C world units, wherever the ray is. A direction of D zero bits turns by sqrt(3)/2 2^(D-30). A pixel is 2 (r + l tan theta) wide at the distance l
//! behind the ray's entry, r the cone's radius there. So nothing moves by more than w pixels if C <= 2 w r and the turn is at most 2 w tan theta, for all rays of the job.

use crate::format::{JobRegion, Meta, Scene};
use crate::mesh::{coarsened_by, most_zeros};
use crate::num::MOST_DIRECTION_ZEROS;
use crate::rays::{ModelSpace, RaySource};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};

/// The coarsest grids within some pixels.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, rename_all = "kebab-case")]
pub struct Within {
    /// The most that anything that is seen may move, in pixels.
    pub pixels: f64,
    /// Zero bits at the bottom of coordinates.
    pub coordinate_zeros: u32,
    /// Zero bits at the bottom of components of directions.
    pub direction_zeros: u32,
}

/// The narrowest cones of some rays: radius where a ray enters the model, in world units, and growth with the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Narrowest {
    radius: f64,
    tan_theta: f64,
}

impl Narrowest {
    /// Of no ray.
    pub const NONE: Self = Self { radius: f64::INFINITY, tan_theta: f64::INFINITY };

    /// Of the rays of a source that enter the model.
    pub fn of(space: &ModelSpace, source: &dyn RaySource) -> Self {
        let batch = |batch: usize| {
            let mut least = Self::NONE;
            source.batch(batch, &mut |_, query| {
                if let Some(entered) = space.enter(query, 1.0) {
                    least = least.with(Self { radius: query.radius + entered.start * query.tan_theta, tan_theta: query.tan_theta });
                }
            });
            least
        };
        (0..source.batches()).into_par_iter().map(batch).reduce(|| Self::NONE, Self::with)
    }

    /// Of all rays of a region.
    pub fn of_region(space: &ModelSpace, region: &JobRegion) -> Self {
        Self { radius: region.cone * space.distance_between(region.lo, region.hi), tan_theta: region.cone }
    }

    /// Of both.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self { radius: self.radius.min(other.radius), tan_theta: self.tan_theta.min(other.tan_theta) }
    }
}

/// What a model of these zero bits moves by wherever the ray is, in units.
fn moved(meta: &Meta, zeros: u32) -> f64 {
    let step = f64::from(1u32 << zeros);
    let morphs = 3.0 * f64::from(1u32 << meta.levels) * step;
    coarsened_by(meta.levels, zeros, meta.vertices.is_compact()) + 0.5 * 3f64.sqrt() * step + morphs
}

impl Within {
    /// The most zero bits of a scene and its rays that move nothing by more than `pixels`; as many as it has where there are no more.
    pub fn of(scene: &Scene, rays: &Narrowest, pixels: f64) -> Self {
        let meta = scene.meta();
        let room = 2.0 * pixels * rays.radius / meta.placement.scale;
        let turn = |zeros: u32| 0.5 * 3f64.sqrt() * 2f64.powi(zeros as i32 - 30); // at most 14
        let coordinate_zeros = (0..=most_zeros(meta.levels)).rev().find(|&zeros| moved(meta, zeros) <= room).unwrap_or(0);
        let direction_zeros = (0..=MOST_DIRECTION_ZEROS).rev().find(|&zeros| turn(zeros) <= 2.0 * pixels * rays.tan_theta).unwrap_or(0);
        Self {
            pixels,
            coordinate_zeros: coordinate_zeros.max(meta.coordinate_zeros),
            direction_zeros: direction_zeros.max(meta.direction_zeros),
        }
    }

    /// What serves both.
    #[must_use]
    pub fn with(self, other: Self) -> Self {
        Self {
            pixels: self.pixels.min(other.pixels),
            coordinate_zeros: self.coordinate_zeros.min(other.coordinate_zeros),
            direction_zeros: self.direction_zeros.min(other.direction_zeros),
        }
    }
}
