//! A binary BVH by the surface area heuristic with 256 bins, depth first (paper section 3.1): the left child of a node follows it, the right one follows all below the left.
//!
//! Costs are in `f32`, a heuristic; boxes are whole. Equal costs go to the lower axis, then the lower border. The result does not depend on the number of threads.

use crate::bvh::Box32;
use rayon::prelude::*;

/// Bins along each axis.
const BINS: usize = 256;
/// Nodes below this depth are split in halves, so that no path is longer than this and 28 more.
const MOST_DEPTH: u32 = 48;
/// Subtrees above this size are worked on by two threads.
const PARALLEL: usize = 1 << 12;

/// A node: 28 of the 32 bytes of its line.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PairNode {
    /// Box of all below it.
    pub bounds: Box32,
    /// How many nodes lie below its left child, with that child: its right child comes behind them. 0 of a leaf.
    pub skip: u32,
    /// The primitive of a leaf, by its place in leaf order; it follows from the skips.
    pub leaf: u32,
}

/// Nodes over these boxes, at least one, and the boxes in leaf order.
pub fn pairs(boxes: &[Box32]) -> (Vec<PairNode>, Vec<u32>) {
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect(); // at most 2^28
    let mut nodes = vec![PairNode::default(); 2 * boxes.len() - 1];
    subtree(boxes, &mut order, &mut nodes, 0, 0);
    (nodes, order)
}

/// `first`: the place of the first of `order` in leaf order.
fn subtree(boxes: &[Box32], order: &mut [u32], nodes: &mut [PairNode], first: u32, depth: u32) -> Box32 {
    if let [one] = order {
        let bounds = boxes[*one as usize];
        nodes[0] = PairNode { bounds, skip: 0, leaf: first };
        return bounds;
    }
    let middle = if depth < MOST_DEPTH { split(boxes, order) } else { order.len() / 2 };
    let count = order.len();
    let (left, right) = order.split_at_mut(middle);
    let (node, below) = nodes.split_at_mut(1);
    let (of_left, of_right) = below.split_at_mut(2 * middle - 1);
    let skip = of_left.len() as u32; // below 2^29
    let mut a = || subtree(boxes, left, of_left, first, depth + 1);
    let mut b = || subtree(boxes, right, of_right, first + middle as u32, depth + 1);
    let (a, b) = if count > PARALLEL { rayon::join(a, b) } else { (a(), b()) };
    let bounds = a.union(&b);
    node[0] = PairNode { bounds, skip, leaf: first };
    bounds
}

/// Twice the middle of a box along an axis.
fn middle(of: &Box32, axis: usize) -> i64 {
    i64::from(of.lo[axis]) + i64::from(of.hi[axis])
}

/// Boxes and number of what falls into a bin.
type Bin = (Option<Box32>, u32);

fn grown(bin: Bin, other: Bin) -> Bin {
    let bounds = match (bin.0, other.0) {
        (Some(a), Some(b)) => Some(a.union(&b)),
        (a, b) => a.or(b),
    };
    (bounds, bin.1 + other.1)
}

/// Cost of a part: its area for each of its boxes.
fn cost((bounds, count): Bin) -> f32 {
    bounds.map_or(0.0, |bounds| bounds.half_area() as f32) * count as f32
}

/// Ranges up to this size are looked through box by box, as most bins would be empty.
const FEW: usize = 64;

/// Boxes in bins along the range of their middles.
struct Bins<'a> {
    boxes: &'a [Box32],
    ranges: [(i64, i64); 3],
}

impl<'a> Bins<'a> {
    fn new(boxes: &'a [Box32], order: &[u32]) -> Self {
        let range = |axis: usize| {
            let middles = order.iter().map(|&k| middle(&boxes[k as usize], axis));
            middles.fold((i64::MAX, i64::MIN), |(lo, hi), m| (lo.min(m), hi.max(m)))
        };
        Self { boxes, ranges: std::array::from_fn(range) }
    }

    fn of(&self, k: u32, axis: usize) -> usize {
        let (lo, hi) = self.ranges[axis];
        // Differences are below 2^33, so their product with 256 fits.
        ((middle(&self.boxes[k as usize], axis) - lo) * BINS as i64 / (hi - lo + 1)) as usize
    }

    /// The cheapest border, as (cost, axis, first bin behind it); none if all are in one bin.
    fn best(&self, order: &[u32]) -> Option<(f32, usize, usize)> {
        let filled = |own: &[u32]| {
            let mut bins = vec![[(None, 0); BINS]; 3];
            for &k in own {
                for (axis, bins) in bins.iter_mut().enumerate() {
                    let at = &mut bins[self.of(k, axis)];
                    *at = grown(*at, (Some(self.boxes[k as usize]), 1));
                }
            }
            bins
        };
        let joined = |mut a: Vec<[Bin; BINS]>, b: Vec<[Bin; BINS]>| {
            a.iter_mut().flatten().zip(b.into_iter().flatten()).for_each(|(a, b)| *a = grown(*a, b));
            a
        };
        // Unions and counts do not depend on the order in which threads deliver them.
        let bins = if order.len() > PARALLEL {
            order.par_chunks(PARALLEL).map(filled).reduce(|| vec![[(None, 0); BINS]; 3], joined)
        } else {
            filled(order)
        };
        let mut best: Option<(f32, usize, usize)> = None;
        for (axis, bins) in bins.iter().enumerate() {
            let mut above = [0.0; BINS];
            let mut behind = (None, 0);
            for at in (1..BINS).rev() {
                behind = grown(behind, bins[at]);
                above[at] = cost(behind);
            }
            let mut before = (None, 0);
            for at in 1..BINS {
                before = grown(before, bins[at - 1]);
                let total = cost(before) + above[at];
                let parts = before.1 > 0 && (before.1 as usize) < order.len();
                if parts && best.is_none_or(|(least, ..)| total < least) {
                    best = Some((total, axis, at));
                }
            }
        }
        best
    }

