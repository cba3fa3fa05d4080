//! The named formats of `docs/numbers.md`: widths, limits, and the integer ray.

use super::{
    U, Vec3,
    wire::{Wire, wire_struct},
};

/// Largest magnitude of a model coordinate in units, so that 16-bit box codes keep to +-32766.
pub const COORD_LIMIT: i32 = 0x7FFE_0000;
/// Zero bits at the bottom of every stored coordinate (28 of 32 bits are stored).
pub const PADDING_BITS: u32 = 4;
/// Zero bits at the bottom of base vertices of compact models: an L0 record has 22 bits a coordinate.
pub const BASE_ZERO_BITS: u32 = 10;
/// Largest number of 1-to-4 splits.
pub const MAX_LEVELS: u32 = 10;
/// Largest number of quad-BVH nodes on a path from the root to a leaf: what the traversal stack has room for.
pub const MAX_BVH_DEPTH: u32 = 24;
/// Units per step of a 16-bit box code, as a shift.
pub const BOX_SHIFT: u32 = 16;
/// Units by which the model's box is enlarged before a ray is moved to it.
pub const BOX_MARGIN: i32 = 64;
/// Length of a ray direction.
pub const DIRECTION_SCALE: i32 = (1 << 30) - 1;
/// The most zero bits at the bottom of the components of directions, with room left for 16 of coordinates: what the LOD test drops of their product.
pub const MOST_DIRECTION_ZEROS: u32 = 30 - BOX_SHIFT;
/// s = 1 of an edge state.
pub const S_ONE: u64 = 256;
/// 1 of a barycentric coordinate.
pub const BARY_ONE: u64 = 1 << 31;
/// t_near (2^16 units) to t (2^-32 of the direction), as a shift.
pub const T_NEAR_TO_T_SHIFT: u32 = 18;

/// Largest offset of a bound scale: code 255 then stands for less than 2^33 units.
pub const MAX_BOUND_OFFSET: u64 = 272;
/// Largest shift of a compact vertex's displacement: that of the largest bound, or the zero bits of the coarsest inserted vertex.
pub const MAX_DISPLACEMENT_SHIFT: u32 = 21;

/// Bits of a displacement's component in last splits of short ones.
pub const SHORT_BITS: u32 = 7;
/// The lowest bits of a displacement that these leave out.
pub const SHORT_SHIFT: u32 = <U<13> as Wire>::WIDTH - SHORT_BITS;

/// Bytes of a memory line.
pub const LINE_BYTES: u64 = 32;

/// Vertex position in units.
pub type Point = Vec3<32>;
/// Ray direction: each component below 2^30 in magnitude.
pub type Direction = Vec3<31>;
/// Address of a 32-byte memory line: 2 TiB.
pub type LineAddress = U<36>;
/// Displacement bound code.
pub type BoundCode = U<8>;
/// Component of a compact vertex: its displacement from the midpoint of its edge, in steps that follow from the edge's code.
pub type Displacement = Vec3<13>;
/// Edge state s, 0 to 256.
pub type EdgeState = U<9>;
/// Ray parameter in steps of 2^-32.
pub type RayT = U<35>;
/// Barycentric coordinate, 2^31 = 1.
pub type Bary = U<32>;
/// Box entry distance in steps of 2^16 units: 17 bits, because a hit has `t_near 2^18 <= t_max` < 2^35.
pub type TNear = U<17>;

wire_struct! {
    /// Scale of the displacement bounds of one model: a code other than 0 stands for `2^((code + offset) / 16)` units, rounded (`bound_decode`).
    pub struct BoundScale {
        /// Added to every code but 0, at most [`MAX_BOUND_OFFSET`].
        offset: U<9>,
    }
}

wire_struct! {
    /// Ray cone: tolerated displacement at distance l is `floor((offset + l * slope) / 2^shift)` units, clamped to 0 ..= 2^34-1.
    pub struct Cone {
        /// (2/delta) r0 in steps of 2^-shift units.
        offset: U<53>,
        /// (2/delta) tan(theta) in steps of 2^-shift.
        slope: U<18>,
        /// Right shift.
        shift: U<6>,
    }
}

impl Cone {
    /// Of a ray that tolerates anything, if it tolerates either nothing or anything.
    pub fn is_of_no_detail(&self) -> bool {
        self.offset.get() >> (<U<53> as Wire>::WIDTH - 1) == 1
    }
}

wire_struct! {
    /// A ray in model space.
    pub struct Ray {
        /// Origin in units.
        origin: Vec3<32>,
        /// Direction, length close to 2^30 - 1.
        direction: Direction,
        /// Its cone and the wanted quality.
        cone: Cone,
    }
}

/// Bits of the fraction of a [`Start`]: those of barycentric coordinates.
pub const START_BITS: u32 = 31;

wire_struct! {
    /// Where a ray starts: a whole point, or a point of a triangle, exact in steps of 2^-31 units.
    pub struct Start {
        /// Coordinates rounded down to units.
        point: Vec3<32>,
        /// What is left of each, in steps of 2^-31 units.
        fraction: [U<START_BITS>; 3],
    }
}
