//! From a surface in world units to a hierarchy in integers: the placement, the snapping of each point, the bounds.

use super::borders::SharedEdges;
use super::bounds::write_codes;
use super::compact::compact;
use super::lattice::Insertion;
use super::{BoundKind, EdgeCodes, Hierarchy, Placement, Surface, lattice};
use crate::num::{BOX_SHIFT, COORD_LIMIT, MAX_LEVELS, VertexForm, snap};
use rayon::prelude::*;
use thiserror::Error;

/// The furthest that a point may be from the middle of its edge's ends, in units and in each coordinate, to be taken for it: far less than what any is rounded by, and
/// more than what arithmetic in `f64` leaves of a middle in a model no further than some thousand times its size from the world's origin.
const FLAT: f64 = 1.0 / 16.0;

/// Why a surface cannot become a hierarchy.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum SurfaceError {
    /// There is nothing to trace.
    #[error("surface has no triangles")]
    Empty,
    /// Too many splits.
    #[error("surface levels: {0} splits, at most {MAX_LEVELS} are possible")]
    Levels(u32),
    /// More zero bits than there is room for.
    #[error("surface zeros: {zeros} zero bits at the bottom of the coordinates, at most {} are possible with {levels} splits", most_zeros(*.levels))]
    Zeros {
        /// How many.
        zeros: u32,
        /// Number of splits.
        levels: u32,
    },
    /// More trees than a 28-bit reference can name.
    #[error("surface triangles: {0} base triangles, fewer than 2^28 are possible")]
    TooManyTrees(usize),
    /// An array's length does not follow from the others.
    #[error("surface {field}: {found} entries, {expected} expected")]
    Length {
        /// Which array.
        field: &'static str,
        /// Its length.
        found: usize,
        /// The length that it should have.
        expected: usize,
    },
    /// A base triangle uses a vertex that does not exist, or one vertex twice.
    #[error("surface triangles: base triangle {tree} has vertices {triangle:?}; three different ones below {base_vertices} are needed")]
    BadTriangle {
        /// Which base triangle.
        tree: usize,
        /// Its indices.
        triangle: [u32; 3],
        /// Number of base vertices.
        base_vertices: u32,
    },
    /// A position or normal is not finite, or a normal has no length.
    #[error("surface {field}: entry {index} (tree {tree}) is {value:?}")]
    BadVector {
        /// Which array.
        field: &'static str,
        /// Which entry.
        index: usize,
        /// The tree that it belongs to.
        tree: usize,
        /// What it is.
        value: [f64; 3],
    },
    /// The extent of the model cannot be divided into units in `f64`.
    #[error("surface positions: extent {0:e} is outside what can be divided into units")]
    Extent(f64),
    /// A point on a shared base edge or vertex differs between trees.
    #[error("surface positions: trees {trees:?} disagree on point {place} of {of} along base edge {ends:?}")]
    Unequal {
        /// The two trees.
        trees: [u32; 2],
        /// Base vertices of the edge.
        ends: [u32; 2],
        /// Where along it.
        place: u32,
        /// Of how many steps.
        of: u32,
    },
    /// Two trees place one base vertex at two points.
    #[error("surface positions: tree {tree} does not agree with an earlier tree on the place of base vertex {vertex}")]
    UnequalVertex {
        /// The later tree.
        tree: usize,
        /// The base vertex.
        vertex: u32,
    },
    /// A material index without colour.
    #[error("surface materials: base triangle {tree} has material {material}, but there are {colours} colours")]
    BadMaterial {
        /// Which base triangle.
        tree: usize,
        /// Its material.
        material: u16,
        /// Number of colours.
        colours: usize,
    },
}

