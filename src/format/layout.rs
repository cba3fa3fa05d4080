//! Where each node's records lie in the memory images: the only place that knows these formulas.
//!
//! A tree of which d levels are stored has G = (4^(d-1) - 1) / 3 sibling groups (0 if d < 2), the children of node (n, i) at (4^n - 1) / 3 + i behind its first group for
//! n < d - 1. Of exact vertices it has V = (4^d - 1) / 3 lines, node (n, i) at (4^n - 1) / 3 + i behind its first line for n < d; of compact ones 2 G, in which the
//! halves of siblings lie side by side, node (n, i) at ((4^n - 1) / 3 + i - 1) / 2, rounded down, behind its first line for 0 < n < d. The trees' groups and lines follow
//! each other in the order of the trees.

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

/// Vertex line of node (`level`, `node`) of a tree whose first is `first`; `level` below the tree's depth, and not 0 if the form is compact.
#[inline]
pub const fn vertex_line(form: VertexForm, first: usize, level: u32, node: usize) -> usize {
    match form {
        VertexForm::Exact => first + level_start(level) + node,
        VertexForm::Compact => first + (level_start(level) + node - 1) / 2,
    }
}

/// Sibling group with the bound data of the children of node (`level`, `node`) of a tree whose first is `first`; `level` below the tree's depth - 1.
#[inline]
pub const fn child_group(first: usize, level: u32, node: usize) -> usize {
    first + level_start(level) + node
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_follow_each_other_without_gaps() {
        let (mut line, mut half, mut group) = (0, 0, 0);
        let (mut first_exact, mut first_compact, mut first_group) = (0, 0, 0);
        for depth in [0, 3, 1, 6, 0, 2, 4, 4] {
            for level in 0..depth {
                for node in 0..1 << (2 * level) {
                    assert_eq!(vertex_line(VertexForm::Exact, first_exact, level, node), line);
                    line += 1;
                    if level > 0 {
                        assert_eq!((vertex_line(VertexForm::Compact, first_compact, level, node), node % 2), (half / 2, half % 2));
                        half += 1;
                    }
                    if level + 1 < depth {
                        assert_eq!(child_group(first_group, level, node), group);
                        group += 1;
                    }
                }
            }
            first_exact += vertex_lines(VertexForm::Exact, depth);
            first_compact += vertex_lines(VertexForm::Compact, depth);
            first_group += sibling_groups(depth);
            assert_eq!((first_exact, 2 * first_compact, first_group), (line, half, group));
        }
    }
}
