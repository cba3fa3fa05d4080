//! The memory images of a model.

use crate::format::Scene;
use crate::num::BoundScale;
use crate::step::{Fetch, MemoryMap, Section, SectionId};

/// Quad-BVH nodes over base triangles.
pub const NODES: SectionId = SectionId::new(0);
/// L0 records: base triangle and root bound data.
pub const RECORDS: SectionId = SectionId::new(1);
/// Sibling groups of bound data.
pub const BOUNDS: SectionId = SectionId::new(2);
/// Inserted vertices.
pub const VERTICES: SectionId = SectionId::new(3);

/// Lines of a node, of an L0 record and of a group of bound data.
const PAIR: u32 = 2;
/// Place of the inserted vertices among the lines of a split, behind the bound data.
pub(super) const VERTEX_PLACE: u32 = 2;

/// The memory images of one model, as the hardware sees them.
#[derive(Clone, Copy, Debug)]
pub struct LodImage<'a> {
    /// Number of splits N.
    pub levels: u32,
    /// Scale of the displacement bounds.
    pub scale: BoundScale,
    /// Quad-BVH nodes over base triangles; node 0 is the root.
    pub nodes: &'a [[u64; 8]],
    /// L0 records, one per tree.
    pub records: &'a [[u64; 8]],
    /// Sibling groups of bound data.
    pub bounds: &'a [[u64; 8]],
    /// Inserted vertices.
    pub vertices: &'a [[u64; 4]],
    /// Where their lines lie.
    pub map: MemoryMap,
}

impl<'a> LodImage<'a> {
    /// The images of a scene.
    pub fn of(scene: &'a Scene) -> Self {
        let (nodes, records, bounds, vertices) = (scene.nodes(), scene.records(), scene.bounds(), scene.vertices());
        let section = |name, bytes: usize| Section::of_bytes(name, bytes as u64);
        let sections = [
            section("bvh_node", size_of_val(nodes)).of_base(),
            section("l0_record", size_of_val(records)).of_base(),
            section("bound_data", size_of_val(bounds)),
            section("vertex_data", size_of_val(vertices)),
        ];
        let map = MemoryMap::new(&sections, Some((NODES, PAIR)))
            .expect("at most 2^28 triangles, of at most four lines each in all sections together");
        Self { levels: scene.levels(), scale: scene.meta().bound_scale(), nodes, records, bounds, vertices, map }
    }

    /// Both lines of 64-byte record `index` of a section.
    #[inline(always)]
    pub(super) fn pair(&self, section: SectionId, index: usize) -> Fetch {
        Fetch::new(section, self.map.line(section, 2 * index as u64), PAIR)
    }
}
