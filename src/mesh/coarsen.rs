//! A hierarchy on coarser grids.

use super::bounds::edge_codes;
use super::compact::compact;
use super::quantise::{SurfaceError, most_zeros, snap_points};
use super::{Hierarchy, SharedEdges};
use crate::num::VertexForm;

/// The hierarchy with `zeros` zero bits at the bottom of every coordinate.
///
/// Compact vertices keep their codes: each base vertex goes to the nearest point of its grid, and displacements lose what is less than a step where steps get longer. So none
/// gets longer, and every bound that held still holds. Short ones become compact, as longer steps in few bits would lose much more. Exact ones go to the nearest points of their grids, and get the bounds of that.
///
/// # Errors
/// [`SurfaceError::Zeros`]: more than there is room for.
pub fn coarsen(h: &Hierarchy, zeros: u32) -> Result<Hierarchy, SurfaceError> {
    if zeros > most_zeros(h.levels) {
        return Err(SurfaceError::Zeros { zeros, levels: h.levels });
    }
    let mut coarse = Hierarchy { zeros: zeros.max(h.zeros), ..h.clone() };
    if h.vertices.is_compact() {
        coarse.vertices = VertexForm::Compact;
        compact(coarse.vertices, h.levels, coarse.zeros, &mut coarse.points, &coarse.bounds, &SharedEdges::new(&h.triangles));
    } else {
        snap_points(h.levels, h.vertices, coarse.zeros, &h.points, |p| p.map(f64::from), &mut coarse.points);
        coarse.bounds = edge_codes(h.bounds.kind, h.levels, &coarse.points, &SharedEdges::new(&h.triangles));
    }
    Ok(coarse)
}

/// How far a vertex moves at most where a hierarchy of `levels` splits gets `zeros` zero bits, in units: half the diagonal of a step of the base vertices' grid, and of compact
/// displacements a diagonal of each level's.
pub fn farthest(levels: u32, zeros: u32, is_compact: bool) -> f64 {
    let form = if is_compact { VertexForm::Compact } else { VertexForm::Exact };
    let base = f64::from(1u32 << form.zero_bits(levels, 0, zeros));
    3f64.sqrt() * if is_compact { 1.5 } else { 0.5 } * base
}

#[cfg(test)]
mod tests {
    use super::super::procedural::{Options, Scene, generate};
    use super::super::{BoundKind, lattice, quantise};
    use super::*;

    #[test]
    fn points_keep_to_coarser_grids_bounds_hold_and_nothing_moves_further() {
        for scene in [Scene::Terrain, Scene::Cloth, Scene::Sphere, Scene::Spikes] {
            for (form, kind, zeros) in
                VertexForm::ALL.into_iter().flat_map(|f| BoundKind::ALL.map(|k| (f, k))).zip([3, 5, 8, 11]).map(|((f, k), z)| (f, k, z))
            {
                let surface = generate(&Options { levels: Some(4), base: Some(6), ..Options::new(scene) }).unwrap();
                let fine = quantise(&surface, kind, form, 0).unwrap();
                let coarse = coarsen(&fine, zeros).unwrap();
                let (len, m) = (lattice::len(4), 1u32 << 4);
                let places: Vec<_> = (0..=m).flat_map(|j| (0..=m - j).map(move |i| (i, j))).collect();
                assert_eq!(places.len(), len);
                let far = |(p, q): (&[i32; 3], &[i32; 3])| (0..3).map(|c| (f64::from(p[c]) - f64::from(q[c])).powi(2)).sum::<f64>().sqrt();
                let most = coarse.points.iter().zip(&fine.points).map(far).fold(0.0, f64::max);
                assert!(most <= farthest(4, zeros, form.is_compact()), "{scene:?}: {most}");
                for (point, place) in coarse.points.iter().zip(places.iter().cycle()) {
                    let bits = form.zero_bits(4, lattice::level_of(4, *place), zeros);
                    assert!(point.iter().all(|c| c.trailing_zeros() >= bits), "{scene:?}: {point:?}");
                }
                // Bounds by their definition are no larger than those that it has.
                let again = edge_codes(kind, 4, &coarse.points, &SharedEdges::new(&coarse.triangles));
                let decoded = |bounds: &super::super::EdgeCodes| {
                    bounds.codes.iter().map(|&code| crate::num::bound_decode(bounds.scale, code)).collect::<Vec<_>>()
                };
                assert!(decoded(&again).iter().zip(decoded(&coarse.bounds)).all(|(new, old)| *new <= old), "{scene:?}");
            }
        }
        let surface = generate(&Options { levels: Some(4), base: Some(6), ..Options::new(Scene::Sphere) }).unwrap();
        let fine = quantise(&surface, BoundKind::Total, VertexForm::Compact, 0).unwrap();
        assert_eq!(
            coarsen(&fine, 13).unwrap_err().to_string(),
            "surface zeros: 13 zero bits at the bottom of the coordinates, at most 12 are possible with 4 splits"
        );
    }
}
