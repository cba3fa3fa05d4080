//! What a ray does, step by step, in 64 bits each: all that time depends on, and nothing else.
//!
//! | step | what it stands for |
//! |---|---|
//! | `Node` | the lines of a quad-BVH node are read, its children tested, and `met` of them met |
//! | `Tree` | the lines of an L0 record are read |
//! | `Lod` | an LOD test |
//! | `Split` | the line of inserted vertices is read, then they are morphed |
//! | `Bounds` | the children's bound data, asked for together with the `Split` before; the children are tested, `met` are met |
//! | `Leaf` | a line of a leaf's triangles is read; all lines of a leaf follow each other |
//! | `Triangles` | triangle tests; bit k of `hits`: the k-th is met |
//! | `Pop` | a node is taken from the stack, and dropped if it lies behind the closest hit |
//! | `End` | the stack is empty; a hit was `found` or not |
//!
//! Lines are numbered through all sections of a method's memory. Word: line or `hits` in bits 63:16, flag in bit 15, number in bits 14:8, step in bits 7:0.

use crate::traverse::Kind;

/// A step of a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the table above")]
pub enum Step {
    Node { line: u32, met: u32, wide: bool },
    Tree { line: u32 },
    Lod { refine: bool },
    Split { line: u32 },
    Bounds { line: u32, met: u32 },
    Leaf { line: u32 },
    Triangles { count: u32, hits: u32 },
    Pop { dropped: bool },
    End { found: bool },
}

impl Step {
    /// The lines it reads: what they hold, the first, and how many.
    #[inline(always)]
    pub fn lines(self) -> Option<(Kind, u32, u32)> {
        match self {
            Self::Node { line, wide, .. } => Some((Kind::BvhNode, line, if wide { 4 } else { 2 })),
            Self::Tree { line } => Some((Kind::L0Record, line, 2)),
            Self::Split { line } => Some((Kind::VertexData, line, 1)),
            Self::Bounds { line, .. } => Some((Kind::BoundData, line, 2)),
            Self::Leaf { line } => Some((Kind::Leaf, line, 1)),
            _ => None,
        }
    }
}

/// The lines of a step, by its number; a node of wide boxes has twice as many.
const LINES: [u32; 16] = [2, 2, 0, 1, 2, 1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0];

/// What they hold.
const KINDS: [Kind; 16] = {
    let mut kinds = [Kind::BvhNode; 16];
    (kinds[1], kinds[3], kinds[4], kinds[5]) = (Kind::L0Record, Kind::VertexData, Kind::BoundData, Kind::Leaf);
    kinds
};

/// Bit k: lines of step k are asked for together with those before: inserted vertices with the children's bound data, and the lines of a leaf.
const JOINS: u16 = 1 << 4 | 1 << 5;

/// A step, as whoever only reads its lines sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asking {
    /// The first line, and how many.
    pub first: u32,
    /// 0, 1, 2 or 4.
    pub lines: u32,
    /// What they hold.
    pub kind: Kind,
    /// They are asked for together with those before.
    pub joins: bool,
    /// The ray ends.
    pub ends: bool,
}

/// A [`Step`] as a word.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct Event(u64);

impl Event {
    const fn new(step: u8, number: u32, flag: bool, rest: u32) -> Self {
        Self(step as u64 | (number as u64) << 8 | (flag as u64) << 15 | (rest as u64) << 16)
    }

    /// The word; `met` is at most 4 and `count` below 128.
    #[inline(always)]
    pub fn pack(step: Step) -> Self {
        match step {
            Step::Node { line, met, wide } => Self::new(0, met, wide, line),
            Step::Tree { line } => Self::new(1, 0, false, line),
            Step::Lod { refine } => Self::new(2, 0, refine, 0),
            Step::Split { line } => Self::new(3, 0, false, line),
            Step::Bounds { line, met } => Self::new(4, met, false, line),
            Step::Leaf { line } => Self::new(5, 0, false, line),
            Step::Triangles { count, hits } => Self::new(6, count, false, hits),
            Step::Pop { dropped } => Self::new(7, 0, dropped, 0),
            Step::End { found } => Self::new(8, 0, found, 0),
        }
    }

    /// What a ray does with its step towards its next lines. (Tables and no branches: of every step, that is all the replay without compute looks at.)
    #[inline(always)]
    pub fn asking(self) -> Asking {
        let step = (self.0 & 15) as usize;
        let wide = (self.0 >> 15 & 1) as u32;
        Asking {
            first: (self.0 >> 16) as u32,
            lines: LINES[step] << (wide & u32::from(step == 0)),
            kind: KINDS[step],
            joins: JOINS >> step & 1 == 1,
            ends: step == 8,
        }
    }

    /// The step.
    #[inline(always)]
    pub fn step(self) -> Step {
        let (number, flag, rest) = ((self.0 >> 8) as u32 & 0x7f, self.0 >> 15 & 1 == 1, (self.0 >> 16) as u32);
        match self.0 as u8 {
            0 => Step::Node { line: rest, met: number, wide: flag },
            1 => Step::Tree { line: rest },
            2 => Step::Lod { refine: flag },
            3 => Step::Split { line: rest },
            4 => Step::Bounds { line: rest, met: number },
            5 => Step::Leaf { line: rest },
            6 => Step::Triangles { count: number, hits: rest },
            7 => Step::Pop { dropped: flag },
            _ => Step::End { found: flag },
        }
    }
}

impl std::fmt::Debug for Event {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.step().fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_give_back_their_steps() {
        let steps = [
            Step::Node { line: u32::MAX, met: 4, wide: true },
            Step::Node { line: 0, met: 0, wide: false },
            Step::Tree { line: 7 },
            Step::Lod { refine: true },
            Step::Lod { refine: false },
            Step::Split { line: u32::MAX },
            Step::Bounds { line: 123_456_789, met: 3 },
            Step::Leaf { line: 1 },
            Step::Triangles { count: 127, hits: u32::MAX },
            Step::Pop { dropped: true },
            Step::Pop { dropped: false },
            Step::End { found: true },
            Step::End { found: false },
        ];
        for step in steps {
            let event = Event::pack(step);
            assert_eq!(event.step(), step);
            let asking = event.asking();
            assert_eq!((asking.lines > 0).then_some((asking.kind, asking.first, asking.lines)), step.lines());
            assert_eq!(asking.joins, matches!(step, Step::Bounds { .. } | Step::Leaf { .. }));
            assert_eq!(asking.ends, matches!(step, Step::End { .. }));
        }
    }
}
