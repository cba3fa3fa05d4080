//! The binary tree: top-down splits by the surface area heuristic.
//!
//! A node splits its range of primitives at a position no other node splits at, so that position is its index: a tree over n primitives
//! is an array of n - 1 nodes that halves recursively with the primitives, without locks or reallocation.
//!
//! Splits minimise area(left) * count(left) + area(right) * count(right), in `f32` over bins of doubled centroids (a heuristic; boxes are
//! exact integers). Ties go to the lower axis, then the lower position. Equal centroids: the middle of the range.

use super::Box32;
use rayon::prelude::*;

/// Bins per axis, where nothing else is asked for.
const BINS: usize = 16;
/// Largest range whose splits are all tried.
const SWEEP: usize = 6;
/// Subtrees above this size are worked on by two threads.
pub(crate) const PARALLEL: usize = 1 << 12;
/// Ranges above this size are measured and binned by all threads.
const PARALLEL_BINS: usize = 1 << 17;
/// Primitives per thread and turn when measuring and binning.
const CHUNK: usize = 1 << 14;

/// A primitive: box and index, in two vectors of four lanes.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C, align(16))]
pub(crate) struct Prim {
    lo: [i32; 3],
    /// Index of the primitive.
    pub id: u32,
    hi: [i32; 3],
    /// Fourth lane.
    pad: u32,
}

impl Prim {
    #[inline]
    pub fn new(b: &Box32, id: u32) -> Self {
        Self { lo: b.lo, id, hi: b.hi, pad: 0 }
    }

    #[inline]
    pub fn bounds(&self) -> Box32 {
        Box32 { lo: self.lo, hi: self.hi }
    }

    /// Corners as `f32`, lane 3 unused.
    #[inline(always)]
    fn corners(&self) -> [Lanes; 2] {
        // Rounding to 24 bits only moves the heuristic.
        [[self.lo[0] as f32, self.lo[1] as f32, self.lo[2] as f32, 0.0], [self.hi[0] as f32, self.hi[1] as f32, self.hi[2] as f32, 0.0]]
    }

    /// Twice the centroid.
    #[inline(always)]
    fn centroid(&self) -> Lanes {
        let [lo, hi] = self.corners();
        std::array::from_fn(|k| lo[k] + hi[k])
    }
}

type Lanes = [f32; 4];

#[inline(always)]
fn least(a: Lanes, b: Lanes) -> Lanes {
    std::array::from_fn(|k| if a[k] < b[k] { a[k] } else { b[k] })
}

#[inline(always)]
fn most(a: Lanes, b: Lanes) -> Lanes {
    std::array::from_fn(|k| if a[k] > b[k] { a[k] } else { b[k] })
}

/// A box while it grows.
#[derive(Clone, Copy)]
struct Extent {
    lo: Lanes,
    hi: Lanes,
}

impl Extent {
    const EMPTY: Self = Self { lo: [f32::MAX; 4], hi: [f32::MIN; 4] };

    #[inline(always)]
    fn grow(&mut self, lo: Lanes, hi: Lanes) {
        self.lo = least(self.lo, lo);
        self.hi = most(self.hi, hi);
    }

    /// Half the surface; not for an empty box.
    #[inline(always)]
    fn half_area(&self) -> f32 {
        let d: Lanes = std::array::from_fn(|k| self.hi[k] - self.lo[k]);
        d[0] * d[1] + d[1] * d[2] + d[2] * d[0]
    }
}

/// A node of the binary tree.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Node {
    /// Box of everything below.
    pub bounds: Box32,
    /// Position where the lower range is split; unused if that is a leaf.
    pub left: u32,
    /// Position where the upper range is split; unused if that is a leaf.
    pub right: u32,
    /// Most binary nodes on a path down from here, this one included.
    pub height: u8,
}

/// What a subtree tells its parent.
struct Below {
    bounds: Box32,
    /// Where it is split; unused for a leaf.
    split: u32,
    height: u8,
}

/// The binary tree: nodes, one less than primitives, and the root's split position.
pub(crate) struct Binary {
    pub nodes: Vec<Node>,
    pub root: u32,
}

/// Builds the tree over `prims` (not empty), which are put into leaf order.
/// Paths hold at most `2 * depth` binary nodes, which must suffice for a balanced tree.
pub(crate) fn binary_tree(prims: &mut [Prim], depth: u32) -> Binary {
    binary_tree_of::<BINS>(prims, depth, 1)
}

/// The same with so many bins, and leaves of up to `leaf` primitives, 1 or more, which are not split further: their nodes are unused.
pub(crate) fn binary_tree_of<const BINS: usize>(prims: &mut [Prim], depth: u32, leaf: usize) -> Binary {
    let mut nodes = vec![Node::default(); prims.len() - 1];
    let root = subtree::<BINS>(prims, &mut nodes, 0, 2 * depth, leaf).split;
    Binary { nodes, root }
}

