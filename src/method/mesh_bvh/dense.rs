//! Leaves in blocks of the dense geometry format. A node names its first leaf alone, so its leaves follow each other in one block.

use super::cut::Corners;
use super::leaves::{BlockSize, DENSE_MOST, DenseStrip as Strip};
use crate::bvh::order::by_depth;
use crate::bvh::{Box32, Child, WideNode};
use rayon::prelude::*;

/// Nodes whose leaves are packed by one thread.
const TASK: usize = 1 << 12;

/// Goes on with a leaf, in the order of its triangles that suits best, which is appended to `order`.
fn push_leaf(mesh: &Corners<'_>, strip: &mut Strip, ids: &[u32], order: &mut Vec<u32>) {
    let triangles: Vec<_> = ids.iter().map(|&id| mesh.triangle(id)).collect();
    for k in strip.best(&triangles).into_iter().take(ids.len()) {
        strip.push(triangles[k]);
        order.push(ids[k]);
    }
}

fn of_leaf(child: Child, ids: &[u32]) -> Option<&[u32]> {
    if let Child::Leaf { first, count } = child { Some(&ids[first as usize..][..usize::from(count)]) } else { None }
}

/// The nodes, depth first, with nodes of their own for leaves that do not fit one block with those before them. Each leaf has to fit one alone.
pub fn apart<const W: usize>(mesh: &Corners<'_>, nodes: &[WideNode<W>], ids: &[u32]) -> Vec<WideNode<W>> {
    /// Of each child the group of leaves that it is in; the first one stays.
    fn groups<const W: usize>(mesh: &Corners<'_>, node: &WideNode<W>, ids: &[u32]) -> [usize; W] {
        let (mut strip, mut group) = (Strip::default(), 0);
        node.children.map(|child| {
            let Some(own) = of_leaf(child, ids) else { return 0 };
            let mut grown = strip.clone();
            push_leaf(mesh, &mut grown, own, &mut Vec::new());
            if !grown.fits() {
                (grown, group) = (Strip::default(), group + 1);
                push_leaf(mesh, &mut grown, own, &mut Vec::new());
            }
            strip = grown;
            group
        })
    }
    let groups: Vec<[usize; W]> = nodes.par_iter().map(|node| groups(mesh, node, ids)).collect();
    let mut all = nodes.to_vec();
    for (at, groups) in groups.iter().enumerate() {
        let most = groups.iter().copied().max().unwrap_or(0);
        if most == 0 {
            continue;
        }
        let (old, mut new, mut used) = (all[at], WideNode::default(), 0);
        let mut put = |bounds: Box32, child: Child| {
            (new.boxes[used], new.children[used]) = (bounds, child);
            used += 1;
        };
        let of = |group: usize| (0..W).filter(move |&k| groups[k] == group).map(|k| (old.boxes[k], old.children[k]));
        of(0).filter(|(_, child)| *child != Child::Empty).for_each(|(bounds, child)| put(bounds, child));
        for group in 1..=most {
            let mut below = WideNode::default();
            of(group).enumerate().for_each(|(k, (bounds, child))| (below.boxes[k], below.children[k]) = (bounds, child));
            if let Some(bounds) = of(group).map(|(bounds, _)| bounds).reduce(|all, own| all.union(&own)) {
                put(bounds, Child::Inner(all.len() as u32)); // fewer than 2^28
                all.push(below);
            }
        }
        all[at] = new;
    }
    by_depth(&all)
}

/// Gives leaves, which stand side by side, their places in blocks: 64 for each block, and the triangles before it there. Triangles of a leaf are put in the order of their strip.
///
/// How many triangles each block has. Leaves of a node fit one block ([`apart`]).
pub fn in_blocks<const W: usize>(mesh: &Corners<'_>, nodes: &mut [WideNode<W>], ids: &mut Vec<u32>) -> Vec<BlockSize> {
    let pack = |nodes: &mut [WideNode<W>]| {
        let (mut strip, mut sizes, mut count, mut order) = (Strip::default(), Vec::new(), 0, Vec::new());
        for node in nodes {
            let begin = order.len();
            let grow = |mut strip: Strip, order: &mut Vec<u32>| {
                node.children.iter().filter_map(|&child| of_leaf(child, ids)).for_each(|own| push_leaf(mesh, &mut strip, own, order));
                strip
            };
            let mut grown = grow(strip.clone(), &mut order);
            if order.len() == begin {
                continue;
            }
            if !strip.is_empty() && !grown.fits() {
                sizes.push(BlockSize::dense(count));
                order.truncate(begin);
                grown = grow(Strip::default(), &mut order);
                count = 0;
            }
            for child in &mut node.children {
                if let Child::Leaf { first, count: own } = child {
                    *first = (DENSE_MOST * sizes.len() + count) as u32; // checked by who calls
                    count += usize::from(*own);
                }
            }
            strip = grown;
        }
        if count > 0 {
            sizes.push(BlockSize::dense(count));
        }
        (sizes, order)
    };
    let parts: Vec<(Vec<BlockSize>, Vec<u32>)> = nodes.par_chunks_mut(TASK).map(pack).collect();
    let mut before = 0;
    for (nodes, (sizes, _)) in nodes.chunks_mut(TASK).zip(&parts) {
        for child in nodes.iter_mut().flat_map(|node| &mut node.children) {
            if let Child::Leaf { first, .. } = child {
                *first = first.wrapping_add(before);
            }
        }
        before = before.wrapping_add((DENSE_MOST * sizes.len()) as u32);
    }
    let (sizes, order): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
    *ids = order.concat();
    sizes.concat()
}
