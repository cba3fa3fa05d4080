//! Any triangle mesh to a base mesh and N levels of 1-to-4 splits.
//!
//! 1. [`source`] puts the mesh into the unit box and finds its feature lines: borders, non-manifold edges and creases.
//! 2. [`base`] collapses edges by their quadric error, feature lines only along themselves.
//! 3. [`topology`] finds the base mesh's edges and, for those on a feature line, the piece of the line that each stands for.
//! 4. [`split`] inserts vertices level by level: on feature lines by arc length, elsewhere by projection on the original surface.
//! 5. [`settle`] moves vertices that were left beside the surface, or that fold it, to better places.
//! 6. [`shading`] makes the normals and counts what went wrong.

mod base;
mod project;
mod settle;
mod shading;
mod source;
mod split;
mod topology;

use super::clean::TriangleMesh;
use super::distance::{Target, TwoSidedDistance, Vec3, two_sided};
use super::{Surface, lattice};
use crate::num::MAX_LEVELS;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use source::Source;
use topology::Topology;

/// Most finest triangles that are made: they need about 12 GB while they are.
const MAX_TRIANGLES: u64 = 1 << 26;

/// The default base mesh has one triangle for this many of the input, ...
const REDUCTION: usize = 64;
/// ... but at least this many.
const MIN_BASE: usize = 512;

/// Bends beyond these angles (degrees) are tried as creases, in this order.
const CREASES: [f64; 4] = [40.0, 60.0, 85.0, 180.0];
/// Splits that show whether a base mesh goes well.
const TRIAL_LEVELS: u32 = 2;
/// It does if no more than this part of the lattice points is beside the surface or in a triangle that faces away, ...
const LITTLE_TROUBLE: f64 = 0.001;
/// ... and creases are given up only to reduce that to this part of itself.
const WORTH: f64 = 0.5;
/// Up to this factor more base triangles than wanted will do.
const ENOUGH: f64 = 1.25;

/// What to make of a mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RemeshOptions {
    /// Number of splits N, 0 to [`MAX_LEVELS`].
    pub levels: u32,
    /// Wanted number of base triangles; by default 1/64 of the input, but at least 512 (fewer with nine or ten levels, which would make too many
    /// triangles of them), and never more than the input.
    pub base_triangles: Option<usize>,
}

/// What remeshing made, and how well it fits.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct RemeshReport {
    /// Base triangles reached; more than wanted if the topology or the feature lines did not allow it.
    pub base_triangles: usize,
    /// Triangles that collapsed to degenerate ones or to ones already there, and were dropped from the base mesh.
    pub dropped_base_triangles: usize,
    /// Triangles of the finest level.
    pub finest_triangles: u64,
    /// Inserted vertices put where a line along the interpolated normal meets the original surface.
    pub projected_by_ray: u64,
    /// Inserted vertices put at the closest point of the original surface.
    pub by_closest_point: u64,
    /// Inserted vertices put on a border or crease of the original, by arc length.
    pub on_feature_lines: u64,
    /// Inserted vertices kept at the middle of their edge, or between that and the surface, because anything else folds the surface.
    pub midpoints_kept: u64,
    /// Finest triangles that face away from the original surface at their corners.
    pub flipped_triangles: u64,
    /// Finest triangles without area.
    pub degenerate_triangles: u64,
    /// Distances between the finest level and the original. At most about 600 thousand and 900 thousand samples are taken.
    pub distance: TwoSidedDistance,
}

/// Why a mesh was not remeshed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum RemeshError {
    /// Too many splits.
    #[error("{levels} levels are more than the {MAX_LEVELS} there can be")]
    Levels {
        /// What was asked for.
        levels: u32,
    },
    /// A base mesh of no triangles was asked for.
    #[error("a base mesh needs at least one triangle")]
    NoBase,
    /// The result would not fit in memory.
    #[error("{base} base triangles and {levels} levels make {triangles} triangles, more than {MAX_TRIANGLES}; ask for fewer")]
    TooMany {
        /// Base triangles reached.
        base: usize,
        /// Number of splits.
        levels: u32,
        /// What they would make.
        triangles: u64,
    },
    /// The mesh breaks a promise of [`TriangleMesh`].
    #[error("the mesh cannot be remeshed, it has {what}")]
    BadMesh {
        /// What is wrong with it.
        what: &'static str,
    },
}

