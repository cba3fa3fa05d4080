//! Where each node's records lie in the memory images: the only place that knows these formulas.
//!
//! Splits lie level by level over all trees: first those of the roots, then those of their children, and so on. On each level the trees follow each
//! other by depth, deepest first, and in their own order where that is the same: a tree's **place**, which is the same on all levels that it has. So if `lines(n)` trees
//! have splits on level n, that level begins at S(n), the sum of 4^m lines(m) over m < n, and the split of node (n, i) of the tree at place p is line S(n) + 4^n p + i.
//! A root has a split if its tree is deeper than 0, another node (n, i) if it is deeper than n + 1: below a **last split**, one of level depth - 1, are triangles alone.
//!
//! Inserted vertices, if they are exact, lie the same way, with all nodes that split. If they are compact they are in the splits, and those of last splits but roots' in
//! lines apart: level by level, the trees whose last level it is by their places; two siblings share a line, node (n, i) in half i mod 2, or if they are short four.

use super::TreeLines;
use crate::num::VertexForm;

/// Number of nodes of levels 0..`level` of a tree: where level `level` begins, breadth first.
#[inline]
pub const fn level_start(level: u32) -> usize {
    ((1usize << (2 * level)) - 1) / 3
}

/// Splits of a tree of which `depth` levels are stored.
#[inline]
pub const fn split_lines(depth: u32) -> usize {
    if depth < 2 { depth as usize } else { level_start(depth - 1) }
}

/// Vertex lines of a tree of which `depth` levels are stored.
#[inline]
pub const fn vertex_lines(form: VertexForm, depth: u32) -> usize {
    match form {
        VertexForm::Exact => level_start(depth),
        VertexForm::Compact | VertexForm::Short if depth < 2 => 0,
        VertexForm::Compact | VertexForm::Short => form.sibling_lines() << (2 * (depth - 2)),
    }
}

/// Whether a tree of this depth has splits on a level.
#[inline(always)]
pub const fn has_split(depth: u32, level: u32) -> bool {
    if level == 0 { depth > 0 } else { level + 1 < depth }
}

/// Whether a tree of this depth has lines of inserted vertices on a level.
#[inline(always)]
pub const fn has_vertices(form: VertexForm, depth: u32, level: u32) -> bool {
    match form {
        VertexForm::Exact => level < depth,
        VertexForm::Compact | VertexForm::Short => level > 0 && level + 1 == depth,
    }
}

/// Lines of inserted vertices that a tree has on a level, if it has any.
pub const fn vertex_lines_of_level(form: VertexForm, level: u32) -> usize {
    match form {
        VertexForm::Exact => 1 << (2 * level),
        VertexForm::Compact | VertexForm::Short => form.sibling_lines() << (2 * (level - 1)),
    }
}

/// Levels that a node that splits can be on.
pub const SPLIT_LEVELS: usize = 10;

/// Where the levels of all trees of a scene begin.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LevelStarts {
    /// First split of each level; behind the last level with any, their number.
    splits: [usize; SPLIT_LEVELS + 1],
    /// Line of inserted vertices of the tree at place 0 of each level, if vertices are compact in lines of four siblings; it may be one below 0 then, as the trees of a level do not begin
    /// at place 0.
    vertices: [usize; SPLIT_LEVELS],
    /// Lines of inserted vertices.
    vertex_lines: usize,
}

impl LevelStarts {
    /// Of so many trees of each depth, from 0 to at most 10.
    pub fn new(form: VertexForm, trees_by_depth: &[usize]) -> Self {
        let trees =
            |has: &dyn Fn(u32) -> bool| (0..).zip(trees_by_depth).filter(|&(depth, _)| has(depth)).map(|(_, trees)| trees).sum::<usize>();
        let mut starts = Self::default();
        for level in 0..SPLIT_LEVELS {
            let number = level as u32; // at most 9
            starts.splits[level + 1] = starts.splits[level] + (trees(&|depth| has_split(depth, number)) << (2 * level));
            starts.vertices[level] = match form {
                VertexForm::Exact => starts.vertex_lines,
                VertexForm::Compact | VertexForm::Short if level == 0 => 0,
                VertexForm::Compact | VertexForm::Short => {
                    (starts.vertex_lines / form.sibling_lines()).wrapping_sub(trees(&|depth| depth > number + 1) << (2 * (level - 1)))
                }
            };
            let lines = trees(&|depth| has_vertices(form, depth, number));
            starts.vertex_lines += if lines == 0 { 0 } else { lines * vertex_lines_of_level(form, number) };
        }
        starts
    }

    /// First split of a level; behind the last level with any, their number.
    pub fn split_level(&self, level: usize) -> usize {
        self.splits[level]
    }

