//! The kd-tree by the surface area heuristic (paper section 6.1): triangles are clipped to cells exactly, and empty space is cut off by splits of its own.
//!
//! Splits are whole units. A triangle whose part of a cell ends at a split lies on that side alone; one that lies within the split lies on its lower side. Where many triangles are left, 256
//! places on each axis are tried; where few, every end of a part.

use super::clip::part;
use crate::bvh::Box32;
use rayon::prelude::*;

/// Most splits on a path. More than twice what 2^28 triangles need.
pub const MAX_DEPTH: u32 = 64;

/// Places that are tried on each axis where many triangles are left.
const BINS: usize = 256;
/// Triangles down to which they are.
const MANY: usize = 4096;
/// Triangles down to which both sides of a split are built side by side.
const ALONE: usize = 1 << 14;

/// What the heuristic weighs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Costs {
    /// A visit of an inner node.
    pub node: f64,
    /// A triangle of a leaf.
    pub triangle: f64,
    /// Share that a split saves which leaves one side empty.
    pub empty: f64,
    /// Share of a side of a cell from which on empty space is cut off, whatever the heuristic says.
    pub cut: f64,
}

/// As swept in docs/baselines.md ("R-LODs").
pub const COSTS: Costs = Costs { node: 4.0, triangle: 1.0, empty: 0.2, cut: 0.3 };

/// A node, with its left subtree behind it and the right one behind that.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Raw {
    /// Split at `at` along `axis`; the right child is so many nodes behind.
    Inner {
        /// 0 to 2.
        axis: u8,
        /// In units.
        at: i32,
        /// Nodes from this one to its right child.
        skip: u32,
    },
    /// So many triangles, whose numbers come next.
    Leaf(u32),
}

/// A tree depth first.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct RawTree {
    /// Nodes.
    pub nodes: Vec<Raw>,
    /// Triangles of all leaves, in their order.
    pub references: Vec<u32>,
}

/// A triangle's part of a cell.
#[derive(Clone, Copy, Debug)]
struct Part {
    id: u32,
    bounds: Box32,
}

impl Part {
    /// It has something below a split.
    #[inline(always)]
    fn is_left(&self, axis: usize, at: i32) -> bool {
        self.least(axis) < at
    }

    /// It has something above a split.
    #[inline(always)]
    fn is_right(&self, axis: usize, at: i32) -> bool {
        self.bounds.hi[axis] > at
    }

    /// What is flat lies below a split through it.
    #[inline(always)]
    fn least(&self, axis: usize) -> i32 {
        self.bounds.lo[axis].min(self.bounds.hi[axis].saturating_sub(1))
    }
}

/// A split, and what the heuristic says of it.
#[derive(Clone, Copy, Debug)]
struct Split {
    axis: usize,
    at: i32,
    cost: f64,
}

/// What is below a cell.
struct Builder<'a> {
    triangles: &'a [[[i32; 3]; 3]],
    costs: Costs,
}

/// The kd-tree of `triangles` in a cell that holds them all.
pub fn kd_tree(triangles: &[[[i32; 3]; 3]], cell: &Box32, costs: Costs) -> RawTree {
    // At most 2^28 triangles.
    let part = |(id, &triangle): (usize, _)| Part { id: id as u32, bounds: Box32::of_triangle(triangle) };
    let parts = triangles.par_iter().enumerate().map(part).collect();
    let mut tree = RawTree::default();
    Builder { triangles, costs }.below(parts, *cell, 0, &mut tree);
    tree
}

