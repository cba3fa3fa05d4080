//! The memory images of a model.

use super::order::LineOrder;
use crate::block::tessellate::{self, Tessellate};
use crate::block::{Block, child_test, lod_test, ray_setup};
use crate::format::{L0Record, LevelStarts, Line, Scene, SplitRecord, TreeLines, VertexData, has_split, last_displacements, layout};
use crate::method::Knob;
use crate::method::children::{Split, prism_children, tree_children};
use crate::num::prism::Prisms;
use crate::num::{BoundCode, BoundScale, LINE_BYTES, PADDING_BITS, Point, RayT, U, VertexForm, Wire};
use crate::step::{Fetch, MemoryMap, NodeShape, Section, SectionId};

/// Quad-BVH nodes over base triangles.
pub const NODES: SectionId = SectionId::new(0);
/// L0 records: base triangle and the root's codes.
pub const RECORDS: SectionId = SectionId::new(1);
/// Splits: bound codes and boxes of the children, and compact inserted vertices.
pub const SPLITS: SectionId = SectionId::new(2);
/// Inserted vertices: exact ones, and compact ones of last splits.
pub const VERTICES: SectionId = SectionId::new(3);

/// Lines of a node, a record or a split in the paper's layout.
const PAIR: u32 = 2;

/// Whose lines rays ask for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LineLayout {
    /// Those of the images.
    #[default]
    Own,
    /// Those that the paper has (section 4.3): nodes, records and the bounds of four children of two lines, inserted vertices of one, bounds asked for with the vertices. The rays'
    /// ways and hits are the same; only addresses are others. For simulations of the paper's own figures.
    Paper,
    /// Those of the images, but with compact vertices in lines apart from their splits, half a line each; an L0 record has two lines, and the root's vertices in it. So the files of
    /// this program had them before their version 5.
    Apart,
    /// Those of the images in another order, with room for all levels of all trees. Again only addresses are others.
    Ordered(LineOrder),
}

impl LineLayout {
    /// The layout of this name.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "own" => Some(Self::Own),
            "paper" => Some(Self::Paper),
            "apart" => Some(Self::Apart),
            "tree" => Some(Self::Ordered(LineOrder::Tree)),
            "coarse" => Some(Self::Ordered(LineOrder::Coarse)),
            "blocks" => Some(Self::Ordered(LineOrder::Blocks)),
            "veb" => Some(Self::Ordered(LineOrder::VanEmdeBoas)),
            "morton" => Some(Self::Ordered(LineOrder::Morton)),
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
        ("own", "Those of the scene, level by level: a node, record or split in one line, a last split in half a line"),
        ("paper", "Those of the paper's layout, for the same rays: a node, record or four children in two lines, vertices in one"),
        ("apart", "The scene's, but a record in two lines, and compact vertices apart from their splits"),
        ("tree", "The scene's lines, but tree by tree"),
        ("coarse", "Three levels over all trees, then what is below each of their nodes by itself"),
        ("blocks", "Two levels of a tree together, these blocks level by level over all trees"),
        ("veb", "Tree by tree, each in van Emde Boas' order"),
        ("morton", "Level by level, trees along a Morton curve"),
    ],
    of_frame: false,
    allows: |value| {
        LineLayout::named(value).map(drop).ok_or_else(|| format!("'{value}' is not own, paper, apart, tree, coarse, blocks, veb or morton"))
    },
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

/// With what the inserted vertices of a node come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum With {
    /// The L0 record.
    Record,
    /// The node's split.
    Split,
    /// Nothing else: they are asked for themselves.
    Nothing,
}

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
    /// L0 records, of one or two lines each.
    pub records: &'a [Line],
    /// Splits.
    pub splits: &'a [Line],
    /// Inserted vertices that are not in splits.
    pub vertices: &'a [Line],
    /// Where the levels of all trees begin in them.
    pub starts: LevelStarts,
    /// Where their lines lie.
    pub map: MemoryMap,
    layout: LineLayout,
    trees: usize,
    /// Places of trees in an order that is not theirs.
    ranks: Option<&'a [u32]>,
    /// Prisms of the children of each split, if they bound them in place of its boxes.
    pub(super) prisms: Option<&'a [Prisms]>,
}

impl<'a> LodImage<'a> {
    /// The images of a scene.
    pub fn of(scene: &'a Scene) -> Self {
        Self::with(scene, LineLayout::Own)
    }