/// `begin`: position of the first of `prims` in the whole; `depth`: binary nodes allowed on a path from here.
fn subtree<const BINS: usize>(prims: &mut [Prim], nodes: &mut [Node], begin: u32, depth: u32, leaf: usize) -> Below {
    let count = prims.len();
    if count <= leaf {
        let bounds = prims[1..].iter().fold(prims[0].bounds(), |all, prim| all.union(&prim.bounds()));
        return Below { bounds, split: begin, height: 0 };
    }
    let mut mid = split::<BINS>(prims);
    // Each half must fit below a balanced tree of the remaining depth; `count` itself does.
    let room = 1usize << (depth.saturating_sub(1)).min(40);
    if mid.max(count - mid) > room {
        mid = median(prims);
    }
    let (lower, upper) = prims.split_at_mut(mid);
    let (lower_nodes, rest) = nodes.split_at_mut(mid - 1);
    let (node, upper_nodes) = rest.split_at_mut(1);
    let below = depth.saturating_sub(1);
    let middle = begin + mid as u32; // positions are at most 2^28
    let mut left = || subtree::<BINS>(lower, lower_nodes, begin, below, leaf);
    let mut right = || subtree::<BINS>(upper, upper_nodes, middle, below, leaf);
    let (l, r) = if count > PARALLEL { rayon::join(left, right) } else { (left(), right()) };

    let bounds = l.bounds.union(&r.bounds);
    let height = l.height.max(r.height).saturating_add(1);
    node[0] = Node { bounds, left: l.split, right: r.split, height };
    Below { bounds, split: middle, height }
}

/// Puts the primitives (at least two) into two parts and returns the size of the first, which is neither 0 nor all.
fn split<const BINS: usize>(prims: &mut [Prim]) -> usize {
    match prims.len() {
        2 => 1,
        n if n <= SWEEP => sweep(prims),
        _ => binned::<BINS>(prims),
    }
}

/// Tries every split of a small range on every axis.
fn sweep(prims: &mut [Prim]) -> usize {
    let n = prims.len();
    let mut sorted = [[0u8; SWEEP]; 3];
    let mut centroids = [[0.0f32; 4]; SWEEP];
    let mut corners = [[[0.0f32; 4]; 2]; SWEEP];
    for k in 0..n {
        corners[k] = prims[k].corners();
        centroids[k] = std::array::from_fn(|a| corners[k][0][a] + corners[k][1][a]);
    }
    let mut best = (f32::INFINITY, 0, n / 2);
    for (axis, order) in sorted.iter_mut().enumerate() {
        for k in 0..n {
            let mut at = k;
            while at > 0 && centroids[order[at - 1] as usize][axis] > centroids[k][axis] {
                order[at] = order[at - 1];
                at -= 1;
            }
            order[at] = k as u8; // below SWEEP
        }
        let mut suffix = [0.0f32; SWEEP];
        let mut grown = Extent::EMPTY;
        for k in (1..n).rev() {
            let [lo, hi] = corners[order[k] as usize];
            grown.grow(lo, hi);
            suffix[k] = grown.half_area();
        }
        let mut grown = Extent::EMPTY;
        for k in 1..n {
            let [lo, hi] = corners[order[k - 1] as usize];
            grown.grow(lo, hi);
            let cost = grown.half_area() * k as f32 + suffix[k] * (n - k) as f32;
            if cost < best.0 {
                best = (cost, axis, k);
            }
        }
    }
    let mut copy = [Prim::default(); SWEEP];
    copy[..n].copy_from_slice(prims);
    for (to, &from) in prims.iter_mut().zip(&sorted[best.1]) {
        *to = copy[from as usize];
    }
    best.2
}

/// Bins of the three axes.
#[derive(Clone)]
struct Bins<const BINS: usize> {
    extents: [[Extent; BINS]; 3],
    counts: [[u32; BINS]; 3],
}

impl<const BINS: usize> Bins<BINS> {
    const EMPTY: Self = Self { extents: [[Extent::EMPTY; BINS]; 3], counts: [[0; BINS]; 3] };

    #[inline(always)]
    fn add(&mut self, prims: &[Prim], grid: &Grid<BINS>) {
        for p in prims {
            let [lo, hi] = p.corners();
            let bins = grid.bins(std::array::from_fn(|k| lo[k] + hi[k]));
            for (axis, &bin) in bins.iter().enumerate() {
                self.extents[axis][bin].grow(lo, hi);
                self.counts[axis][bin] += 1;
            }
        }
    }

    fn merge(mut self, other: &Self) -> Self {
        for axis in 0..3 {
            for bin in 0..BINS {
                let e = &other.extents[axis][bin];
                self.extents[axis][bin].grow(e.lo, e.hi);
                self.counts[axis][bin] += other.counts[axis][bin];
            }
        }
        self
    }

