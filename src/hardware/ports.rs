//! What goes in and out of the traversal unit, as bits.

use crate::method::Hit;
use crate::num::{BoundScale, LineAddress, Ray, U, wire_struct};

wire_struct! {
    /// The model that the rays meet; held still while rays are under way.
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
        /// The ray met something.
        found: bool,
        /// What; all zero if nothing.
        hit: Hit,
    }
}

wire_struct! {
    /// A memory line asked for.
    pub struct MemoryRequest {
        /// Ray context (upper six bits) and place of the line in its record (lower two).
        tag: U<8>,
        /// The line.
        address: LineAddress,
    }
}

wire_struct! {
    /// A memory line that came.
    pub struct MemoryAnswer {
        /// Tag of the request.
        tag: U<8>,
        /// Its 32 bytes, word 0 first.
        line: [U<64>; 4],
    }
}