    /// The same, whose rays ask for these lines.
    pub fn with(scene: &'a Scene, layout: LineLayout) -> Self {
        let (nodes, records, splits, vertices) = (scene.nodes(), scene.records(), scene.splits(), scene.vertices());
        let (levels, form) = (scene.levels(), scene.meta().vertices);
        let line = |lines: usize| LINE_BYTES * lines as u64;
        let all = |of: usize| scene.trees() * of;
        // In other orders there is room for all levels of all trees.
        let (pair, split_lines, vertex_lines) = match layout {
            LineLayout::Own => (1, splits.len(), vertices.len()),
            LineLayout::Apart if form.is_compact() => (1, splits.len(), 2 * splits.len()),
            LineLayout::Apart => (1, splits.len(), vertices.len()),
            LineLayout::Paper => (2, all(layout::split_lines(levels)), all(layout::vertex_lines(VertexForm::Exact, levels))),
            LineLayout::Ordered(_) if form.is_compact() => {
                (1, all(layout::split_lines(levels)), form.sibling_lines() * all(layout::split_lines(levels)))
            }
            LineLayout::Ordered(_) => (1, all(layout::split_lines(levels)), all(layout::vertex_lines(form, levels))),
        };
        let record_lines = if matches!(layout, LineLayout::Paper | LineLayout::Apart) { 2 * scene.trees() } else { records.len() };
        let sections = [
            Section::of_bytes("bvh_node", line(pair * nodes.len())).of_base(),
            Section::of_bytes("l0_record", line(record_lines)).of_base(),
            Section::of_bytes("split", line(pair * split_lines)),
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
            splits,
            vertices,
            starts: *scene.level_starts(),
            map,
            layout,
            trees: scene.trees(),
            ranks: None,
            prisms: None,
        }
    }

    /// The same with prisms in place of the boxes of trees' nodes: of the children of each split ([`scene_prisms`](crate::format::scene_prisms)).
    #[must_use]
    pub fn bounded_by(self, prisms: &'a [Prisms]) -> Self {
        Self { prisms: Some(prisms), ..self }
    }

    /// The same with trees in these places ([`morton_ranks`](super::order::morton_ranks)), where the layout is an order.
    #[must_use]
    pub fn ranked_by(self, ranks: &'a [u32]) -> Self {
        Self { ranks: Some(ranks), ..self }
    }

