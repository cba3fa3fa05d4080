//! A scene looked through once, for all that is asked about it.

use super::scene::{Met, met};
use super::{Data, RayNeeds, SceneNeeds};
use crate::format::{JobRegion, Scene};
use crate::rays::RaySource;

/// A scene and what was met on the way through all its trees.
pub struct Measure<'a> {
    scene: &'a Scene,
    met: Met,
}

impl<'a> Measure<'a> {
    /// Looks through a scene: each node of each tree that some ray could read.
    pub fn of(scene: &'a Scene) -> Self {
        Self { scene, met: met(scene) }
    }

    /// What it needs.
    pub fn needs(&self) -> SceneNeeds {
        SceneNeeds::of(self.scene, &self.met)
    }

    /// What the rays of `source` need on it at quality `delta`; those that miss the model's box need nothing.
    pub fn rays(&self, source: &dyn RaySource, delta: f64) -> RayNeeds {
        RayNeeds::of(self.scene, &self.met, source, delta)
    }

    /// What all rays of a region need on it, of which none goes below `deepest_level` ([`Reach::add_region`](super::Reach::add_region)).
    pub fn region(&self, region: &JobRegion, deepest_level: u32) -> RayNeeds {
        RayNeeds::of_region(self.scene, region, deepest_level)
    }

    /// Its bytes, and those if no more levels of each tree were stored than this.
    pub fn data(&self, depths: &[u32]) -> Data {
        Data::of(self.scene, &self.met, depths)
    }
}
