//! What goes in and out of the traversal unit, as bits.

use super::RayError;
use crate::method::Hit;
use crate::num::{BoundScale, LineAddress, Ray, U, wire_struct};

/// Number of a context's rays, modulo 2^8: what tells their lines apart.
pub type Epoch = U<8>;
/// How long a memory line may take.
pub type AnswerLimit = U<20>;

wire_struct! {
    /// The model that the rays meet, and what bounds their ways; held still while rays are under way.
    pub struct SceneConfig {
        /// Number of splits N.
        levels: U<4>,
        /// Zero bits at the bottom of all coordinates: of morphed triangles too, and of the rays' origins.
        zeros: U<5>,
        /// Inserted vertices are stored as displacements from the midpoints of their edges.
        compact: bool,
        /// Scale of the displacement bounds.
        scale: BoundScale,
        /// First line of the quad-BVH's nodes.
        nodes: LineAddress,
        /// First line of the L0 records.
        records: LineAddress,
        /// First line of the bound data.
        bounds: LineAddress,
        /// First line of the vertex data.
        vertices: LineAddress,
        /// The most entries that a ray can visit: quad-BVH nodes, trees, and nodes of trees. A ray that would visit more is in a loop.
        visits: U<32>,
        /// Cycles, less one, after which a line that is waited for counts as late if it has not come in as many more.
        answer_limit: AnswerLimit,
    }
}

wire_struct! {
    /// A ray to trace.
    pub struct RayIn {
        /// Comes back with the hit.
        tag: U<32>,
        /// The ray in model space.
        ray: Ray,
    }
}

wire_struct! {
    /// A ray traced.
    pub struct HitOut {
        /// The ray's tag.
        tag: U<32>,
        /// Why it ended early: a code of `ray_error_t`. 0: it did not.
        error: U<3>,
        /// The ray met something; 0 if it ended early.
        found: bool,
        /// What; all zero if nothing.
        hit: Hit,
    }
}

impl HitOut {
    /// Why the ray ended early.
    pub fn error(&self) -> Option<RayError> {
        RayError::of_code(self.error)
    }
}

wire_struct! {
    /// A memory line asked for.
    pub struct MemoryRequest {
        /// Ray context (upper six bits) and place of the line in its record (lower two).
        tag: U<8>,
        /// Of the context's rays, the one that asks: comes back with the line.
        epoch: Epoch,
        /// The line.
        address: LineAddress,
    }
}

wire_struct! {
    /// A memory line that came.
    pub struct MemoryAnswer {
        /// Tag of the request.
        tag: U<8>,
        /// Its epoch.
        epoch: Epoch,
        /// There is no such line, or it could not be read.
        error: bool,
        /// Its 32 bytes, word 0 first.
        line: [U<64>; 4],
    }
}
