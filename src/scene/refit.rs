//! Scenes whose vertices move.

use crate::bvh::refit_over_trees;
use crate::format::{Refit, RefitError, RefitOptions, Scene};

impl Scene {
    /// The scene with the vertices of its finest level at these positions, in the order in which `export` writes them. Its base triangles, its splits and the tree of its quad-BVH stay; boxes, bounds, codes and
    /// whatever else follows from positions is what building it from them would make. For many frames [`Scene::refitting`] is faster.
    ///
    /// # Errors
    /// As many positions as it has no vertices, one that is not finite, or a scene that was pruned for a job.
    pub fn refit(&self, positions: &[[f64; 3]], options: RefitOptions) -> Result<Self, RefitError> {
        let mut refit = self.refitting()?;
        refit.move_to(positions, options)?;
        Ok(refit.into_scene())
    }

    /// Gets it ready to be refitted frame after frame.
    ///
    /// # Errors
    /// It was pruned for a job.
    pub fn refitting(&self) -> Result<Refit, RefitError> {
        Refit::new(self, refit_over_trees)
    }
}
