//! The numbers of a level's vertices, welded by topology: trees share the vertices of their common base vertices and base edges, nothing is welded by position.
//!
//! Trees follow each other in the order of the scene, each with those of its vertices that no earlier tree has: corners, then the inner points of its edges
//! p0-p1, p1-p2 and p2-p0 (each from its smaller base vertex on), then its inside row by row. `export` writes vertices in this order, and `refit` reads them so.

use crate::mesh::lattice::{self, LatticePoint};
use std::collections::HashMap;

/// Gives numbers to the vertices of one tree after the other, from 0.
pub(crate) struct Numbering {
    level: u32,
    base: HashMap<u32, u64>,
    /// Of the first inner point of each base edge, by its base vertices.
    edges: HashMap<[u32; 2], u64>,
    next: u64,
}

impl Numbering {
    /// Of this level.
    pub fn new(level: u32) -> Self {
        Self { level, base: HashMap::new(), edges: HashMap::new(), next: 0 }
    }

    /// How many there are so far.
    pub fn vertices(&self) -> u64 {
        self.next
    }

    /// The numbers of the lattice points of the level's own lattice of a tree with this base triangle; `new` is told, in their order, which points have a number that no tree before had.
    ///
    /// # Errors
    /// Those of `new`.
    pub fn tree<E>(&mut self, triangle: [u32; 3], ids: &mut [u64], mut new: impl FnMut(LatticePoint) -> Result<(), E>) -> Result<(), E> {
        let (level, m) = (self.level, 1u32 << self.level);
        let corners = lattice::root(level);
        for (&v, corner) in triangle.iter().zip(corners) {
            let id = *self.base.entry(v).or_insert(self.next);
            if id == self.next {
                self.next += 1;
                new(corner)?;
            }
            ids[lattice::index(level, corner)] = id;
        }
        for (a, b) in [(0, 1), (1, 2), (2, 0)] {
            let (a, b) = if triangle[a] < triangle[b] { (a, b) } else { (b, a) };
            // Place 1 to m-1 along the edge from its smaller base vertex.
            let along = |place: u32| {
                let part = |from: u32, to: u32| (from * (m - place) + to * place) / m;
                (part(corners[a].0, corners[b].0), part(corners[a].1, corners[b].1))
            };
            let known = self.edges.get(&[triangle[a], triangle[b]]).copied();
            let first = known.unwrap_or(self.next);
            if known.is_none() {
                self.edges.insert([triangle[a], triangle[b]], first);
                self.next += u64::from(m - 1);
                (1..m).try_for_each(|place| new(along(place)))?;
            }
            for place in 1..m {
                ids[lattice::index(level, along(place))] = first + u64::from(place - 1);
            }
        }
        for (i, j) in (1..m).flat_map(|j| (1..m - j).map(move |i| (i, j))) {
            ids[lattice::index(level, (i, j))] = self.next;
            self.next += 1;
            new((i, j))?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::convert::Infallible;

    #[test]
    fn shared_vertices_have_one_number_and_no_number_is_left_out() {
        let level = 3;
        let mut numbering = Numbering::new(level);
        let mut seen = Vec::new();
        for triangle in [[0, 1, 2], [2, 1, 3], [1, 0, 4]] {
            let mut ids = vec![u64::MAX; lattice::len(level)];
            let mut new = Vec::new();
            let before = numbering.vertices();
            let keep = |p| {
                new.push(p);
                Ok(())
            };
            numbering.tree::<Infallible>(triangle, &mut ids, keep).unwrap();
            // What is new follows what there was, in order.
            let own: Vec<u64> = new.iter().map(|&p| ids[lattice::index(level, p)]).collect();
            assert!(own.into_iter().eq(before..numbering.vertices()));
            assert!(ids.iter().all(|&id| id < numbering.vertices()));
            seen.push(ids);
        }
        // Euler: each tree has 45 points; two edges of 9 are shared.
        assert_eq!(numbering.vertices(), 3 * 45 - 2 * 9);
        let at = |tree: usize, p| seen[tree][lattice::index(level, p)];
        let m = 1 << level;
        for t in 0..=m {
            // Edge 1-2: side 0 of the first tree from p1 to p2, and of the second from p1 = 1 back to p0 = 2.
            assert_eq!(at(0, (m - t, t)), at(1, (m - t, 0)));
            // Edge 0-1: of the third tree the other way round.
            assert_eq!(at(0, (t, 0)), at(2, (m - t, 0)));
        }
    }
}
