//! Grid primitives in memory (paper section 2.1): tuples, radii, and vertices by where they lie.

use super::bounds::{Bounding, Bounds, groups};
use super::pattern::{Pattern, Preliminary, inside, on_side, points, within};
use super::top::{Top, Width};
use super::tuple::{Source, Tuple, share};
use crate::bvh::{Box32, BvhError};
use crate::mesh::{Hierarchy, lattice};
use crate::method::bvh::check_hierarchy;
use crate::num::LINE_BYTES;
use crate::step::{Fetch, MemoryMap, Section, SectionId};
use rayon::prelude::*;

/// Nodes of the BVH over the primitives.
pub const NODES: SectionId = SectionId::new(0);
/// Tuples, 24 bytes each.
pub const TUPLES: SectionId = SectionId::new(1);
/// Bounds of the nodes of primitives, four siblings together: those of a primitive one behind the other, breadth first, its root has none.
pub const BOUNDS: SectionId = SectionId::new(2);
/// Vertices at corners.
pub const CORNERS: SectionId = SectionId::new(3);
/// Vertices on boundaries.
pub const BOUNDARIES: SectionId = SectionId::new(4);
/// Vertices inside.
pub const INSIDES: SectionId = SectionId::new(5);

/// How vertices are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PointForm {
    /// Three floats of 32 bits, 96 bits in all: coordinates are rounded to 24 bits, to nearest and ties to even.
    Float,
    /// Three coordinates of 28 bits, 84 bits in all: nothing is lost.
    Packed,
}

impl PointForm {
    /// Bits of a vertex.
    pub const fn bits(self) -> u64 {
        match self {
            Self::Float => 96,
            Self::Packed => 84,
        }
    }

    /// A vertex as it is stored.
    pub fn stored(self, point: [i32; 3]) -> [i32; 3] {
        match self {
            Self::Float => point.map(float_nearest),
            Self::Packed => point,
        }
    }
}

/// The nearest number of units that an `f32` holds, ties to even. Coordinates are at most [`COORD_LIMIT`](crate::num::COORD_LIMIT), which is one.
pub fn float_nearest(v: i32) -> i32 {
    v as f32 as i32
}

/// What a grid is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GridOptions {
    /// Splits K of a primitive, 0 to 4, but no more than the hierarchy has.
    pub splits: u32,
    /// The finest levels without bounds.
    pub left_out: u32,
    /// What bounds the others.
    pub bounding: Bounding,
    /// Nodes over primitives.
    pub width: Width,
    /// Vertices.
    pub points: PointForm,
}

impl Default for GridOptions {
    fn default() -> Self {
        Self { splits: 4, left_out: 2, bounding: Bounding::Spheres, width: Width::Four, points: PointForm::Packed }
    }
}

/// Grid primitives of a hierarchy with their BVH.
#[derive(Debug)]
pub struct GridMesh {
    /// Number of splits N of the hierarchy.
    pub levels: u32,
    /// The grid of each.
    pub pattern: Pattern,
    /// Levels with bounds.
    pub bounded: u32,
    /// Tree and node of each primitive, in leaf order. Charged to none, as are those of a BVH: a design would look them up once for each hit.
    pub ids: Vec<(u32, u32)>,
    /// Its box.
    pub boxes: Vec<Box32>,
    /// The nodes above.
    pub top: Top,
    tuples: Vec<Tuple>,
    /// Of the children of its nodes.
    pub bounds: Bounds,
    corners: Vec<[i32; 3]>,
    boundaries: Vec<[i32; 3]>,
    insides: Vec<[i32; 3]>,
    form: PointForm,
    map: MemoryMap,
}

/// Primitives worked on by a thread at a time.
const CHUNK: usize = 64;

impl GridMesh {
    /// Builds the primitives of a hierarchy.
    ///
    /// # Errors
    /// No or too many triangles, too many levels, points missing or beyond the coordinate limit.
    pub fn build(hierarchy: &Hierarchy, options: &GridOptions) -> Result<Self, BvhError> {
        check_hierarchy(hierarchy)?;
        let levels = hierarchy.levels;
        let splits = options.splits.min(levels);
        let level = levels - splits;
        let pattern = Pattern::new(splits);
        let stored = |tree: u32, at| options.points.stored(hierarchy.tree(tree as usize)[lattice::index(levels, at)]);
        let lattice_points: Vec<_> = points(splits).collect();
        let vertices = |(tree, node): (u32, u32)| {
            let p = lattice::node(levels, level, node);
            lattice_points.iter().map(move |&at| stored(tree, within(p, splits, at)))
        };

        let natural = |k: usize| ((k >> (2 * level)) as u32, (k & ((1 << (2 * level)) - 1)) as u32); // at most 2^28
        let count = hierarchy.triangles.len() << (2 * level);
        let extent = |k: usize| {
            let grown = vertices(natural(k)).fold(([i32::MAX; 3], [i32::MIN; 3]), |(lo, hi), p| {
                (std::array::from_fn(|c| p[c].min(lo[c])), std::array::from_fn(|c| p[c].max(hi[c])))
            });
            Box32 { lo: grown.0, hi: grown.1 }
        };
        let boxes: Vec<Box32> = (0..count).into_par_iter().map(extent).collect();
        let (top, order) = Top::new(&boxes, options.width);
        let boxes: Vec<_> = order.par_iter().map(|&k| boxes[k as usize]).collect();
        let ids: Vec<_> = order.par_iter().map(|&k| natural(k as usize)).collect();
        drop(order);

        let bounded = splits - options.left_out.min(splits);
        let bounds = Bounds::new(options.bounding, splits, bounded, count, |primitive, to| to.extend(vertices(ids[primitive])));

        let shared = share(hierarchy, splits, &ids);
        let gather = |of: &[Source]| of.par_iter().map(|&(tree, at)| stored(tree, at)).collect::<Vec<_>>();
        let (corners, boundaries) = (gather(&shared.corners), gather(&shared.boundaries));
        let mut insides = vec![[0; 3]; count * inside(splits)];
        if inside(splits) > 0 {
            let is_inside = |at| matches!(pattern.at(at), Preliminary::Inside(_));
            let own: Vec<_> = lattice_points.iter().copied().filter(|&at| is_inside(at)).collect();
            insides.par_chunks_mut(inside(splits) * CHUNK).zip(ids.par_chunks(CHUNK)).for_each(|(insides, ids)| {
                for (insides, &(tree, node)) in insides.chunks_mut(own.len()).zip(ids) {
                    let p = lattice::node(levels, level, node);
                    insides.iter_mut().zip(&own).for_each(|(to, &at)| *to = stored(tree, within(p, splits, at)));
                }
            });
        }
        let form = options.points;
        let of_vertices = |name, count: usize| Section::of_bytes(name, (count as u64 * form.bits()).div_ceil(8));
        let sections = [
            Section::of_bytes("bvh_node", top.count() as u64 * u64::from(top.lines()) * LINE_BYTES),
            Section::of_bytes("tuple", count as u64 * TUPLE_BYTES),
            Section::of_bytes(options.bounding.section(), bounds.bytes()),
            of_vertices("corner", corners.len()),
            of_vertices("boundary", boundaries.len()),
            of_vertices("inside", insides.len()),
        ];
        let map = MemoryMap::new(&sections, Some((NODES, top.lines()))).expect("at most 2^28 triangles of fewer than 16 bytes each");
        let tuples = shared.tuples;
        Ok(Self { levels, pattern, bounded, ids, boxes, top, tuples, bounds, corners, boundaries, insides, form, map })
    }