    /// A tree's L0 record.
    #[inline(always)]
    pub fn record(&self, tree: usize) -> &'a Line {
        &self.records[tree * self.form.record_lines()]
    }

    /// A tree's corners.
    #[inline(always)]
    pub fn corners(&self, tree: usize) -> [Point; 3] {
        match self.form {
            VertexForm::Exact => VertexData::from_words(&self.records[2 * tree + 1]).points(),
            VertexForm::Compact | VertexForm::Short => L0Record::from_words(&self.records[tree]).corners(),
        }
    }

    /// With what a ray asks for the inserted vertices of a node of a tree of this depth.
    #[inline(always)]
    pub(super) fn vertices_with(&self, depth: u32, level: u32) -> With {
        match self.layout {
            _ if !self.form.is_compact() => With::Nothing,
            LineLayout::Own | LineLayout::Ordered(_) if has_split(depth, level) => With::Split,
            LineLayout::Apart if level == 0 => With::Record,
            _ => With::Nothing,
        }
    }

    /// The line or lines of quad-BVH node `index`.
    #[inline(always)]
    pub(super) fn node(&self, index: usize) -> Fetch {
        match self.layout {
            LineLayout::Own | LineLayout::Apart | LineLayout::Ordered(_) => Fetch::new(NODES, self.map.line(NODES, index as u64), 1),
            LineLayout::Paper => self.pair(NODES, index),
        }
    }

    /// The line or lines of a node's split.
    #[inline(always)]
    pub(super) fn split(&self, tree: TreeAt, level: u32, node: usize) -> Fetch {
        match self.layout {
            LineLayout::Own | LineLayout::Apart => {
                Fetch::new(SPLITS, self.map.line(SPLITS, self.starts.split(tree.lines, level, node) as u64), 1)
            }
            LineLayout::Paper => self.pair(SPLITS, self.ordered(LineOrder::Tree, tree, level, node)),
            LineLayout::Ordered(order) => Fetch::new(SPLITS, self.map.line(SPLITS, self.ordered(order, tree, level, node) as u64), 1),
        }
    }

    /// The line or lines of L0 record `index`.
    #[inline(always)]
    pub(super) fn l0_record(&self, index: usize) -> Fetch {
        if self.form.is_compact() && matches!(self.layout, LineLayout::Own | LineLayout::Ordered(_)) {
            Fetch::new(RECORDS, self.map.line(RECORDS, index as u64), 1)
        } else {
            self.pair(RECORDS, index)
        }
    }

    #[inline(always)]
    fn pair(&self, section: SectionId, index: usize) -> Fetch {
        Fetch::new(section, self.map.line(section, 2 * index as u64), PAIR)
    }

    /// The line with the inserted vertices of a node, where [they come with nothing else](Self::vertices_with).
    #[inline(always)]
    pub(super) fn inserted(&self, tree: TreeAt, level: u32, node: usize) -> Fetch {
        let (line, place) = match self.layout {
            LineLayout::Apart if self.form.is_compact() => (2 * self.starts.split(tree.lines, level - 1, node / 4) + node % 4 / 2, 1),
            LineLayout::Own | LineLayout::Apart => (self.starts.vertex_line(self.form, tree.lines, level, node), 1),
            LineLayout::Paper => (tree.index as usize * layout::level_start(self.levels) + layout::level_start(level) + node, 2),
            // The vertices of four siblings follow each other as their parents' splits do.
            LineLayout::Ordered(order) if self.form.is_compact() => {
                let lines = self.form.sibling_lines();
                (lines * self.ordered(order, tree, level - 1, node / 4) + node % 4 * lines / 4, 1)
            }
            LineLayout::Ordered(_) if level == 0 => (self.place(tree), 1),
            LineLayout::Ordered(order) => (self.trees + 4 * self.ordered(order, tree, level - 1, node / 4) + node % 4, 1),
        };
        Fetch::new(VERTICES, self.map.line(VERTICES, line as u64), 1).at(place)
    }

    /// The inserted vertices of a node as they are stored.
    #[inline(always)]
    fn stored<const COMPACT: bool>(&self, tree: TreeAt, level: u32, node: usize) -> [Point; 3] {
        let lines = tree.lines;
        let line = || &self.vertices[self.starts.vertex_line(self.form, lines, level, node)];
        match COMPACT {
            false => VertexData::from_words(line()).points(),
            true if has_split(lines.depth, level) => SplitRecord::line_displacements(&self.splits[self.starts.split(lines, level, node)]),
            true => last_displacements(self.form, line(), node),
        }
    }

    /// The inserted vertices of a node, of full resolution and as `lod` has its edges morphed: its corners `f` and `p` are that too.
    #[inline(always)]
    pub(super) fn tessellated<const COMPACT: bool, const FULL_DETAIL: bool>(
        &self,
        tree: TreeAt,
        level: u32,
        node: u32,
        codes: [BoundCode; 3],
        lod: &lod_test::Out,
        [f, p]: [[Point; 3]; 2],
    ) -> tessellate::Out {
        let [v0, v1, v2] = self.stored::<COMPACT>(tree, level, node as usize);
        let (scale, zeros) = (self.scale, self.zeros);
        let grid = U::new(u64::from(self.levels - level - 1 + zeros));
        let (compact, padding) = (COMPACT, U::new(u64::from(PADDING_BITS.saturating_sub(zeros))));
        let ([e0, e1, e2], [f0, f1, f2], [p0, p1, p2]) = (codes, f, p);
        let lod_test::Out { s0, s1, s2, .. } = *lod;
        let tessellate = if FULL_DETAIL { Tessellate::of_full_detail } else { Tessellate::eval };
        tessellate(&tessellate::In { compact, grid, padding, scale, e0, e1, e2, s0, s1, s2, f0, f1, f2, p0, p1, p2, v0, v1, v2 })
    }

    /// Tests and sorts the children of the node whose split has this number, and whose triangles are `split`.
    #[inline(always)]
    pub(super) fn children(&self, number: usize, ray: &ray_setup::Out, t_max: RayT, split: &Split) -> (NodeShape, child_test::Out) {
        match self.prisms {
            None => (NodeShape::Tree, tree_children(ray, t_max, &self.splits[number], split)),
            Some(prisms) => (NodeShape::Prisms, prism_children(ray, t_max, &prisms[number], split)),
        }
    }

    /// The split of a node, in this order.
    #[inline(always)]
    fn ordered(&self, order: LineOrder, tree: TreeAt, level: u32, node: usize) -> usize {
        order.split(self.trees, (self.levels - 1).max(1), self.place(tree), level, node)
    }

    /// The place of a tree in an order that is not that of the images.
    #[inline(always)]
    fn place(&self, tree: TreeAt) -> usize {
        self.ranks.map_or(tree.index, |ranks| ranks[tree.index as usize]) as usize
    }
}
