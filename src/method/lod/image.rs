//! The memory images of a model.

use super::order::LineOrder;
use crate::format::{LevelStarts, Line, Scene, TreeLines, layout};
use crate::method::Knob;
use crate::num::prism::Prisms;
use crate::num::{BoundScale, LINE_BYTES, VertexForm};
use crate::step::{Fetch, MemoryMap, Section, SectionId};

/// Quad-BVH nodes over base triangles.
pub const NODES: SectionId = SectionId::new(0);
/// L0 records: base triangle, the root's codes and, if they are compact, inserted vertices.
pub const RECORDS: SectionId = SectionId::new(1);
/// Sibling groups: boxes and bound codes.
pub const BOUNDS: SectionId = SectionId::new(2);
/// Inserted vertices.
pub const VERTICES: SectionId = SectionId::new(3);

/// Lines of an L0 record.
const PAIR: u32 = 2;

/// Whose lines rays ask for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineLayout {
    /// Those of the images.
    #[default]
    Own,
    /// Those that the paper has (section 4.3): nodes and sibling groups of two lines, inserted vertices of one, every group asked for with its vertices. The rays' ways
    /// and hits are the same; only addresses are others. For simulations of the paper's own figures.
    Paper,
    /// Those of the images in another order, with room for all levels of all trees. Again only addresses are others.
    Ordered(LineOrder),
}

impl LineLayout {
    /// The layout of this name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "own" => Some(Self::Own),
            "paper" => Some(Self::Paper),
            "tree" => Some(Self::Ordered(LineOrder::Tree)),
            "coarse" => Some(Self::Ordered(LineOrder::Coarse)),
            "blocks" => Some(Self::Ordered(LineOrder::Blocks)),
            "veb" => Some(Self::Ordered(LineOrder::VanEmdeBoas)),
            _ => None,
        }
    }
}

/// Whose lines rays ask for.
pub static LINE_LAYOUT: Knob = Knob {
    name: "line-layout",
    value_name: "LINE_LAYOUT",
    help: "Memory lines that rays of lod ask for",
    default: Some("own"),
    words: &[
        ("own", "Those of the scene, level by level: a node or group in one line, compact vertices in half a line"),
        ("paper", "Those of the paper's layout, for the same rays: a node or group in two lines, vertices in one"),
        ("tree", "The scene's lines, but tree by tree"),
        ("coarse", "Three levels over all trees, then what is below each of their nodes by itself"),
        ("blocks", "Two levels of a tree together, these blocks level by level over all trees"),
        ("veb", "Tree by tree, each in van Emde Boas' order"),
    ],
    of_frame: false,
    allows: |value| LineLayout::named(value).map(drop).ok_or_else(|| format!("'{value}' is not own, paper, tree, coarse, blocks or veb")),
};

/// What bounds the children of a tree's nodes.
pub static NODE_BOUNDS: Knob = Knob {
    name: "node-bounds",
    value_name: "NODE_BOUNDS",
    help: "Bounds of the children of nodes of trees in lod",
    default: Some("boxes"),
    words: &[
        ("boxes", "Boxes along the axes, as the paper has them"),
        ("prisms", "Prisms over their triangles (not stored yet: fitted when the scene is opened)"),
    ],
    of_frame: false,
    allows: |value| if ["boxes", "prisms"].contains(&value) { Ok(()) } else { Err(format!("'{value}' is not boxes or prisms")) },
};

/// A tree that a ray is in.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TreeAt {
    /// Its number.
    pub index: u32,
    /// What of it is stored.
    pub lines: TreeLines,
}

/// The memory images of one model, as the hardware sees them.
#[derive(Clone, Copy, Debug)]
pub struct LodImage<'a> {
    /// Number of splits N.
    pub levels: u32,
    /// Zero bits at the bottom of all coordinates.
    pub zeros: u32,
    /// Scale of the displacement bounds.
    pub scale: BoundScale,
    /// How inserted vertices are stored.
    pub form: VertexForm,
    /// Quad-BVH nodes over base triangles; node 0 is the root.
    pub nodes: &'a [Line],
    /// L0 records, one per tree.
    pub records: &'a [[u64; 8]],
    /// Sibling groups.
    pub bounds: &'a [Line],
    /// Inserted vertices.
    pub vertices: &'a [Line],
    /// Where the levels of all trees begin in them.
    pub starts: LevelStarts,
    /// Where their lines lie.
    pub map: MemoryMap,
    layout: LineLayout,
    trees: usize,
    /// Prisms of the children of each sibling group, if they bound them in place of its boxes.
    pub(super) prisms: Option<&'a [Prisms]>,
}

impl<'a> LodImage<'a> {
    /// The images of a scene.
    pub fn of(scene: &'a Scene) -> Self {
        Self::with(scene, LineLayout::Own)
    }

