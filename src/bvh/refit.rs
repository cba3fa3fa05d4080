//! The boxes of a quad-BVH anew, bottom-up: for things that moved, with the tree as it is.

use super::{Box32, Child, QuadNode, encode_line};
use crate::format::{Box16, BvhNode, ChildRef, Line};
use crate::num::Wire;
use rayon::prelude::*;

/// Nodes of one task: fewer are not worth a thread.
const TASK: usize = 1 << 10;

/// The same nodes with boxes anew. `leaf` gives the box of the things of a leaf, from its first one and their number.
///
/// Nodes that lie depth first with siblings together, as [`super::build()`] puts them, are done in parallel; in any other order one after the other.
pub fn refit(nodes: &[Line], leaf: &(impl Fn(u32, u32) -> Box32 + Sync)) -> Vec<Line> {
    let mut out = nodes.to_vec();
    if let Some((root, below)) = out.split_first_mut()
        && group(std::slice::from_mut(root), below, 1, leaf).is_some()
    {
        return out;
    }
    in_turn(nodes, leaf)
}

/// [`refit`] of the nodes over a scene's trees, whose boxes are these.
pub fn refit_over_trees(nodes: &[Line], boxes: &[Box16]) -> Vec<Line> {
    refit(nodes, &|first, _| super::wide(&boxes[first as usize]))
}

/// The number of an inner child.
fn inner(child: &Child) -> Option<usize> {
    if let Child::Inner(index) = child { Some(*index as usize) } else { None }
}

fn children(line: &Line) -> [Child; 4] {
    let node = BvhNode::from_words(line);
    [0, 1, 2, 3].map(|k| {
        let child = node.child(k);
        let index = child.index.get() as u32; // 28 bits
        match child.kind.get() {
            ChildRef::INNER => Child::Inner(index),
            ChildRef::LEAF => Child::Leaf { first: index, count: child.count.get() as u8 + 1 }, // 2 bits
            _ => Child::Empty,
        }
    })
}

/// Siblings with boxes anew, and what is below them: `below` begins with the children of the first of them that has inner ones, and is node `at`. The box of all; none if the nodes lie
/// otherwise.
fn group(siblings: &mut [Line], below: &mut [Line], at: usize, leaf: &(impl Fn(u32, u32) -> Box32 + Sync)) -> Option<[Box32; 4]> {
    let all: Vec<[Child; 4]> = siblings.iter().map(children).collect();
    let first_inner = |of: &[Child; 4]| of.iter().filter_map(inner).min();
    // What is below each of them, and the number of its first node.
    let mut parts = Vec::with_capacity(4);
    let (mut rest, mut from) = (below, at);
    for (k, of) in all.iter().enumerate() {
        let next = match first_inner(of) {
            None => from,
            Some(first) if first == from => all[k + 1..].iter().find_map(first_inner).unwrap_or(from + rest.len()),
            Some(_) => return None,
        };
        if next < from || next - from > rest.len() {
            return None;
        }
        let (own, others) = std::mem::take(&mut rest).split_at_mut(next - from);
        parts.push((own, from));
        (rest, from) = (others, next);
    }
    if !rest.is_empty() {
        return None;
    }
    let is_large = from - at > TASK;
    let work: Vec<_> = siblings.iter_mut().zip(&all).zip(parts).collect();
    let done: Vec<Option<Box32>> = if is_large {
        work.into_par_iter().map(|((line, of), (own, first))| node(line, of, own, first, leaf)).collect()
    } else {
        work.into_iter().map(|((line, of), (own, first))| node(line, of, own, first, leaf)).collect()
    };
    let mut boxes = [Box32::default(); 4];
    for (to, found) in boxes.iter_mut().zip(done) {
        *to = found?;
    }
    Some(boxes)
}

/// A node with boxes anew; `own` is everything below it. Its box, none if what is below lies otherwise.
fn node(line: &mut Line, of: &[Child; 4], own: &mut [Line], first: usize, leaf: &(impl Fn(u32, u32) -> Box32 + Sync)) -> Option<Box32> {
    let count = of.iter().filter(|c| matches!(c, Child::Inner(_))).count();
    if count > own.len() {
        return None;
    }
    let (inner, below) = own.split_at_mut(count);
    let boxes = if count == 0 { [Box32::default(); 4] } else { group(inner, below, first + count, leaf)? };
    let mut of_children = [Box32::default(); 4];
    let mut next = 0;
    for (to, child) in of_children.iter_mut().zip(of) {
        *to = match *child {
            Child::Empty => continue,
            Child::Leaf { first, count } => leaf(first, u32::from(count)),
            Child::Inner(index) if index as usize == first + next => {
                next += 1;
                boxes[next - 1]
            }
            Child::Inner(_) => return None,
        };
    }
    Some(write(line, of, of_children))
}

/// Writes a node with these boxes of its children, and gives the box of all.
fn write(line: &mut Line, children: &[Child; 4], boxes: [Box32; 4]) -> Box32 {
    *line = encode_line(&QuadNode { boxes, children: *children });
    let used = boxes.iter().zip(children).filter(|(_, child)| **child != Child::Empty).map(|(b, _)| *b);
    used.reduce(|a, b| a.union(&b)).unwrap_or_default()
}

