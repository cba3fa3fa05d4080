//! Where each node's records lie in the memory images: the only place that knows these formulas.
//!
//! Sibling groups lie level by level over all trees: first those of the roots' children, then those of their children, and so on. On each level the trees follow each
//! other by depth, deepest first, and in their own order where that is the same: a tree's **place**, which is the same on all levels that it has. So level n begins at
//! group S(n), the sum over m < n of 4^m times the number of trees deeper than m + 1, and the children of node (n, i) of the tree at place p are group S(n) + 4^n p + i.
//!
//! Inserted vertices follow the groups, as four siblings have one: of exact vertices node (n, i), n > 0, has line R + 4 g + k, g being the group that it is in, as
//! child k, and R the number of trees that split, whose roots' vertices come first, at p; of compact ones it has half k mod 2 of line 2 g + k / 2, rounded down (a
//! root's are in its L0 record).

use super::TreeLines;
use crate::num::VertexForm;

/// Number of nodes of levels 0..`level` of a tree: where level `level` begins, breadth first.
#[inline]
pub const fn level_start(level: u32) -> usize {
    ((1usize << (2 * level)) - 1) / 3
}

/// Vertex lines of a tree of which `depth` levels are stored.
#[inline]
pub const fn vertex_lines(form: VertexForm, depth: u32) -> usize {
    match form {
        VertexForm::Exact => level_start(depth),
        VertexForm::Compact => 2 * sibling_groups(depth),
    }
}

/// Sibling groups of a tree of which `depth` levels are stored.
#[inline]
pub const fn sibling_groups(depth: u32) -> usize {
    if depth < 2 { 0 } else { level_start(depth - 1) }
}

/// Levels that sibling groups can be on: those of nodes two levels above the finest or higher.
pub const GROUP_LEVELS: usize = 9;

/// Where the levels of all trees of a scene begin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LevelStarts {
    /// First sibling group of each level; behind the last level with any, their number.
    groups: [usize; GROUP_LEVELS + 1],
    /// Trees that split.
    roots: usize,
}

impl LevelStarts {
    /// Of so many trees of each depth, from 0 to at most 10.
    pub fn new(trees_by_depth: &[usize]) -> Self {
        let deeper = |depth: usize| trees_by_depth.iter().skip(depth + 1).sum::<usize>();
        let mut groups = [0; GROUP_LEVELS + 1];
        for level in 0..GROUP_LEVELS {
            groups[level + 1] = groups[level] + (deeper(level + 1) << (2 * level));
        }
        Self { groups, roots: deeper(0) }
    }

    /// First sibling group of a level; behind the last level with any, their number.
    pub fn level(&self, level: usize) -> usize {
        self.groups[level]
    }

    /// Trees that split.
    pub fn roots(&self) -> usize {
        self.roots
    }

    /// Number of sibling groups.
    pub fn groups(&self) -> usize {
        self.groups[GROUP_LEVELS]
    }

    /// Number of lines of inserted vertices.
    pub fn vertex_lines(&self, form: VertexForm) -> usize {
        match form {
            VertexForm::Exact => self.roots + 4 * self.groups(),
            VertexForm::Compact => 2 * self.groups(),
        }
    }

    /// Sibling group of the children of node (`level`, `node`); `level` below the tree's depth - 1.
    #[inline(always)]
    pub fn child_group(&self, tree: TreeLines, level: u32, node: usize) -> usize {
        self.groups[level as usize] + (tree.place << (2 * level)) + node
    }

    /// Vertex line of node (`level`, `node`); `level` below the tree's depth, and not 0 if the form is compact.
    #[inline(always)]
    pub fn vertex_line(&self, form: VertexForm, tree: TreeLines, level: u32, node: usize) -> usize {
        let group = || self.child_group(tree, level - 1, node / 4);
        match form {
            VertexForm::Exact if level == 0 => tree.place,
            VertexForm::Exact => self.roots + 4 * group() + node % 4,
            VertexForm::Compact => 2 * group() + node % 4 / 2,
        }
    }
}

/// The place of each tree among those of its levels, and where levels begin, of trees of these depths.
pub fn places(depths: &[u32]) -> (Vec<TreeLines>, LevelStarts) {
    let mut by_depth = [0; GROUP_LEVELS + 2];
    depths.iter().for_each(|&depth| by_depth[depth as usize] += 1);
    let mut next = [0; GROUP_LEVELS + 2];
    for depth in (0..next.len() - 1).rev() {
        next[depth] = next[depth + 1] + by_depth[depth + 1];
    }
    let place = |&depth: &u32| {
        let place = next[depth as usize];
        next[depth as usize] += 1;
        TreeLines { depth, place }
    };
    (depths.iter().map(place).collect(), LevelStarts::new(&by_depth))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_has_one_owner() {
        let depths = [0, 3, 1, 6, 0, 2, 4, 4];
        let (trees, starts) = places(&depths);
        let (mut groups, mut lines, mut halves) = (Vec::new(), Vec::new(), Vec::new());
        for &tree in &trees {
            for (level, node) in (0..tree.depth).flat_map(|level| (0..1usize << (2 * level)).map(move |node| (level, node))) {
                lines.push(starts.vertex_line(VertexForm::Exact, tree, level, node));
                if level > 0 {
                    halves.push(2 * starts.vertex_line(VertexForm::Compact, tree, level, node) + node % 2);
                }
                if level + 1 < tree.depth {
                    groups.push(starts.child_group(tree, level, node));
                }
            }
        }
        let numbers = [starts.groups(), starts.vertex_lines(VertexForm::Exact), 2 * starts.vertex_lines(VertexForm::Compact)];
        for (mut owned, number) in [groups, lines, halves].into_iter().zip(numbers) {
            owned.sort_unstable();
            assert!(owned.into_iter().eq(0..number));
        }
        let total = |of: fn(u32) -> usize| depths.iter().map(|&depth| of(depth)).sum::<usize>();
        assert_eq!(numbers[0], total(sibling_groups));
        assert_eq!(numbers[1], total(|depth| vertex_lines(VertexForm::Exact, depth)));
        assert_eq!(numbers[2], 2 * total(|depth| vertex_lines(VertexForm::Compact, depth)));
    }

    #[test]
    fn levels_follow_each_other_and_deeper_trees_come_first() {
        let (trees, starts) = places(&[2, 4, 4]);
        assert_eq!(trees.iter().map(|tree| tree.place).collect::<Vec<_>>(), [2, 0, 1]);
        assert_eq!([0, 1, 2, 3].map(|level| starts.level(level)), [0, 3, 3 + 2 * 4, 3 + 2 * 4 + 2 * 16]);
        assert_eq!(starts.child_group(trees[2], 2, 5), 3 + 2 * 4 + 16 + 5);
    }
}
