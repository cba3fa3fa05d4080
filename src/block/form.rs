//! What blocks depend on of the hardware that they are built for.

use crate::num::MAX_LEVELS;

/// Edges of a triangle that a block takes in a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgesPerCycle {
    /// All three of a triangle.
    Three,
    /// One.
    One,
}

impl EdgesPerCycle {
    /// All that there are.
    pub const ALL: [Self; 2] = [Self::One, Self::Three];

    /// As many as `count`, if that may be.
    pub fn new(count: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|edges| edges.count() == count)
    }

    /// How many.
    pub const fn count(self) -> u32 {
        match self {
            Self::Three => 3,
            Self::One => 1,
        }
    }
}

/// Boxes that the test of four children tests in a cycle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BoxesPerCycle {
    /// All four of a node.
    Four,
    /// Two.
    Two,
    /// One.
    One,
}

impl BoxesPerCycle {
    /// All that there are.
    pub const ALL: [Self; 3] = [Self::One, Self::Two, Self::Four];

    /// How many.
    pub const fn count(self) -> u32 {
        match self {
            Self::Four => 4,
            Self::Two => 2,
            Self::One => 1,
        }
    }

    /// As many as `count`, if that may be.
    pub fn new(count: u32) -> Option<Self> {
        Self::ALL.into_iter().find(|boxes| boxes.count() == count)
    }

    /// Box tests side by side for nodes of so many children: one for each, or as many as four children have.
    pub const fn side_by_side(self, children: u32) -> u32 {
        match self {
            Self::Four => children,
            _ => self.count(),
        }
    }

    /// Cycles from one such node to the next.
    pub const fn passes(self, children: u32) -> u32 {
        children.div_ceil(self.side_by_side(children))
    }
}

/// The most bits of a quotient that a division finds in a cycle.
pub const MOST_DIVIDE_BITS: u32 = 3;

/// What blocks depend on of the hardware that they are built for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Form {
    /// The most 1-to-4 splits of a model.
    pub levels: u32,
    /// Edge functions of the triangle test.
    pub edges_per_cycle: EdgesPerCycle,
    /// Edges of the LOD test.
    pub lod_edges_per_cycle: EdgesPerCycle,
    /// Bits of a quotient in a cycle of the division of hits.
    pub divide_bits: u32,
    /// Bits of a reciprocal in a cycle of the constants of a ray.
    pub setup_bits: u32,
    /// Box tests of the test of four children.
    pub boxes_per_cycle: BoxesPerCycle,
    /// Levels of detail are chosen: triangles are morphed.
    pub lod_test: bool,
    /// Cones can have a radius where their rays start.
    pub start_radius: bool,
    /// Inserted vertices can be displacements.
    pub compact_vertices: bool,
    /// They can be stored as they are.
    pub exact_vertices: bool,
    /// Zero bits at the bottom of all coordinates, of origins and of morphed triangles too.
    pub coordinate_zeros: u32,
    /// Zero bits at the bottom of all components of directions.
    pub direction_zeros: u32,
}

impl Form {
    /// Of the default hardware.
    pub const FULL: Self = Self {
        levels: MAX_LEVELS,
        edges_per_cycle: EdgesPerCycle::One,
        lod_edges_per_cycle: EdgesPerCycle::One,
        divide_bits: MOST_DIVIDE_BITS,
        setup_bits: MOST_DIVIDE_BITS,
        boxes_per_cycle: BoxesPerCycle::Two,
        lod_test: true,
        start_radius: true,
        compact_vertices: true,
        exact_vertices: true,
        coordinate_zeros: 0,
        direction_zeros: 0,
    };
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_a_cycle_are_one_or_three() {
        assert_eq!([0, 1, 2, 3, 4].map(|count| EdgesPerCycle::new(count).map(EdgesPerCycle::count)), [None, Some(1), None, Some(3), None]);
    }

    #[test]
    fn boxes_a_cycle_are_one_two_or_four() {
        assert_eq!(
            [0, 1, 2, 3, 4, 5].map(|count| BoxesPerCycle::new(count).map(BoxesPerCycle::count)),
            [None, Some(1), Some(2), None, Some(4), None]
        );
    }
}
