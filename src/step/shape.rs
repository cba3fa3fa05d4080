//! Nodes by the shape of their children's bounds, as a table: how many children there are, and which operations test them. A new kind of node is a line here.

use crate::block::Operation;

/// What a node's children are bounded by, and how that is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum NodeShape {
    /// Boxes that follow from those of the node's lines and, in trees, from its triangle.
    Tree,
    /// Prisms that follow from the node's line and its triangle.
    Prisms,
    /// 16-bit boxes that are stored as they are.
    Plain,
    /// 16-bit boxes that are stored in steps from their node's corner.
    Local,
    /// 32-bit boxes.
    Wide,
    /// 32-bit boxes of two children.
    Pair,
    /// 16-bit boxes of six children that are stored in finer steps from the node's corner.
    Six,
    /// The same in a frame that the ray is first turned into.
    Turned,
    /// A model where it stands: the ray goes on in the model's own space.
    Instance,
}

/// A line of the table.
#[derive(Debug)]
pub struct ShapeFacts {
    /// Its letter where steps are written in short.
    pub letter: char,
    /// Its children's bounds in words.
    pub words: &'static str,
    /// How many children are tested.
    pub children: u32,
    /// What tests them, in order, and how often a node takes each: once for a child, or once for all.
    pub path: &'static [(Operation, u32)],
}

impl NodeShape {
    /// All, in the order of their numbers.
    pub const ALL: [Self; 9] =
        [Self::Tree, Self::Prisms, Self::Plain, Self::Local, Self::Wide, Self::Pair, Self::Six, Self::Turned, Self::Instance];

    /// The shape's line of the table.
    #[inline(always)]
    pub const fn facts(self) -> &'static ShapeFacts {
        const TABLE: [ShapeFacts; NodeShape::ALL.len()] = [
            ShapeFacts { letter: 'c', words: "boxes in steps, widened where morphed", children: 4, path: &[(Operation::ChildTest, 1)] },
            ShapeFacts { letter: 'g', words: "prisms", children: 4, path: &[(Operation::ChildPrisms, 1)] },
            ShapeFacts { letter: 'p', words: "16-bit boxes", children: 4, path: &[(Operation::BoxTest, 4), (Operation::ChildSort, 1)] },
            ShapeFacts {
                letter: 'l',
                words: "16-bit boxes in steps",
                children: 4,
                path: &[(Operation::BoxDecode, 4), (Operation::BoxTest, 4), (Operation::ChildSort, 1)],
            },
            ShapeFacts { letter: 'w', words: "32-bit boxes", children: 4, path: &[(Operation::BoxTest32, 4), (Operation::ChildSort, 1)] },
            ShapeFacts {
                letter: 'z',
                words: "32-bit boxes of two children",
                children: 2,
                path: &[(Operation::BoxTest32, 2), (Operation::ChildSort, 1)],
            },
            ShapeFacts {
                letter: 'b',
                words: "16-bit boxes in finer steps",
                children: 6,
                path: &[(Operation::BoxDecode8, 6), (Operation::BoxTest, 6), (Operation::ChildSort6, 1)],
            },
            ShapeFacts {
                letter: 'e',
                words: "16-bit boxes in finer steps, in another frame than those before",
                children: 6,
                path: &[(Operation::RaySetup, 1), (Operation::BoxDecode8, 6), (Operation::BoxTest, 6), (Operation::ChildSort6, 1)],
            },
            ShapeFacts { letter: 'i', words: "a model in a space of its own", children: 1, path: &[(Operation::RaySetup, 1)] },
        ];
        const FACTS: &[ShapeFacts; NodeShape::ALL.len()] = &TABLE;
        &FACTS[self as usize]
    }

    /// The shape of this number.
    #[inline(always)]
    pub(super) const fn of_number(number: u32) -> Self {
        Self::ALL[number as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_and_letters_tell_shapes_apart() {
        for (number, shape) in NodeShape::ALL.into_iter().enumerate() {
            assert_eq!((shape as usize, NodeShape::of_number(number as u32)), (number, shape));
            let facts = shape.facts();
            let same =
                NodeShape::ALL.into_iter().filter(|other| other.facts().letter == facts.letter || other.facts().words == facts.words);
            assert_eq!(same.count(), 1, "{shape:?}");
            // Letters of other acts (`report/inspect.rs`).
            assert!(!"fkyrstxodhmn".contains(facts.letter), "{shape:?}");
            assert!(facts.path.iter().all(|&(_, times)| times == 1 || times == facts.children), "{shape:?}");
        }
    }
}
