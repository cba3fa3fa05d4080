//! The same traversal in floats of 32 bits alone, with the paper's binary nodes: what it takes of a processor's time.

use super::bounds::Bounds;
use super::mesh::GridMesh;
use super::pattern::{LeafPattern, Preliminary, first_of_depth};
use super::top::Top;
use super::tuple::Tuple;
use crate::method::floats::{FloatRay, dot, less};
use crate::num::prism::child;
use std::sync::Arc;

/// A node of the BVH with its box.
#[derive(Clone, Copy, Debug)]
struct FloatNode {
    lo: [f32; 3],
    hi: [f32; 3],
    skip: u32,
    leaf: u32,
}

/// What a ray meets: distance in units, primitive, and triangle of its finest level.
pub type FloatHit = (f32, u32, u32);

/// Traces rays in floats.
pub struct FloatGrid {
    mesh: Arc<GridMesh>,
    nodes: Vec<FloatNode>,
    radii: Vec<[f32; 4]>,
    /// Corners, boundaries and insides, one behind the other.
    vertices: Vec<[f32; 3]>,
    /// Where boundaries and insides begin.
    starts: [usize; 2],
    leaves: LeafPattern,
    stack: Vec<(f32, u32)>,
}

impl FloatGrid {
    /// A traverser of `mesh` at full depth; `None` if its nodes are not of two children, or its bounds are no spheres.
    pub fn new(mesh: Arc<GridMesh>) -> Option<Self> {
        let (Top::Two(nodes), Bounds::Spheres(radii)) = (&mesh.top, &mesh.bounds) else { return None };
        let float = |p: [i32; 3]| p.map(|c| c as f32);
        let node =
            |of: &super::binary::PairNode| FloatNode { lo: float(of.bounds.lo), hi: float(of.bounds.hi), skip: of.skip, leaf: of.leaf };
        let nodes = nodes.iter().map(node).collect();
        let [corners, boundaries, insides] = mesh.vertices();
        let vertices = [corners, boundaries, insides].into_iter().flatten().map(|&p| float(p)).collect();
        let starts = [corners.len(), corners.len() + boundaries.len()];
        let leaves = mesh.pattern.leaves(mesh.bounded, mesh.pattern.splits);
        Some(Self { nodes, radii: radii.clone(), vertices, starts, leaves, stack: Vec::new(), mesh })
    }

    /// The nearest triangle that a ray meets.
    pub fn trace(&mut self, ray: &FloatRay) -> Option<FloatHit> {
        let mut best = (f32::INFINITY, 0, 0);
        self.stack.clear();
        self.stack.push((0.0, 0));
        while let Some((near, mut at)) = self.stack.pop() {
            if near > best.0 {
                continue;
            }
            loop {
                let node = self.nodes[at as usize];
                if node.skip == 0 {
                    self.primitive(ray, node.leaf, &mut best);
                    break;
                }
                let children = [at + 1, at + 1 + node.skip];
                let met = children.map(|at| {
                    let FloatNode { lo, hi, .. } = self.nodes[at as usize];
                    ray.slabs(lo, hi, best.0)
                });
                at = match met {
                    [None, None] => break,
                    [Some(_), None] => children[0],
                    [None, Some(_)] => children[1],
                    [Some(a), Some(b)] => {
                        let first = usize::from(b < a);
                        self.stack.push(([a, b][1 - first], children[1 - first]));
                        children[first]
                    }
                };
            }
        }
        best.0.is_finite().then_some(best)
    }

    #[inline(always)]
    fn vertex(&self, primitive: usize, tuple: &Tuple, of: Preliminary) -> [f32; 3] {
        let (_, index) = self.mesh.place(primitive, tuple, of);
        self.vertices[match of {
            Preliminary::Corner(_) => index,
            Preliminary::Boundary(..) => self.starts[0] + index,
            Preliminary::Inside(_) => self.starts[1] + index,
        }]
    }

    #[inline(always)]
    fn primitive(&self, ray: &FloatRay, number: u32, best: &mut FloatHit) {
        let primitive = number as usize;
        let tuple = self.mesh.tuple(primitive);
        let end = self.leaves.depth;
        let mut stack = [(0.0f32, 0u16, 0u8); 16];
        let mut count = 1;
        while count > 0 {
            count -= 1;
            let (near, node, depth) = stack[count];
            if near > best.0 {
                continue;
            }
            if u32::from(depth) == end {
                self.leaf(ray, number, tuple, usize::from(node) - first_of_depth(end), best);
                continue;
            }
            let points = self.mesh.pattern.node(node.into()).map(|of| self.vertex(primitive, tuple, of));
            let radii = self.radii[self.mesh.group(primitive, node.into())];
            let first = count;
            for (k, radius) in radii.into_iter().enumerate() {
                let [a, b, c] = child(&points, k);
                let centre: [f32; 3] = std::array::from_fn(|axis| (a[axis] + b[axis] + c[axis]) * (1.0 / 3.0));
                let to = less(centre, ray.origin);
                let along = dot(to, ray.direction);
                let beside = less(to, ray.direction.map(|c| c * along));
                let chord = radius * radius - dot(beside, beside);
                if chord < 0.0 {
                    continue;
                }
                let half = chord.sqrt();
                let near = along - half;
                if along + half < 0.0 || near > best.0 {
                    continue;
                }
                // The nearest on top.
                let mut at = count;
                while at > first && stack[at - 1].0 < near {
                    stack[at] = stack[at - 1];
                    at -= 1;
                }
                stack[at] = (near, 4 * node + 1 + k as u16, depth + 1); // at most 340 nodes
                count += 1;
            }
        }
    }

    #[inline(always)]
    fn leaf(&self, ray: &FloatRay, number: u32, tuple: &Tuple, node: usize, best: &mut FloatHit) {
        let mut points = [[0.0; 3]; 153];
        let vertices = self.leaves.vertices(node);
        for (to, &of) in points.iter_mut().zip(vertices) {
            *to = self.vertex(number as usize, tuple, of);
        }
        let first = (node << (2 * self.leaves.splits)) as u32; // at most 256
        for (k, places) in (0..).zip(&self.leaves.triangles) {
            if let Some(t) = ray.triangle(places.map(|at| points[usize::from(at)]), best.0) {
                *best = (t, number, first | k);
            }
        }
    }
}
