//! Binary trees that something else built, to compare with.

use super::Box32;
use super::build::{Binary, Node, Prim};

/// A node of a binary tree that something else built.
#[derive(Clone, Copy, Debug)]
pub enum BinaryNode {
    /// Two nodes, by their places.
    Inner([u32; 2]),
    /// A primitive.
    Leaf(u32),
}

/// Puts `prims`, of which the k-th is primitive k, into the order of the leaves of `tree`, whose first node is the root; none if that is no tree over all of
/// them, each once, or a path holds more than `2 * depth` inner nodes.
pub(crate) fn adopt(prims: &[Prim], tree: &[BinaryNode], depth: u32) -> Option<(Vec<Prim>, Binary)> {
    let mut adoption = Adoption {
        prims,
        tree,
        held: vec![false; prims.len()],
        order: Vec::with_capacity(prims.len()),
        nodes: vec![Node::default(); prims.len().checked_sub(1)?],
    };
    let (_, root, _) = adoption.subtree(0, 2 * depth)?;
    (adoption.order.len() == prims.len()).then_some((adoption.order, Binary { nodes: adoption.nodes, root }))
}

struct Adoption<'a> {
    prims: &'a [Prim],
    tree: &'a [BinaryNode],
    held: Vec<bool>,
    order: Vec<Prim>,
    nodes: Vec<Node>,
}

impl Adoption<'_> {
    /// Box, split position and height of the subtree of node `at`, below which paths hold at most `depth` inner nodes.
    fn subtree(&mut self, at: u32, depth: u32) -> Option<(Box32, u32, u8)> {
        let begin = self.order.len() as u32; // at most 2^28
        match *self.tree.get(at as usize)? {
            BinaryNode::Leaf(primitive) => {
                let prim = *self.prims.get(primitive as usize)?;
                if std::mem::replace(&mut self.held[primitive as usize], true) {
                    return None;
                }
                self.order.push(prim);
                Some((prim.bounds(), begin, 0))
            }
            BinaryNode::Inner([lower, upper]) => {
                let depth = depth.checked_sub(1)?;
                let (lower_bounds, left, lower_height) = self.subtree(lower, depth)?;
                let split = self.order.len() as u32; // at most 2^28
                let (upper_bounds, right, upper_height) = self.subtree(upper, depth)?;
                let (bounds, height) = (lower_bounds.union(&upper_bounds), lower_height.max(upper_height) + 1);
                self.nodes[split as usize - 1] = Node { bounds, left, right, height };
                Some((bounds, split, height))
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn prims(count: u32) -> Vec<Prim> {
        (0..count).map(|k| Prim::new(&Box32 { lo: [k as i32 * 16; 3], hi: [k as i32 * 16 + 16; 3] }, k)).collect()
    }

    #[test]
    fn a_tree_is_taken_as_it_is_and_what_is_none_is_not() {
        use BinaryNode::{Inner, Leaf};
        let tree = [Inner([1, 2]), Leaf(2), Inner([3, 4]), Leaf(0), Leaf(1)];
        let (order, binary) = adopt(&prims(3), &tree, 1).unwrap();
        assert_eq!(order.iter().map(|prim| prim.id).collect::<Vec<_>>(), [2, 0, 1]);
        let Node { bounds, left, right, height } = binary.nodes[binary.root as usize - 1];
        assert_eq!((binary.root, bounds, right, height), (1, Box32 { lo: [0; 3], hi: [48; 3] }, 2, 2));
        assert_eq!(left, 0);
        assert_eq!((binary.nodes[1].bounds, binary.nodes[1].height), (Box32 { lo: [0; 3], hi: [32; 3] }, 1));
        let none = |count, tree: &[BinaryNode], depth| adopt(&prims(count), tree, depth).is_none();
        assert!(none(3, &tree, 0) && none(4, &tree, 1) && none(2, &tree, 1) && none(0, &[], 1));
        assert!(none(3, &[Inner([1, 2]), Leaf(2), Inner([3, 4]), Leaf(0), Leaf(0)], 1), "one twice");
        assert!(none(3, &[Inner([0, 0])], 1) && none(1, &[Inner([1, 9]), Leaf(0)], 1));
        assert!(!none(1, &[Leaf(0)], 0));
    }
}
