//! Counts of what was checked and what was wrong.

/// The checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Reserved,
    Limit,
    LowBits,
    VerticesInTree,
    VerticesAcross,
    CodesInTree,
    CodesAcross,
    Bounds,
    Monotone,
    Boxes,
    ModelBox,
    BaseTriangles,
    BvhNodes,
    BvhTrees,
    BvhLeafBoxes,
    BvhInnerBoxes,
    Normals,
    Materials,
}

/// All checks in the order of [`Kind`], with their names.
pub(super) const CHECKS: [(Kind, &str); 18] = [
    (Kind::Reserved, "reserved bits and empty slots are zero"),
    (Kind::Limit, "coordinates keep to the limit"),
    (Kind::LowBits, "low bits of the level's grid are zero"),
    (Kind::VerticesInTree, "inserted vertices are equal on both sides of an edge"),
    (Kind::VerticesAcross, "vertices are equal in all trees that share them"),
    (Kind::CodesInTree, "both sides of an edge hold the same code"),
    (Kind::CodesAcross, "all trees that share an edge hold the same code"),
    (Kind::Bounds, "bounds cover the true displacement"),
    (Kind::Monotone, "codes do not grow towards finer levels"),
    (Kind::Boxes, "boxes contain all full-resolution vertices below"),
    (Kind::ModelBox, "the model's box is that of its vertices"),
    (Kind::BaseTriangles, "base triangles have three different vertices"),
    (Kind::BvhNodes, "quad-BVH nodes are referred to exactly once"),
    (Kind::BvhTrees, "trees are referred to exactly once"),
    (Kind::BvhLeafBoxes, "quad-BVH leaf boxes contain their trees' boxes"),
    (Kind::BvhInnerBoxes, "quad-BVH inner boxes contain their children's boxes"),
    (Kind::Normals, "normals are present"),
    (Kind::Materials, "materials have colours"),
];

/// One check's counts.
#[derive(Clone, Debug, Default)]
pub(super) struct Tally {
    pub checked: u64,
    pub breaches: u64,
    pub first: Option<String>,
}

/// Counts of all checks, and the box of the vertices seen.
#[derive(Clone, Debug)]
pub(super) struct Tallies {
    pub tallies: [Tally; CHECKS.len()],
    pub lo: [i32; 3],
    pub hi: [i32; 3],
}

impl Default for Tallies {
    fn default() -> Self {
        Self { tallies: Default::default(), lo: [i32::MAX; 3], hi: [i32::MIN; 3] }
    }
}

impl Tallies {
    /// Counts one thing looked at; `describe` names it if it does not hold and is the first.
    #[inline(always)]
    pub fn check(&mut self, kind: Kind, holds: bool, describe: impl FnOnce() -> String) {
        let tally = &mut self.tallies[kind as usize];
        tally.checked += 1;
        if !holds {
            tally.breaches += 1;
            tally.first.get_or_insert_with(describe);
        }
    }

    /// Both counts together; `later` is of later trees.
    pub fn join(mut self, later: Self) -> Self {
        for (a, b) in self.tallies.iter_mut().zip(later.tallies) {
            a.checked += b.checked;
            a.breaches += b.breaches;
            a.first = a.first.take().or(b.first);
        }
        for k in 0..3 {
            self.lo[k] = self.lo[k].min(later.lo[k]);
            self.hi[k] = self.hi[k].max(later.hi[k]);
        }
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn checks_stand_in_the_order_of_their_kinds() {
        for (k, (kind, _)) in CHECKS.iter().enumerate() {
            assert_eq!(*kind as usize, k);
        }
    }
}
