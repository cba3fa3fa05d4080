//! A scene: one byte image, owned or mapped from its file, read through typed slices.

use super::sections::{COUNT, FileSection};
use super::{JobRegion, JobView, L0Record, LevelStarts, Line, TreeLines, normal};
use crate::mesh::{BoundKind, Placement, SurfaceError, lattice};
use crate::num::{BoundScale, LINE_BYTES, U, VertexForm};
use memmap2::{Mmap, MmapMut};
use serde::{Deserialize, Serialize};
use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;
use thiserror::Error;

#[cfg(target_endian = "big")]
compile_error!("scene files are mapped as they are: little-endian machines only");

/// Why a scene cannot be built, written or read.
#[derive(Debug, Error)]
pub enum SceneError {
    /// The surface is not fit to build from.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// What the builder was given does not fit together.
    #[error("scene: {0}")]
    Build(String),
    /// The operating system refuses.
    #[error("{}: {action}: {source}", path.display())]
    Io {
        /// The scene file.
        path: PathBuf,
        /// What was being done.
        action: &'static str,
        /// Its answer.
        source: std::io::Error,
    },
    /// The file is not a valid scene file.
    #[error("{}: {problem}", path.display())]
    Invalid {
        /// The scene file.
        path: PathBuf,
        /// What is wrong, naming section and field.
        problem: String,
    },
}

/// The META section: what the images do not say themselves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Meta {
    /// Name of the model, for reports.
    pub name: String,
    /// Version of the program that wrote the file.
    pub program: String,
    /// Number of splits N, 0 to 10.
    pub levels: u32,
    /// Number of trees (base triangles).
    pub trees: u32,
    /// Number of base vertices.
    pub base_vertices: u32,
    /// Units to world.
    pub placement: Placement,
    /// What displacement bounds cover; `largest` is not written.
    #[serde(default = "BoundKind::unnamed", skip_serializing_if = "BoundKind::is_unnamed")]
    pub bounds: BoundKind,
    /// Bound scale: offset, at most [`MAX_BOUND_OFFSET`](crate::num::MAX_BOUND_OFFSET).
    pub bound_offset: u32,
    /// How inserted vertices are stored.
    pub vertices: VertexForm,
    /// Zero bits at the bottom of every coordinate: of full-resolution vertices, morphed triangles and the origins of rays. 0 is not written.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub coordinate_zeros: u32,
    /// Zero bits at the bottom of every component of the directions of rays. 0 is not written.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub direction_zeros: u32,
    /// Largest distance of a stored vertex from where the surface had it, in world units.
    pub moved: f64,
    /// Lower corner of the box of all vertices in units.
    pub lo: [i32; 3],
    /// Upper corner of the box of all vertices in units.
    pub hi: [i32; 3],
    /// For the rays of which cameras levels were taken away ([`Self::is_whole`]).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub job: Vec<JobView>,
    /// For which rays besides, by where they start.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub regions: Vec<JobRegion>,
    /// Shading normals were left out: rays find their hits, but no picture of them is shaded.
    #[serde(default, skip_serializing_if = "is_false")]
    pub without_normals: bool,
    /// How the model was made.
    #[serde(default, skip_serializing_if = "serde_json::Value::is_null")]
    pub origin: serde_json::Value,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
