//! Boxes in turned frames: each node of six gets the rotation in which its children's boxes cost least.
//!
//! The tree and the order of its nodes stay as they are. All children of a node share its frame, so a ray is turned once for them. This follows Kern et al.,
//! "DOBB-BVH: Efficient Ray Traversal by Transforming Wide BVHs into Oriented Bounding Box Trees using Discrete Rotations" (2025), with tighter boxes: they choose by
//! k-DOPs, while here each box is that of all vertices below, in every frame.

use super::encode::box16;
use super::{Box32, Child, WideNode};
use crate::num::{LET_OUT, ROTATIONS, Rotation};
use rayon::prelude::*;

/// Nodes of these many upper levels share their children among threads.
const SHARED_LEVELS: u32 = 6;

/// Appends the corners of a leaf.
type Corners<'a> = dyn Fn(u32, u8, &mut Vec<[i32; 3]>) + Sync + 'a;

/// What is asked of a tree's leaves, each named by its first primitive and how many it has.
pub(crate) struct Leaves<'a> {
    /// Appends all corners of a leaf.
    pub corners: &'a Corners<'a>,
    /// What a visit of a leaf costs.
    pub cost: &'a (dyn Fn(u32, u8) -> f64 + Sync),
    /// What a visit of a node costs.
    pub node_cost: f64,
}

/// The frame of a node, and its boxes there.
struct Choice {
    node: u32,
    rotation: u32,
    boxes: [Box32; 6],
}

/// Puts the boxes of each node into the frame in which they cost least, and says which frame that is, by number. Turned boxes are let out as far as turned rays
/// need. Of frames that cost the same the lowest number is taken; so boxes stay as they are where turning saves nothing.
///
/// The result does not depend on the number of threads.
pub(crate) fn orient(nodes: &mut [WideNode<6>], leaves: &Leaves<'_>) -> Vec<u32> {
    let mut choices = Vec::with_capacity(nodes.len());
    let lengths = (0..ROTATIONS as u32).map(|number| Rotation::numbered(number).lengths()).collect();
    Tree { nodes, leaves, lengths }.node(0, 0, &mut choices);
    let mut rotations = vec![0; nodes.len()];
    for Choice { node, rotation, boxes } in choices {
        nodes[node as usize].boxes = boxes;
        rotations[node as usize] = rotation;
    }
    rotations
}

/// A tree whose nodes choose.
struct Tree<'a> {
    nodes: &'a [WideNode<6>],
    leaves: &'a Leaves<'a>,
    /// Of each frame, how long its axes are.
    lengths: Vec<[f64; 3]>,
}

