//! From the binary tree to nodes of `W` children, four or more, in the memory order that [`super::WideTree`] states.
//!
//! Depth: a subtree of binary height h fits h / 2 nodes (rounded up) on a path, by opening both halves of every node. Any other
//! choice of children is taken only if each child still fits what then remains, so the bound holds whatever the costs say.

use super::build::{Binary, Node, Prim};
use super::plan::{LeafCost, Plan, plans};
use super::{Box32, Child, Collapse, Options, WideNode};
use rayon::prelude::*;

/// Subtrees up to this many primitives are written by one thread.
const TASK: u32 = 1 << 16;

/// The binary tree to read.
pub(crate) struct BinaryTree<'a, const W: usize> {
    prims: &'a [Prim],
    tree: &'a Binary,
    plans: Vec<Plan<W>>,
    cost: f64,
    collapse: Collapse,
    leaf: &'a LeafCost<'a>,
}

/// A subtree: the primitives `begin..end`, split at `split` if there are several.
#[derive(Clone, Copy, Default)]
struct Part {
    begin: u32,
    end: u32,
    split: u32,
}

/// Up to `W` children.
#[derive(Clone, Copy)]
struct Parts<const W: usize> {
    parts: [Part; W],
    len: usize,
}

impl<const W: usize> Default for Parts<W> {
    fn default() -> Self {
        Self { parts: [Part::default(); W], len: 0 }
    }
}

impl<const W: usize> Parts<W> {
    fn push(&mut self, p: Part) {
        self.parts[self.len] = p;
        self.len += 1;
    }

    fn as_slice(&self) -> &[Part] {
        &self.parts[..self.len]
    }
}

impl<'a, const W: usize> BinaryTree<'a, W> {
    pub fn new(prims: &'a [Prim], tree: &'a Binary, options: &Options, leaf: &'a LeafCost<'a>) -> Self {
        let (plans, cost) = plans(prims, tree, options.costs.node, leaf);
        Self { prims, tree, plans, cost, collapse: options.collapse, leaf }
    }

    /// Expected cost of a ray that meets the root's box, by the surface area heuristic, of the optimal collapse; a root without area counts as 1.
    pub fn cost(&self) -> f64 {
        let area = self.bounds(self.whole()).half_area();
        if area > 0.0 { self.cost / area } else { self.cost }
    }

    fn whole(&self) -> Part {
        Part { begin: 0, end: self.prims.len() as u32, split: self.tree.root } // at most 2^28
    }

    /// The node of a subtree of at least two primitives.
    fn node(&self, p: Part) -> &'a Node {
        &self.tree.nodes[p.split as usize - 1]
    }

    /// How the subtree of a node is best collapsed.
    fn plan(&self, p: Part) -> Plan<W> {
        self.plans[p.split as usize - 1]
    }

    fn halves(&self, p: Part) -> [Part; 2] {
        let n = self.node(p);
        [Part { begin: p.begin, end: p.split, split: n.left }, Part { begin: p.split, end: p.end, split: n.right }]
    }

    fn is_leaf(&self, p: Part) -> bool {
        let count = p.end - p.begin;
        count == 1
            || match self.collapse {
                Collapse::Optimal => self.plan(p).is_leaf(),
                Collapse::Greedy => (self.leaf)(&self.prims[p.begin as usize..p.end as usize]).is_some(),
            }
    }

    fn bounds(&self, p: Part) -> Box32 {
        if p.end - p.begin == 1 { self.prims[p.begin as usize].bounds() } else { self.node(p).bounds }
    }

    /// The children of a node over `p`; `depth` nodes may stand on a path from it, itself included.
    fn children(&self, p: Part, depth: u32) -> Parts<W> {
        let mut out = Parts::default();
        if self.is_leaf(p) {
            out.push(p); // only the root
            return out;
        }
        let [l, r] = self.halves(p);
        match self.collapse {
            Collapse::Optimal => {
                let slots = self.plan(p).lower(1);
                self.open(l, slots, &mut out);
                self.open(r, W - slots, &mut out);
            }
            Collapse::Greedy => {
                out.push(l);
                out.push(r);
                while out.len < W {
                    let mut largest = None;
                    for (k, &c) in out.as_slice().iter().enumerate() {
                        let area = self.bounds(c).half_area();
                        if !self.is_leaf(c) && largest.is_none_or(|(_, a)| area > a) {
                            largest = Some((k, area));
                        }
                    }
                    let Some((k, _)) = largest else { break };
                    let [l, r] = self.halves(out.parts[k]);
                    out.parts[k] = l;
                    out.push(r);
                }
            }
        }
        let fits = |c: &Part| self.is_leaf(*c) || u32::from(self.node(*c).height) <= 2 * (depth - 1);
        if !out.as_slice().iter().all(fits) {
            out.len = 0;
            for half in [l, r] {
                if self.is_leaf(half) {
                    out.push(half);
                } else {
                    self.halves(half).into_iter().for_each(|c| out.push(c));
                }
            }
        }
        out
    }

    /// Puts a subtree into at most `slots` slots, 1 to `W` - 1.
    fn open(&self, p: Part, mut slots: usize, out: &mut Parts<W>) {
        if p.end - p.begin == 1 {
            return out.push(p);
        }
        let plan = self.plan(p);
        while slots > 1 && plan.lower(slots) == 0 {
            slots -= 1;
        }
        if slots == 1 {
            return out.push(p);
        }
        let [l, r] = self.halves(p);
        let lower = plan.lower(slots);
        self.open(l, lower, out);
        self.open(r, slots - lower, out);
    }

    /// The node with these children, the first inner one at index `next`.
    fn wide(&self, parts: &Parts<W>, mut next: u32) -> WideNode<W> {
        let mut wide = WideNode::default();
        for (k, &p) in parts.as_slice().iter().enumerate() {
            wide.boxes[k] = self.bounds(p);
            wide.children[k] = if self.is_leaf(p) {
                Child::Leaf { first: p.begin, count: (p.end - p.begin) as u8 } // at most 16
            } else {
                next += 1;
                Child::Inner(next - 1)
            };
        }
        wide
    }

    /// The inner ones of these children.
    fn inner(&self, parts: &Parts<W>) -> Parts<W> {
        let mut out = Parts::default();
        for &p in parts.as_slice() {
            if !self.is_leaf(p) {
                out.push(p);
            }
        }
        out
    }

    /// Number of nodes below a node over `p`.
    fn count(&self, p: Part, depth: u32) -> u32 {
        let inner = self.inner(&self.children(p, depth));
        inner.as_slice().iter().map(|&c| 1 + self.count(c, depth - 1)).sum()
    }

    /// Hands every node of the subtree over `p` to `put` with its index, the node itself with index `at`; those below take the indices from
    /// `next` on.
    fn walk(&self, p: Part, depth: u32, at: u32, next: &mut u32, put: &mut impl FnMut(u32, &WideNode<W>)) {
        let parts = self.children(p, depth);
        let first = *next;
        put(at, &self.wide(&parts, first));
        let inner = self.inner(&parts);
        *next += inner.len as u32; // at most W
        for (at, &c) in (first..).zip(inner.as_slice()) {
            self.walk(c, depth - 1, at, next, put);
        }
    }
}