    /// The same of [`FEW`] boxes at most: in the order of their bins.
    fn best_of_few(&self, order: &[u32]) -> Option<(f32, usize, usize)> {
        let count = order.len();
        let mut best: Option<(f32, usize, usize)> = None;
        let mut sorted = [(0, Box32::default()); FEW];
        let mut above = [0.0; FEW];
        for axis in 0..3 {
            let sorted = &mut sorted[..count];
            sorted.iter_mut().zip(order).for_each(|(to, &k)| *to = (self.of(k, axis), self.boxes[k as usize]));
            sorted.sort_unstable_by_key(|of| of.0);
            let mut behind = (None, 0);
            for at in (1..count).rev() {
                behind = grown(behind, (Some(sorted[at].1), 1));
                above[at] = cost(behind);
            }
            let mut before = (None, 0);
            for at in 1..count {
                before = grown(before, (Some(sorted[at - 1].1), 1));
                let total = cost(before) + above[at];
                let parts = sorted[at - 1].0 < sorted[at].0;
                if parts && best.is_none_or(|(least, ..)| total < least) {
                    best = Some((total, axis, sorted[at - 1].0 + 1));
                }
            }
        }
        best
    }
}

/// Puts the boxes, at least two, into two parts; gives the size of the first.
fn split(boxes: &[Box32], order: &mut [u32]) -> usize {
    let bins = Bins::new(boxes, order);
    let best = if order.len() <= FEW { bins.best_of_few(order) } else { bins.best(order) };
    // All middles are one: any halves do.
    let Some((_, axis, border)) = best else { return order.len() / 2 };
    order.sort_by_key(|&k| bins.of(k, axis) >= border);
    order.partition_point(|&k| bins.of(k, axis) < border)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Random;

    fn check(nodes: &[PairNode], at: usize, boxes: &[Box32], order: &[u32], next: &mut u32, depth: u32) -> (Box32, usize) {
        let node = nodes[at];
        assert!(depth <= MOST_DEPTH + 28);
        if node.skip == 0 {
            assert_eq!(node.leaf, *next);
            *next += 1;
            assert_eq!(node.bounds, boxes[order[node.leaf as usize] as usize]);
            return (node.bounds, 1);
        }
        let (left, below) = check(nodes, at + 1, boxes, order, next, depth + 1);
        assert_eq!(below, node.skip as usize);
        let (right, behind) = check(nodes, at + 1 + below, boxes, order, next, depth + 1);
        assert_eq!(node.bounds, left.union(&right));
        (node.bounds, 1 + below + behind)
    }

    #[test]
    fn few_boxes_are_split_as_many_are() {
        let mut random = Random::of(1, 2);
        for _ in 0..2_000 {
            let count = 2 + random.below(FEW as u64 - 1);
            let bits = 1 + random.below(28);
            let boxes: Vec<Box32> = (0..count)
                .map(|_| {
                    let lo = [(); 3].map(|()| random.within(1 << bits) as i32);
                    Box32 { lo, hi: lo.map(|c| c + random.below(1 << 20) as i32) }
                })
                .collect();
            let order: Vec<u32> = (0..count as u32).collect();
            let bins = Bins::new(&boxes, &order);
            assert_eq!(bins.best_of_few(&order), bins.best(&order), "{boxes:?}");
        }
    }

    #[test]
    fn every_box_is_a_leaf_and_nodes_lie_depth_first() {
        for count in [1, 2, 3, 17, 1000, 9000] {
            for kind in 0..3u64 {
                let mut random = Random::of(kind, count);
                let boxes: Vec<Box32> = (0..count)
                    .map(|k| {
                        let lo: [i32; 3] = match kind {
                            0 => [(); 3].map(|()| random.within(1 << 28) as i32),
                            1 => [7, 7, 7],
                            // Each as far as all before together: a list, where nothing holds it back.
                            _ => [1 << (k % 30), 0, 0],
                        };
                        Box32 { lo, hi: lo.map(|c| c + random.below(1 << 20) as i32) }
                    })
                    .collect();
                let (nodes, order) = pairs(&boxes);
                let mut sorted = order.clone();
                sorted.sort_unstable();
                assert_eq!(sorted, (0..count as u32).collect::<Vec<_>>());
                assert_eq!(check(&nodes, 0, &boxes, &order, &mut 0, 0).1, nodes.len());
            }
        }
    }
}
