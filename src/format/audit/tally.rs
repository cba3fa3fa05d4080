//! Counts of what was checked and what was wrong.

use super::boxes::Span;

/// The checks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum CheckKind {
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
    Sources,
    BvhNodes,
    BvhTrees,
    BvhLeafBoxes,
    BvhInnerBoxes,
    Normals,
    Materials,
}

/// All checks in the order of [`CheckKind`], with their names.
pub(super) const CHECKS: [(CheckKind, &str); 19] = [
    (CheckKind::Reserved, "reserved bits and empty slots are zero"),
    (CheckKind::Limit, "coordinates keep to the limit"),
    (CheckKind::LowBits, "low bits of the level's grid are zero"),
    (CheckKind::VerticesInTree, "inserted vertices are equal on both sides of an edge"),
    (CheckKind::VerticesAcross, "vertices are equal in all trees that share them"),
    (CheckKind::CodesInTree, "both sides of an edge hold the same code"),
    (CheckKind::CodesAcross, "all trees that share an edge hold the same code"),
    (CheckKind::Bounds, "bounds cover the true displacement"),
    (CheckKind::Monotone, "codes do not grow towards finer levels"),
    (CheckKind::Boxes, "boxes contain all full-resolution vertices below"),
    (CheckKind::ModelBox, "the model's box is that of its vertices"),
    (CheckKind::BaseTriangles, "base triangles have three different vertices"),
    (CheckKind::Sources, "trees are the given base triangles, each once"),
    (CheckKind::BvhNodes, "quad-BVH nodes are referred to exactly once"),
    (CheckKind::BvhTrees, "trees are referred to exactly once"),
    (CheckKind::BvhLeafBoxes, "quad-BVH leaf boxes contain all vertices of their trees"),
    (CheckKind::BvhInnerBoxes, "quad-BVH inner boxes contain all vertices of the trees below"),
    (CheckKind::Normals, "normals are present"),
    (CheckKind::Materials, "materials have colours"),
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
    pub span: Span,
}

impl Default for Tallies {
    fn default() -> Self {
        Self { tallies: Default::default(), span: Span::EMPTY }
    }
}

impl Tallies {
    /// Counts one thing looked at; `describe` names it if it does not hold and is the first.
    #[inline(always)]
    pub fn check(&mut self, kind: CheckKind, holds: bool, describe: impl FnOnce() -> String) {
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
        self.span = self.span.with(&later.span);
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
