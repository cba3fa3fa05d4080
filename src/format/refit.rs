//! A scene whose vertices move: its trees, its splits and the tree of its quad-BVH stay, and everything that follows from where vertices are is made anew.
//!
//! Positions are those of the finest level's vertices, in the order in which [`export_level`](super::export_level) writes them. What is stored of them, and how, is what building the scene
//! from these positions would store: the same functions make it. Trees keep their places in the file.

use super::encode::{Images, extent, new_image, places, seal, slices};
use super::numbering::Numbering;
use super::scene::Image;
use super::sections::{COUNT, FileSection, place};
use super::shading::SmoothShading;
use super::{Box16, Line, Meta, Scene, SceneError, tree_boxes};
use crate::mesh::{Hierarchy, SharedEdges, SurfaceError, first_not_finite, grid_holds, lattice, move_vertices};
use serde::Deserialize;
use std::convert::Infallible;
use std::sync::Arc;
use thiserror::Error;

/// Why a scene cannot be refitted.
#[derive(Debug, Error)]
pub enum RefitError {
    /// It was pruned for a job: what is not there cannot move.
    #[error("the scene was pruned for the rays of a job: vertices that it does not have cannot move")]
    Pruned,
    /// More vertices than there are numbers.
    #[error("the scene has {0} vertices, more than 2^32")]
    TooMany(u64),
    /// Other positions than it has vertices.
    #[error("{found} positions, but the finest level of the scene has {expected} vertices (lodray export writes them in their order)")]
    Count {
        /// How many there are.
        found: usize,
        /// How many it has.
        expected: usize,
    },
    /// A position that is none.
    #[error("position {vertex} is {value:?}: not three finite numbers")]
    NotFinite {
        /// Which, from 0.
        vertex: usize,
        /// What it is.
        value: [f64; 3],
    },
    /// Positions that cannot be divided into units.
    #[error(transparent)]
    Surface(#[from] SurfaceError),
    /// What was made of them does not fit.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

/// Shading normals of a scene that is refitted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Shading {
    /// Those of the facets around each vertex, by their area; where trees had normals of their own at a vertex, as at a crease, those of facets on one side of it.
    #[default]
    Smooth,
    /// As they were.
    Keep,
}

impl Shading {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Smooth, Self::Keep];

    /// Its name in options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::Keep => "keep",
        }
    }
}

/// Where units lie in a scene that is refitted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Grid {
    /// Where building the scene anew would have them: the box of the new positions fills the range of coordinates.
    #[default]
    New,
    /// Where they were, so that what does not move keeps its coordinates; as new if a position is outside of what coordinates reach.
    Keep,
}

impl Grid {
    /// Both.
    pub const ALL: [Self; 2] = [Self::New, Self::Keep];

    /// Its name in options.
    pub const fn name(self) -> &'static str {
        match self {
            Self::New => "new",
            Self::Keep => "keep",
        }
    }
}

/// How a scene is refitted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RefitOptions {
    /// Its normals.
    pub shading: Shading,
    /// Its units.
    pub grid: Grid,
}

/// Makes the boxes of a quad-BVH over trees anew, for trees of these boxes.
pub type RefitNodes = fn(&[Line], &[Box16]) -> Vec<Line>;

/// A scene that is refitted, once or frame after frame: it keeps what does not change, and its memory.
pub struct Refit {
    scene: Scene,
    /// Trees in the order of the file.
    hierarchy: Hierarchy,
    shared: SharedEdges,
    /// Of each point of each tree the number of its vertex.
    numbers: Vec<u32>,
    vertices: usize,
    bounds: Vec<u64>,
    order: Vec<u32>,
    /// Made when it is first wanted.
    smooth: Option<SmoothShading>,
    refit_nodes: RefitNodes,
}

/// The mesh file that a scene was built from shows it at rest ([`Meta::FILE_AT_REST`]), and how far the two were apart says nothing of the vertices where they are now.
fn move_origin(origin: &mut serde_json::Value) {
    let Some(origin) = origin.as_object_mut() else { return };
    if let Some(file) = origin.remove(Meta::FILE) {
        origin.insert(Meta::FILE_AT_REST.into(), file);
    }
    if let Some(remesh) = origin.get_mut("remesh").and_then(|remesh| remesh.as_object_mut()) {
        remesh.remove("distance");
    }
}

impl Refit {
    /// Gets a scene ready.
    ///
    /// # Errors
    /// It was pruned, or has too many vertices.
    pub fn new(scene: &Scene, refit_nodes: RefitNodes) -> Result<Self, RefitError> {
        if !scene.meta().is_whole() {
            return Err(RefitError::Pruned);
        }
        let (levels, len) = (scene.levels(), lattice::len(scene.levels()));
        let mut numbering = Numbering::new(levels);
        let mut numbers = Vec::with_capacity(scene.trees() * len);
        let mut ids = vec![0; len];
        for &triangle in scene.triangles() {
            let Ok(()) = numbering.tree(triangle, &mut ids, |_| Ok::<_, Infallible>(()));
            numbers.extend(ids.iter().map(|&id| id as u32)); // checked below
        }
        let vertices = u32::try_from(numbering.vertices()).map_err(|_| RefitError::TooMany(numbering.vertices()))? as usize;
        let hierarchy = scene.decode();
        let shared = SharedEdges::new(&hierarchy.triangles);
        let order = (0..scene.meta().trees).collect();
        Ok(Self { scene: scene.clone(), hierarchy, shared, numbers, vertices, bounds: Vec::new(), order, smooth: None, refit_nodes })
    }