/// The hierarchy of a surface: points snapped to the grids of their levels, of which the finest has `zeros` zero bits, and to what vertices of this form can hold, and the
/// bounds of all edges, of this kind.
///
/// # Errors
/// Whatever [`SurfaceError`] names: lengths, indices or values that [`Surface`] does not allow.
pub fn quantise(surface: &Surface, kind: BoundKind, vertices: VertexForm, zeros: u32) -> Result<Hierarchy, SurfaceError> {
    if zeros > most_zeros(surface.levels) {
        return Err(SurfaceError::Zeros { zeros, levels: surface.levels });
    }
    check_shape(surface)?;
    let len = lattice::len(surface.levels);
    if let Some(index) = first_not_finite(&surface.positions) {
        return Err(SurfaceError::BadVector { field: "positions", index, tree: index / len, value: surface.positions[index] });
    }
    let Surface { levels, base_vertices, .. } = *surface;
    let mut h = Hierarchy {
        levels,
        placement: placement(&surface.positions)?,
        base_vertices,
        triangles: surface.triangles.clone(),
        points: vec![[0; 3]; surface.positions.len()],
        bounds: EdgeCodes { kind, ..EdgeCodes::default() },
        vertices,
        zeros,
    };
    let units = to_units(h.placement);
    snap_points(levels, vertices, zeros, &surface.positions, units, &mut h.points);
    let shared = SharedEdges::new(&h.triangles);
    check_shared_points(surface, &h.points, &shared)?;
    fit_codes(&mut h, &shared, &mut Vec::new());
    Ok(h)
}

/// Moves the vertices of a hierarchy, in place: `numbers` has for each of its points which of these positions, all finite, it takes. Points that trees share have the same number in each. Everything is as
/// [`quantise`] has it, the same form and kind, the placement anew unless one is given that holds all ([`grid_holds`]). `bounds` is memory for use on the way.
///
/// # Errors
/// [`SurfaceError::Extent`]; nothing has changed then.
pub fn move_vertices(
    h: &mut Hierarchy,
    shared: &SharedEdges,
    numbers: &[u32],
    positions: &[[f64; 3]],
    kept: Option<Placement>,
    bounds: &mut Vec<u64>,
) -> Result<(), SurfaceError> {
    h.placement = kept.map_or_else(|| placement(positions), Ok)?;
    let units = to_units(h.placement);
    snap_points(h.levels, h.vertices, h.zeros, numbers, |number| units(positions[number as usize]), &mut h.points);
    fit_codes(h, shared, bounds);
    Ok(())
}

/// Bounds of the points, and points as their form has them.
fn fit_codes(h: &mut Hierarchy, shared: &SharedEdges, bounds: &mut Vec<u64>) {
    write_codes(h.levels, &h.points, shared, &mut h.bounds, bounds);
    if h.vertices.is_compact() {
        compact(h.vertices, h.levels, h.zeros, &mut h.points, &h.bounds, shared);
    }
}

/// World to units.
fn to_units(Placement { offset, scale }: Placement) -> impl Fn([f64; 3]) -> [f64; 3] + Copy + Sync {
    move |position| std::array::from_fn(|k| (position[k] - offset[k]) / scale)
}

/// Whether coordinates in this placement reach all positions.
pub fn grid_holds(grid: Placement, positions: &[[f64; 3]]) -> bool {
    let (units, limit) = (to_units(grid), f64::from(COORD_LIMIT));
    positions.par_iter().with_min_len(1 << 12).all(|&p| units(p).iter().all(|c| c.abs() <= limit))
}

/// The first position that is not finite.
pub fn first_not_finite(positions: &[[f64; 3]]) -> Option<usize> {
    positions.par_iter().with_min_len(1 << 12).position_first(|p| !p.iter().all(|c| c.is_finite()))
}

/// The most zero bits at the bottom of every coordinate: base vertices have one more for each split, and boxes end at no more than 16.
pub const fn most_zeros(levels: u32) -> u32 {
    BOX_SHIFT - levels
}