impl Builder<'_> {
    /// Appends what is below a cell.
    fn below(&self, parts: Vec<Part>, cell: Box32, depth: u32, tree: &mut RawTree) {
        let split = if depth < MAX_DEPTH { self.empty(&parts, &cell).or_else(|| self.best(&parts, &cell)) } else { None };
        let Some((axis, at)) = split else {
            tree.nodes.push(Raw::Leaf(parts.len() as u32)); // at most 2^28
            tree.references.extend(parts.iter().map(|part| part.id));
            return;
        };
        let parts_count = parts.len();
        let cells = halves(&cell, axis, at);
        let [left, right] = self.sides(&parts, axis, at, &cells);
        drop(parts);
        let own = tree.nodes.len();
        let inner = |skip| Raw::Inner { axis: axis as u8, at, skip };
        tree.nodes.push(inner(0));
        // `Tree::new` refuses more nodes than fit.
        if parts_count <= ALONE {
            self.below(left, cells[0], depth + 1, tree);
            tree.nodes[own] = inner((tree.nodes.len() - own) as u32);
            self.below(right, cells[1], depth + 1, tree);
        } else {
            let mut other = RawTree::default();
            rayon::join(|| self.below(left, cells[0], depth + 1, tree), || self.below(right, cells[1], depth + 1, &mut other));
            tree.nodes[own] = inner((tree.nodes.len() - own) as u32);
            tree.nodes.append(&mut other.nodes);
            tree.references.append(&mut other.references);
        }
    }

    /// A split that cuts off empty space, where there is much along some axis.
    fn empty(&self, parts: &[Part], cell: &Box32) -> Option<(usize, i32)> {
        let bounds = parts.iter().map(|part| part.bounds).reduce(|all, own| all.union(&own))?;
        let mut best = (self.costs.cut, None);
        for axis in 0..3 {
            let (lo, hi) = (i64::from(cell.lo[axis]), i64::from(cell.hi[axis]));
            // What is flat lies below a split through it, so the lower split is a unit below all.
            for at in [i64::from(bounds.lo[axis]) - 1, i64::from(bounds.hi[axis])] {
                let gap = if at < i64::from(bounds.hi[axis]) { at - lo } else { hi - at };
                let share = gap as f64 / (hi - lo).max(1) as f64;
                if at > lo && at < hi && share > best.0 {
                    best = (share, Some((axis, at as i32))); // between two of 32 bits
                }
            }
        }
        best.1
    }

    /// The best split, if one is better than a leaf.
    fn best(&self, parts: &[Part], cell: &Box32) -> Option<(usize, i32)> {
        let most = self.costs.triangle * parts.len() as f64;
        let best = if parts.len() > MANY { self.of_bins(parts, cell) } else { self.of_ends(parts, cell) }?;
        (best.cost < most).then_some((best.axis, best.at))
    }

    /// What the heuristic says of a split with so many triangles on its sides.
    fn cost(&self, cell: &Box32, axis: usize, at: i32, counts: [usize; 2]) -> f64 {
        let whole = cell.half_area();
        let shares = halves(cell, axis, at).map(|half| half.half_area() / whole);
        let saved = if counts.contains(&0) { 1.0 - self.costs.empty } else { 1.0 };
        self.costs.node + saved * self.costs.triangle * (shares[0] * counts[0] as f64 + shares[1] * counts[1] as f64)
    }

    /// The best of places that are as far from each other.
    fn of_bins(&self, parts: &[Part], cell: &Box32) -> Option<Split> {
        type Counts = [[[u32; 2]; BINS]; 3];
        let side = |axis: usize| i64::from(cell.hi[axis]) - i64::from(cell.lo[axis]);
        let bin = |axis: usize, at: i32| {
            let beyond = (i64::from(at) - i64::from(cell.lo[axis])).max(0);
            ((beyond * BINS as i64 / side(axis).max(1)) as usize).min(BINS - 1)
        };
        let count = |mut counts: Box<Counts>, part: &Part| {
            for axis in 0..3 {
                counts[axis][bin(axis, part.least(axis))][0] += 1;
                counts[axis][bin(axis, part.bounds.hi[axis].saturating_sub(1))][1] += 1;
            }
            counts
        };
        let none = || Box::new([[[0; 2]; BINS]; 3]);
        let add = |mut a: Box<Counts>, b: Box<Counts>| {
            a.as_flattened_mut().as_flattened_mut().iter_mut().zip(b.as_flattened().as_flattened()).for_each(|(a, b)| *a += b);
            a
        };
        let counts = if parts.len() > ALONE {
            parts.par_chunks(ALONE).map(|chunk| chunk.iter().fold(none(), count)).reduce(none, add)
        } else {
            parts.iter().fold(none(), count)
        };
        let mut best: Option<Split> = None;
        for axis in 0..3 {
            if side(axis) < 2 * BINS as i64 {
                continue;
            }
            let [mut left, mut right] = [0, parts.len()];
            for k in 1..BINS {
                left += counts[axis][k - 1][0] as usize;
                right -= counts[axis][k - 1][1] as usize;
                // The first unit of the bin: what begins below it has a lower bin, and so has what ends at it.
                let at = (i64::from(cell.lo[axis]) + (k as i64 * side(axis) + BINS as i64 - 1) / BINS as i64) as i32; // within the cell
                let cost = self.cost(cell, axis, at, [left, right]);
                if best.is_none_or(|best| cost < best.cost) {
                    best = Some(Split { axis, at, cost });
                }
            }
        }
        best.or_else(|| self.of_ends(parts, cell))
    }

    /// The best of all places at which a part begins or ends.
    fn of_ends(&self, parts: &[Part], cell: &Box32) -> Option<Split> {
        let mut best: Option<Split> = None;
        let (mut begins, mut ends) = (Vec::with_capacity(parts.len()), Vec::with_capacity(parts.len()));
        for axis in 0..3 {
            begins.clear();
            ends.clear();
            begins.extend(parts.iter().map(|part| part.least(axis)));
            ends.extend(parts.iter().map(|part| part.bounds.hi[axis]));
            begins.sort_unstable();
            ends.sort_unstable();
            let (mut begun, mut ended) = (0, 0);
            loop {
                // The next place in order: where a part begins above what is flat, or ends.
                let next = match (begins.get(begun), ends.get(ended)) {
                    (Some(&begin), Some(&end)) => begin.min(end),
                    (None, Some(&end)) => end,
                    _ => break,
                };
                while ends.get(ended).is_some_and(|&end| end <= next) {
                    ended += 1;
                }
                if next > cell.lo[axis] && next < cell.hi[axis] {
                    let cost = self.cost(cell, axis, next, [begun, parts.len() - ended]);
                    if best.is_none_or(|best| cost < best.cost) {
                        best = Some(Split { axis, at: next, cost });
                    }
                }
                while begins.get(begun).is_some_and(|&begin| begin <= next) {
                    begun += 1;
                }
            }
        }
        best
    }

    /// What lies on both sides of a split.
    fn sides(&self, parts: &[Part], axis: usize, at: i32, cells: &[Box32; 2]) -> [Vec<Part>; 2] {
        let mut sides = [Vec::new(), Vec::new()];
        for whole in parts {
            match [whole.is_left(axis, at), whole.is_right(axis, at)] {
                [true, true] => {
                    for (side, cell) in sides.iter_mut().zip(cells) {
                        side.extend(part(&self.triangles[whole.id as usize], cell).map(|bounds| Part { bounds, ..*whole }));
                    }
                }
                [is_left, _] => sides[usize::from(!is_left)].push(*whole),
            }
        }
        sides
    }
}

/// A cell's halves.
pub fn halves(cell: &Box32, axis: usize, at: i32) -> [Box32; 2] {
    let mut both = [*cell; 2];
    (both[0].hi[axis], both[1].lo[axis]) = (at, at);
    both
}
