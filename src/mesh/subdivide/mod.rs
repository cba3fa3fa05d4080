//! A mesh's own faces, split: on the limit surface of Loop's or of Catmull and Clark's rules, or where they lie.

mod catmull_clark;
mod flat;
mod loop_net;
mod loop_surface;
mod quad_net;
mod shading;

pub use catmull_clark::{CornerTexture, catmull_clark_surface};
pub use flat::flat_surface;
pub(super) use flat::{between, weights};
pub use loop_surface::loop_surface;
pub(super) use shading::{SharedPoints, shade};

use crate::num::MAX_LEVELS;

/// Most finest triangles: their edges are numbered in 32 bits.
pub const MAX_SUBDIVIDED: u64 = 1 << 30;

/// Why a mesh cannot be subdivided so often.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SubdivideError {
    /// Too many splits.
    #[error("{0} levels are too many: 0 to {MAX_LEVELS} are possible")]
    Levels(u32),
    /// The result would be too large.
    #[error("{triangles} base triangles with {levels} levels are more than {MAX_SUBDIVIDED} triangles")]
    Triangles {
        /// Base triangles.
        triangles: u64,
        /// Splits.
        levels: u32,
    },
}

/// Refuses what would be too large.
///
/// # Errors
/// Too many splits, or more than [`MAX_SUBDIVIDED`] finest triangles.
pub fn check_subdivision(triangles: u64, levels: u32) -> Result<(), SubdivideError> {
    if levels > MAX_LEVELS {
        return Err(SubdivideError::Levels(levels));
    }
    if triangles << (2 * levels) > MAX_SUBDIVIDED {
        return Err(SubdivideError::Triangles { triangles, levels });
    }
    Ok(())
}

/// The rule of each vertex of a net, from its edges, of which the first `curves` are on curves, and all pairs of neighbours that a face has beside each other at a vertex: [vertex,
/// one, other], both ways.
fn rules(vertices: usize, mut pairs: Vec<[u32; 3]>, edges: &[[u32; 2]], curves: usize) -> Vec<Rule> {
    let mut on_curves = vec![0_u32; vertices];
    edges[..curves].iter().flatten().for_each(|&v| on_curves[v as usize] += 1);
    pairs.sort_unstable();
    let mut rules = vec![Rule::Fixed; vertices];
    for own in pairs.chunk_by(|a, b| a[0] == b[0]) {
        let v = own[0][0] as usize;
        rules[v] = match on_curves[v] {
            0 if is_one_fan(own) => Rule::Smooth,
            2 => Rule::Curve,
            _ => Rule::Fixed,
        };
    }
    rules
}

/// What moves a vertex.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Rule {
    /// All its neighbours: faces lie around it like a fan, and none of its edges is on a curve.
    Smooth,
    /// Its two neighbours along the one curve that it lies on.
    Curve,
    /// Nothing: curves end or meet there, or fans touch.
    Fixed,
}

/// Whether the faces around a vertex, of which two meet at each of its edges, are one closed fan. `pairs` are its sorted pairs of neighbours.
fn is_one_fan(pairs: &[[u32; 3]]) -> bool {
    let [_, start, mut to] = pairs[0];
    let (mut from, mut met) = (start, 1);
    while to != start {
        // Both faces at the edge to this neighbour, the one that was met and the next.
        let at = pairs.partition_point(|pair| pair[1] < to);
        let next = if pairs[at][2] == from { pairs[at + 1][2] } else { pairs[at][2] };
        (from, to) = (to, next);
        met += 1;
    }
    2 * met == pairs.len()
}

fn add(sum: &mut [f64; 3], point: [f64; 3]) {
    sum.iter_mut().zip(point).for_each(|(sum, c)| *sum += c);
}
