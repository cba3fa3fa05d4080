//! A model of the lab: its scene, its hierarchy, and the positions that it was made from.

use crate::bvh::over_trees;
use crate::format::{self, Scene, SceneError, SceneInfo};
use crate::golden::{naive_bounds, naive_compact};
use crate::lab::crack::{Closedness, closedness};
use crate::mesh::{BoundKind, Hierarchy, Surface, lattice};
use crate::num::VertexForm;
use crate::num::prism::Prisms;
use crate::rays::ModelSpace;

/// A model of the lab.
pub struct Model {
    /// Its name within its case.
    pub name: String,
    /// The memory images.
    pub scene: Scene,
    /// What bounds the children of its splits, if prisms do.
    pub prisms: Vec<Prisms>,
    /// The same as integers, for the golden traverser.
    pub hierarchy: Hierarchy,
    /// World to units.
    pub space: ModelSpace,
    /// How its base triangles meet.
    pub closed: Closedness,
    /// World positions before they were rounded to units; empty if they are not known (scenes from files) or vertices are compact, which rounds more than that.
    positions: Vec<[f64; 3]>,
}

impl Model {
    /// Rounds and encodes a surface, with the paper's bounds, on which the figures of docs/stability.md rest.
    ///
    /// # Errors
    /// Those of [`format::build`].
    pub fn of_surface(name: impl Into<String>, surface: &Surface, vertices: VertexForm) -> Result<Self, SceneError> {
        let scene = format::build(surface, SceneInfo { bounds: BoundKind::Largest, vertices, ..SceneInfo::default() }, over_trees)?;
        let mut model = Self::of_scene(name, scene);
        if vertices == VertexForm::Exact {
            // Trees have the order of the scene.
            let len = lattice::len(surface.levels);
            let source = |tree: usize| model.scene.source(tree) as usize; // 28 bits
            model.positions =
                (0..model.scene.trees()).flat_map(|tree| surface.positions[source(tree) * len..][..len].iter().copied()).collect();
        }
        Ok(model)
    }

    /// Encodes integers, with displacement bounds computed anew: exact ones as they are, compact ones as that leaves them.
    ///
    /// # Errors
    /// Those of [`format::encode`]: a point off its grid or beyond the limit.
    pub fn of_hierarchy(name: impl Into<String>, mut hierarchy: Hierarchy) -> Result<Self, SceneError> {
        naive_bounds(&mut hierarchy);
        let (form, depths) = (hierarchy.vertices, |h: &Hierarchy| (0..h.triangles.len()).map(|tree| h.depth(tree)).collect::<Vec<_>>());
        while form.is_compact() {
            let before = depths(&hierarchy);
            naive_compact(form, &mut hierarchy);
            // Of the points as they are now, so that the same points give the same model: no displacement has grown, so they stay where they are.
            naive_bounds(&mut hierarchy);
            // Trees that became less deep have other last splits, where short vertices lose more.
            if form == VertexForm::Compact || depths(&hierarchy) == before {
                break;
            }
        }
        let surface = Surface {
            levels: hierarchy.levels,
            base_vertices: hierarchy.base_vertices,
            triangles: hierarchy.triangles.clone(),
            normals: vec![[0.0, 0.0, 1.0]; hierarchy.points.len()],
            ..Surface::default()
        };
        let bvh = over_trees(&format::tree_boxes(&hierarchy)).map_err(|e| SceneError::Build(e.to_string()))?;
        Ok(Self::of_scene(name, format::encode(&hierarchy, &surface, SceneInfo::default(), &bvh)?))
    }

    /// Takes a scene as it is.
    pub fn of_scene(name: impl Into<String>, scene: Scene) -> Self {
        let hierarchy = scene.decode();
        let (space, closed, prisms) = (ModelSpace::of(&scene), closedness(&hierarchy.triangles), format::scene_prisms(&scene));
        Self { name: name.into(), scene, prisms, hierarchy, space, closed, positions: Vec::new() }
    }

    /// How far rounding to units moved the point with barycentrics `bary` (2^31 = 1) of full-resolution triangle `node` of `tree`, in world units;
    /// 0 if the positions before are not known.
    pub fn moved(&self, tree: u32, node: u32, bary: [u32; 3]) -> f64 {
        if self.positions.is_empty() {
            return 0.0;
        }
        let levels = self.hierarchy.levels;
        let corners = lattice::node(levels, levels, node).map(|p| tree as usize * lattice::len(levels) + lattice::index(levels, p));
        let mut sum = [0.0; 3];
        for (at, weight) in corners.into_iter().zip(bary) {
            let by = self.rounding(at);
            sum = std::array::from_fn(|k| sum[k] + by[k] * f64::from(weight) / f64::from(1u32 << 31));
        }
        sum.iter().map(|v| v * v).sum::<f64>().sqrt()
    }

    /// What rounding did to point `at`, in world units. The difference is taken in units, where it is small, so that an offset far from the
    /// world's origin does not swallow it.
    fn rounding(&self, at: usize) -> [f64; 3] {
        let (before, after) = (self.space.to_units(self.positions[at]), self.hierarchy.points[at]);
        std::array::from_fn(|k| (f64::from(after[k]) - before[k]) * self.space.placement.scale)
    }

    /// Largest and mean distance that rounding to units moved a vertex, in units; 0 if the positions before are not known.
    pub fn vertex_loss(&self) -> (f64, f64) {
        let lengths = (0..self.positions.len()).map(|at| {
            let by = self.rounding(at).map(|v| v / self.space.placement.scale);
            by.iter().map(|v| v * v).sum::<f64>().sqrt()
        });
        let (most, sum, count) = lengths.fold((0.0f64, 0.0, 0u64), |(most, sum, count), v| (most.max(v), sum + v, count + 1));
        (most, sum / count.max(1) as f64)
    }
}
