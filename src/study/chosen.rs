//! A method with its knobs, and what it needs for a scene.

use super::cache::{Cache, Lookup};
use super::progress::{Progress, busy};
use crate::bvh::BvhError;
use crate::format::Scene;
use crate::method::{Knobs, Method, Registered, lod};
use thiserror::Error;

/// A method and its knobs.
#[derive(Clone, Debug, PartialEq)]
pub struct Chosen {
    /// The method.
    pub method: &'static Registered,
    /// Its knobs, those that were turned.
    pub knobs: Knobs,
}

/// A method that a scene does not serve.
#[derive(Debug, Error)]
pub enum ChosenError {
    /// It is over a mesh that is not at hand.
    #[error("--method {method}: the mesh that {scene} was built from is not at hand; simulate, sweep and error-time look for it")]
    NoInput {
        /// The method.
        method: &'static str,
        /// The scene.
        scene: String,
    },
    /// It needs all of the scene.
    #[error("scene {scene} was pruned for a job: method: {method} needs the full resolution, and there is but what lod's rays read")]
    Pruned {
        /// The method.
        method: &'static str,
        /// The scene.
        scene: String,
    },
    /// What it needs cannot be built.
    #[error("building what {method} needs")]
    Building {
        /// The method.
        method: &'static str,
        /// Why.
        source: BvhError,
    },
}

impl Chosen {
    /// A method with its knobs as they are by default.
    pub fn plain(method: &'static Registered) -> Self {
        Self { method, knobs: Knobs::default() }
    }

    /// Quality of its level of detail.
    pub fn delta(&self) -> f64 {
        self.knobs.delta()
    }

    /// Builds what it needs for a scene, or takes it from the cache, and whether all was taken.
    ///
    /// # Errors
    /// Those of [`Self::check`], or what it needs cannot be built.
    pub fn make(&self, scene: &Scene, cache: &Cache, progress: &dyn Progress) -> Result<(Box<dyn Method>, bool), ChosenError> {
        self.check(scene)?;
        let lookup = Lookup::new(cache, progress);
        let method = self.method.name;
        let made = busy(progress, &format!("building what {method} needs"), || (self.method.make)(scene, &self.knobs, &lookup));
        Ok((made.map_err(|source| ChosenError::Building { method, source })?, lookup.was_read()))
    }

    /// Refuses a method that needs the full resolution on a scene that was pruned for a job, and one over an input mesh that is not at hand.
    ///
    /// # Errors
    /// It is one.
    pub fn check(&self, scene: &Scene) -> Result<(), ChosenError> {
        let (method, name) = (self.method.name, || scene.meta().name.clone());
        if self.method.of_input() && scene.input().is_none() {
            return Err(ChosenError::NoInput { method, scene: name() });
        }
        if !scene.meta().is_whole() && self.method != &lod::METHOD {
            return Err(ChosenError::Pruned { method, scene: name() });
        }
        Ok(())
    }
}
