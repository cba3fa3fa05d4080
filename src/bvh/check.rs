//! What every BVH must satisfy, and what it costs.

use super::{Box32, Child, Costs, MAX_DEPTH, WideTree};

/// The first thing found wrong with a BVH.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum Defect {
    /// A reference to a node or slot that does not exist, or a node reached twice.
    #[error("node {0} holds a wrong reference")]
    Reference(u32),
    /// A box other than the smallest one around what lies below.
    #[error("a box of node {0} is not that of its contents")]
    Bounds(u32),
    /// A leaf with no or more than four primitives, a used slot after an empty one, an empty slot with a box, or an empty node.
    #[error("node {0} has badly formed slots")]
    Slots(u32),
    /// A path longer than [`MAX_DEPTH`].
    #[error("node {0} lies too deep")]
    Depth(u32),
    /// A primitive that no or several leaves hold.
    #[error("primitive {0} is not referenced exactly once")]
    Primitive(u32),
    /// A node that no path reaches.
    #[error("node {0} is not reached")]
    Unreached(u32),
}

/// Checks a tree against the boxes it was built over.
///
/// # Errors
/// The first defect found.
pub fn check<const W: usize>(tree: &WideTree<W>, boxes: &[Box32]) -> Result<(), Defect> {
    check_depth(tree, boxes, MAX_DEPTH)
}

fn check_depth<const W: usize>(tree: &WideTree<W>, boxes: &[Box32], depth: u32) -> Result<(), Defect> {
    let mut reached = vec![false; tree.nodes.len()];
    let mut held = vec![false; boxes.len()];
    let mut path = vec![(0u32, 1u32)];
    while let Some((index, level)) = path.pop() {
        let node = tree.nodes.get(index as usize).ok_or(Defect::Reference(index))?;
        if std::mem::replace(&mut reached[index as usize], true) {
            return Err(Defect::Reference(index));
        }
        if level > depth {
            return Err(Defect::Depth(index));
        }
        let used = node.children.iter().take_while(|c| **c != Child::Empty).count();
        if used == 0 || (used..W).any(|k| node.children[k] != Child::Empty || node.boxes[k] != Box32::default()) {
            return Err(Defect::Slots(index));
        }
        for (bounds, child) in node.boxes.iter().zip(&node.children[..used]) {
            let inside = match *child {
                Child::Empty => return Err(Defect::Slots(index)),
                Child::Inner(c) => {
                    let below = tree.nodes.get(c as usize).ok_or(Defect::Reference(index))?;
                    path.push((c, level + 1));
                    let used = below.children.iter().take_while(|c| **c != Child::Empty).count();
                    below.boxes[..used].iter().copied().reduce(|a, b| a.union(&b))
                }
                Child::Leaf { first, count } => {
                    if !(1..=4).contains(&count) {
                        return Err(Defect::Slots(index));
                    }
                    let (first, count) = (first as usize, usize::from(count));
                    let slots = tree.order.get(first..first + count).ok_or(Defect::Reference(index))?;
                    for &p in slots {
                        let held = held.get_mut(p as usize).ok_or(Defect::Primitive(p))?;
                        if std::mem::replace(held, true) {
                            return Err(Defect::Primitive(p));
                        }
                    }
                    slots.iter().map(|&p| boxes[p as usize]).reduce(|a, b| a.union(&b))
                }
            };
            if inside != Some(*bounds) {
                return Err(Defect::Bounds(index));
            }
        }
    }
    // Indices of both have at most 28 bits.
    if let Some(p) = held.iter().position(|h| !h) {
        return Err(Defect::Primitive(p as u32));
    }
    reached.iter().position(|r| !r).map_or(Ok(()), |n| Err(Defect::Unreached(n as u32)))
}

/// Expected cost of a ray that meets the root's box, by the surface area heuristic; a root without area counts as 1.
pub fn sah_cost<const W: usize>(tree: &WideTree<W>, costs: &Costs) -> f64 {
    let Some(root) = tree.nodes.first() else { return 0.0 };
    let used = root.boxes.iter().zip(&root.children).filter(|(_, c)| **c != Child::Empty);
    let root_area = used.map(|(b, _)| *b).reduce(|a, b| a.union(&b)).map_or(0.0, |b| b.half_area());
    let mut sum = root_area * costs.node;
    for node in &tree.nodes {
        for (b, c) in node.boxes.iter().zip(&node.children) {
            sum += match c {
                Child::Empty => 0.0,
                Child::Inner(_) => b.half_area() * costs.node,
                Child::Leaf { count, .. } => b.half_area() * costs.primitive * f64::from(*count),
            };
        }
    }
    if root_area > 0.0 { sum / root_area } else { sum }
}

