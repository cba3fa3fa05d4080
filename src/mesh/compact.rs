//! Compact vertices: what is left of a hierarchy's points if each inserted vertex is stored as its displacement in steps of its edge's code.
//!
//! Displacements are those of the points as they were, rounded towards zero, and the points are put together again from the base down. So no displacement gets longer,
//! and every bound that held still holds. A vertex inserted by split n is moved by at most sqrt(3) (e_1 + ... + e_n) units more than the base vertices were,
//! e_k the largest step of level k.
//!
//! Short ones lose more in last splits, whose displacements have few bits. A vertex on a base edge does if it is in a last split of any tree there, so that all trees have it alike.

use super::borders::SharedEdges;
use super::hierarchy::depth;
use super::lattice::Insertion;
use super::{EdgeCodes, edges_of_tree, lattice};
use crate::num::{COORD_LIMIT, VertexForm, displaced, displacement_shift, displacement_steps, short_steps, snap};
use rayon::prelude::*;

/// Zero bits of a compact vertex that a node of `level` inserts, in a model of which every coordinate has `zeros`.
pub(crate) fn inserted_zero_bits(levels: u32, level: u32, zeros: u32) -> u32 {
    VertexForm::Compact.zero_bits(levels, level + 1, zeros)
}

/// The displacement of `q` from the midpoint of `a` and `b` in steps of 2^shift units.
pub(crate) fn steps_of(q: [i32; 3], a: [i32; 3], b: [i32; 3], shift: u32) -> [i32; 3] {
    std::array::from_fn(|c| displacement_steps(i64::from(q[c]) - (i64::from(a[c]) + i64::from(b[c])) / 2, shift))
}

/// The levels whose inserted vertices have few bits, bit n for level n: on a tree's three sides and inside of it.
type ShortLevels = [u16; 4];

/// The short levels of each tree: those of last splits, but of roots. (Level 9 is the last that splits.)
fn short_levels(levels: u32, bounds: &EdgeCodes, shared: &SharedEdges) -> Vec<ShortLevels> {
    let own = |codes: &[u8]| [if depth(levels, codes) < 2 { 0 } else { 1 << (depth(levels, codes) - 1) }; 4];
    let mut all: Vec<ShortLevels> = bounds.codes.par_chunks(edges_of_tree(levels)).map(own).collect();
    for uses in shared.edges() {
        let of_edge = uses.iter().fold(0, |of_edge, of| of_edge | all[of.tree as usize][3]);
        uses.iter().for_each(|of| all[of.tree as usize][usize::from(of.side)] = of_edge);
    }
    all
}

/// Moves every inserted vertex to where this compact form has it, and base vertices to their grid. Points are on grids as fine or finer, and codes cover their displacements.
pub(super) fn compact(form: VertexForm, levels: u32, zeros: u32, points: &mut [[i32; 3]], bounds: &EdgeCodes, shared: &SharedEdges) {
    let edges = edges_of_tree(levels);
    if edges == 0 {
        points.iter_mut().for_each(|p| *p = p.map(|c| snap(f64::from(c), VertexForm::Compact.zero_bits(0, 0, zeros))));
        return;
    }
    let short = if form == VertexForm::Short { short_levels(levels, bounds, shared) } else { vec![[0; 4]; bounds.codes.len() / edges] };
    let insertions = lattice::insertions(levels);
    let corners = lattice::root(levels).map(|place| lattice::index(levels, place));
    let trees = points.par_chunks_mut(lattice::len(levels)).zip(bounds.codes.par_chunks(edges)).zip(short);
    trees.for_each_init(Vec::new, |moved: &mut Vec<[i32; 3]>, ((points, codes), short)| {
        moved.clear();
        moved.extend_from_slice(points);
        for corner in corners {
            moved[corner] = points[corner].map(|c| snap(f64::from(c), VertexForm::Compact.zero_bits(levels, 0, zeros)));
        }
        let mut codes = codes.iter();
        for (level, insertions) in (0..).zip(&insertions) {
            let zero_bits = inserted_zero_bits(levels, level, zeros);
            let shift_of = |code: u8| displacement_shift(bounds.scale, code, zero_bits);
            for (&Insertion { own, ends, side }, &code) in insertions.iter().zip(codes.by_ref()) {
                let (own, [a, b]) = (own as usize, ends.map(|end| end as usize));
                let shift = shift_of(code);
                let (steps, is_short) = (steps_of(points[own], points[a], points[b], shift), short[usize::from(side)] >> level & 1 == 1);
                moved[own] = std::array::from_fn(|c| {
                    // Of a short one that would pass the limit nothing is left.
                    let (a, b, of) = (moved[a][c], moved[b][c], if is_short { short_steps(steps[c]) } else { steps[c] });
                    let kept = within(a, b, of, shift);
                    if is_short && kept != displaced(a, b, of, shift) { displaced(a, b, 0, shift) } else { kept }
                });
            }
        }
        points.copy_from_slice(moved);
    });
}