    /// How many vertices the finest level has.
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// Of each lattice point of each tree, trees in the order of the file, the number of its vertex.
    pub fn numbers(&self) -> &[u32] {
        &self.numbers
    }

    /// The scene as it is now.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// The scene, with all memory besides it given back.
    pub fn into_scene(self) -> Scene {
        self.scene
    }

    /// World positions of its vertices, as they are stored.
    pub fn positions(&self) -> Vec<[f64; 3]> {
        let mut positions = vec![[0.0; 3]; self.vertices];
        for (&number, &point) in self.numbers.iter().zip(&self.hierarchy.points) {
            positions[number as usize] = self.hierarchy.to_world(point);
        }
        positions
    }

    /// Moves the vertices to these positions. Of the scene that was there before nothing is left, unless somebody has a clone of it: then its memory stays, and other memory is taken.
    ///
    /// # Errors
    /// As many positions as there are no vertices, or one that is not finite: the scene is as it was. Or more lines than can be numbered.
    pub fn move_to(&mut self, positions: &[[f64; 3]], options: RefitOptions) -> Result<&Scene, RefitError> {
        if positions.len() != self.vertices {
            return Err(RefitError::Count { found: positions.len(), expected: self.vertices });
        }
        if let Some(vertex) = first_not_finite(positions) {
            return Err(RefitError::NotFinite { vertex, value: positions[vertex] });
        }
        let smooth = match (options.shading, &mut self.smooth) {
            _ if self.scene.meta().without_normals => None,
            (Shading::Keep, _) => None,
            (Shading::Smooth, smooth) => Some(&*smooth.get_or_insert_with(|| SmoothShading::of(&self.scene, &self.numbers))),
        };
        let h = &mut self.hierarchy;
        let kept = (options.grid == Grid::Keep && grid_holds(h.placement, positions)).then_some(h.placement);
        move_vertices(h, &self.shared, &self.numbers, positions, kept, &mut self.bounds)?;

        let h = &self.hierarchy;
        let (stored, starts) = places(h, &self.order)?;
        let nodes = (self.refit_nodes)(self.scene.nodes(), &tree_boxes(h));
        let len = lattice::len(h.levels);
        let ([lo, hi], moved) = extent(h, |tree, point| Some(positions[self.numbers[tree * len + point] as usize]));
        let mut meta = self.scene.meta.clone();
        (meta.placement, meta.bound_offset) = (h.placement, h.bounds.scale.offset.get() as u32); // 9 bits
        (meta.lo, meta.hi, meta.moved) = (lo, hi, moved);
        meta.program = env!("CARGO_PKG_VERSION").into();
        move_origin(&mut meta.origin);
        let json = serde_json::to_vec(&meta).map_err(|e| SceneError::Build(format!("META: {e}")))?;
        let lengths = FileSection::ALL.map(|section| match section {
            FileSection::Meta => json.len(),
            FileSection::Splits => size_of::<Line>() * starts.splits(),
            FileSection::Vertices => size_of::<Line>() * starts.vertex_lines(),
            section => self.scene.section(section).len(),
        });
        let (ranges, total) = place(lengths);
        let fits = self.scene.bytes().len() == total && ranges.iter().zip(&self.scene.ranges).all(|(new, old)| new.start == old.start);
        let fill = |image: &mut [u8]| {
            // Up to the next section are zeros.
            image[ranges[0].start..ranges[1].start].fill(0);
            let [meta_out, nodes_out, records, splits, vertices, normals, ..]: [&mut [u8]; COUNT] = slices(image, &ranges);
            meta_out.copy_from_slice(&json);
            nodes_out.copy_from_slice(bytemuck::cast_slice(&nodes));
            if let Some(smooth) = smooth {
                smooth.write(h, bytemuck::cast_slice_mut(normals));
            }
            let (records, splits) = (bytemuck::cast_slice_mut(records), bytemuck::cast_slice_mut(splits));
            Images { records, splits, vertices: bytemuck::cast_slice_mut(vertices) }.write(h, &self.order, &stored)?;
            seal(image, &ranges);
            Ok::<_, SceneError>(())
        };
        match Arc::get_mut(&mut self.scene.image) {
            Some(Image::Owned(image)) if fits => fill(image)?,
            _ => {
                let (mut image, _) = new_image(lengths)?;
                for section in [FileSection::Normals, FileSection::Triangles, FileSection::Sources, FileSection::Colours] {
                    image[ranges[section.slot()].clone()].copy_from_slice(self.scene.section(section));
                }
                fill(&mut image)?;
                self.scene.image = Arc::new(Image::Owned(image));
            }
        }
        (self.scene.ranges, self.scene.meta, self.scene.starts, self.scene.input) = (ranges, meta, starts, None);
        Ok(&self.scene)
    }
}
