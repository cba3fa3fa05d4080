//! Compact vertices by their definition: what is left of a model's points where each inserted vertex is stored in steps of its edge's bound code.

use super::naive_bounds::{for_each_edge, identify};
use crate::{
    mesh::{
        Hierarchy, edge_index, edges_of_tree,
        lattice::{self, LatticePoint},
    },
    num::{COORD_LIMIT, VertexForm},
};
use std::collections::HashSet;

/// Gives the model vertices of this compact form: its points become those of that form, its codes stay. What few bits short ones have in a last split hold in all trees that share
/// the vertex.
///
/// Points are multiples of 2^(N - n + max(4, Z)) units, n their level and Z the zero bits of all coordinates, and codes cover their displacements.
pub fn naive_compact(form: VertexForm, h: &mut Hierarchy) {
    let mut points = h.points.clone();
    let mut short = HashSet::new();
    for level in (1..h.levels).filter(|_| form == VertexForm::Short) {
        for_each_edge(h, level, |tree, _, _, q| {
            if last_level(h, tree) == Some(level) {
                short.insert(identify(h, tree, q));
            }
        });
    }
    for level in 0..h.levels {
        for_each_edge(h, level, |tree, a, b, q| {
            let code = h.codes(tree as usize)[edge_index(h.levels, level, a, b)];
            let octave = (u64::from(code) + h.bounds.scale.offset.get()) / 16;
            let exponent = u64::from(h.levels - level - 1 + h.zeros.max(4)).max(octave.saturating_sub(11));
            let is_short = short.contains(&identify(h, tree, q));
            let [a, b, q] = [a, b, q].map(|p| place(h, tree, p));
            let all = (h.points[a], h.points[b], h.points[q]);
            let few = is_short.then_some(64);
            points[q] =
                std::array::from_fn(|c| coordinate([all.0[c], all.1[c], all.2[c]], [points[a][c], points[b][c]], 1 << exponent, few));
        });
    }
    (h.points, h.vertices) = (points, form);
}

/// The deepest level of a tree on which an edge has a code other than 0.
fn last_level(h: &Hierarchy, tree: u32) -> Option<u32> {
    let of_level = |level: &u32| edges_of_tree(*level)..edges_of_tree(level + 1);
    (0..h.levels).rev().find(|level| h.codes(tree as usize)[of_level(level)].iter().any(|&code| code != 0))
}

fn place(h: &Hierarchy, tree: u32, p: LatticePoint) -> usize {
    tree as usize * lattice::len(h.levels) + lattice::index(h.levels, p)
}

/// The displacement of `q` on `a` and `b` in whole steps, no longer than it was, put on the ends that are stored, or as much of it as the limit allows. If it has few bits, in whole
/// multiples of so many steps, or nothing where the limit does not allow that.
fn coordinate([a, b, q]: [i32; 3], stored: [i32; 2], step: i64, few: Option<i64>) -> i32 {
    let middle = |[a, b]: [i32; 2]| (i64::from(a) + i64::from(b)) / 2; // exact
    let mut steps = (i64::from(q) - middle([a, b])) / step; // towards zero
    let at = |steps: i64| middle(stored) + steps * step;
    if let Some(few) = few {
        steps -= steps % few;
    }
    while at(steps).abs() > i64::from(COORD_LIMIT) {
        steps -= if few.is_some() { steps } else { steps.signum() };
    }
    at(steps) as i32 // within the limit
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn displacements_lose_what_is_less_than_a_step() {
        assert_eq!(coordinate([0, 64, 32 + 40], [0, 64], 16, None), 32 + 32);
        assert_eq!(coordinate([0, 64, 32 - 40], [0, 64], 16, None), 32 - 32);
        // Put on ends that were moved.
        assert_eq!(coordinate([0, 64, 32 + 40], [0, 32], 16, None), 16 + 32);
        // To the limit and not past it.
        let top = COORD_LIMIT;
        assert_eq!(coordinate([0, 0, 1 << 17], [top - (1 << 16); 2], 1 << 16, None), top);
        assert_eq!(coordinate([0, 0, -(1 << 18)], [-top; 2], 1 << 16, None), -top);
        // In multiples of 64 steps, towards zero, or not at all.
        assert_eq!(coordinate([0, 0, -16 * 130], [0, 0], 16, Some(64)), -16 * 128);
        assert_eq!(coordinate([0, 0, 16 * 63], [0, 0], 16, Some(64)), 0);
        assert_eq!(coordinate([0, 0, 16 * 70], [top - 16 * 60; 2], 16, Some(64)), top - 16 * 60);
    }
}