    /// The cheapest (axis, first bin of the upper part), or `None` if no border separates anything.
    fn best(&self) -> Option<(usize, usize)> {
        let mut best = (f32::INFINITY, None);
        for axis in 0..3 {
            let (extents, counts) = (&self.extents[axis], &self.counts[axis]);
            let mut upper = [(0.0f32, 0u32); BINS];
            let (mut grown, mut count) = (Extent::EMPTY, 0);
            for k in (1..BINS).rev() {
                grown.grow(extents[k].lo, extents[k].hi);
                count += counts[k];
                upper[k] = (grown.half_area(), count);
            }
            let (mut grown, mut count) = (Extent::EMPTY, 0);
            for k in 1..BINS {
                grown.grow(extents[k - 1].lo, extents[k - 1].hi);
                count += counts[k - 1];
                if count == 0 || upper[k].1 == 0 {
                    continue;
                }
                let cost = grown.half_area() * count as f32 + upper[k].0 * upper[k].1 as f32;
                if cost < best.0 {
                    best = (cost, Some((axis, k)));
                }
            }
        }
        best.1
    }
}

/// Maps centroids to bins.
struct Grid<const BINS: usize> {
    origin: Lanes,
    scale: Lanes,
}

impl<const BINS: usize> Grid<BINS> {
    fn new(centroids: &Extent) -> Self {
        let scale = |k: usize| {
            let width = centroids.hi[k] - centroids.lo[k];
            // Doubled centroids of different primitives are integers at least one apart: no overflow.
            if width > 0.0 { BINS as f32 / width } else { 0.0 }
        };
        Self { origin: centroids.lo, scale: [scale(0), scale(1), scale(2), 0.0] }
    }

    #[inline(always)]
    fn bins(&self, c: Lanes) -> [usize; 3] {
        // At least 0 and at most BINS and a rounding error; the cast saturates and the minimum closes the last bin.
        std::array::from_fn(|k| (((c[k] - self.origin[k]) * self.scale[k]) as i32 as usize).min(BINS - 1))
    }
}

fn centroids(prims: &[Prim]) -> Extent {
    let mut e = Extent::EMPTY;
    for p in prims {
        let c = p.centroid();
        e.grow(c, c);
    }
    e
}

/// Splits at the best border between bins.
fn binned<const BINS: usize>(prims: &mut [Prim]) -> usize {
    // Minima, maxima and sums of integers do not depend on the order in which threads deliver them.
    let (grid, best) = if prims.len() > PARALLEL_BINS {
        let both = |mut a: Extent, b: Extent| {
            a.grow(b.lo, b.hi);
            a
        };
        let grid = Grid::<BINS>::new(&prims.par_chunks(CHUNK).map(centroids).reduce(|| Extent::EMPTY, both));
        let filled = prims.par_chunks(CHUNK).fold(
            || Bins::<BINS>::EMPTY,
            |mut bins, chunk| {
                bins.add(chunk, &grid);
                bins
            },
        );
        let best = filled.reduce(|| Bins::<BINS>::EMPTY, |a, b| a.merge(&b)).best();
        (grid, best)
    } else {
        let grid = Grid::<BINS>::new(&centroids(prims));
        let mut bins = Bins::<BINS>::EMPTY;
        bins.add(prims, &grid);
        (grid, bins.best())
    };
    let Some((axis, border)) = best else { return prims.len() / 2 };
    let mid = partition(prims, |p| grid.bins(p.centroid())[axis] < border);
    if mid == 0 || mid == prims.len() { prims.len() / 2 } else { mid }
}

/// Moves the primitives for which `below` holds to the front; returns their number.
#[inline(always)]
fn partition(prims: &mut [Prim], below: impl Fn(&Prim) -> bool) -> usize {
    let (mut i, mut j) = (0, prims.len());
    loop {
        while i < j && below(&prims[i]) {
            i += 1;
        }
        while i < j && !below(&prims[j - 1]) {
            j -= 1;
        }
        if i >= j {
            return i;
        }
        prims.swap(i, j - 1);
        i += 1;
        j -= 1;
    }
}

/// Splits into halves by count, along the widest axis of the centroids; equal ones by index.
fn median(prims: &mut [Prim]) -> usize {
    let e = centroids(prims);
    let width = |k: usize| e.hi[k] - e.lo[k];
    let axis = (1..3).fold(0, |best, k| if width(k) > width(best) { k } else { best });
    let mid = prims.len() / 2;
    prims.select_nth_unstable_by(mid, |a, b| a.centroid()[axis].total_cmp(&b.centroid()[axis]).then(a.id.cmp(&b.id)));
    mid
}