    /// The same, whose rays ask for these lines.
    pub fn with(scene: &'a Scene, layout: LineLayout) -> Self {
        let (nodes, records, bounds, vertices) = (scene.nodes(), scene.records(), scene.bounds(), scene.vertices());
        let (levels, form) = (scene.levels(), scene.meta().vertices);
        let line = |lines: usize| LINE_BYTES * lines as u64;
        let all = scene.trees() * layout::sibling_groups(levels);
        let (pair, groups, vertex_lines) = match layout {
            LineLayout::Own => (1, bounds.len(), vertices.len()),
            LineLayout::Paper => (2, all, scene.trees() * layout::vertex_lines(VertexForm::Exact, levels)),
            LineLayout::Ordered(_) => (1, all, scene.trees() * layout::vertex_lines(form, levels)),
        };
        let sections = [
            Section::of_bytes("bvh_node", line(pair * nodes.len())).of_base(),
            Section::of_bytes("l0_record", size_of_val(records) as u64).of_base(),
            Section::of_bytes("bound_data", line(pair * groups)),
            Section::of_bytes("vertex_data", line(vertex_lines)),
        ];
        let map = MemoryMap::new(&sections, Some((NODES, pair as u32))) // 1 or 2
            .expect("at most 2^28 triangles, of at most four lines each in all sections together");
        Self {
            levels,
            zeros: scene.meta().coordinate_zeros,
            scale: scene.meta().bound_scale(),
            form,
            nodes,
            records,
            bounds,
            vertices,
            starts: *scene.level_starts(),
            map,
            layout,
            trees: scene.trees(),
            prisms: None,
        }
    }

    /// The same with prisms in place of the boxes of trees' nodes: of the children of each sibling group ([`scene_prisms`](crate::format::scene_prisms)).
    #[must_use]
    pub fn bounded_by(self, prisms: &'a [Prisms]) -> Self {
        Self { prisms: Some(prisms), ..self }
    }

    /// The inserted vertices of a root are in its L0 record, and rays ask for it alone.
    #[inline(always)]
    pub(super) fn root_has_split(&self) -> bool {
        self.form.is_compact() && self.layout != LineLayout::Paper
    }

    /// The line or lines of quad-BVH node `index`.
    #[inline(always)]
    pub(super) fn node(&self, index: usize) -> Fetch {
        match self.layout {
            LineLayout::Own | LineLayout::Ordered(_) => Fetch::new(NODES, self.map.line(NODES, index as u64), 1),
            LineLayout::Paper => self.pair(NODES, index),
        }
    }

    /// The line or lines of the sibling group of the children of a node.
    #[inline(always)]
    pub(super) fn group(&self, tree: TreeAt, level: u32, node: usize) -> Fetch {
        match self.layout {
            LineLayout::Own => Fetch::new(BOUNDS, self.map.line(BOUNDS, self.starts.child_group(tree.lines, level, node) as u64), 1),
            LineLayout::Paper => self.pair(BOUNDS, self.ordered(LineOrder::Tree, tree, level, node)),
            LineLayout::Ordered(order) => Fetch::new(BOUNDS, self.map.line(BOUNDS, self.ordered(order, tree, level, node) as u64), 1),
        }
    }

    /// Both lines of L0 record `index`.
    #[inline(always)]
    pub(super) fn l0_record(&self, index: usize) -> Fetch {
        self.pair(RECORDS, index)
    }

    #[inline(always)]
    fn pair(&self, section: SectionId, index: usize) -> Fetch {
        Fetch::new(section, self.map.line(section, 2 * index as u64), PAIR)
    }

    /// The line with the inserted vertices of a node, which is not a root that has them in its record.
    #[inline(always)]
    pub(super) fn split(&self, tree: TreeAt, level: u32, node: usize) -> Fetch {
        let (line, place) = match self.layout {
            LineLayout::Own => (self.starts.vertex_line(self.form, tree.lines, level, node), 1),
            LineLayout::Paper => (tree.index as usize * layout::level_start(self.levels) + layout::level_start(level) + node, 2),
            // The vertices of four siblings follow each other as their groups do.
            LineLayout::Ordered(order) if self.form.is_compact() => (2 * self.ordered(order, tree, level - 1, node / 4) + node % 4 / 2, 1),
            LineLayout::Ordered(_) if level == 0 => (tree.index as usize, 1),
            LineLayout::Ordered(order) => (self.trees + 4 * self.ordered(order, tree, level - 1, node / 4) + node % 4, 1),
        };
        Fetch::new(VERTICES, self.map.line(VERTICES, line as u64), 1).at(place)
    }

    /// The group of the children of a node, in this order.
    #[inline(always)]
    fn ordered(&self, order: LineOrder, tree: TreeAt, level: u32, node: usize) -> usize {
        order.group(self.trees, self.levels - 1, tree.index as usize, level, node)
    }
}
