//! The same structure in `f32`, one ray after the other on one thread: for its speed alone, beside papers that have floats. Hits of rays near edges may differ from the exact ones.

use super::tree::{Kind, LEAF, Tree};
use crate::bvh::BvhError;
use crate::mesh::Hierarchy;
use crate::method::floats::FloatRay;

/// A node.
struct FloatNode {
    lo: [f32; 3],
    hi: [f32; 3],
    kind: Kind,
}

/// A node that is to be visited.
#[derive(Clone, Copy)]
struct Entry {
    near: f32,
    node: u32,
    leaf: u32,
}

/// A tree with coordinates of single precision.
pub struct FloatTree {
    nodes: Vec<FloatNode>,
    triples: Vec<[u32; 3]>,
    vertices: Vec<[f32; 3]>,
    /// Places for triangles in each leaf.
    leaf: usize,
    stack: Vec<Entry>,
}

impl FloatTree {
    /// The same tree; coordinates that single precision does not have are rounded, and boxes with them: a box holds its rounded vertices.
    pub fn new(tree: &Tree) -> Self {
        let float = |p: [i32; 3]| p.map(|c| c as f32);
        let node = |node: &super::tree::Node| FloatNode { lo: float(node.bounds.lo), hi: float(node.bounds.hi), kind: node.kind() };
        Self {
            nodes: tree.nodes.iter().map(node).collect(),
            triples: tree.triples.clone(),
            vertices: tree.vertices.iter().map(|&p| float(p)).collect(),
            leaf: tree.leaf,
            stack: Vec::new(),
        }
    }

    /// A tree with leaves of another size than the paper's, 1 to 16: what these are worth on a processor.
    ///
    /// # Errors
    /// Those of [`Tree::new`].
    pub fn with_leaves(hierarchy: &Hierarchy, leaf: usize) -> Result<Self, BvhError> {
        Ok(Self::new(&Tree::with_leaves(hierarchy, leaf.clamp(1, LEAF))?))
    }

    /// How many of these rays meet something, each traced to its closest hit.
    pub fn hits(&mut self, rays: &[FloatRay]) -> usize {
        rays.iter().filter(|ray| self.trace(ray).is_some()).count()
    }

    /// Distance to the closest hit of a ray, in units.
    pub fn trace(&mut self, ray: &FloatRay) -> Option<f32> {
        let Self { nodes, triples, vertices, leaf: size, stack } = self;
        stack.clear();
        let mut closest = f32::MAX;
        let mut next = Some(Entry { near: 0.0, node: 0, leaf: 0 });
        while let Some(Entry { near, node, leaf }) = next.take().or_else(|| stack.pop()) {
            if near >= closest {
                continue;
            }
            match nodes[node as usize].kind {
                Kind::Leaf(count) => {
                    for triple in &triples[*size * leaf as usize..][..count] {
                        if let Some(t) = ray.triangle(triple.map(|v| vertices[v as usize]), closest) {
                            closest = t;
                        }
                    }
                }
                Kind::Inner { nodes: below, leaves } => {
                    let children = [(node + 1, leaf), (node + 1 + below, leaf + leaves)];
                    let met = children.map(|(node, leaf)| {
                        let own = &nodes[node as usize];
                        ray.slabs(own.lo, own.hi, closest).map(|near| Entry { near, node, leaf })
                    });
                    next = match met {
                        [Some(a), Some(b)] => {
                            let (first, then) = if b.near < a.near { (b, a) } else { (a, b) };
                            stack.push(then);
                            Some(first)
                        }
                        [a, b] => a.or(b),
                    };
                }
            }
        }
        (closest < f32::MAX).then_some(closest)
    }
}
