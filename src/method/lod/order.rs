//! Orders in which the splits of all trees could lie instead: their numbers, if all levels of all trees are stored.

use crate::format::Scene;
use crate::format::layout::level_start;
use crate::num::BOX_SHIFT;

/// An order of splits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LineOrder {
    /// Tree by tree, each level by level.
    Tree,
    /// The coarsest three levels over all trees, then the rest of each of their nodes by itself.
    Coarse,
    /// Two levels of a tree together, these blocks level by level over all trees.
    Blocks,
    /// Tree by tree, each in van Emde Boas' order: the upper half of its levels, then the lower half below each of their nodes in turn, and so on within these.
    VanEmdeBoas,
    /// Level by level over all trees, which have the places of [`morton_ranks`].
    Morton,
}

/// The rank of each tree along a Morton curve through the middles of their corners, in steps of 2^16 units.
pub fn morton_ranks(scene: &Scene) -> Vec<u32> {
    let code = |tree: usize| {
        let corners = scene.corners(tree);
        (0..3).fold(0u64, |code, axis| {
            let sum: i64 = corners.iter().map(|p| i64::from(p[axis])).sum();
            let place = ((sum / 3) >> BOX_SHIFT) + (1 << 15); // 16 bits
            (0..16).fold(code, |code, bit| code | (place as u64 >> bit & 1) << (3 * bit + axis))
        })
    };
    let mut trees: Vec<(u64, u32)> = (0..scene.trees()).map(|tree| (code(tree), tree as u32)).collect(); // at most 2^28
    trees.sort_unstable();
    let mut ranks = vec![0; trees.len()];
    for (rank, (_, tree)) in (0..).zip(trees) {
        ranks[tree as usize] = rank;
    }
    ranks
}

/// Levels that [`LineOrder::Coarse`] has over all trees.
const COARSE: u32 = 3;

impl LineOrder {
    /// Number of the split of node (`level`, `node`) of the tree of place `tree`, of `trees` trees that have splits on `levels` levels.
    pub fn split(self, trees: usize, levels: u32, tree: usize, level: u32, node: usize) -> usize {
        // Its place among the subtrees of so many levels whose roots are on level `top`.
        let below = |top: u32, levels: u32| {
            let under = 2 * (level - top);
            let place = (tree << (2 * top)) + (node >> under);
            place * level_start(levels) + level_start(level - top) + (node & ((1 << under) - 1))
        };
        let above = |top: u32| trees * level_start(top);
        match self {
            Self::Tree => below(0, levels),
            Self::Coarse if level < COARSE => above(level) + below(level, 1),
            Self::Coarse => above(COARSE) + below(COARSE, levels - COARSE),
            Self::Blocks => {
                let top = level & !1;
                above(top) + below(top, (levels - top).min(2))
            }
            Self::VanEmdeBoas => tree * level_start(levels) + van_emde_boas(levels, level, node),
            Self::Morton => above(level) + below(level, 1),
        }
    }
}

/// Number of node (`level`, `node`) in a tree of `levels` levels.
fn van_emde_boas(levels: u32, level: u32, node: usize) -> usize {
    if levels <= 1 {
        return 0;
    }
    let upper = levels / 2;
    if level < upper {
        return van_emde_boas(upper, level, node);
    }
    let under = 2 * (level - upper);
    let (above, within) = (node >> under, node & ((1 << under) - 1));
    level_start(upper) + above * level_start(levels - upper) + van_emde_boas(levels - upper, level - upper, within)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_once() {
        let orders = [LineOrder::Tree, LineOrder::Coarse, LineOrder::Blocks, LineOrder::VanEmdeBoas, LineOrder::Morton];
        for (order, levels, trees) in orders.into_iter().flat_map(|order| (1..=6).map(move |levels| (order, levels, 3))) {
            let mut numbers: Vec<usize> = (0..trees)
                .flat_map(|tree| (0..levels).flat_map(move |level| (0..1 << (2 * level)).map(move |node| (tree, level, node))))
                .map(|(tree, level, node)| order.split(trees, levels, tree, level, node))
                .collect();
            numbers.sort_unstable();
            assert!(numbers.into_iter().eq(0..trees * level_start(levels)), "{order:?}, {levels} levels");
        }
    }

    #[test]
    fn van_emde_boas_has_subtrees_together() {
        // Four levels: the upper two, then each of the 16 lower ones as five in a row.
        assert_eq!(van_emde_boas(4, 1, 3), 4);
        assert_eq!((van_emde_boas(4, 2, 0), van_emde_boas(4, 3, 0), van_emde_boas(4, 2, 1)), (5, 6, 10));
    }
}
