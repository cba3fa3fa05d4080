//! Orders in which the splits of all trees could lie instead: their numbers, if all levels of all trees are stored.

use crate::format::layout::level_start;

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
}

/// Levels that [`LineOrder::Coarse`] has over all trees.
const COARSE: u32 = 3;

impl LineOrder {
    /// Number of the split of node (`level`, `node`) of `tree`, of `trees` trees that have splits on `levels` levels.
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
        let orders = [LineOrder::Tree, LineOrder::Coarse, LineOrder::Blocks, LineOrder::VanEmdeBoas];
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
