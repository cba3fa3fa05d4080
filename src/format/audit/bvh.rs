//! The quad-BVH over the trees.

use super::tally::{CheckKind, Tallies};
use crate::format::{Box16, BvhChild, ChildRef, Scene};
use crate::num::Wire;

/// Walks from the root and checks references and boxes.
pub(super) fn check(scene: &Scene, found: &mut Tallies) {
    let nodes = scene.nodes();
    let children = |node: usize| std::array::from_fn::<_, 4, _>(|k| BvhChild::from_words(&nodes[node][2 * k..]));
    let (mut node_uses, mut tree_uses) = (vec![0u32; nodes.len()], vec![0u32; scene.trees()]);
    let mut open = Vec::new();
    if let Some(root) = node_uses.first_mut() {
        *root = 1;
        open.push(0);
    }
    while let Some(node) = open.pop() {
        for (k, slot) in children(node).into_iter().enumerate() {
            let (kind, index, more) = (slot.child.kind.get(), slot.child.index.get() as usize, slot.child.count.get() as usize);
            let zero = kind != ChildRef::EMPTY || nodes[node][2 * k..2 * k + 2] == [0, 0];
            let legal = kind <= ChildRef::LEAF && (kind != ChildRef::INNER || more == 0);
            found.check(CheckKind::Reserved, zero && legal, || {
                format!("quad-BVH node {node}: slot {k} is {:x?}", &nodes[node][2 * k..2 * k + 2])
            });
            match kind {
                ChildRef::INNER => match node_uses.get_mut(index) {
                    Some(uses) => {
                        *uses += 1;
                        if *uses == 1 {
                            open.push(index);
                            let inside = children(index).into_iter().filter(|c| c.child.kind.get() != ChildRef::EMPTY);
                            let holds = inside.into_iter().all(|c| contains(slot.bounds, c.bounds));
                            found.check(CheckKind::BvhInnerBoxes, holds, || {
                                format!("quad-BVH node {node}: box of child {k} (node {index})")
                            });
                        }
                    }
                    None => found.check(CheckKind::BvhNodes, false, || format!("quad-BVH node {node} refers to node {index}")),
                },
                ChildRef::LEAF => {
                    for tree in index..=index + more {
                        match tree_uses.get_mut(tree) {
                            Some(uses) => {
                                *uses += 1;
                                let holds = contains(slot.bounds, scene.record(tree).root.bounds);
                                found.check(CheckKind::BvhLeafBoxes, holds, || {
                                    format!("quad-BVH node {node}: box of child {k} (tree {tree})")
                                });
                            }
                            None => found.check(CheckKind::BvhTrees, false, || format!("quad-BVH node {node} refers to tree {tree}")),
                        }
                    }
                }
                _ => {}
            }
        }
    }
    for (node, &uses) in node_uses.iter().enumerate() {
        found.check(CheckKind::BvhNodes, uses == 1, || format!("quad-BVH node {node} is referred to {uses} times"));
    }
    for (tree, &uses) in tree_uses.iter().enumerate() {
        found.check(CheckKind::BvhTrees, uses == 1, || format!("tree {tree} is referred to {uses} times"));
    }
}

fn contains(outer: Box16, inner: Box16) -> bool {
    let [a, b, c, d] = [outer.lo.get(), inner.lo.get(), inner.hi.get(), outer.hi.get()];
    (0..3).all(|k| a[k] <= b[k] && c[k] <= d[k])
}
