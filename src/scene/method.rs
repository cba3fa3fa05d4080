//! Methods by name, and rays cast with them.

use crate::block::{FIRST_SHARED, Operation};
use crate::bvh::BvhError;
use crate::format::Scene;
use crate::method::bvh::NoStore;
use crate::method::{Crossings, KnobError, Knobs, METHODS, Method, Registered, find, lod};
use crate::rays::{ModelSpace, RaySource, Sight};
use crate::run::{ClosestOnly, HitRow, cast, cast_all, cast_any, cast_counting};
use std::collections::HashSet;
use thiserror::Error;

/// A way to find hits that there is not.
#[derive(Debug, Error)]
pub enum MethodError {
    /// No method has this name.
    #[error("there is no method '{0}', but: {names}", names = METHODS.iter().map(|method| method.name).collect::<Vec<_>>().join(", "))]
    Unknown(String),
    /// The method has no such knob.
    #[error("{name} has no knob '{knob}', but: {names}", name = method.name, names = method.knobs.iter().map(|knob| knob.name).collect::<Vec<_>>().join(", "))]
    NoKnob {
        /// The method.
        method: &'static Registered,
        /// The name.
        knob: String,
    },
    /// The knob has no such value.
    #[error(transparent)]
    Value(#[from] KnobError),
    /// The scene was pruned for a job.
    #[error("the scene was pruned for a job: {0} needs the full resolution, and there is but what lod's rays read")]
    Pruned(&'static str),
    /// What it needs cannot be built.
    #[error(transparent)]
    Bvh(#[from] BvhError),
}

/// A way to find hits in a scene, with what it needs for that. It keeps the scene.
pub struct SceneMethod {
    scene: Scene,
    registered: &'static Registered,
    knobs: Knobs,
    method: Box<dyn Method>,
}

impl Scene {
    /// The method of this name, with its knobs as they are by default: [`METHODS`] has all.
    ///
    /// # Errors
    /// There is none of this name, or what it needs cannot be built.
    pub fn method(&self, name: &str) -> Result<SceneMethod, MethodError> {
        self.method_with(name, &[])
    }

    /// The same with some knobs turned: names and values as the options of the program have them, such as `("delta", "0.5")`.
    ///
    /// # Errors
    /// Besides, a knob that it does not have, or no such value.
    pub fn method_with(&self, name: &str, knobs: &[(&str, &str)]) -> Result<SceneMethod, MethodError> {
        self.method_of(find(name).ok_or_else(|| MethodError::Unknown(name.to_owned()))?, knobs)
    }

    /// The same of a method that need not be in [`METHODS`], such as one of your own.
    ///
    /// # Errors
    /// As above, but for the name.
    ///
    /// # Panics
    /// It has more operations of its own than there are numbers below [`FIRST_SHARED`], or two of one name, or one with the name of a block.
    pub fn method_of(&self, registered: &'static Registered, knobs: &[(&str, &str)]) -> Result<SceneMethod, MethodError> {
        let works: HashSet<_> = registered.works.iter().map(|work| work.name).collect();
        let is_new = Operation::ALL.into_iter().all(|block| !works.contains(block.name()));
        assert!(
            works.len() == registered.works.len() && works.len() <= FIRST_SHARED as usize && is_new,
            "{}: its operations",
            registered.name
        );
        let mut turned = Knobs::default();
        for &(name, value) in knobs {
            let knob = registered.knobs.iter().find(|knob| knob.name == name);
            turned.set(knob.ok_or_else(|| MethodError::NoKnob { method: registered, knob: name.to_owned() })?, value)?;
        }
        if !self.meta().is_whole() && registered.name != lod::METHOD.name {
            return Err(MethodError::Pruned(registered.name));
        }
        let method = (registered.make)(self, &turned, &NoStore)?;
        Ok(SceneMethod { scene: self.clone(), registered, knobs: turned, method })
    }
}

impl SceneMethod {
    /// What every ray meets, in their order, by all threads; a ray's cone says which detail it needs ([`Query::with_cone`](crate::rays::Query::with_cone)).
    /// Each starts at its own origin, whichever ray it names as the one before ([`cast_following`](crate::run::cast_following) starts it there). Of a scene that
    /// was pruned for a job, hits are right for that job's rays alone.
    pub fn cast(&self, rays: &dyn RaySource) -> Vec<HitRow> {
        cast(&*self.method, self.traced(), rays, &self.sight(rays), &|_| ())
    }

    /// Whether every ray meets anything.
    pub fn meets(&self, rays: &dyn RaySource) -> Vec<bool> {
        cast_any(&*self.method, rays, &self.sight(rays), &|_| ())
    }

    /// Every hit of every ray, nearest first. Of a closed surface each crossing is there once, also where a ray goes through an edge or a vertex.
    ///
    /// # Errors
    /// The method finds but the closest, as `reference` does.
    pub fn cast_all(&self, rays: &dyn RaySource) -> Result<Vec<Vec<HitRow>>, ClosestOnly> {
        cast_all(&*self.method, self.traced(), rays, &self.sight(rays), &|_| ())
    }

    /// How many fronts and backs every ray meets.
    ///
    /// # Errors
    /// As above.
    pub fn crossings(&self, rays: &dyn RaySource) -> Result<Vec<Crossings>, ClosestOnly> {
        cast_counting(&*self.method, rays, &self.sight(rays), &|_| ())
    }

    /// What rays see of the scene.
    pub fn sight(&self, rays: &dyn RaySource) -> Sight {
        Sight::new(rays, &ModelSpace::of(self.traced()), self.knobs.delta())
    }

    /// The scene whose triangles rays meet: that of the mesh that the scene was built from, if the method is over that.
    pub fn traced(&self) -> &Scene {
        // Such a method was made of it.
        self.scene.input().filter(|_| self.registered.of_input()).unwrap_or(&self.scene)
    }

    /// The scene.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Its entry in the registry.
    pub fn registered(&self) -> &'static Registered {
        self.registered
    }

    /// Its knobs, those that were turned.
    pub fn knobs(&self) -> &Knobs {
        &self.knobs
    }

    /// The method itself.
    pub fn method(&self) -> &dyn Method {
        &*self.method
    }
}