/// A subtree for one thread.
struct Task {
    part: Part,
    depth: u32,
    /// Index of its own node.
    at: u32,
    /// Number of nodes below it, and their first index.
    below: u32,
    first: u32,
}

/// All nodes, encoded, root first.
pub(crate) fn nodes<T, F, const W: usize>(source: &BinaryTree<'_, W>, depth: u32, encode: F) -> Vec<T>
where
    T: Copy + Default + Send,
    F: Fn(&WideNode<W>) -> T + Sync,
{
    // Cut the tree into tasks, count their nodes in parallel, place them, write them in parallel.
    let mut tasks = Vec::new();
    cut(source, source.whole(), depth, &mut tasks);
    tasks.par_iter_mut().for_each(|t| t.below = source.count(t.part, t.depth));
    let mut above = Vec::new();
    let mut next = 1;
    place(source, source.whole(), depth, 0, &mut next, &mut tasks.iter_mut(), &mut above);

    let mut out = vec![T::default(); next as usize];
    let mut slices = Vec::with_capacity(tasks.len());
    let (mut rest, mut at) = (out.as_mut_slice(), 0);
    for t in &tasks {
        let (slice, tail) = rest[(t.first - at) as usize..].split_at_mut(t.below as usize);
        slices.push((t, slice));
        (rest, at) = (tail, t.first + t.below);
    }
    let write = |(t, slice): (&Task, &mut [T])| {
        let mut own = T::default();
        let mut next = t.first;
        source.walk(t.part, t.depth, t.at, &mut next, &mut |index, node| {
            if index == t.at { own = encode(node) } else { slice[(index - t.first) as usize] = encode(node) }
        });
        (t.at, own)
    };
    let owns: Vec<(u32, T)> = slices.into_par_iter().map(write).collect();
    for (index, node) in owns {
        out[index as usize] = node;
    }
    for (index, node) in &above {
        out[*index as usize] = encode(node);
    }
    out
}

/// Lists the largest subtrees that are small enough for one thread, in memory order.
fn cut<const W: usize>(source: &BinaryTree<'_, W>, p: Part, depth: u32, tasks: &mut Vec<Task>) {
    if p.end - p.begin <= TASK {
        return tasks.push(Task { part: p, depth, at: 0, below: 0, first: 0 });
    }
    for &c in source.inner(&source.children(p, depth)).as_slice() {
        cut(source, c, depth - 1, tasks);
    }
}

/// Gives every task its indices, and lists the nodes above the tasks.
fn place<'t, const W: usize>(
    source: &BinaryTree<'_, W>,
    p: Part,
    depth: u32,
    at: u32,
    next: &mut u32,
    tasks: &mut impl Iterator<Item = &'t mut Task>,
    above: &mut Vec<(u32, WideNode<W>)>,
) {
    if p.end - p.begin <= TASK {
        if let Some(t) = tasks.next() {
            (t.at, t.first) = (at, *next);
            *next += t.below;
        }
        return;
    }
    let parts = source.children(p, depth);
    let first = *next;
    above.push((at, source.wide(&parts, first)));
    let inner = source.inner(&parts);
    *next += inner.len as u32; // at most W
    for (at, &c) in (first..).zip(inner.as_slice()) {
        place(source, c, depth - 1, at, next, tasks, above);
    }
}
