//! Where each node's records lie in the memory images: the only place that knows these formulas.
//!
//! With N splits: tree t has V = (4^N - 1) / 3 vertex lines, node (n, i) at t V + (4^n - 1) / 3 + i for n < N; and
//! G = (4^(N-1) - 1) / 3 sibling groups (0 if N < 2), the children of node (n, i) at t G + (4^n - 1) / 3 + i for n < N - 1.

/// Number of nodes of levels 0..`level` of a tree: where level `level` begins, breadth first.
#[inline]
pub const fn level_start(level: u32) -> usize {
    ((1usize << (2 * level)) - 1) / 3
}

/// Vertex lines per tree.
#[inline]
pub const fn vertex_lines(levels: u32) -> usize {
    level_start(levels)
}

/// Sibling groups per tree.
#[inline]
pub const fn sibling_groups(levels: u32) -> usize {
    if levels < 2 { 0 } else { level_start(levels - 1) }
}

/// Vertex line of node (`level`, `node`) of `tree`; `level` below `levels`.
#[inline]
pub const fn vertex_line(levels: u32, tree: usize, level: u32, node: usize) -> usize {
    tree * vertex_lines(levels) + level_start(level) + node
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
            let (mut line, mut group) = (0, 0);
            for tree in 0..3 {
                for level in 0..levels {
                    for node in 0..1 << (2 * level) {
                        assert_eq!(vertex_line(levels, tree, level, node), line);
                        line += 1;
                        if level + 1 < levels {
                            assert_eq!(child_group(levels, tree, level, node), group);
                            group += 1;
                        }
                    }
                }
            }
            assert_eq!((line, group), (3 * vertex_lines(levels), 3 * sibling_groups(levels)));
        }
    }
}
