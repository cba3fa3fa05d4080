//! How the binary tree is best collapsed to nodes of `W` children: bottom-up, the cheapest way to put each subtree into 1 to `W` - 1 slots.

use super::build::{Binary, Node, PARALLEL, Prim};

/// The cheapest way to put a subtree into a stated number of slots.
#[derive(Clone, Copy, Debug)]
pub(super) struct Plan<const W: usize> {
    /// At 0, for one slot: 0 for a leaf; else it is a node, with this many of its `W` slots for the lower half. At k, for k + 1 slots: those of the lower half,
    /// or 0 for as in k.
    lower: [u8; W],
}

impl<const W: usize> Plan<W> {
    /// In one slot: as a leaf.
    pub fn is_leaf(&self) -> bool {
        self.lower[0] == 0
    }

    /// Slots for the lower half of a node, where the subtree has one slot; else of so many slots, or 0 if one fewer do as well.
    pub fn lower(&self, slots: usize) -> usize {
        usize::from(self.lower[slots - 1])
    }
}

/// What a leaf of some primitives costs for each unit of its area; none if they may not be one, which one primitive may.
pub(crate) type LeafCost<'a> = dyn Fn(&[Prim]) -> Option<f64> + Sync + 'a;

/// Least cost in 1 to `W` - 1 slots, times area; the last is not used.
type Cost<const W: usize> = [f64; W];

/// The plan of every node of `tree` over `prims`, and the least cost of all, times area.
pub(super) fn plans<const W: usize>(prims: &[Prim], tree: &Binary, node_cost: f64, leaf: &LeafCost<'_>) -> (Vec<Plan<W>>, f64) {
    let mut plans = vec![Plan { lower: [0; W] }; tree.nodes.len()];
    let cost = subtree(prims, &tree.nodes, &mut plans, (0, tree.root), node_cost, leaf);
    (plans, cost[0])
}

/// `begin`: position of the first of `prims` in the whole; `split`: where they are split, if they are several.
fn subtree<const W: usize>(
    prims: &[Prim],
    nodes: &[Node],
    plans: &mut [Plan<W>],
    (begin, split): (u32, u32),
    node_cost: f64,
    leaf: &LeafCost<'_>,
) -> Cost<W> {
    if let [p] = prims {
        // One primitive may always be a leaf.
        return [p.bounds().half_area() * leaf(prims).unwrap_or(node_cost); W];
    }
    let count = prims.len();
    let mid = (split - begin) as usize;
    let (lower, upper) = prims.split_at(mid);
    let node = &nodes[mid - 1];
    let (lower_plans, rest) = plans.split_at_mut(mid - 1);
    let (own, upper_plans) = rest.split_at_mut(1);
    let mut left = || subtree(lower, &nodes[..mid - 1], lower_plans, (begin, node.left), node_cost, leaf);
    let mut right = || subtree(upper, &nodes[mid..], upper_plans, (split, node.right), node_cost, leaf);
    let (l, r) = if count > PARALLEL { rayon::join(left, right) } else { (left(), right()) };
    let (plan, cost) = plan(&l, &r, node.bounds.half_area(), node_cost, leaf(prims));
    own[0] = plan;
    cost
}

/// The cheapest use of two halves with these costs; `leaf` is the cost of both as a leaf, if they may be one.
#[inline]
fn plan<const W: usize>(l: &Cost<W>, r: &Cost<W>, area: f64, node_cost: f64, leaf: Option<f64>) -> (Plan<W>, Cost<W>) {
    // Of so many slots: those of the lower half, and the cost of both.
    let apart = |slots: usize| {
        let mut best = (1, l[0] + r[slots - 2]);
        for lower in 2..slots {
            let cost = l[lower - 1] + r[slots - lower - 1];
            if cost < best.1 {
                best = (lower, cost);
            }
        }
        best
    };
    let (slots, below) = apart(W);
    let one = area * node_cost + below;
    // Equal costs: the leaf, which saves a node.
    let as_leaf = leaf.map(|cost| area * cost).filter(|&cost| cost <= one);
    let mut plan = Plan { lower: [0; W] };
    plan.lower[0] = if as_leaf.is_some() { 0 } else { slots as u8 }; // at most W
    let mut cost = [as_leaf.unwrap_or(one); W];
    for slots in 2..W {
        let (lower, below) = apart(slots);
        cost[slots - 1] = cost[slots - 2];
        if below < cost[slots - 1] {
            (plan.lower[slots - 1], cost[slots - 1]) = (lower as u8, below); // at most W
        }
    }
    (plan, cost)
}
