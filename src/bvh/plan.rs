//! How the binary tree is best collapsed: bottom-up, the cheapest way to put each subtree into one, two and three slots.

use super::build::{Binary, Node, PARALLEL, Prim};

/// The cheapest way to put a subtree into a stated number of slots.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Plan {
    /// In one slot: 0 for a leaf; else it is a node, with this many of its four slots (1 to 3) for the lower half.
    pub one: u8,
    /// In three slots: those of the lower half (1 or 2), or 0 for as in two.
    pub three: u8,
    /// In two slots: one for each half; else as in one.
    pub two: bool,
}

/// What a leaf of some primitives costs for each unit of its area; none if they may not be one, which one primitive may.
pub(crate) type LeafCost<'a> = dyn Fn(&[Prim]) -> Option<f64> + Sync + 'a;

/// Least cost in 1, 2 and 3 slots, times area.
type Cost = [f64; 3];

/// The plan of every node of `tree` over `prims`.
pub(super) fn plans(prims: &[Prim], tree: &Binary, node_cost: f64, leaf: &LeafCost<'_>) -> Vec<Plan> {
    let mut plans = vec![Plan::default(); tree.nodes.len()];
    subtree(prims, &tree.nodes, &mut plans, (0, tree.root), node_cost, leaf);
    plans
}

/// `begin`: position of the first of `prims` in the whole; `split`: where they are split, if they are several.
fn subtree(prims: &[Prim], nodes: &[Node], plans: &mut [Plan], (begin, split): (u32, u32), node_cost: f64, leaf: &LeafCost<'_>) -> Cost {
    if let [p] = prims {
        // One primitive may always be a leaf.
        return [p.bounds().half_area() * leaf(prims).unwrap_or(node_cost); 3];
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
fn plan(l: &Cost, r: &Cost, area: f64, node_cost: f64, leaf: Option<f64>) -> (Plan, Cost) {
    let mut four = (1, l[0] + r[2]);
    for (slots, cost) in [(2, l[1] + r[1]), (3, l[2] + r[0])] {
        if cost < four.1 {
            four = (slots, cost);
        }
    }
    let mut one = area * node_cost + four.1;
    // Equal costs: the leaf, which saves a node.
    let as_leaf = leaf.map(|cost| area * cost).filter(|&cost| cost <= one);
    one = as_leaf.unwrap_or(one);
    let two = l[0] + r[0];
    let split_two = two < one;
    let two = if split_two { two } else { one };
    let mut three = (0, two);
    for (slots, cost) in [(1, l[0] + r[1]), (2, l[1] + r[0])] {
        if cost < three.1 {
            three = (slots, cost);
        }
    }
    (Plan { one: if as_leaf.is_some() { 0 } else { four.0 }, three: three.0, two: split_two }, [one, two, three.1])
}