/// A terrain of `quads`^2 base quads (two trees each) with `levels` splits: smooth hills with hashed roughness.
#[cfg(test)]
pub(crate) fn synthetic_terrain(quads: u32, levels: u32) -> crate::mesh::Hierarchy {
    use crate::mesh::{EdgeCodes, Hierarchy, Placement, lattice};
    let m = 1u32 << levels;
    let side = (quads * m) as f64;
    let height = |x: u32, y: u32| {
        let hash =
            (u64::from(x) << 32 | u64::from(y)).wrapping_mul(0x9E37_79B9_7F4A_7C15).rotate_left(29).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let (u, v) = (f64::from(x) / side * 17.0, f64::from(y) / side * 13.0);
        u.sin() * v.cos() * 0.05 + (hash >> 40) as f64 / (1u64 << 24) as f64 * 0.5 / side
    };
    let point = |x: u32, y: u32| {
        let place = |k: u32| f64::from(k) / side * 1.9 - 0.95;
        [place(x), place(y), height(x, y)].map(|v| crate::num::snap(v * 2f64.powi(31), levels))
    };
    let mut h = Hierarchy {
        levels,
        placement: Placement { offset: [0.0; 3], scale: 1.0 },
        base_vertices: (quads + 1) * (quads + 1),
        triangles: vec![],
        points: vec![],
        bounds: EdgeCodes::default(),
        vertices: crate::num::VertexForm::Exact,
        zeros: 0,
    };
    for qy in 0..quads {
        for qx in 0..quads {
            let v = |x: u32, y: u32| y * (quads + 1) + x;
            // Second triangle: the same lattice turned by half a turn.
            h.triangles.push([v(qx, qy), v(qx + 1, qy), v(qx, qy + 1)]);
            h.triangles.push([v(qx + 1, qy + 1), v(qx, qy + 1), v(qx + 1, qy)]);
            for turned in [false, true] {
                for j in 0..=m {
                    for i in 0..=m - j {
                        let (i, j) = if turned { (m - i, m - j) } else { (i, j) };
                        h.points.push(point(qx * m + i, qy * m + j));
                    }
                }
            }
        }
    }
    debug_assert_eq!(h.points.len(), h.triangles.len() * lattice::len(levels));
    h
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::{
        BvhError, Collapse, MAX_DEPTH_OF_SIX, Options, QuadNode, QuadTree, WideNode, WideTree, build, build::Prim, build_nodes, over_trees,
    };
    use crate::format::{Box16, BvhNode, ChildRef, TreeBvh};
    use crate::num::{COORD_LIMIT, Wire};
    use proptest::prelude::*;

    struct Random(u64);

    impl Random {
        fn next(&mut self, below: i64) -> i32 {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((self.0 >> 33) as i64 % below) as i32
        }

        fn cube(&mut self, centre: [i32; 3], spread: i32, size: i32) -> Box32 {
            let lo = centre.map(|c| (c + self.next(2 * i64::from(spread) + 1) - spread).clamp(-COORD_LIMIT, COORD_LIMIT - size));
            Box32 { lo, hi: lo.map(|v| v + self.next(i64::from(size) + 1)) }
        }
    }

    fn inputs() -> Vec<(String, Vec<Box32>)> {
        let mut r = Random(1);
        let mut all: Vec<(String, Vec<Box32>)> =
            (1..=20).map(|n| (format!("{n}"), (0..n).map(|_| r.cube([0; 3], 1 << 20, 1 << 18)).collect())).collect();
        all.push(("random".into(), (0..20_000).map(|_| r.cube([0; 3], 1 << 29, 1 << 22)).collect()));
        let mut clustered = Vec::new();
        for _ in 0..30 {
            let centre = [r.next(1 << 30), r.next(1 << 30), r.next(1 << 30)];
            clustered.extend((0..300).map(|_| r.cube(centre, 1 << 8, 16)));
        }
        all.push(("clustered".into(), clustered));
        all.push(("identical".into(), vec![Box32 { lo: [-5, 7, 9], hi: [100, 90, 80] }; 10_000]));
        all.push(("one point".into(), vec![Box32::default(); 777]));
        all.push(("collinear".into(), (0..5000).map(|k| Box32 { lo: [k * 64, 0, 0], hi: [k * 64 + 64, 0, 0] }).collect()));
        // Each twice as far out as the last: splits by area peel one off at a time.
        let shell = |k: i32| {
            let v = (1 << (k % 30)) + k / 30;
            Box32 { lo: [0; 3], hi: [v, v, 1] }
        };
        all.push(("nested".into(), (0..3000).map(shell).collect()));
        let limit = Box32 { lo: [-COORD_LIMIT; 3], hi: [COORD_LIMIT; 3] };
        all.push((
            "largest".into(),
            vec![limit, Box32 { lo: limit.lo, hi: limit.lo }, Box32 { lo: limit.hi, hi: limit.hi }, limit, limit, limit, limit, limit],
        ));
        all
    }

    fn options(max_leaf: u32, collapse: Collapse) -> Options {
        Options { collapse, ..Options::with_leaf(max_leaf) }
    }

    #[test]
    fn all_sorts_of_input_give_sound_trees() {
        let mut trees = 0;
        for (name, boxes) in inputs() {
            for max_leaf in 1..=4 {
                let cost = [Collapse::Optimal, Collapse::Greedy].map(|collapse| {
                    let o = options(max_leaf, collapse);
                    let tree = build(&boxes, &o).unwrap();
                    assert_eq!(check(&tree, &boxes), Ok(()), "{name} {o:?}");
                    let largest = tree.nodes.iter().flat_map(|n| n.children).filter_map(|c| match c {
                        Child::Leaf { count, .. } => Some(u32::from(count)),
                        _ => None,
                    });
                    assert!(largest.max().unwrap() <= max_leaf);
                    trees += 1;
                    sah_cost(&tree, &o.costs)
                });
                assert!(cost[0] <= cost[1] * 1.000_001, "{name} {max_leaf}: {cost:?}");
            }
        }
        assert_eq!(trees, 27 * 8);
    }

    #[test]
    fn the_depth_bound_holds_however_tight() {
        let mut checked = 0;
        for (name, boxes) in inputs() {
            let least = (boxes.len() as u32).next_power_of_two().trailing_zeros().div_ceil(2).max(1);
            for depth in least..least + 3 {
                for collapse in [Collapse::Optimal, Collapse::Greedy] {
                    let prims = (0..).zip(&boxes).map(|(k, b)| Prim::new(b, k)).collect();
                    let (nodes, order) = build_nodes(prims, &options(1, collapse), depth, |n: &QuadNode| *n).unwrap();
                    assert_eq!(check_depth(&QuadTree { nodes, order }, &boxes, depth), Ok(()), "{name} {depth}");
                    checked += 1;
                }
            }
        }
        assert_eq!(checked, 27 * 6);
    }

    #[test]
    fn six_children_a_node_are_sound_and_cost_less() {
        let mut cheaper = 0;
        for (name, boxes) in inputs() {
            let least = (boxes.len() as u32).next_power_of_two().trailing_zeros().div_ceil(2).max(1);
            for depth in [least, least + 1, MAX_DEPTH_OF_SIX] {
                for (max_leaf, collapse) in [(1, Collapse::Optimal), (4, Collapse::Optimal), (1, Collapse::Greedy)] {
                    let prims = || (0..).zip(&boxes).map(|(k, b)| Prim::new(b, k)).collect();
                    let of = options(max_leaf, collapse);
                    let (nodes, order) = build_nodes(prims(), &of, depth, |n: &WideNode<6>| *n).unwrap();
                    let six = WideTree { nodes, order };
                    assert_eq!(check_depth(&six, &boxes, depth), Ok(()), "{name} {depth}");
                    let (nodes, order) = build_nodes(prims(), &of, depth, |n: &QuadNode| *n).unwrap();
                    let four = QuadTree { nodes, order };
                    if depth == MAX_DEPTH_OF_SIX && collapse == Collapse::Optimal {
                        let [six, four] = [sah_cost(&six, &of.costs), sah_cost(&four, &of.costs)];
                        assert!(six <= four * 1.000_001, "{name} {max_leaf}: {six} {four}");
                        cheaper += u32::from(six < four * 0.95);
                    }
                }
            }
        }
        assert!(cheaper > 27, "{cheaper}");
    }

    #[test]
    fn a_million_identical_boxes_build() {
        let boxes = vec![Box32 { lo: [1, 2, 3], hi: [4, 5, 6] }; 1_000_000];
        for max_leaf in [1, 4] {
            let tree = build(&boxes, &Options::with_leaf(max_leaf)).unwrap();
            assert_eq!(check(&tree, &boxes), Ok(()));
        }
    }

    #[test]
    fn the_number_of_threads_does_not_matter() {
        let mut r = Random(7);
        // Enough for parallel bins, tasks and joins.
        let boxes: Vec<Box32> = (0..300_000).map(|_| r.cube([0; 3], 1 << 24, 1 << 12)).collect();
        for max_leaf in [1, 4] {
            let [one, three] = [1, 3].map(|threads| {
                let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
                pool.install(|| build(&boxes, &Options::with_leaf(max_leaf)).unwrap())
            });
            assert!(one == three);
            assert_eq!(check(&one, &boxes), Ok(()));
        }
    }

    #[test]
    fn siblings_stand_side_by_side_and_depth_first() {
        let mut r = Random(3);
        let boxes: Vec<Box32> = (0..200_000).map(|_| r.cube([0; 3], 1 << 24, 1 << 12)).collect();
        let tree = build(&boxes, &Options::with_leaf(2)).unwrap();
        let (mut next, mut slot) = (1, 0);
        let mut path = vec![Child::Inner(0)];
        let mut nodes = 0;
        while let Some(c) = path.pop() {
            match c {
                Child::Inner(n) => {
                    nodes += 1;
                    for c in tree.nodes[n as usize].children {
                        if let Child::Inner(at) = c {
                            assert_eq!(at, next);
                            next += 1;
                        }
                    }
                    path.extend(tree.nodes[n as usize].children.iter().rev());
                }
                Child::Leaf { first, count } => {
                    assert_eq!(first, slot);
                    slot += u32::from(count);
                }
                Child::Empty => {}
            }
        }
        assert_eq!((nodes, slot), (tree.nodes.len(), 200_000));
    }

    #[test]
    fn illegal_input_is_refused() {
        let good = Box32 { lo: [0; 3], hi: [16; 3] };
        assert_eq!(build(&[], &Options::with_leaf(1)), Err(BvhError::Empty));
        assert_eq!(build(&[good], &Options::with_leaf(0)), Err(BvhError::LeafSize(0)));
        assert_eq!(build(&[good], &Options::with_leaf(5)), Err(BvhError::LeafSize(5)));
        let costs = Costs { node: f64::NAN, ..Costs::default() };
        assert_eq!(build(&[good], &Options { costs, ..Options::with_leaf(1) }), Err(BvhError::Costs));
        for bad in [Box32 { lo: [1, 0, 0], hi: [0; 3] }, Box32 { lo: [i32::MIN; 3], hi: [0; 3] }, Box32 { lo: [0; 3], hi: [i32::MAX; 3] }] {
            assert_eq!(build(&[good, good, bad], &Options::with_leaf(1)), Err(BvhError::IllegalBox(2)));
        }
        assert_eq!(over_trees(&[]), Err(BvhError::Empty));
        assert_eq!(over_trees(&[Box16::from_codes([i16::MIN; 3], [0; 3])]), Err(BvhError::IllegalBox(0)));
    }

    #[test]
    fn leaves_over_trees_name_the_tree_and_hold_its_box() {
        let mut r = Random(11);
        for count in [1, 2, 5, 4000] {
            let boxes: Vec<Box16> = (0..count)
                .map(|_| {
                    let lo: [i16; 3] = std::array::from_fn(|_| (r.next(60_000) - 30_000) as i16);
                    Box16::from_codes(lo, lo.map(|v| v + r.next(2000) as i16))
                })
                .collect();
            let mut seen = vec![false; boxes.len()];
            let TreeBvh { nodes, order } = over_trees(&boxes).unwrap();
            for node in nodes.iter().map(|line| BvhNode::from_words(line)) {
                for k in 0..4 {
                    let child = node.child(k);
                    if child.kind.get() == ChildRef::LEAF {
                        assert_eq!(child.count.get(), 0);
                        let tree = order[child.index.get() as usize] as usize;
                        let (stored, own) = (node.bounds(k), boxes[tree]);
                        assert!((0..3).all(|c| stored.lo.get()[c] <= own.lo.get()[c] && stored.hi.get()[c] >= own.hi.get()[c]));
                        assert!(!std::mem::replace(&mut seen[tree], true));
                    }
                }
            }
            assert!(seen.iter().all(|&s| s));
        }
    }

    proptest! {
        #[test]
        fn few_boxes_of_any_kind(raw in prop::collection::vec((prop::array::uniform3(-COORD_LIMIT..=COORD_LIMIT),
                                                               prop::array::uniform3(-COORD_LIMIT..=COORD_LIMIT)), 1..40), max_leaf in 1u32..=4) {
            let boxes: Vec<Box32> = raw.iter().map(|(a, b)| Box32 {
                lo: std::array::from_fn(|k| a[k].min(b[k])),
                hi: std::array::from_fn(|k| a[k].max(b[k])),
            }).collect();
            let tree = build(&boxes, &Options::with_leaf(max_leaf)).unwrap();
            prop_assert_eq!(check(&tree, &boxes), Ok(()));
            prop_assert_eq!(check(&tree.side_by_side(), &boxes), Ok(()));
        }
    }
}
