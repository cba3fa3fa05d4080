//! Leaves in blocks of the dense geometry format. A node names its first leaf alone, and the others by how many triangles are before them: so its leaves follow each other in one block, or
//! at the end of one and the beginning of the next. For that a triangle has two names: counted from the block's beginning, and up to its end ([`DENSE_PLACES`]).

use super::cut::Corners;
use super::leaves::{BlockSize, DENSE_PLACES, DenseStrip as Strip};
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

/// The leaves of a node, in order.
fn leaves<'a, const W: usize>(node: &WideNode<W>, ids: &'a [u32]) -> Vec<&'a [u32]> {
    node.children.iter().filter_map(|&child| of_leaf(child, ids)).collect()
}

/// Goes on with leaves, in a next block where they do not fit: the strip of the last block, and how many leaves are in the first one; none if two do not do. Each leaf fits one.
fn push(mesh: &Corners<'_>, mut strip: Strip, leaves: &[&[u32]], order: &mut Vec<u32>) -> Option<(Strip, usize)> {
    let mut in_first = None;
    for (k, own) in leaves.iter().enumerate() {
        let (begin, mut grown) = (order.len(), strip.clone());
        push_leaf(mesh, &mut grown, own, order);
        if !grown.fits() {
            if in_first.replace(k).is_some() {
                return None;
            }
            order.truncate(begin);
            grown = Strip::default();
            push_leaf(mesh, &mut grown, own, order);
        }
        strip = grown;
    }
    Some((strip, in_first.unwrap_or(leaves.len())))
}

/// The nodes, depth first, with nodes of their own for leaves that do not fit two blocks with those before them. Each leaf has to fit one alone.
pub fn apart<const W: usize>(mesh: &Corners<'_>, nodes: &[WideNode<W>], ids: &[u32]) -> Vec<WideNode<W>> {
    // Of each group of leaves how many it has; the first one stays.
    let groups = |node: &WideNode<W>| {
        let (all, mut groups, mut first) = (leaves(node, ids), Vec::new(), 0);
        while first < all.len() {
            let fits = |end: &usize| push(mesh, Strip::default(), &all[first..*end], &mut Vec::new()).is_some();
            let end = (first + 1..=all.len()).rev().find(fits).unwrap_or(first + 1);
            groups.push(end - first);
            first = end;
        }
        groups
    };
    let groups: Vec<Vec<usize>> = nodes.par_iter().map(groups).collect();
    let mut all = nodes.to_vec();
    for (at, groups) in groups.iter().enumerate().filter(|(_, groups)| groups.len() > 1) {
        let old = all[at];
        let is_leaf = |child: &Child| matches!(child, Child::Leaf { .. });
        let of = |of_leaves: bool| {
            old.boxes.into_iter().zip(old.children).filter(move |(_, child)| is_leaf(child) == of_leaves && *child != Child::Empty)
        };
        let mut own = of(true);
        let mut kept: Vec<(Box32, Child)> = own.by_ref().take(groups[0]).chain(of(false)).collect();
        for &count in &groups[1..] {
            let below = node(own.by_ref().take(count));
            if let Some(bounds) = below.boxes[..count].iter().copied().reduce(|all, own| all.union(&own)) {
                kept.push((bounds, Child::Inner(all.len() as u32))); // fewer than 2^28
                all.push(below);
            }
        }
        all[at] = node(kept);
    }
    by_depth(&all)
}

/// A node of these children, at most as many as it holds.
fn node<const W: usize>(children: impl IntoIterator<Item = (Box32, Child)>) -> WideNode<W> {
    let mut node = WideNode::default();
    children.into_iter().enumerate().for_each(|(k, (bounds, child))| (node.boxes[k], node.children[k]) = (bounds, child));
    node
}

/// Blocks that are filled one after the other.
#[derive(Default)]
struct Filled {
    sizes: Vec<BlockSize>,
    /// The open one.
    strip: Strip,
    count: usize,
    /// The triangles in their order.
    order: Vec<u32>,
}

impl Filled {
    fn close(&mut self) {
        if self.count > 0 {
            self.sizes.push(BlockSize::dense(self.count));
        }
        (self.strip, self.count) = (Strip::default(), 0);
    }

    /// Puts the leaves of a node, and names them.
    fn put<const W: usize>(&mut self, mesh: &Corners<'_>, node: &mut WideNode<W>, ids: &[u32]) {
        let own = leaves(node, ids);
        let begin = self.order.len();
        let pushed = push(mesh, self.strip.clone(), &own, &mut self.order).or_else(|| {
            self.order.truncate(begin);
            self.close();
            push(mesh, Strip::default(), &own, &mut self.order)
        });
        let Some((strip, in_first)) = pushed else { unreachable!("leaves of a node fit two blocks: they were put apart") };
        let before: usize = own[..in_first].iter().map(|own| own.len()).sum();
        if in_first < own.len() {
            self.count += before;
            self.close();
        }
        // Of the first leaf: in the open block, or so that those in the block before end where it ends.
        let mut place = DENSE_PLACES * self.sizes.len() + self.count;
        if in_first < own.len() {
            place -= before;
        }
        for child in &mut node.children {
            if let Child::Leaf { first, count } = child {
                *first = place as u32; // checked by who calls
                place += usize::from(*count);
            }
        }
        self.count = place - DENSE_PLACES * self.sizes.len();
        self.strip = strip;
    }
}

/// Gives leaves, which stand side by side, their places in blocks. Triangles of a leaf are put in the order of their strip.
///
/// How many triangles each block has. Leaves of a node fit two blocks ([`apart`]).
pub fn in_blocks<const W: usize>(mesh: &Corners<'_>, nodes: &mut [WideNode<W>], ids: &mut Vec<u32>) -> Vec<BlockSize> {
    let fill = |nodes: &mut [WideNode<W>]| {
        let mut filled = Filled::default();
        nodes.iter_mut().for_each(|node| filled.put(mesh, node, ids));
        filled.close();
        (filled.sizes, filled.order)
    };
    let parts: Vec<(Vec<BlockSize>, Vec<u32>)> = nodes.par_chunks_mut(TASK).map(fill).collect();
    let mut before = 0;
    for (nodes, (sizes, _)) in nodes.chunks_mut(TASK).zip(&parts) {
        for child in nodes.iter_mut().flat_map(|node| &mut node.children) {
            if let Child::Leaf { first, .. } = child {
                *first = first.wrapping_add(before);
            }
        }
        before = before.wrapping_add((DENSE_PLACES * sizes.len()) as u32);
    }
    let (sizes, order): (Vec<_>, Vec<_>) = parts.into_iter().unzip();
    *ids = order.concat();
    sizes.concat()
}
