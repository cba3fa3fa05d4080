//! Compact vertices by their definition: what is left of a model's points where each inserted vertex is stored in steps of its edge's bound code.

use super::naive_bounds::for_each_edge;
use crate::{
    mesh::{
        Hierarchy, edge_index,
        lattice::{self, LatticePoint},
    },
    num::{COORD_LIMIT, VertexForm},
};

/// Gives the model compact vertices: its points become those of that form, its codes stay.
///
/// Points are multiples of 2^(N - n + max(4, Z)) units, n their level and Z the zero bits of all coordinates, and codes cover their displacements.
pub fn naive_compact(h: &mut Hierarchy) {
    let mut points = h.points.clone();
    for level in 0..h.levels {
        for_each_edge(h, level, |tree, a, b, q| {
            let code = h.codes(tree as usize)[edge_index(h.levels, level, a, b)];
            let octave = (u64::from(code) + h.bounds.scale.offset.get()) / 16;
            let exponent = u64::from(h.levels - level - 1 + h.zeros.max(4)).max(octave.saturating_sub(11));
            let [a, b, q] = [a, b, q].map(|p| place(h, tree, p));
            let all = (h.points[a], h.points[b], h.points[q]);
            points[q] = std::array::from_fn(|c| coordinate([all.0[c], all.1[c], all.2[c]], [points[a][c], points[b][c]], 1 << exponent));
        });
    }
    (h.points, h.vertices) = (points, VertexForm::Compact);
}

fn place(h: &Hierarchy, tree: u32, p: LatticePoint) -> usize {
    tree as usize * lattice::len(h.levels) + lattice::index(h.levels, p)
}

/// The displacement of `q` on `a` and `b` in whole steps, no longer than it was, put on the ends that are stored, or as much of it as the limit allows.
fn coordinate([a, b, q]: [i32; 3], stored: [i32; 2], step: i64) -> i32 {
    let middle = |[a, b]: [i32; 2]| (i64::from(a) + i64::from(b)) / 2; // exact
    let mut steps = (i64::from(q) - middle([a, b])) / step; // towards zero
    let at = |steps: i64| middle(stored) + steps * step;
    while at(steps).abs() > i64::from(COORD_LIMIT) {
        steps -= steps.signum();
    }
    at(steps) as i32 // within the limit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displacements_lose_what_is_less_than_a_step() {
        assert_eq!(coordinate([0, 64, 32 + 40], [0, 64], 16), 32 + 32);
        assert_eq!(coordinate([0, 64, 32 - 40], [0, 64], 16), 32 - 32);
        // Put on ends that were moved.
        assert_eq!(coordinate([0, 64, 32 + 40], [0, 32], 16), 16 + 32);
        // To the limit and not past it.
        let top = COORD_LIMIT;
        assert_eq!(coordinate([0, 0, 1 << 17], [top - (1 << 16); 2], 1 << 16), top);
        assert_eq!(coordinate([0, 0, -(1 << 18)], [-top; 2], 1 << 16), -top);
    }
}
