//! Base edges that several trees share, found from the base indices, and the checks across trees.

use super::tally::{CheckKind, Tallies};
use super::tree::Lattices;
use crate::mesh::lattice;

/// One tree's border along a base edge: (smaller vertex, larger vertex, tree, corner of the smaller, corner of the larger).
type Use = (u32, u32, usize, usize, usize);

/// Borders by base edge.
pub(super) struct Edges {
    levels: u32,
    uses: Vec<Use>,
}

impl Edges {
    pub fn new(triangles: &[[u32; 3]], levels: u32) -> Self {
        let mut uses: Vec<Use> = Vec::with_capacity(3 * triangles.len());
        for (tree, t) in triangles.iter().enumerate() {
            for (a, b) in [(0, 1), (1, 2), (0, 2)] {
                uses.push(if t[a] < t[b] { (t[a], t[b], tree, a, b) } else { (t[b], t[a], tree, b, a) });
            }
        }
        uses.sort_unstable();
        Self { levels, uses }
    }

    /// How many places of shared edges, ends excluded, are to be compared with those of each edge's first tree, where trees are known down to these levels.
    pub fn places(&self, known: &[u32]) -> u64 {
        let first = |uses: &[Use]| known[uses[0].2];
        self.shared().flat_map(|uses| uses[1..].iter().map(move |other| (1 << known[other.2].min(first(uses))) - 1)).sum()
    }

    /// The uses of each edge that several trees have.
    fn shared(&self) -> impl Iterator<Item = &[Use]> {
        self.uses.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)).filter(|uses| uses.len() > 1)
    }

    /// Index over all trees of the point `place` steps of the full lattice from the smaller vertex on.
    fn index(&self, &(_, _, tree, from, to): &Use, place: u32) -> usize {
        let m = 1 << self.levels;
        let mut steps = [0; 3];
        steps[from] = m - place;
        steps[to] = place;
        tree * lattice::len(self.levels) + lattice::index(self.levels, (steps[1], steps[2]))
    }

    /// Positions and codes along shared edges, ends excluded, of trees that are known down to these levels.
    pub fn check_shared(&self, lattices: &Lattices, known: &[u32], found: &mut Tallies) {
        for uses in self.shared() {
            for other in &uses[1..] {
                let name = |place| format!("trees {} and {}, edge ({}, {}), place {place}", uses[0].2, other.2, other.0, other.1);
                let step = 1 << (self.levels - known[uses[0].2].min(known[other.2]));
                for place in (step..1 << self.levels).step_by(step) {
                    let (a, b) = (self.index(&uses[0], place as u32), self.index(other, place as u32));
                    let (p, q) = (lattices.points[a], lattices.points[b]);
                    found.check(CheckKind::VerticesAcross, p == q, || format!("{}: {p:?} and {q:?}", name(place)));
                    let (c, d) = (lattices.codes[a], lattices.codes[b]);
                    found.check(CheckKind::CodesAcross, c == d, || format!("{}: codes {c} and {d}", name(place)));
                }
            }
        }
    }

    /// Base vertices: one position each. Returns how many comparisons the indices call for.
    pub fn check_corners(&self, triangles: &[[u32; 3]], lattices: &Lattices, found: &mut Tallies) -> u64 {
        let m = 1 << self.levels;
        let mut corners: Vec<(u32, usize, usize)> = Vec::with_capacity(3 * triangles.len());
        for (tree, t) in triangles.iter().enumerate() {
            for (&v, place) in t.iter().zip([(0, 0), (m, 0), (0, m)]) {
                corners.push((v, tree, tree * lattice::len(self.levels) + lattice::index(self.levels, place)));
            }
        }
        corners.sort_unstable();
        let mut vertices = 0;
        for uses in corners.chunk_by(|a, b| a.0 == b.0) {
            vertices += 1;
            let (v, first, at) = uses[0];
            for &(_, tree, other) in &uses[1..] {
                let (p, q) = (lattices.points[at], lattices.points[other]);
                found.check(CheckKind::VerticesAcross, p == q, || format!("base vertex {v}: {p:?} in tree {first}, {q:?} in tree {tree}"));
            }
        }
        corners.len() as u64 - vertices
    }

    /// Gives vertices inserted at `level` (1 to N) on shared edges the largest displacement of all trees.
    pub fn raise_shared(&self, level: u32, displacements: &mut [u64]) {
        let step = 1 << (self.levels - level);
        for uses in self.shared() {
            for place in (step..1 << self.levels).step_by(2 * step as usize) {
                let largest = uses.iter().map(|u| displacements[self.index(u, place)]).max().unwrap_or(0);
                for u in uses {
                    displacements[self.index(u, place)] = largest;
                }
            }
        }
    }
}