fn is_zero(v: &u32) -> bool {
    *v == 0
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
fn is_false(v: &bool) -> bool {
    !*v
}

impl Meta {
    /// Where `origin` records the mesh file that a scene was built from.
    pub const FILE: &str = "file";
    /// The same of a scene whose vertices were moved since: the file shows them at rest.
    pub const FILE_AT_REST: &str = "file_at_rest";

    /// No levels were taken away: any ray may be traced. Otherwise those of `job` and `regions` alone.
    pub fn is_whole(&self) -> bool {
        self.job.is_empty() && self.regions.is_empty()
    }

    /// Scale of the displacement bounds.
    pub fn bound_scale(&self) -> BoundScale {
        // Widths are checked when a file is opened.
        BoundScale { offset: U::saturating(self.bound_offset.into()) }
    }
}

#[derive(Debug)]
pub(super) enum Image {
    Owned(MmapMut),
    Mapped(Mmap),
}

impl Image {
    pub fn bytes(&self) -> &[u8] {
        match self {
            Self::Owned(m) => m,
            Self::Mapped(m) => m,
        }
    }
}

/// Memory images of one model and what belongs to them. A clone is of the same memory. Slices are looked up in the image at each call: take them out of hot loops.
#[derive(Clone, Debug)]
pub struct Scene {
    pub(super) image: Arc<Image>,
    pub(super) ranges: [Range<usize>; COUNT],
    pub(super) meta: Meta,
    pub(super) starts: LevelStarts,
    /// The mesh that it was made from, where somebody has it at hand; files do not hold it.
    pub(super) input: Option<Arc<Scene>>,
}

impl Scene {
    /// What the images do not say themselves.
    pub fn meta(&self) -> &Meta {
        &self.meta
    }

    /// The same with the mesh that it was made from at hand, as a scene of no splits whose vertices are exact.
    #[must_use]
    pub fn with_input(self, input: Self) -> Self {
        Self { input: Some(Arc::new(input)), ..self }
    }

    /// The mesh that it was made from, if somebody has it at hand.
    pub fn input(&self) -> Option<&Self> {
        self.input.as_deref()
    }

    /// The whole file image.
    pub fn bytes(&self) -> &[u8] {
        self.image.bytes()
    }

    /// Bytes of a section.
    pub fn section(&self, section: FileSection) -> &[u8] {
        &self.bytes()[self.range(section)]
    }

    /// Where a section lies in the file.
    pub fn range(&self, section: FileSection) -> Range<usize> {
        self.ranges[section.slot()].clone()
    }

    /// L0 quad-BVH nodes ([`super::BvhNode`]), the root first.
    pub fn nodes(&self) -> &[Line] {
        bytemuck::cast_slice(self.section(FileSection::Nodes))
    }

    /// L0 records: of each tree a [`L0Record`] line, and if vertices are exact a [`super::VertexData`] line (p0, p1, p2) behind it.
    pub fn records(&self) -> &[Line] {
        bytemuck::cast_slice(self.section(FileSection::Records))
    }

    /// The first line of a tree's L0 record: a [`L0Record`].
    #[inline]
    pub fn record_line(&self, tree: usize) -> &Line {
        &self.records()[tree * self.meta.vertices.record_lines()]
    }

    /// What of a tree is stored, and where.
    #[inline]
    pub fn tree_lines(&self, tree: usize) -> TreeLines {
        L0Record::line_tree(self.record_line(tree))
    }

    /// Where the levels of all trees begin in [`Self::splits`] and [`Self::vertices`].
    #[inline]
    pub fn level_starts(&self) -> &LevelStarts {
        &self.starts
    }

    /// How many levels of each tree are stored.
    pub fn depths(&self) -> Vec<u32> {
        (0..self.trees()).map(|tree| self.tree_lines(tree).depth).collect()
    }

    /// How many trees have how many levels stored: from none to N.
    pub fn trees_by_depth(&self) -> Vec<usize> {
        let mut trees = vec![0; self.levels() as usize + 1];
        self.depths().into_iter().for_each(|depth| trees[depth as usize] += 1);
        trees
    }

    /// Splits ([`super::SplitRecord`]), where [`LevelStarts::split`] says.
    pub fn splits(&self) -> &[Line] {
        bytemuck::cast_slice(self.section(FileSection::Splits))
    }

    /// Inserted vertices ([`super::VertexData`] or two [`super::Displacements`]), where [`LevelStarts::vertex_line`] says.
    pub fn vertices(&self) -> &[Line] {
        bytemuck::cast_slice(self.section(FileSection::Vertices))
    }

    /// Octahedral normals, `lattice::len(levels)` per tree; none if they were left out ([`Meta::without_normals`]).
    pub fn normals(&self) -> &[u32] {
        bytemuck::cast_slice(self.section(FileSection::Normals))
    }

    /// Base vertex indices of each tree.
    pub fn triangles(&self) -> &[[u32; 3]] {
        bytemuck::cast_slice(self.section(FileSection::Triangles))
    }

    /// Number of a tree's base triangle in the mesh that the scene was made of.
    pub fn source(&self, tree: usize) -> u32 {
        self.sources()[tree][0]
    }

    /// Material of a tree.
    pub fn material(&self, tree: usize) -> u16 {
        self.sources()[tree][1] as u16 // checked: below 2^16
    }

    /// Number of its base triangle in the mesh, and material of each tree.
    pub(super) fn sources(&self) -> &[[u32; 2]] {
        bytemuck::cast_slice(self.section(FileSection::Sources))
    }

    /// Material colours: sRGB-encoded red, green, blue, and 255; may be empty.
    pub fn colours(&self) -> &[[u8; 4]] {
        bytemuck::cast_slice(self.section(FileSection::Colours))
    }

    /// Number of splits N.
    pub fn levels(&self) -> u32 {
        self.meta.levels
    }

    /// Number of trees.
    pub fn trees(&self) -> usize {
        self.meta.trees as usize
    }

    /// Number of full-resolution triangles.
    pub fn finest_triangles(&self) -> u64 {
        u64::from(self.meta.trees) << (2 * self.meta.levels)
    }

    /// Bytes of L0 records, splits and vertices per full-resolution triangle.
    pub fn bytes_per_triangle(&self) -> f64 {
        let bytes: usize = [FileSection::Records, FileSection::Splits, FileSection::Vertices].map(|s| self.section(s).len()).iter().sum();
        bytes as f64 / self.finest_triangles() as f64
    }

    /// Unit shading normal at a lattice point (of the full lattice) of a tree.
    ///
    /// # Panics
    /// The scene has none ([`Meta::without_normals`]).
    pub fn normal_at(&self, tree: usize, point: lattice::LatticePoint) -> [f32; 3] {
        let levels = self.levels();
        normal::decode_normal(self.normals()[tree * lattice::len(levels) + lattice::index(levels, point)])
    }

    /// Linear colour of a material, or `None` if there are no colours.
    pub fn colour(&self, material: u16) -> Option<[f32; 3]> {
        self.colours().get(usize::from(material)).map(|&[r, g, b, _]| [r, g, b].map(super::colour::to_linear))
    }

    /// Lengths of the sections that have as much of every tree, from META's counts; `None` if they overflow.
    pub(super) fn section_lengths(meta: &Meta, section: FileSection) -> Option<usize> {
        const LINE: usize = LINE_BYTES as usize;
        let per_tree = match section {
            FileSection::Records => meta.vertices.record_lines() * LINE,
            FileSection::Normals if meta.without_normals => 0,
            FileSection::Normals => 4 * lattice::len(meta.levels),
            FileSection::Triangles => 12,
            FileSection::Sources => 8,
            FileSection::Meta | FileSection::Nodes | FileSection::Splits | FileSection::Vertices | FileSection::Colours => return None,
        };
        per_tree.checked_mul(meta.trees as usize)
    }
}
