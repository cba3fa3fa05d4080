//! Where each node's records lie in the memory images: the only place that knows these formulas.
//!
//! With N splits a tree has G = (4^(N-1) - 1) / 3 sibling groups (0 if N < 2), the children of node (n, i) at t G + (4^n - 1) / 3 + i for n < N - 1. Of exact
//! vertices it has V = (4^N - 1) / 3 lines, node (n, i) at t V + (4^n - 1) / 3 + i for n < N; of compact ones 2 G, in which the halves of siblings
//! lie side by side, node (n, i) at 2 t G + ((4^n - 1) / 3 + i - 1) / 2, rounded down, for 0 < n < N.

use crate::num::VertexForm;

/// Number of nodes of levels 0..`level` of a tree: where level `level` begins, breadth first.
#[inline]
pub const fn level_start(level: u32) -> usize {
    ((1usize << (2 * level)) - 1) / 3
}

/// Vertex lines per tree.
#[inline]
pub const fn vertex_lines(form: VertexForm, levels: u32) -> usize {
    match form {
        VertexForm::Exact => level_start(levels),
        VertexForm::Compact => 2 * sibling_groups(levels),
    }
}

/// Sibling groups per tree.
#[inline]
pub const fn sibling_groups(levels: u32) -> usize {
    if levels < 2 { 0 } else { level_start(levels - 1) }
}

/// Vertex line of node (`level`, `node`) of `tree`; `level` below `levels`, and not 0 if the form is compact.
#[inline]
pub const fn vertex_line(form: VertexForm, levels: u32, tree: usize, level: u32, node: usize) -> usize {
    let first = tree * vertex_lines(form, levels);
    match form {
        VertexForm::Exact => first + level_start(level) + node,
        VertexForm::Compact => first + (level_start(level) + node - 1) / 2,
    }
}

/// Sibling group with the bound data of the children of node (`level`, `node`) of `tree`; `level` below `levels` - 1.
#[inline]
pub const fn child_group(levels: u32, tree: usize, level: u32, node: usize) -> usize {
    tree * sibling_groups(levels) + level_start(level) + node
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_follow_each_other_without_gaps() {
        for levels in 0..=6 {
            let (mut line, mut half, mut group) = (0, 0, 0);
            for tree in 0..3 {
                for level in 0..levels {
                    for node in 0..1 << (2 * level) {
                        assert_eq!(vertex_line(VertexForm::Exact, levels, tree, level, node), line);
                        line += 1;
                        if level > 0 {
                            assert_eq!((vertex_line(VertexForm::Compact, levels, tree, level, node), node % 2), (half / 2, half % 2));
                            half += 1;
                        }
                        if level + 1 < levels {
                            assert_eq!(child_group(levels, tree, level, node), group);
                            group += 1;
                        }
                    }
                }
            }
            let lines = VertexForm::ALL.map(|form| 3 * vertex_lines(form, levels));
            assert_eq!((lines, group), ([line, half / 2], 3 * sibling_groups(levels)));
        }
    }
}
