//! Other orders of a tree's nodes in memory. In all of them siblings stay side by side and behind their parents, and the root stays first.

use super::{Child, MAX_DEPTH, MAX_DEPTH_OF_SIX, WideNode};
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

/// The root as siblings.
const ROOT: Siblings = Siblings { area: 0, first: Reverse(0), count: 1 };

/// The nodes in treelets of at most `size` nodes, at least `W`, parts of the tree that a ray is likely to go through together: each begins with siblings and
/// goes on with those of largest area that are next below it, as long as they fit. Treelets follow each other depth first.
pub(crate) fn by_treelets<const W: usize>(nodes: &[WideNode<W>], size: usize) -> Vec<WideNode<W>> {
    let mut order: Vec<u32> = Vec::with_capacity(nodes.len());
    let mut begins = vec![ROOT];
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
    moved(nodes, &order)
}

/// The nodes level by level: what far rays read of all of the tree is one piece.
pub(crate) fn by_levels<const W: usize>(nodes: &[WideNode<W>]) -> Vec<WideNode<W>> {
    let mut order: Vec<u32> = vec![0];
    let mut at = 0;
    while at < order.len() {
        if let Some(Siblings { first: Reverse(first), count, .. }) = Siblings::below(&nodes[order[at] as usize]) {
            order.extend(first..first + count);
        }
        at += 1;
    }
    moved(nodes, &order)
}

/// The nodes depth first, whatever their order was; inner children of a node need not have stood side by side.
pub(crate) fn by_depth<const W: usize>(nodes: &[WideNode<W>]) -> Vec<WideNode<W>> {
    let mut order: Vec<u32> = vec![0];
    let mut next = vec![0];
    while let Some(at) = next.pop() {
        let first = order.len();
        order.extend(
            nodes[at as usize].children.iter().filter_map(|child| if let Child::Inner(below) = child { Some(*below) } else { None }),
        );
        next.extend(order[first..].iter().rev());
    }
    moved(nodes, &order)
}

/// Van Emde Boas' order: the upper levels, then each subtree below them, each part again so, cut at powers of two of levels. Whatever the size of a line or a
/// row, few of them have a path.
pub(crate) fn by_halves<const W: usize>(nodes: &[WideNode<W>]) -> Vec<WideNode<W>> {
    /// Puts so many levels of what begins with `siblings`; gives what is next below.
    fn put<const W: usize>(nodes: &[WideNode<W>], siblings: Siblings, levels: u32, order: &mut Vec<u32>) -> Vec<Siblings> {
        if levels == 1 {
            let Siblings { first: Reverse(first), count, .. } = siblings;
            order.extend(first..first + count);
            return (first..first + count).filter_map(|at| Siblings::below(&nodes[at as usize])).collect();
        }
        let upper = put(nodes, siblings, levels / 2, order);
        upper.into_iter().flat_map(|below| put(nodes, below, levels - levels / 2, order)).collect()
    }
    let mut order = Vec::with_capacity(nodes.len());
    // As many as no path has.
    let below = put(nodes, ROOT, 2 * MAX_DEPTH.max(MAX_DEPTH_OF_SIX).next_power_of_two(), &mut order);
    debug_assert!(below.is_empty() && order.len() == nodes.len());
    moved(nodes, &order)
}

/// The nodes in this order.
fn moved<const W: usize>(nodes: &[WideNode<W>], order: &[u32]) -> Vec<WideNode<W>> {
    let mut places = vec![0; nodes.len()];
    order.iter().zip(0..).for_each(|(&at, place)| places[at as usize] = place);
    let node = |&at: &u32| {
        let mut node = nodes[at as usize];
        for child in &mut node.children {
            if let Child::Inner(below) = child {
                *below = places[*below as usize];
            }
        }
        node
    };
    order.iter().map(node).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::{Box32, Options, QuadTree, build, check};

    fn cubes() -> Vec<Box32> {
        let cube = |k: i32| {
            let corner = [k.wrapping_mul(7919) % 5000, k.wrapping_mul(104_729) % 5000, k % 70].map(|c| c * 16);
            Box32 { lo: corner, hi: corner.map(|c| c + 640) }
        };
        (0..20_000).map(cube).collect()
    }

    #[test]
    fn treelets_hold_the_same_tree() {
        let boxes = cubes();
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
    fn depth_first_is_the_order_that_trees_are_built_in() {
        let tree = build(&cubes(), &Options::with_leaf(2)).unwrap();
        assert_eq!(by_depth(&by_levels(&tree.nodes)), tree.nodes);
    }

    #[test]
    fn levels_and_halves_hold_the_same_tree() {
        let boxes = cubes();
        let tree = build(&boxes, &Options::with_leaf(2)).unwrap();
        for nodes in [by_levels(&tree.nodes), by_halves(&tree.nodes)] {
            assert_eq!(nodes.len(), tree.nodes.len());
            assert!(nodes != tree.nodes);
            let moved = QuadTree { nodes, order: tree.order.clone() };
            assert_eq!(check(&moved, &boxes), Ok(()));
            for (at, node) in moved.nodes.iter().enumerate() {
                let inner: Vec<u32> = node.children.iter().filter_map(|c| if let Child::Inner(c) = c { Some(*c) } else { None }).collect();
                assert!(inner.windows(2).all(|pair| pair[1] == pair[0] + 1) && inner.iter().all(|&c| c as usize > at));
            }
        }
        // Level by level, depths never fall.
        let nodes = by_levels(&tree.nodes);
        let mut depths = vec![0; nodes.len()];
        for (at, node) in nodes.iter().enumerate() {
            for child in &node.children {
                if let Child::Inner(below) = child {
                    depths[*below as usize] = depths[at] + 1;
                }
            }
        }
        assert!(depths.is_sorted());
    }

    #[test]
    fn a_root_alone_stays() {
        let tree = build(&[Box32::default()], &Options::with_leaf(1)).unwrap();
        assert!([by_treelets(&tree.nodes, 4), by_levels(&tree.nodes), by_halves(&tree.nodes)].iter().all(|nodes| *nodes == tree.nodes));
    }
}