/// Lengths, indices and materials.
fn check_shape(s: &Surface) -> Result<(), SurfaceError> {
    if s.levels > MAX_LEVELS {
        return Err(SurfaceError::Levels(s.levels));
    }
    let trees = s.triangles.len();
    if trees == 0 {
        return Err(SurfaceError::Empty);
    }
    if trees >= 1 << 28 {
        return Err(SurfaceError::TooManyTrees(trees));
    }
    let expected = trees * lattice::len(s.levels);
    for (field, found, expected) in [
        ("positions", s.positions.len(), expected),
        ("normals", s.normals.len(), expected),
        ("materials", s.materials.len(), if s.materials.is_empty() { 0 } else { trees }),
    ] {
        if found != expected {
            return Err(SurfaceError::Length { field, found, expected });
        }
    }
    for (tree, &triangle) in s.triangles.iter().enumerate() {
        let [a, b, c] = triangle;
        if a == b || b == c || c == a || triangle.iter().any(|&v| v >= s.base_vertices) {
            return Err(SurfaceError::BadTriangle { tree, triangle, base_vertices: s.base_vertices });
        }
    }
    if let Some((tree, &material)) = s.materials.iter().enumerate().find(|&(_, &m)| usize::from(m) >= s.colours.len()) {
        return Err(SurfaceError::BadMaterial { tree, material, colours: s.colours.len() });
    }
    Ok(())
}

/// Places units so that the box of all positions is centred and its largest half extent comes to one unit less than [`COORD_LIMIT`]: then no
/// rounding passes the limit, which lies on every level's grid.
fn placement(positions: &[[f64; 3]]) -> Result<Placement, SurfaceError> {
    type Corners = [[f64; 3]; 2];
    let none: Corners = [[f64::INFINITY; 3], [f64::NEG_INFINITY; 3]];
    let join = |[a, b]: Corners, [c, d]: Corners| [std::array::from_fn(|k| a[k].min(c[k])), std::array::from_fn(|k| b[k].max(d[k]))];
    let [lo, hi] = positions.par_iter().with_min_len(1 << 12).fold(|| none, |b, &p| join(b, [p, p])).reduce(|| none, join);
    // Halved first: the sum of two finite numbers need not be finite. Adding 0 turns -0 into 0.
    let offset: [f64; 3] = std::array::from_fn(|k| lo[k] / 2.0 + hi[k] / 2.0 + 0.0);
    // Not (hi - lo) / 2: far from the world's origin the centre itself is rounded.
    let half = (0..3).map(|k| (hi[k] - offset[k]).max(offset[k] - lo[k])).fold(0.0, f64::max);
    let scale = if half == 0.0 { 1.0 / f64::from(COORD_LIMIT) } else { half / f64::from(COORD_LIMIT - 1) };
    if !scale.is_normal() {
        return Err(SurfaceError::Extent(2.0 * half));
    }
    Ok(Placement { offset, scale })
}

/// Every point of all trees, in the units that `units` gives, to its level's grid; where the surface is flat, to the middle of its edge's ends as they were snapped, if
/// that is on the grid, as it always is in the compact form: there are no displacements, and nothing to store.
pub(super) fn snap_points<P: Copy + Sync>(
    levels: u32,
    vertices: VertexForm,
    zeros: u32,
    places: &[P],
    units: impl Fn(P) -> [f64; 3] + Sync,
    points: &mut [[i32; 3]],
) {
    let len = lattice::len(levels);
    // The zero bits of each lattice point and what is inserted between what are the same for all trees.
    let m = 1 << levels;
    let zero_bits: Vec<u32> =
        (0..=m).flat_map(|j| (0..=m - j).map(move |i| vertices.zero_bits(levels, lattice::level_of(levels, (i, j)), zeros))).collect();
    let inserted: Vec<Insertion> = lattice::insertions(levels).into_iter().flatten().collect();
    points.par_chunks_mut(len).zip(places.par_chunks(len)).for_each_init(Vec::new, |exact: &mut Vec<[f64; 3]>, (points, places)| {
        exact.clear();
        exact.extend(places.iter().map(|&place| units(place)));
        for ((point, &exact), &bits) in points.iter_mut().zip(&*exact).zip(&zero_bits) {
            *point = exact.map(|v| snap(v, bits));
        }
        for &Insertion { own, ends, .. } in &inserted {
            let (q, [a, b]) = (own as usize, ends.map(|end| end as usize));
            // The sum is the same in either order: so trees that share an edge agree.
            if (0..3).any(|k| (exact[q][k] - 0.5 * (exact[a][k] + exact[b][k])).abs() > FLAT) {
                continue;
            }
            let middle = std::array::from_fn(|k| points[a][k].midpoint(points[b][k]));
            // Below the padding of exact vertices it may not be on the grid.
            if middle.iter().all(|c| c.trailing_zeros() >= zero_bits[q]) {
                points[q] = middle;
            }
        }
    });
}