impl Tree<'_> {
    /// Appends the choices of a node and of all below it. Gives the box of all that lies below, in each frame.
    fn node(&self, at: u32, level: u32, choices: &mut Vec<Choice>) -> Vec<Box32> {
        let node = &self.nodes[at as usize];
        let used = node.children.iter().take_while(|child| **child != Child::Empty).count();
        let children = &node.children[..used];
        // Of each child, in each frame.
        let mut boxes: Vec<Vec<Box32>> = if level < SHARED_LEVELS {
            let of = |child: &Child| {
                let mut own = Vec::new();
                (self.child(*child, level + 1, &mut own), own)
            };
            let parts: Vec<_> = children.par_iter().map(of).collect();
            let both = |(boxes, own)| {
                choices.extend(own);
                boxes
            };
            parts.into_iter().map(both).collect()
        } else {
            children.iter().map(|child| self.child(*child, level + 1, choices)).collect()
        };
        // Rays are not turned for the first frame: its boxes are not let out.
        boxes.iter_mut().zip(&node.boxes).for_each(|(boxes, as_built)| boxes[0] = *as_built);

        let weights: Vec<f64> = children.iter().map(|child| self.weight(*child)).collect();
        let mut best = (f64::INFINITY, 0);
        for (number, lengths) in self.lengths.iter().enumerate() {
            let cost = boxes.iter().zip(&weights).map(|(boxes, weight)| area(&boxes[number], lengths) * weight).sum();
            if cost < best.0 {
                best = (cost, number);
            }
        }
        let chosen = std::array::from_fn(|k| boxes.get(k).map_or_else(Box32::default, |boxes| boxes[best.1]));
        choices.push(Choice { node: at, rotation: best.1 as u32, boxes: chosen }); // seven bits

        let joined = |a: Vec<Box32>, b: Vec<Box32>| a.iter().zip(&b).map(|(a, b)| a.union(b)).collect();
        boxes.into_iter().reduce(joined).unwrap_or_default()
    }

    /// The same of a child.
    fn child(&self, child: Child, level: u32, choices: &mut Vec<Choice>) -> Vec<Box32> {
        match child {
            Child::Empty => Vec::new(),
            Child::Inner(node) => self.node(node, level, choices),
            Child::Leaf { first, count } => {
                let mut corners = Vec::new();
                (self.leaves.corners)(first, count, &mut corners);
                // Triangles share most of them.
                corners.sort_unstable();
                corners.dedup();
                (0..ROTATIONS as u32).map(|number| around(&corners, Rotation::numbered(number))).collect()
            }
        }
    }

    /// What a visit of a child costs.
    fn weight(&self, child: Child) -> f64 {
        match child {
            Child::Empty => 0.0,
            Child::Inner(_) => self.leaves.node_cost,
            Child::Leaf { first, count } => (self.leaves.cost)(first, count),
        }
    }
}

/// The smallest box of whole units in a frame that holds these points, let out.
fn around(points: &[[i32; 3]], frame: &Rotation) -> Box32 {
    let (mut lo, mut hi) = ([i32::MAX; 3], [i32::MIN; 3]);
    for point in points {
        let [below, above] = frame.around(*point);
        for axis in 0..3 {
            lo[axis] = lo[axis].min(below[axis]);
            hi[axis] = hi[axis].max(above[axis]);
        }
    }
    // Turned points keep to the coordinate limit. Behind it there is room for this in 32 bits, and in codes.
    Box32 { lo: lo.map(|c| c - LET_OUT), hi: hi.map(|c| c + LET_OUT) }
}

