//! Any triangle mesh to a base mesh and N levels of 1-to-4 splits.
//!
//! 1. [`source`] puts the mesh into the unit box and finds its feature lines: borders, non-manifold edges, edges between materials and creases.
//! 2. [`decimate`] removes vertices as long as the original still lies over what is left like a field of heights.
//! 3. [`topology`] finds the base mesh's edges and, for those on a feature line, the piece of the line that each stands for.
//! 4. [`split`] inserts vertices level by level: on feature lines by arc length, elsewhere by projection on the original surface.
//! 5. [`settle`] moves vertices that were left beside the surface, or that fold it, to better places.
//! 6. [`refine`] judges the result, with [`folds`] for what turns away from the original, and goes back to 2 with more vertices to keep where it falls short.
//! 7. [`shading`] gives every vertex the normal of the point of the original that it stands for.

mod decimate;
mod error;
mod folds;
mod options;
mod project;
mod refine;
mod report;
mod settle;
mod shading;
mod source;
mod split;
mod topology;

pub use error::{RemeshError, Works};
pub use options::{DEFAULT_MAX_ERROR, RemeshOptions};
pub use report::{Folds, RemeshReport};

use super::clean::TriangleMesh;
use super::distance::{Distance, TwoSidedDistance, Vec3, mean_distances, percent};
use super::farthest::Farthest;
use super::{Surface, corner_normals, lattice};
use crate::num::{MAX_LEVELS, PADDING_BITS};
use decimate::Decimator;
use rayon::prelude::*;
use refine::{Fitted, Turned, Wanted};
use source::Source;
use topology::Topology;

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
    if let Some(levels) = options.levels.filter(|&levels| levels > MAX_LEVELS) {
        return Err(RemeshError::Levels { levels });
    }
    if options.base_triangles == Some(0) {
        return Err(RemeshError::NoBase);
    }
    let range = |name, value: f64, ok: bool, range| if ok { Ok(()) } else { Err(RemeshError::Range { name, value, range }) };
    let error = options.max_error - options.reserve;
    range("the largest error", options.max_error, error > 0.0 && options.max_error <= 100.0, "above 0 and at most 100 percent")?;
    let angle = options.crease_angle;
    range("the crease angle", angle, (0.0..=180.0).contains(&angle), "from 0 to 180 degrees")?;
    check(mesh)?;

    let source = Source::new(mesh, angle.to_radians());
    let limit = |levels| {
        let least = percent(source.diagonal) * (rounding(levels) + EXACT);
        if error < least {
            return Err(RemeshError::Grid { wanted: options.max_error, levels, least: rounded_up(least + options.reserve) });
        }
        Ok((source.diagonal * error / 100.0 - rounding(levels)).max(0.0))
    };
    let (levels, fitted) = match (options.levels, options.base_triangles.map(|wanted| wanted.min(mesh.triangles.len()))) {
        (Some(levels), None) => {
            let wanted = Wanted { levels, base: 0, limit: limit(levels)? };
            (levels, refine::fit(&source, &mut Decimator::new(&source), &wanted, progress)?)
        }
        (None, None) => refine::fit_by_need(&source, &limit, progress)?,
        (levels, Some(base)) => {
            let levels = levels.unwrap_or_else(|| refine::levels_for(base as u64, mesh.triangles.len() as u64));
            limit(levels)?;
            (levels, refine::force(&source, base, levels, progress)?)
        }
    };
    let limit = limit(levels)?;
    let Fitted { topology, forest, .. } = &fitted;
    progress("normals", 0, 1);
    let surface = Surface {
        levels,
        base_vertices: topology.vertices.len() as u32,
        triangles: topology.triangles.clone(),
        positions: to_world(&source, topology, &forest.positions, levels, mesh),
        normals: shading::shade(&source, topology, forest, &corner_normals(mesh, angle), !mesh.normals.is_empty()),
        materials: topology.faces.iter().filter_map(|&t| mesh.materials.get(t as usize).copied()).collect(),
        colours: mesh.colours.clone(),
    };
    progress("normals", 1, 1);

    progress("distance", 0, 1);
    let far = refine::measure(&source, &fitted, limit);
    let turned = refine::turned(&source, &fitted, limit);
    let base_triangles = fitted.topology.triangles.len();
    let mut report = RemeshReport {
        base_triangles,
        wanted_base_triangles: options.base_triangles.filter(|&wanted| wanted < base_triangles),
        own_base_triangles: fitted.topology.own.iter().flatten().count(),
        finest_triangles: surface.finest_triangles(),
        flipped_triangles: turned.flips,
        folds: turned.folds,
        degenerate_triangles: fitted.target.degenerate(),
        distance: distances(&source, &fitted, &far, levels),
        rounding: percent(source.diagonal) * rounding(levels),
        ..Default::default()
    };
    fitted.forest.count_methods(&fitted.topology, &mut report);
    report.warning = warning(&source, &turned, &far, options, mesh, &report, levels);
    progress("distance", 1, 1);
    Ok((surface, report))
}