/// All nodes, each after those below it, in whatever order they lie.
fn in_turn(nodes: &[Line], leaf: &impl Fn(u32, u32) -> Box32) -> Vec<Line> {
    // Parents before children.
    let mut order = vec![0];
    let mut at = 0;
    while at < order.len() {
        order.extend(children(&nodes[order[at]]).iter().filter_map(inner));
        at += 1;
    }
    let mut out = nodes.to_vec();
    let mut own = vec![Box32::default(); nodes.len()];
    for &at in order.iter().rev() {
        let of = children(&nodes[at]);
        let boxes = of.map(|child| match child {
            Child::Empty => Box32::default(),
            Child::Leaf { first, count } => leaf(first, u32::from(count)),
            Child::Inner(index) => own[index as usize],
        });
        own[at] = write(&mut out[at], &of, boxes);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::{Options, build};
    use crate::num::random::Random;

    fn boxes(count: usize, seed: u64, spread: i32) -> Vec<Box32> {
        let mut random = Random::new(seed);
        let mut coordinate = |within: i32| (random.below(2 * within as u64 + 1) as i64 - i64::from(within)) as i32;
        (0..count)
            .map(|_| {
                let (a, b) = ([0; 3].map(|_| coordinate(spread)), [0; 3].map(|_| coordinate(spread / 16)));
                let pick = |f: fn(i32, i32) -> i32| std::array::from_fn(|k| f(a[k], a[k] / 2 + b[k]));
                Box32 { lo: pick(i32::min), hi: pick(i32::max) }
            })
            .collect()
    }

    fn fitted(nodes: &[Line], order: &[u32], boxes: &[Box32]) -> Vec<Line> {
        refit(nodes, &|first, count| {
            let own = order[first as usize..][..count as usize].iter().map(|&k| boxes[k as usize]);
            own.reduce(|a, b| a.union(&b)).unwrap()
        })
    }

    #[test]
    fn the_same_boxes_give_the_same_nodes() {
        for (count, leaf) in [(1, 1), (2, 1), (5, 2), (300, 1), (20_000, 4)] {
            let own = boxes(count, 1, 1 << 30);
            let tree = build(&own, &Options::with_leaf(leaf)).unwrap().side_by_side();
            let nodes: Vec<Line> = tree.nodes.iter().map(encode_line).collect();
            assert_eq!(fitted(&nodes, &tree.order, &own), nodes, "{count}");
        }
    }

    #[test]
    fn other_boxes_give_what_encoding_them_gives_in_any_order_of_nodes() {
        let (before, after) = (boxes(9_000, 1, 1 << 30), boxes(9_000, 2, 1 << 22));
        let tree = build(&before, &Options::with_leaf(4)).unwrap().side_by_side();
        let nodes: Vec<Line> = tree.nodes.iter().map(encode_line).collect();
        // By a walk of its own, over boxes of whole subtrees.
        fn below(tree: &crate::bvh::QuadTree, at: usize, boxes: &[Box32]) -> Vec<Box32> {
            let of = |child: &Child| match *child {
                Child::Empty => Vec::new(),
                Child::Inner(index) => below(tree, index as usize, boxes),
                Child::Leaf { first, count } => tree.order[first as usize..][..count.into()].iter().map(|&k| boxes[k as usize]).collect(),
            };
            tree.nodes[at].children.iter().flat_map(of).collect()
        }
        let moved: Vec<QuadNode> = tree
            .nodes
            .iter()
            .map(|node| {
                let of = |child: &Child| {
                    let own = match *child {
                        Child::Empty => return Box32::default(),
                        Child::Inner(index) => below(&tree, index as usize, &after),
                        Child::Leaf { first, count } => {
                            tree.order[first as usize..][..count.into()].iter().map(|&k| after[k as usize]).collect()
                        }
                    };
                    own.into_iter().reduce(|a, b| a.union(&b)).unwrap()
                };
                QuadNode { boxes: node.children.each_ref().map(of), children: node.children }
            })
            .collect();
        let wanted: Vec<Line> = moved.iter().map(encode_line).collect();
        assert_eq!(fitted(&nodes, &tree.order, &after), wanted);

        // The root's children moved to the end: one after the other.
        let count = tree.nodes[0].children.iter().filter(|c| matches!(c, Child::Inner(_))).count();
        let to = |index: u32| if (index as usize) <= count { index as usize + nodes.len() - 1 - count } else { index as usize - count };
        let place = |at: usize| if at == 0 { 0 } else { to(at as u32) };
        let shuffled = |nodes: &[QuadNode]| {
            let mut out = vec![[0; 4]; nodes.len()];
            for (at, node) in nodes.iter().enumerate() {
                let children = node.children.map(|c| if let Child::Inner(index) = c { Child::Inner(to(index) as u32) } else { c });
                out[place(at)] = encode_line(&QuadNode { children, ..*node });
            }
            out
        };
        assert_eq!(fitted(&shuffled(&tree.nodes), &tree.order, &after), shuffled(&moved));
    }
}
