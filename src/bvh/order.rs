//! Another order of a tree's nodes in memory: by treelets, parts of the tree that a ray is likely to go through together.

use super::{Child, WideNode};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Siblings, which stay side by side.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Siblings {
    /// Half the surface area of their boxes, as bits: not negative, so ordered like the numbers.
    area: u64,
    /// The first one's place before; of equal areas the first goes first.
    first: Reverse<u32>,
    count: u32,
}

impl Siblings {
    /// The inner children of a node, if it has any.
    fn below<const W: usize>(node: &WideNode<W>) -> Option<Self> {
        let mut first = None;
        let (mut area, mut count) = (0.0, 0);
        for (bounds, child) in node.boxes.iter().zip(&node.children) {
            if let Child::Inner(at) = *child {
                first.get_or_insert(at);
                area += bounds.half_area();
                count += 1;
            }
        }
        first.map(|first| Self { area: area.to_bits(), first: Reverse(first), count })
    }
}

/// The nodes in treelets of at most `size` nodes, at least `W`: each begins with siblings and goes on with those of largest area that are next below it, as
/// long as they fit. Treelets follow each other depth first. Siblings stay side by side and behind their parents; the root stays first.
pub(crate) fn by_treelets<const W: usize>(nodes: &[WideNode<W>], size: usize) -> Vec<WideNode<W>> {
    let mut order: Vec<u32> = Vec::with_capacity(nodes.len());
    let mut begins = vec![Siblings { area: 0, first: Reverse(0), count: 1 }];
    while let Some(begin) = begins.pop() {
        let end = order.len() + size;
        let mut next = BinaryHeap::from([begin]);
        let mut rest = Vec::new();
        while let Some(siblings) = next.pop() {
            let Siblings { first: Reverse(first), count, .. } = siblings;
            if order.len() + count as usize > end {
                rest.push(siblings);
                continue;
            }
            for at in first..first + count {
                order.push(at);
                next.extend(Siblings::below(&nodes[at as usize]));
            }
        }
        // The first of memory is taken next.
        rest.sort_unstable_by_key(|siblings| siblings.first);
        begins.extend(rest);
    }
    let mut places = vec![0; nodes.len()];
    order.iter().zip(0..).for_each(|(&at, place)| places[at as usize] = place);
    let moved = |&at: &u32| {
        let mut node = nodes[at as usize];
        for child in &mut node.children {
            if let Child::Inner(below) = child {
                *below = places[*below as usize];
            }
        }
        node
    };
    order.iter().map(moved).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::{Box32, Options, QuadTree, build, check};

    #[test]
    fn treelets_hold_the_same_tree() {
        let cube = |k: i32| {
            let corner = [k.wrapping_mul(7919) % 5000, k.wrapping_mul(104_729) % 5000, k % 70].map(|c| c * 16);
            Box32 { lo: corner, hi: corner.map(|c| c + 640) }
        };
        let boxes: Vec<Box32> = (0..20_000).map(cube).collect();
        let tree = build(&boxes, &Options::with_leaf(2)).unwrap();
        for size in [4, 5, 32, 1 << 20] {
            let nodes = by_treelets(&tree.nodes, size);
            assert_eq!(nodes.len(), tree.nodes.len());
            // Treelets of one set of siblings each are the order of before.
            assert!((size == 4) == (nodes == tree.nodes));
            let moved = QuadTree { nodes, order: tree.order.clone() };
            assert_eq!(check(&moved, &boxes), Ok(()));
            for (at, node) in moved.nodes.iter().enumerate() {
                let inner: Vec<u32> = node.children.iter().filter_map(|c| if let Child::Inner(c) = c { Some(*c) } else { None }).collect();
                assert!(inner.windows(2).all(|pair| pair[1] == pair[0] + 1) && inner.iter().all(|&c| c as usize > at));
            }
        }
        // One treelet is a best-first walk: areas of siblings below the root fall as far as their parents allow.
        let nodes = by_treelets(&tree.nodes, tree.nodes.len());
        let areas: Vec<f64> = nodes.iter().filter_map(Siblings::below).map(|siblings| f64::from_bits(siblings.area)).collect();
        let falls = areas.windows(2).filter(|pair| pair[1] <= pair[0]).count();
        assert!(falls * 2 > areas.len(), "{falls} of {}", areas.len());
    }

    #[test]
    fn a_root_alone_stays() {
        let tree = build(&[Box32::default()], &Options::with_leaf(1)).unwrap();
        assert!(by_treelets(&tree.nodes, 4) == tree.nodes);
    }
}