    /// The memory.
    pub fn map(&self) -> &MemoryMap {
        &self.map
    }

    /// The tuple of a primitive.
    #[inline(always)]
    pub fn tuple(&self, primitive: usize) -> &Tuple {
        &self.tuples[primitive]
    }

    /// All vertices: at corners, on boundaries, inside.
    pub fn vertices(&self) -> [&[[i32; 3]]; 3] {
        [&self.corners, &self.boundaries, &self.insides]
    }

    /// How many boundaries there are.
    pub fn boundary_count(&self) -> usize {
        self.boundaries.len() / on_side(self.pattern.splits).max(1)
    }

    /// Section and final index of a vertex of a primitive.
    #[inline(always)]
    pub fn place(&self, primitive: usize, tuple: &Tuple, vertex: Preliminary) -> (SectionId, usize) {
        match vertex {
            Preliminary::Corner(k) => (CORNERS, tuple.corners[k] as usize),
            Preliminary::Boundary(side, index) => (BOUNDARIES, tuple.boundary(side, index)),
            Preliminary::Inside(k) => (INSIDES, primitive * inside(self.pattern.splits) + k as usize),
        }
    }

    /// A vertex of a primitive, in units.
    #[inline(always)]
    pub fn vertex(&self, primitive: usize, tuple: &Tuple, vertex: Preliminary) -> [i32; 3] {
        let (section, index) = self.place(primitive, tuple, vertex);
        match section {
            CORNERS => self.corners[index],
            BOUNDARIES => self.boundaries[index],
            _ => self.insides[index],
        }
    }

    /// The place of the bounds of a node's children among all, breadth first.
    #[inline(always)]
    pub fn group(&self, primitive: usize, node: usize) -> usize {
        debug_assert!(node < groups(self.bounded));
        primitive * groups(self.bounded) + node
    }

    /// The lines of the bounds of a group.
    #[inline(always)]
    pub fn group_fetch(&self, group: usize) -> Fetch {
        let bytes = self.bounds.kind().bytes();
        self.fetch(BOUNDS, group as u64 * bytes, bytes)
    }

    /// The lines of some bytes of a section.
    #[inline(always)]
    fn fetch(&self, section: SectionId, first: u64, bytes: u64) -> Fetch {
        let [first, last] = [first, first + bytes - 1].map(|at| self.map.line(section, at / LINE_BYTES));
        Fetch::new(section, first, last - first + 1)
    }

    /// The lines of a vertex: the first, and the last.
    #[inline(always)]
    pub fn vertex_lines(&self, section: SectionId, index: usize) -> [u32; 2] {
        let (bits, line) = (self.form.bits(), 8 * LINE_BYTES);
        let first = index as u64 * bits;
        [first / line, (first + bits - 1) / line].map(|at| self.map.line(section, at))
    }

    /// The lines of a tuple.
    #[inline(always)]
    pub fn tuple_fetch(&self, primitive: usize) -> Fetch {
        self.fetch(TUPLES, primitive as u64 * TUPLE_BYTES, TUPLE_BYTES)
    }
}

/// Bytes of a tuple.
pub const TUPLE_BYTES: u64 = size_of::<Tuple>() as u64;
const _: () = assert!(TUPLE_BYTES == 24);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::COORD_LIMIT;

    #[test]
    fn float_nearest_keeps_24_bits_and_the_limit() {
        for v in [0, 16, -16, (1 << 24) - 1, COORD_LIMIT, -COORD_LIMIT] {
            assert_eq!(float_nearest(v), v);
        }
        // Half way: to the even one; and otherwise to the nearest.
        assert_eq!(
            [(1 << 30) + 64, (1 << 30) + 192, (1 << 30) + 96, -(1 << 30) - 63].map(float_nearest),
            [1 << 30, (1 << 30) + 256, (1 << 30) + 128, -(1 << 30)]
        );
    }
}