/// Base vertices and points of shared base edges are the same in all trees.
fn check_shared_points(surface: &Surface, points: &[[i32; 3]], shared: &SharedEdges) -> Result<(), SurfaceError> {
    let levels = surface.levels;
    let len = lattice::len(levels);
    let corner = |tree: usize, k: usize| points[tree * len + lattice::index(levels, lattice::root(levels)[k])];
    let each = surface.triangles.iter().enumerate().flat_map(|(tree, t)| [0, 1, 2].map(|k| (t[k], tree, k)));
    // Sorted, not indexed by vertex: nothing bounds the number of base vertices that no tree uses.
    let mut corners: Vec<(u32, usize, usize)> = each.collect();
    corners.par_sort_unstable();
    for pair in corners.windows(2) {
        let ((vertex, tree, k), (other, later, l)) = (pair[0], pair[1]);
        if vertex == other && corner(tree, k) != corner(later, l) {
            return Err(SurfaceError::UnequalVertex { tree: later, vertex });
        }
    }
    let at = |u: &super::borders::EdgeUse, place| points[u.tree as usize * len + lattice::index(levels, u.point(levels, place))];
    let of = 1 << levels;
    for uses in shared.edges() {
        for other in &uses[1..] {
            if let Some(place) = (0..=of).find(|&place| at(&uses[0], place) != at(other, place)) {
                return Err(SurfaceError::Unequal { trees: [uses[0].tree, other.tree], ends: other.ends, place, of });
            }
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use lattice::LatticePoint;

    const LEVELS: u32 = 4;

    fn places() -> impl Iterator<Item = LatticePoint> {
        (0..=1u32 << LEVELS).flat_map(|j| (0..=(1 << LEVELS) - j).map(move |i| (i, j)))
    }

    /// Two triangles of a tilted plane far from the world's origin, with one point of the first somewhere else.
    fn tilted(apart: Option<(LatticePoint, [f64; 3])>) -> Surface {
        let corners = [[300.1, -20.3, 7.7], [301.3, -20.1, 7.9], [299.9, -19.2, 8.6], [301.1, -19.0, 8.8]];
        let triangles = [[0, 1, 2], [3, 2, 1]];
        let m = f64::from(1 << LEVELS);
        let mut positions: Vec<[f64; 3]> = Vec::new();
        for t in triangles {
            let at = |(i, j): LatticePoint| {
                // Corners in one order, so that both trees have the same points along their edge.
                let mut weighted = [(t[0], m - f64::from(i) - f64::from(j)), (t[1], f64::from(i)), (t[2], f64::from(j))];
                weighted.sort_unstable_by_key(|&(v, _)| v);
                std::array::from_fn(|k| {
                    weighted.iter().fold(0.0, |sum, &(v, w)| if w == 0.0 { sum } else { sum + w / m * corners[v as usize][k] })
                })
            };
            positions.extend(places().map(at));
        }
        if let Some((place, by)) = apart {
            let point = &mut positions[lattice::index(LEVELS, place)];
            *point = std::array::from_fn(|k| point[k] + by[k]);
        }
        let normals = vec![[0.0, 0.0, 1.0]; positions.len()];
        Surface { levels: LEVELS, base_vertices: 4, triangles: triangles.to_vec(), positions, normals, ..Surface::default() }
    }

    fn furthest(surface: &Surface, h: &Hierarchy) -> f64 {
        let to_units = |p: [f64; 3]| std::array::from_fn(|k| (p[k] - h.placement.offset[k]) / h.placement.scale);
        let far = |(p, q): (&[f64; 3], &[i32; 3])| {
            let p: [f64; 3] = to_units(*p);
            (0..3).map(|k| (p[k] - f64::from(q[k])).abs()).fold(0.0, f64::max)
        };
        surface.positions.iter().zip(&h.points).map(far).fold(0.0, f64::max)
    }

    #[test]
    fn where_a_surface_is_flat_nothing_is_displaced() {
        let surface = tilted(None);
        for (kind, zeros) in BoundKind::ALL.into_iter().flat_map(|kind| [0, 5].map(|zeros| (kind, zeros))) {
            let h = quantise(&surface, kind, VertexForm::Compact, zeros).unwrap();
            assert!(h.bounds.codes.iter().all(|&code| code == 0));
            assert_eq!((h.depth(0), h.depth(1)), (0, 0));
            // Half a step of the base vertices' grid, and a little of the middles.
            let half = f64::from(1 << VertexForm::Compact.zero_bits(LEVELS, 0, zeros)) / 2.0;
            let most = furthest(&surface, &h);
            assert!(most <= half + 1.0 && most > half / 8.0, "{most} of {half}");
        }
    }

    #[test]
    fn one_point_apart_is_found_by_the_edges_around_it_alone() {
        for (place, units) in [((3, 3), 40.0), ((3, 3), 4e6), ((6, 2), 4e6)] {
            let flat = tilted(None);
            let scale = quantise(&flat, BoundKind::Largest, VertexForm::Compact, 0).unwrap().placement.scale;
            let h = quantise(&tilted(Some((place, [0.0, 0.0, units * scale]))), BoundKind::Largest, VertexForm::Compact, 0).unwrap();
            // The other tree's only through the edge that both share.
            assert!(h.depth(0) == LEVELS && h.depth(1) <= 1);
            let displaced = (0..LEVELS).flat_map(|level| lattice::inserted(LEVELS, level)).filter(|place| {
                let [q, a, b] = place.map(|p| h.tree(0)[lattice::index(LEVELS, p)]);
                (0..3).any(|k| 2 * i64::from(q[k]) != i64::from(a[k]) + i64::from(b[k]))
            });
            let displaced: Vec<_> = displaced.map(|[q, ..]| q).collect();
            // A point of the finest level is the end of no other edge; one of the level above is that of six, whose middles stay where they were.
            let around = if place == (3, 3) { 1 } else { 7 };
            assert!(displaced.len() == around && displaced.contains(&place), "{place:?}: {displaced:?}");
        }
    }

    #[test]
    fn exact_vertices_keep_to_their_grid() {
        let h = quantise(&tilted(None), BoundKind::Largest, VertexForm::Exact, 0).unwrap();
        for (point, place) in h.points.iter().zip(places().chain(places())) {
            let bits = VertexForm::Exact.zero_bits(LEVELS, lattice::level_of(LEVELS, place), 0);
            assert!(point.iter().all(|c| c.trailing_zeros() >= bits), "{place:?}: {point:?}");
        }
        // With nothing finer than the padding no middle is off the grid.
        let coarse = quantise(&tilted(None), BoundKind::Largest, VertexForm::Exact, 5).unwrap();
        assert_eq!((coarse.depth(0), coarse.depth(1)), (0, 0));
    }
}