/// The displaced coordinate, or the furthest on the way to it that keeps to the limit.
fn within(a: i32, b: i32, steps: i32, shift: u32) -> i32 {
    let middle = displaced(a, b, 0, shift);
    // The midpoint keeps to the limit, and so does whatever lies towards it.
    let room = i64::from(COORD_LIMIT) + if steps < 0 { i64::from(middle) } else { -i64::from(middle) };
    // 13 bits at most.
    let most = (room >> shift).min(4095) as i32;
    displaced(a, b, steps.clamp(-most, most), shift)
}

#[cfg(test)]
mod tests {
    use super::super::bounds::edge_codes;
    use super::super::lattice::LatticePoint;
    use super::super::procedural::{Options, Scene, generate};
    use super::super::{BoundKind, Hierarchy, SharedEdges, quantise};
    use super::*;
    use crate::num::bound_decode;

    /// Twice the displacement of the vertex on an edge, and the edge's code.
    fn displacement(h: &Hierarchy, tree: usize, level: u32, p: [LatticePoint; 3], edge: usize) -> ([i64; 3], u8) {
        let points = h.tree(tree);
        let at = |place| points[lattice::index(h.levels, place)].map(i64::from);
        let (a, b, q) = (at(p[(edge + 1) % 3]), at(p[(edge + 2) % 3]), at(lattice::midpoints(p)[edge]));
        (std::array::from_fn(|c| 2 * q[c] - a[c] - b[c]), h.node_codes(tree, level, p)[edge])
    }

    #[test]
    fn displacements_never_get_longer_and_points_stay_near() {
        for scene in [Scene::Terrain, Scene::Cloth, Scene::Sphere, Scene::Spikes] {
            let levels = 4;
            let surface = generate(&Options { levels: Some(levels), base: Some(6), ..Options::new(scene) }).unwrap();
            let mut before = quantise(&surface, BoundKind::Total, VertexForm::Exact, 0).unwrap();
            let m = 1u32 << levels;
            let places: Vec<_> = (0..=m).flat_map(|j| (0..=m - j).map(move |i| (i, j))).collect();
            for (point, place) in before.points.iter_mut().zip(places.iter().cycle()) {
                let bits = VertexForm::Compact.zero_bits(levels, lattice::level_of(levels, *place), 0);
                *point = point.map(|c| (c >> bits) << bits);
            }
            before.bounds = edge_codes(BoundKind::Total, levels, &before.points, &SharedEdges::new(&before.triangles));
            let mut after = before.clone();
            compact(VertexForm::Compact, levels, 0, &mut after.points, &after.bounds, &SharedEdges::new(&after.triangles));

            let (mut reach, mut shorter) = (0.0, 0);
            for level in 0..levels {
                let mut step = 0;
                for (tree, node) in (0..after.triangles.len()).flat_map(|tree| (0..1u32 << (2 * level)).map(move |node| (tree, node))) {
                    let p = lattice::node(levels, level, node);
                    for edge in 0..3 {
                        let ((new, code), (old, _)) =
                            (displacement(&after, tree, level, p, edge), displacement(&before, tree, level, p, edge));
                        let shift = displacement_shift(after.bounds.scale, code, inserted_zero_bits(levels, level, 0));
                        step = step.max(shift);
                        for (new, old) in new.into_iter().zip(old) {
                            assert!(new.abs() <= old.abs() && new * old >= 0, "{scene:?}: {new} of {old}");
                            assert!(new & ((2 << shift) - 1) == 0 && (-4096..4096).contains(&(new >> (shift + 1))));
                            shorter += u32::from(new != old);
                        }
                    }
                }
                reach += 3f64.sqrt() * f64::from(1 << step);
            }
            let far = |(p, q): (&[i32; 3], &[i32; 3])| (0..3).map(|c| f64::from(p[c] - q[c]).powi(2)).sum::<f64>().sqrt();
            let most = after.points.iter().zip(&before.points).map(far).fold(0.0, f64::max);
            assert!(most <= reach && shorter > 0, "{scene:?}: {most} of {reach}, {shorter} shorter");
            // So all bounds hold that held.
            let again = edge_codes(BoundKind::Total, levels, &after.points, &SharedEdges::new(&after.triangles));
            let decoded = |bounds: &EdgeCodes| bounds.codes.iter().map(|&code| bound_decode(bounds.scale, code)).collect::<Vec<_>>();
            assert!(decoded(&again).iter().zip(decoded(&after.bounds)).all(|(new, old)| *new <= old));
        }
    }

    #[test]
    fn nothing_passes_the_limit() {
        let shift = 12;
        let top = COORD_LIMIT;
        assert_eq!(within(top, top, 5, shift), top);
        assert_eq!(within(-top, -top, -5, shift), -top);
        assert_eq!(within(top, top - (2 << shift), 5, shift), top);
        assert_eq!(within(0, 0, 5, shift), 5 << shift);
        assert_eq!(within(-top, -top, 5, shift), -top + (5 << shift));
    }
}