/// Half the surface of a box as its codes have it, in squared codes of the frame that is not turned.
fn area(bounds: &Box32, lengths: &[f64; 3]) -> f64 {
    let codes = box16(bounds);
    let (lo, hi) = (codes.lo.get(), codes.hi.get());
    // 17 bits each.
    let [x, y, z]: [f64; 3] = std::array::from_fn(|axis| (hi[axis] - lo[axis]) as f64 / lengths[axis]);
    x * y + y * z + z * x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::bvh::build::Prim;
    use crate::bvh::{MAX_DEPTH_OF_SIX, Options, build_nodes, encode6, side_by_side};
    use crate::format::SixNode;
    use crate::num::{COORD_LIMIT, Random, Wire};

    type Triangle = [[i32; 3]; 3];

    /// A wavy sheet across all coordinates that lies along no axis.
    fn sheet() -> Vec<Triangle> {
        let side = 60;
        let point = |i: i32, j: i32| {
            let (u, v) = (i - side / 2, j - side / 2);
            let step = COORD_LIMIT / side;
            [(u + v) * (step / 2), (u - v) * (step / 2), (u * 3 / 2) * (step / 2) + (i * j % 7) * (step / 16)]
        };
        let quads = (0..side).flat_map(|i| (0..side).map(move |j| (i, j)));
        quads
            .flat_map(|(i, j)| [[point(i, j), point(i + 1, j), point(i, j + 1)], [point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)]])
            .collect()
    }

    fn any(count: u64) -> Vec<Triangle> {
        let mut random = Random::of(5, count);
        (0..count).map(|_| [(); 3].map(|()| [(); 3].map(|()| random.within(COORD_LIMIT as u64) as i32))).collect()
    }

    fn tree(triangles: &[Triangle]) -> (Vec<WideNode<6>>, Vec<u32>) {
        let prims = (0..).zip(triangles).map(|(k, p)| Prim::new(&Box32::of_triangle(*p), k)).collect();
        let (mut nodes, order) = build_nodes(prims, &Options::with_leaf(2), MAX_DEPTH_OF_SIX, |node: &WideNode<6>| *node).unwrap();
        let order = side_by_side(&mut nodes, &order);
        (nodes, order)
    }

    fn oriented(triangles: &[Triangle]) -> (Vec<WideNode<6>>, Vec<u32>, Vec<u32>) {
        let (mut nodes, order) = tree(triangles);
        let own = |first: u32, count: u8| order[first as usize..][..usize::from(count)].iter().map(|&id| triangles[id as usize]);
        let corners = |first: u32, count: u8, out: &mut Vec<[i32; 3]>| out.extend(own(first, count).flatten());
        let rotations = orient(&mut nodes, &Leaves { corners: &corners, cost: &|_, count| 0.5 * f64::from(count), node_cost: 1.0 });
        (nodes, order, rotations)
    }

    /// All corners below a child.
    fn corners(nodes: &[WideNode<6>], order: &[u32], triangles: &[Triangle], child: Child) -> Vec<[i32; 3]> {
        match child {
            Child::Empty => Vec::new(),
            Child::Inner(at) => nodes[at as usize].children.iter().flat_map(|child| corners(nodes, order, triangles, *child)).collect(),
            Child::Leaf { first, count } => {
                order[first as usize..][..usize::from(count)].iter().flat_map(|&id| triangles[id as usize]).collect()
            }
        }
    }

    #[test]
    fn boxes_hold_all_corners_below_in_their_frame() {
        for triangles in [sheet(), any(1), any(7), any(900)] {
            let (nodes, order, rotations) = oriented(&triangles);
            for (node, &rotation) in nodes.iter().zip(&rotations) {
                let stored = SixNode::from_words(&encode6(node, rotation));
                assert_eq!(stored.rotation.get(), u64::from(rotation));
                let frame = Rotation::numbered(rotation);
                let more = if rotation == 0 { 0 } else { i64::from(LET_OUT) };
                for (k, &child) in node.children.iter().enumerate() {
                    let bounds = stored.bounds(k);
                    for corner in corners(&nodes, &order, &triangles, child) {
                        let [below, above] = frame.around(corner);
                        for c in 0..3 {
                            assert!(
                                bounds.lo.get()[c] << 16 <= i64::from(below[c]) - more
                                    && i64::from(above[c]) + more <= bounds.hi.get()[c] << 16
                            );
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn a_slanted_sheet_is_turned_and_costs_less() {
        let triangles = sheet();
        let (nodes, _, rotations) = oriented(&triangles);
        let (as_built, _) = tree(&triangles);
        let cost = |nodes: &[WideNode<6>], turned: bool| {
            let of = |(node, &rotation): (&WideNode<6>, &u32)| {
                let lengths = Rotation::numbered(if turned { rotation } else { 0 }).lengths();
                node.boxes
                    .iter()
                    .zip(node.children)
                    .filter(|(_, child)| *child != Child::Empty)
                    .map(|(b, _)| area(b, &lengths))
                    .sum::<f64>()
            };
            nodes.iter().zip(&rotations).map(of).sum::<f64>()
        };
        let turned = rotations.iter().filter(|&&rotation| rotation > 0).count();
        assert!(turned * 10 > rotations.len() * 9, "{turned} of {}", rotations.len());
        assert!(cost(&nodes, true) < 0.8 * cost(&as_built, false), "{} {}", cost(&nodes, true), cost(&as_built, false));
    }

    #[test]
    fn the_number_of_threads_does_not_matter() {
        let triangles = any(3_000);
        let [one, three] = [1, 3].map(|threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| oriented(&triangles))
        });
        assert!(one == three);
    }
}
