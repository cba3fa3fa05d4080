//! The quad-BVH over the trees.

use super::boxes::{Span, local};
use super::tally::{CheckKind, Tallies};
use crate::format::{BvhNode, Scene};
use crate::num::Wire;

/// Kinds of slots.
const EMPTY: u64 = 0;
const INNER: u64 = 1;
const LEAF: u64 = 2;

/// Walks from the root and checks references and boxes; `trees` are the boxes of their full-resolution vertices.
pub(super) fn check(scene: &Scene, trees: &[Span], found: &mut Tallies) {
    let nodes = scene.nodes();
    let (mut node_uses, mut tree_uses) = (vec![0u32; nodes.len()], vec![0u32; trees.len()]);
    // Boxes of all vertices below a node, and the slots that lead to nodes: (node, slot, child), parents first.
    let mut spans = vec![Span::EMPTY; nodes.len()];
    let mut inner = Vec::new();
    let mut open = Vec::new();
    if let Some(root) = node_uses.first_mut() {
        *root = 1;
        open.push(0);
    }
    while let Some(at) = open.pop() {
        let node = BvhNode::from_words(&nodes[at]);
        let without = |kind: u64| node.kinds.iter().all(|k| k.get() != kind);
        let unused = without(INNER) && node.first_node.get() != 0 || without(LEAF) && node.first_leaf.get() != 0;
        found.check(CheckKind::Reserved, node.reserved.get() == 0 && !unused, || {
            format!("quad-BVH node {at}: its first bit, or children {} and {} that there are not", node.first_node, node.first_leaf)
        });
        // Children of a kind stand side by side, in the order of their slots.
        let (mut next_node, mut next_leaf) = (node.first_node.get() as usize, node.first_leaf.get() as usize);
        for k in 0..4 {
            let (kind, count) = (node.kinds[k].get(), node.counts[k].get());
            let planes = &node.planes[6 * k..6 * k + 6];
            let zero = kind != EMPTY || planes.iter().all(|plane| plane.get() == 0);
            let legal = kind == LEAF || kind < LEAF && count == 0;
            found.check(CheckKind::Reserved, zero && legal, || {
                format!("quad-BVH node {at}: slot {k} of kind {kind} has count {count}, planes {planes:?}")
            });
            match kind {
                INNER => {
                    let index = next_node;
                    next_node += 1;
                    match node_uses.get_mut(index) {
                        Some(uses) => {
                            *uses += 1;
                            if *uses == 1 {
                                open.push(index);
                                inner.push((at, k, index));
                            }
                        }
                        None => found.check(CheckKind::BvhNodes, false, || format!("quad-BVH node {at} refers to node {index}")),
                    }
                }
                LEAF => {
                    let (lo, hi) = local(&node, k);
                    for _ in 0..=count {
                        let tree = next_leaf;
                        next_leaf += 1;
                        match tree_uses.get_mut(tree) {
                            Some(uses) => {
                                *uses += 1;
                                spans[at] = spans[at].with(&trees[tree]);
                                found.check(CheckKind::BvhLeafBoxes, trees[tree].is_within(lo, hi), || {
                                    format!("quad-BVH node {at}: box of child {k} (tree {tree}), {lo:?} to {hi:?} (times 2^16)")
                                });
                            }
                            None => found.check(CheckKind::BvhTrees, false, || format!("quad-BVH node {at} refers to tree {tree}")),
                        }
                    }
                }
                _ => {}
            }
        }
    }
    for (at, k, index) in inner.into_iter().rev() {
        let (lo, hi) = local(&BvhNode::from_words(&nodes[at]), k);
        found.check(CheckKind::BvhInnerBoxes, spans[index].is_within(lo, hi), || {
            format!("quad-BVH node {at}: box of child {k} (node {index}), {lo:?} to {hi:?} (times 2^16)")
        });
        spans[at] = spans[at].with(&spans[index]);
    }
    for (node, &uses) in node_uses.iter().enumerate() {
        found.check(CheckKind::BvhNodes, uses == 1, || format!("quad-BVH node {node} is referred to {uses} times"));
    }
    for (tree, &uses) in tree_uses.iter().enumerate() {
        found.check(CheckKind::BvhTrees, uses == 1, || format!("tree {tree} is referred to {uses} times"));
    }
}

/// Each base triangle as it was given is that of one tree.
pub(super) fn check_sources(scene: &Scene, found: &mut Tallies) {
    let mut uses = vec![0u32; scene.trees()];
    for tree in 0..scene.trees() {
        let source = scene.source(tree);
        match uses.get_mut(source as usize) {
            Some(uses) => *uses += 1,
            None => found.check(CheckKind::Sources, false, || format!("tree {tree} is of base triangle {source}")),
        }
    }
    for (source, &uses) in uses.iter().enumerate() {
        found.check(CheckKind::Sources, uses == 1, || format!("base triangle {source} is that of {uses} trees"));
    }
}
