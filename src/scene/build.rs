//! Scenes of meshes.

use crate::bvh::over_trees;
use crate::format::{self, Scene, SceneError, SceneInfo};
use crate::mesh::procedural::{self, GenerateError};
use crate::mesh::{
    BoundKind, DEFAULT_CREASE_ANGLE, MeshError, RemeshError, RemeshOptions, RemeshReport, Surface, TriangleMesh, corner_normals, remesh,
};
use crate::num::{MOST_DIRECTION_ZEROS, VertexForm};
use crate::rays::ModelSpace;
use serde_json::{Value, json};
use thiserror::Error;

/// How a mesh becomes a scene.
#[derive(Clone, Debug)]
pub struct BuildOptions {
    /// Name of the model.
    pub name: String,
    /// How the mesh becomes base triangles that are split; none for its own triangles, which are not.
    pub remesh: Option<RemeshOptions>,
    /// What displacement bounds cover.
    pub bounds: BoundKind,
    /// How vertices are stored.
    pub vertices: VertexForm,
    /// Zero bits at the bottom of every coordinate, 0 to 16 less the splits: a hardware can leave them out.
    pub coordinate_zeros: u32,
    /// Zero bits at the bottom of the components of its rays' directions, 0 to 14.
    pub direction_zeros: u32,
    /// What is to be kept of how it was made, by name.
    pub origin: serde_json::Map<String, Value>,
}

impl Default for BuildOptions {
    fn default() -> Self {
        Self { remesh: Some(RemeshOptions::default()), vertices: VertexForm::default(), ..Self::own_triangles() }
    }
}

impl BuildOptions {
    /// The mesh's own triangles, each vertex within half a step of its place: the largest side of the mesh's box has some 2^28 steps.
    pub fn own_triangles() -> Self {
        Self {
            name: String::new(),
            remesh: None,
            bounds: BoundKind::default(),
            vertices: VertexForm::Exact,
            coordinate_zeros: 0,
            direction_zeros: 0,
            origin: serde_json::Map::new(),
        }
    }

    /// The same with something that is kept of how it was made.
    #[must_use]
    pub fn with_origin(mut self, name: &str, value: Value) -> Self {
        self.origin.insert(name.to_owned(), value);
        self
    }
}

/// A mesh that does not become a scene.
#[derive(Debug, Error)]
pub enum BuildError {
    /// It is none.
    #[error(transparent)]
    Mesh(#[from] MeshError),
    /// It cannot be generated.
    #[error(transparent)]
    Generate(#[from] GenerateError),
    /// It cannot be remeshed so.
    #[error(transparent)]
    Remesh(#[from] RemeshError),
    /// What was made of it does not fit.
    #[error(transparent)]
    Scene(#[from] SceneError),
}

/// Remeshes, at most.
const TRIES: u32 = 3;

impl Scene {
    /// The scene of a mesh: positions, and three indices into them for each triangle. Triangles without area are left out, and vertices at one place are one.
    ///
    /// # Errors
    /// An index out of range, a coordinate that is not finite, no triangle; a mesh that cannot be remeshed so; more triangles than there can be.
    pub fn build(vertices: &[[f64; 3]], faces: &[[u32; 3]], options: &BuildOptions) -> Result<Self, BuildError> {
        Self::of_mesh(&TriangleMesh::from_parts(vertices, faces, &[], Vec::new())?, options, &|_, _, _| ())
    }

    /// A procedural scene.
    ///
    /// # Errors
    /// Options that cannot be, or more triangles than there can be.
    pub fn generate(options: &procedural::Options) -> Result<Self, BuildError> {
        let surface = procedural::generate(options)?;
        let form = BuildOptions { name: options.scene.name().to_owned(), vertices: VertexForm::default(), ..BuildOptions::own_triangles() };
        Ok(Self::of_surface(&surface, &form.with_origin("generate", json!(options)))?)
    }

    /// The scene of a mesh. `progress` is told what is being done, and how many steps of it are done, of how many.
    ///
    /// Stored vertices are within the largest error too: as a rule there is room for what storing moves, otherwise it is made again with so much in reserve.
    /// What was lost stands in its origin (`remesh.warning`).
    ///
    /// # Errors
    /// As [`Self::build`].
    pub fn of_mesh(mesh: &TriangleMesh, options: &BuildOptions, progress: &(dyn Fn(&str, u64, u64) + Sync)) -> Result<Self, BuildError> {
        let Some(mut remeshing) = options.remesh else {
            let surface = Surface::of_mesh(mesh, &corner_normals(mesh, DEFAULT_CREASE_ANGLE));
            progress("encoding", 0, 1);
            return Ok(Self::of_surface(&surface, options)?);
        };
        let mut last = None;
        for tried in 1..=TRIES {
            let (surface, mut report) = match (remesh(mesh, &remeshing, progress), last.take()) {
                (Err(_), Some(scene)) => return Ok(scene),
                (made, _) => made?,
            };
            progress("encoding", 0, 1);
            let made = |report: &RemeshReport| {
                let options = options.clone().with_origin("mesh", json!(mesh.report)).with_origin("remesh", json!(report));
                Self::of_surface(&surface, &options)
            };
            let scene = made(&report)?;
            // Rounding to the grid is among the distances.
            let moved = (moved_percent(&scene) - report.rounding).max(0.0);
            let far = report.distance.to_original.max.max(report.distance.from_original.max) + moved;
            if far <= remeshing.max_error || report.warning.is_some() {
                return Ok(scene);
            }
            let finer = if options.vertices == VertexForm::Short { VertexForm::Compact } else { VertexForm::Exact };
            report.warning = Some(format!(
                "stored vertices are up to {far:.4} % of the diagonal away from the original (wanted: {} %), {moved:.4} % of it by storing; try --vertices {}",
                remeshing.max_error,
                finer.name()
            ));
            let scene = made(&report)?;
            // What is moved depends a little on what is made.
            remeshing.reserve = 1.25 * moved;
            if tried == TRIES || leaves_no_room(&remeshing) {
                return Ok(scene);
            }
            last = Some(scene);
        }
        unreachable!("the last try returns")
    }

    /// The scene of a surface whose splits are known; the options say nothing of those.
    ///
    /// # Errors
    /// The surface is not fit, or has more triangles than there can be.
    pub fn of_surface(surface: &Surface, options: &BuildOptions) -> Result<Self, SceneError> {
        let BuildOptions { bounds, vertices, coordinate_zeros, direction_zeros, .. } = *options;
        if direction_zeros > MOST_DIRECTION_ZEROS {
            return Err(SceneError::Build(format!("direction_zeros: {direction_zeros} is more than {MOST_DIRECTION_ZEROS}")));
        }
        let origin = if options.origin.is_empty() { Value::Null } else { Value::Object(options.origin.clone()) };
        let info = SceneInfo { name: options.name.clone(), origin, bounds, vertices, coordinate_zeros, direction_zeros, moved: 0.0 };
        format::build(surface, info, over_trees)
    }
}

/// Whether a base mesh of a given size, or a reserve beyond the error, makes another try useless.
fn leaves_no_room(options: &RemeshOptions) -> bool {
    options.base_triangles.is_some() || options.reserve >= options.max_error
}

/// How far storing moved vertices at most, in percent of the diagonal of the model's box.
pub fn moved_percent(scene: &Scene) -> f64 {
    100.0 * scene.meta().moved / (2.0 * ModelSpace::of(scene).radius())
}