/// Remeshes `mesh` as `options` say; `progress` is called with a stage's name, what is done of it and its total.
///
/// The result is the same for any number of threads.
///
/// # Errors
/// If the options are out of range, the mesh is unusable or the result would be too large: see [`RemeshError`].
pub fn remesh(
    mesh: &TriangleMesh,
    options: &RemeshOptions,
    progress: &dyn Fn(&str, u64, u64),
) -> Result<(Surface, RemeshReport), RemeshError> {
    let levels = options.levels;
    if levels > MAX_LEVELS {
        return Err(RemeshError::Levels { levels });
    }
    if options.base_triangles == Some(0) {
        return Err(RemeshError::NoBase);
    }
    check(mesh)?;
    let count = mesh.triangles.len();
    // With many levels the default is what the size limit leaves room for.
    let default = (count / REDUCTION).max(MIN_BASE).min((MAX_TRIANGLES >> (2 * levels)) as usize / 2);
    let wanted = options.base_triangles.unwrap_or(default).min(count);

    let (source, topology, dropped) = choose_base(mesh, wanted, progress);
    let base = topology.triangles.len();
    let triangles = (base as u64) << (2 * levels);
    if triangles > MAX_TRIANGLES {
        return Err(RemeshError::TooMany { base, levels, triangles });
    }

    let forest = split::split(&source, &topology, levels, progress);
    progress("normals", 0, 1);
    let (normals, flipped_triangles) = shading::shade(&topology, &forest);
    progress("normals", 1, 1);

    let surface = Surface {
        levels,
        base_vertices: topology.vertices.len() as u32,
        triangles: topology.triangles.clone(),
        positions: to_world(&source, &topology, &forest.positions, levels, mesh),
        normals,
        materials: topology.faces.iter().filter_map(|&t| mesh.materials.get(t as usize).copied()).collect(),
        colours: mesh.colours.clone(),
    };

    progress("distance", 0, 1);
    let corners = shading::finest_corners(&forest);
    let mut report = RemeshReport {
        base_triangles: topology.triangles.len(),
        dropped_base_triangles: dropped,
        finest_triangles: surface.finest_triangles(),
        flipped_triangles,
        degenerate_triangles: corners.par_iter().filter(|c| super::clean::is_degenerate(c.map(|p| p.to_array()))).count() as u64,
        distance: two_sided(&source.target, &Target::grouped(corners, 1 << (2 * levels.min(2))), source.diagonal),
        ..Default::default()
    };
    forest.count_methods(&topology, &mut report);
    progress("distance", 1, 1);
    Ok((surface, report))
}

/// Makes a base mesh for one crease angle after the other, splits it a little, and takes the first that goes well; else the best.
///
/// Creases kept are edges kept sharp, but on a rough or coarse surface they can be so many that they leave no room for anything else.
fn choose_base(mesh: &TriangleMesh, wanted: usize, progress: &dyn Fn(&str, u64, u64)) -> (Source, Topology, usize) {
    let attempt = |crease: f64| {
        let (source, base, dropped) = base::simplify(mesh, wanted, crease.to_radians());
        let topology = Topology::new(&source, base);
        let forest = split::split(&source, &topology, TRIAL_LEVELS, &|_, _, _| {});
        let mut report = RemeshReport::default();
        forest.count_methods(&topology, &mut report);
        let bad = report.midpoints_kept + shading::shade(&topology, &forest).1;
        let trouble = bad as f64 / forest.positions.len() as f64;
        let too_many = (topology.triangles.len() as f64 / wanted as f64 - ENOUGH).max(0.0);
        ((source, topology, dropped), trouble + too_many)
    };
    let total = CREASES.len() as u64;
    progress("base mesh", 0, total);
    let (mut best, mut least) = attempt(CREASES[0]);
    for (&crease, done) in CREASES[1..].iter().zip(1..) {
        if least <= LITTLE_TROUBLE {
            break;
        }
        progress("base mesh", done, total);
        let (next, trouble) = attempt(crease);
        if trouble < WORTH * least {
            (best, least) = (next, trouble);
        }
    }
    progress("base mesh", total, total);
    best
}

fn check(mesh: &TriangleMesh) -> Result<(), RemeshError> {
    let bad = |what| Err(RemeshError::BadMesh { what });
    if mesh.triangles.is_empty() {
        return bad("no triangles");
    }
    if mesh.triangles.iter().flatten().any(|&v| v as usize >= mesh.positions.len()) {
        return bad("a vertex index out of range");
    }
    if mesh.triangles.iter().any(|t| t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
        return bad("a triangle with a repeated vertex");
    }
    if mesh.positions.iter().flatten().any(|&v| !super::clean::is_coordinate(v)) {
        return bad("a coordinate that is not finite");
    }
    if !mesh.materials.is_empty() && mesh.materials.len() != mesh.triangles.len() {
        return bad("a different number of materials and triangles");
    }
    if mesh.materials.iter().any(|&m| m as usize >= mesh.colours.len()) {
        return bad("a material without a colour");
    }
    Ok(())
}

/// Positions in the user's units; base vertices that did not move are exactly those of the original.
fn to_world(source: &Source, topology: &Topology, positions: &[Vec3], levels: u32, mesh: &TriangleMesh) -> Vec<[f64; 3]> {
    let mut world: Vec<[f64; 3]> = positions.par_iter().map(|&p| source.to_world(p)).collect();
    let corners = lattice::root(levels).map(|p| lattice::index(levels, p));
    for (t, triangle) in topology.triangles.iter().enumerate() {
        for k in 0..3 {
            let (at, vertex) = (t * lattice::len(levels) + corners[k], topology.vertices[triangle[k] as usize] as usize);
            if positions[at] == source.positions[vertex] {
                world[at] = mesh.positions[vertex];
            }
        }
    }
    world
}
