//! Where trees that take long to build are kept, if they are.

use super::{FullTree, TreeKey};
use crate::bvh::BvhError;

/// Keeps trees, or does not.
pub trait TreeStore {
    /// The tree of `key` over `triangles` triangles: kept from before, or what `build` makes.
    ///
    /// # Errors
    /// Those of `build`.
    fn tree(
        &self,
        key: &dyn Fn() -> TreeKey,
        triangles: u64,
        build: &mut dyn FnMut() -> Result<FullTree, BvhError>,
    ) -> Result<FullTree, BvhError>;
}

/// Keeps nothing.
pub struct NoStore;

impl TreeStore for NoStore {
    fn tree(&self, _: &dyn Fn() -> TreeKey, _: u64, build: &mut dyn FnMut() -> Result<FullTree, BvhError>) -> Result<FullTree, BvhError> {
        build()
    }
}