    /// Where the vertices of a level begin: of exact ones the first line, of compact ones the lines of four siblings that the tree at place 0 would have (modulo the size of a word).
    pub fn vertex_level(&self, level: usize) -> usize {
        self.vertices[level]
    }

    /// Number of splits.
    pub fn splits(&self) -> usize {
        self.splits[SPLIT_LEVELS]
    }

    /// Number of lines of inserted vertices.
    pub fn vertex_lines(&self) -> usize {
        self.vertex_lines
    }

    /// All have numbers of 28 bits: splits, and lines of exact vertices, or those of four siblings of compact ones.
    pub(super) fn are_numbered(&self, form: VertexForm) -> bool {
        let vertices = if form.is_compact() { self.vertex_lines / form.sibling_lines() } else { self.vertex_lines };
        self.splits().max(vertices) <= 1 << 28
    }

    /// Split of node (`level`, `node`), which [has one](has_split).
    #[inline(always)]
    pub fn split(&self, tree: TreeLines, level: u32, node: usize) -> usize {
        self.splits[level as usize] + (tree.place << (2 * level)) + node
    }

    /// Vertex line of node (`level`, `node`), which [has one](has_vertices).
    #[inline(always)]
    pub fn vertex_line(&self, form: VertexForm, tree: TreeLines, level: u32, node: usize) -> usize {
        let start = self.vertices[level as usize];
        match form {
            VertexForm::Exact => start + (tree.place << (2 * level)) + node,
            VertexForm::Compact => 2 * start.wrapping_add((tree.place << (2 * (level - 1))) + node / 4) + node % 4 / 2,
            VertexForm::Short => start.wrapping_add((tree.place << (2 * (level - 1))) + node / 4),
        }
    }
}

/// The place of each tree among those of its levels, and where levels begin, of trees of these depths.
pub fn places(form: VertexForm, depths: &[u32]) -> (Vec<TreeLines>, LevelStarts) {
    let mut by_depth = [0; SPLIT_LEVELS + 1];
    depths.iter().for_each(|&depth| by_depth[depth as usize] += 1);
    let mut next = [0; SPLIT_LEVELS + 1];
    for depth in (0..next.len() - 1).rev() {
        next[depth] = next[depth + 1] + by_depth[depth + 1];
    }
    let place = |&depth: &u32| {
        let place = next[depth as usize];
        next[depth as usize] += 1;
        TreeLines { depth, place }
    };
    (depths.iter().map(place).collect(), LevelStarts::new(form, &by_depth))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_line_has_one_owner() {
        let depths = [0, 3, 1, 6, 0, 2, 4, 4, 10, 9];
        for form in VertexForm::ALL {
            let (trees, starts) = places(form, &depths);
            let (mut splits, mut places_of_vertices) = (Vec::new(), Vec::new());
            let per_line = 4 / form.sibling_lines();
            for &tree in &trees {
                for (level, node) in (0..tree.depth).flat_map(|level| (0..1usize << (2 * level)).map(move |node| (level, node))) {
                    if has_split(tree.depth, level) {
                        splits.push(starts.split(tree, level, node));
                    }
                    if has_vertices(form, tree.depth, level) {
                        places_of_vertices.push(per_line * starts.vertex_line(form, tree, level, node) + node % per_line);
                    }
                    assert!(has_split(tree.depth, level) || has_vertices(form, tree.depth, level), "depth {}, level {level}", tree.depth);
                }
            }
            let numbers = [starts.splits(), per_line * starts.vertex_lines()];
            for (mut owned, number) in [splits, places_of_vertices].into_iter().zip(numbers) {
                owned.sort_unstable();
                assert!(owned.into_iter().eq(0..number), "{form:?}");
            }
            let total = |of: &dyn Fn(u32) -> usize| depths.iter().map(|&depth| of(depth)).sum::<usize>();
            assert_eq!([starts.splits(), starts.vertex_lines()], [total(&split_lines), total(&|depth| vertex_lines(form, depth))]);
        }
    }

    #[test]
    fn levels_follow_each_other_and_deeper_trees_come_first() {
        let (trees, starts) = places(VertexForm::Compact, &[2, 4, 4]);
        assert_eq!(trees.iter().map(|tree| tree.place).collect::<Vec<_>>(), [2, 0, 1]);
        assert_eq!([0, 1, 2, 3].map(|level| starts.split_level(level)), [0, 3, 3 + 2 * 4, 3 + 2 * 4 + 2 * 16]);
        assert_eq!(starts.split(trees[2], 2, 5), 3 + 2 * 4 + 16 + 5);
        // The tree of two levels first: two lines for the four children of its root. Then those of level 3, of which 64 nodes have 32 lines a tree.
        assert_eq!(
            [starts.vertex_line(VertexForm::Compact, trees[0], 1, 3), starts.vertex_line(VertexForm::Compact, trees[2], 3, 2)],
            [1, 2 + 32 + 1]
        );
    }
}
