//! What goes in and out of the traversal unit, as bits.

use super::RayError;
use crate::method::{Departure, Hit, Prior};
use crate::num::{BoundScale, LineAddress, Point, Ray, RayT, START_BITS, U, wire_struct};

/// Number of a context's rays, modulo 2^8: what tells their lines apart.
pub type Epoch = U<8>;
/// Rays that a context may take while it is owed lines, far fewer than there are epochs; and ticks of the limit of answers in an age.
pub type Behind = U<4>;
/// Lines that a context's rays have asked for and that have not come: two of each of these rays at most, and of the one before.
pub type Owed = U<6>;
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
        /// Those of last splits have 7 bits a coordinate. Of no meaning where vertices are no displacements.
        short_splits: bool,
        /// Scale of the displacement bounds.
        scale: BoundScale,
        /// First line of the quad-BVH's nodes.
        nodes: LineAddress,
        /// First line of the L0 records.
        records: LineAddress,
        /// First line of the splits.
        splits: LineAddress,
        /// First line of the vertex data.
        vertices: LineAddress,
        /// First split of each level from 1 on.
        split_starts: [U<28>; 8],
        /// Exact vertices: first line of each level from 1 on. Compact ones: the two lines, or short ones the line, that the tree at place 0 would have for the first four nodes there, modulo 2^28.
        vertex_starts: [U<28>; 9],
        /// The most entries that a ray can visit: quad-BVH nodes, trees, and nodes of trees. A ray that would visit more is in a loop.
        visits: U<32>,
        /// Cycles, less one, after which a line that is waited for counts as late if it has not come in as many more.
        answer_limit: AnswerLimit,
    }
}

impl SceneConfig {
    /// First split of a level.
    pub fn split_start(&self, level: u64) -> U<28> {
        Self::of_level(&self.split_starts, level)
    }

    /// Where the vertices of a level begin.
    pub fn vertex_start(&self, level: u64) -> U<28> {
        Self::of_level(&self.vertex_starts, level)
    }

    fn of_level(starts: &[U<28>], level: u64) -> U<28> {
        (level as usize).checked_sub(1).and_then(|at| starts.get(at)).copied().unwrap_or(U::ZERO) // four bits
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
    /// What a ray has that starts on a surface or wants less than the closest hit: comes with the ray, to hardware for such rays ([`Hardware::secondary`](super::Hardware::secondary));
    /// other hardware does not look at it. Of a primary ray all is 0 but `t_max`, which has all bits.
    pub struct SecondaryIn {
        /// The smallest t that counts.
        t_min: RayT,
        /// The largest t that counts.
        t_max: RayT,
        /// Any hit serves: the ray ends with the closest of the first triangles tested together of which one is met.
        any: bool,
        /// What its start has beyond the ray's origin, in steps of 2^-31 units.
        fraction: [U<START_BITS>; 3],
        /// Rays before it decide about levels around its start; all that follows is theirs.
        prior: bool,
        /// Base triangle of the last hit.
        last: U<28>,
        /// Its corner p0.
        a0: Point,
        /// Its corner p1.
        a1: Point,
        /// Its corner p2.
        a2: Point,
        /// Of its edges (p1, p2), (p2, p0), (p0, p1): the second ray decides, not the first.
        by_second: [bool; 3],
        /// The ray that decides inside it, and about its other edges.
        first: Ray,
        /// The second ray.
        second: Ray,
    }
}

wire_struct! {
    /// Corners of the triangle of a hit, as it was tested: what the exact start of rays from there is made of.
    pub struct Corners {
        /// Its corner p0.
        p0: Point,
        /// Its corner p1.
        p1: Point,
        /// Its corner p2.
        p2: Point,
    }
}

impl SecondaryIn {
    /// That of a primary ray.
    pub fn primary() -> Self {
        Self { t_max: RayT::MAX, ..Self::default() }
    }

    /// That of a ray that leaves a surface, if it does, of whose hits those from the first to the last of `range` count, and one is enough if `any`.
    pub fn of(departure: Option<&Departure>, range: [RayT; 2], any: bool) -> Self {
        let [t_min, t_max] = range;
        let own = Self { t_min, t_max, any, ..Self::default() };
        let Some(&Departure { start, prior, .. }) = departure else { return own };
        let from = Self { fraction: start.fraction, ..own };
        let Some(Prior { tree, corners: [a0, a1, a2], viewers: [first, second], second: by_second }) = prior else { return from };
        Self { prior: true, last: U::new(u64::from(tree)), a0, a1, a2, by_second, first, second, ..from }
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

wire_struct! {
    /// What the memories of a unit take for test, which mean nothing to what it computes.
    pub struct MemoryTest {
        /// Words are written with the wrong parity.
        flip: bool,
        /// For the pins of a compiled memory: margins, modes.
        pins: U<7>,
    }
}

wire_struct! {
    /// What a context is doing: for who looks from outside, at a ray that is stuck too. What the state gives no meaning to is 0.
    pub struct ContextView {
        /// Its state.
        state: U<5>,
        /// It takes no ray before the lines that it is owed have come.
        rests: bool,
        /// Number of its ray, or of the one before.
        epoch: Epoch,
        /// Lines that it has asked for and that have not come, of rays before too.
        owed: Owed,
        /// Lines wanted and not yet asked for, by place.
        want: U<2>,
        /// Lines asked for and not there, by place.
        waiting: U<2>,
        /// Entries on its stack.
        stacked: U<7>,
        /// Tag of its ray.
        tag: U<32>,
        /// Why its ray ends early: a code of `ray_error_t`.
        error: U<3>,
        /// Kind of the entry under visit.
        kind: U<2>,
        /// Its level in its tree.
        level: U<4>,
        /// Its index.
        index: U<28>,
        /// Entries that the ray may still visit.
        visits: U<32>,
        /// Triangles still to be sent.
        left: U<3>,
        /// Triangles without a verdict.
        pending: U<3>,
    }
}

wire_struct! {
    /// What a unit did since its counters were cleared, each modulo 2^32.
    pub struct UnitCounters {
        /// Cycles.
        cycles: U<32>,
        /// Those in which a ray was under way, or something waited at a port.
        busy: U<32>,
        /// Rays taken.
        rays: U<32>,
        /// Rays done that met something.
        hits: U<32>,
        /// Rays done that met nothing.
        misses: U<32>,
        /// Rays that ended early.
        errors: U<32>,
        /// Lines asked for.
        requests: U<32>,
        /// Lines that came.
        answers: U<32>,
        /// Triangles met, as each is compared with the closest.
        compared: U<32>,
        /// Cycles in which a ray waited at the port.
        rays_wait: U<32>,
        /// Cycles in which a hit waited at the port.
        hits_wait: U<32>,
        /// Cycles in which a request waited at the port.
        requests_wait: U<32>,
        /// What blocks and ports took from contexts: ray_setup, node_address, child_test, tree_deciders, lod_test, tessellate, tri_test, hit_divide (but for t), bary_map, hits.
        taken: [U<32>; 10],
        /// Cycles in which a context asked for each of them and none was served.
        refused: [U<32>; 10],
    }
}