/// What is left of rounding in `f64` where the result is the original, in units of the box, and more.
const EXACT: f64 = 1e-12;

/// A number with four digits that is a little larger, by less than two thousandths.
fn rounded_up(value: f64) -> f64 {
    format!("{:.3e}", 1.001 * value).parse().unwrap_or(value)
}

/// How far a vertex moves at most when it is rounded to the format's grid, in units of the box.
///
/// Coordinates have 31 bits and a sign over the model, which is at most 2 units wide; half a step of the coarsest grid in each direction.
fn rounding(levels: u32) -> f64 {
    3f64.sqrt() * f64::from(levels.max(PADDING_BITS)).exp2() * 2f64.powi(-31)
}

/// Distances in percent, with what rounding to the format's grid adds to the largest.
fn distances(source: &Source, fitted: &Fitted, far: &[Farthest; 2], levels: u32) -> TwoSidedDistance {
    let percent = percent(source.diagonal);
    let [to, from] = mean_distances(&source.target, &fitted.target, source.diagonal, far.each_ref().map(|far| far.bound));
    let distance = |mean, far: &Farthest| Distance { mean, max: percent * (far.bound + rounding(levels)), found: percent * far.found };
    TwoSidedDistance { to_original: distance(to, &far[0]), from_original: distance(from, &far[1]) }
}

/// One line on what was lost, where, and what to try; none if nothing was.
fn warning(
    source: &Source,
    turned: &Turned,
    far: &[Farthest; 2],
    options: &RemeshOptions,
    mesh: &TriangleMesh,
    report: &RemeshReport,
    levels: u32,
) -> Option<String> {
    let (to, from) = (&report.distance.to_original, &report.distance.from_original);
    let place = |p: Vec3| {
        let [x, y, z] =
            source.to_world(p).map(|v| if v == 0.0 || (1e-3..1e6).contains(&v.abs()) { format!("{v:.4}") } else { format!("{v:.3e}") });
        format!("at ({x}, {y}, {z})")
    };
    let mut lost = Vec::new();
    if to.max.max(from.max) + options.reserve > options.max_error {
        let (worst, at) = if from.max > to.max { (from.max, far[1].at) } else { (to.max, far[0].at) };
        let worst = worst + options.reserve;
        let worst = if worst < 0.01 { format!("{worst:.2e}") } else { format!("{worst:.3}") };
        lost.push(format!("it is up to {worst} % of the diagonal away from the original, {} (wanted: {} %)", place(at), options.max_error));
    }
    if let Some(at) = turned.flip {
        let flips = turned.flips;
        let face = if flips == 1 { "faces" } else { "face" };
        lost.push(format!("{flips} of its {} triangles {face} away from the original, such as {}", report.finest_triangles, place(at)));
    }
    if let Some(at) = turned.fold {
        let edges = if turned.folds.new == 1 { "edge folds" } else { "edges fold" };
        lost.push(format!(
            "{} of its {edges} by more than 150 degrees where the original has no fold, such as {}",
            turned.folds.new,
            place(at)
        ));
    }
    if lost.is_empty() {
        return None;
    }
    let seams = mesh.report.non_manifold_edges + mesh.report.inconsistent_edges;
    let all = mesh.triangles.len();
    let fits = |base: usize| base as u64 <= refine::most_base(levels);
    let try_this = match options.base_triangles {
        Some(base) if base < all => "leave --base out, or try a larger one".to_owned(),
        _ if seams > 0 => format!(
            "its {seams} {} with more than two triangles, or with two that face different ways, are best repaired in the original",
            if seams == 1 { "edge" } else { "edges" }
        ),
        _ if report.base_triangles < all / 2 && fits(2 * report.base_triangles) => format!("try --base {}", 2 * report.base_triangles),
        _ if turned.flip.is_some() => "the original folds there".to_owned(),
        // The original's own triangles split flat.
        _ if fits(all) => format!("try --base {all}, the mesh itself"),
        _ => "try fewer --levels".to_owned(),
    };
    Some(format!("{}; {try_this}", lost.join(", and ")))
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
