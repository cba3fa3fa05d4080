//! Frames of several models on machines.

use super::simulate::{Described, Outcome, PassRays, Target};
use crate::method::{Knobs, Registered};
use crate::paths::{World, WorldFrame};
use crate::report::result::{MethodFacts, SceneFacts};
use crate::run::Traced;
use crate::step::MapError;

/// A frame of several models to run: a ray for each pixel, or those of a file, through all of them.
pub struct WorldPass<'a> {
    /// The models, for these rays: one world for all of their frames, or one for each.
    pub worlds: &'a [World<'a>],
    /// What results say of them.
    pub scene: SceneFacts,
    /// How rays find their hits, in all models.
    pub registered: &'static Registered,
    /// The method's knobs.
    pub knobs: &'a Knobs,
    /// The rays.
    pub rays: PassRays,
}

impl WorldPass<'_> {
    /// Traces the rays once and replays them on every target; `look` sees them, in order, as they are traced.
    ///
    /// # Errors
    /// The models have more lines than can be numbered.
    pub fn run(&self, targets: &[Target], look: &mut dyn FnMut(&Traced)) -> Result<Vec<Outcome>, MapError> {
        let frame = WorldFrame::new(self.worlds, self.rays.source())?;
        let map = frame.map();
        let of_frame = Described {
            frame: &frame,
            map,
            scene: self.scene.clone(),
            registered: self.registered,
            method: MethodFacts::new(self.registered, self.knobs, &self.worlds[0].choices(), map.bytes()),
            rays: &self.rays,
        };
        Ok(of_frame.run(targets, look))
    }
}
