//! How a BVH is built.

use super::build::Prim;

/// How the binary tree becomes a quad tree.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Collapse {
    /// The cheapest of all collapses of the binary tree, by dynamic programming.
    #[default]
    Optimal,
    /// Opens the child of largest area until there are four; leaves as large as allowed. For comparison.
    Greedy,
}

/// What the surface area heuristic counts, relative to each other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Costs {
    /// One visit of a node: up to two 32-byte lines, four box tests.
    pub node: f64,
    /// One triangle of a leaf: one line or a little more, one triangle test; of a leaf block the test alone.
    pub primitive: f64,
    /// One line of a leaf block.
    pub line: f64,
}

impl Default for Costs {
    /// By lines read, which is what the energy follows: two for a node, one for a triangle.
    fn default() -> Self {
        Self { node: 1.0, primitive: 0.5, line: 0.0 }
    }
}

/// How a quad-BVH is built.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// Largest number of primitives of a leaf: 1 to 4, or 16 where leaves are blocks.
    pub max_leaf: u32,
    /// Collapse to four children.
    pub collapse: Collapse,
    /// Costs of the heuristic, both positive and finite.
    pub costs: Costs,
}

impl Options {
    /// Leaves of at most `max_leaf` primitives, optimal collapse, default costs.
    pub fn with_leaf(max_leaf: u32) -> Self {
        Self { max_leaf, collapse: Collapse::default(), costs: Costs::default() }
    }

    /// What a leaf of some primitives costs for each unit of its area, if it may be one: where all leaves up to the largest may.
    pub(crate) fn leaf_cost(&self) -> impl Fn(&[Prim]) -> Option<f64> + Sync + use<> {
        let Self { max_leaf, costs, .. } = *self;
        // 1 to 4: exact in f64.
        move |prims| (prims.len() <= max_leaf as usize).then_some(costs.primitive * prims.len() as f64)
    }
}
