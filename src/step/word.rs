//! A step in 64 bits.
//!
//! | bits | what |
//! |---|---|
//! | 63:32 | the first line, `hits`, or the `count` of work |
//! | 31:28 | act; of `Children` 8 and the three lower bits of the shape |
//! | 27:22 | `met`, `count`, `work` or `found` |
//! | 21 | `refine`, `dropped`, or bit 3 of the shape |
//! | 20 | `mapped`, or bit 4 of the shape |
//! | 19:17 | section |
//! | 16:14 | lines; 0 if none are asked for |
//! | 13 | taken by a packet |
//! | 12 | stores |
//! | 11 | joins |
//! | 10 | visits |
//! | 9:0 | place; of a packet 9:5 its rays less one, 4:0 the place |

use super::{Act, Fetch, MAX_FETCH_LINES, MAX_PLACES, MAX_RUN, NodeShape, SectionId, Step};
use crate::block::MAX_WORKS;

const UPPER: u32 = 32;
const ACT: u32 = 28;
const NUMBER: u32 = 22;
const FLAG: u32 = 21;
const MAPPED: u32 = 20;
const SECTION: u32 = 17;
const LINES: u32 = 14;
const PACKET: u32 = 13;
const STORES: u32 = 12;
const JOINS: u32 = 11;
const VISITS: u32 = 10;
const LANES: u32 = 5;
const PLACE: u32 = 0;

/// Places of lines in a record that a packet reads.
const PACKET_PLACES: u32 = 1 << LANES;

const FETCH: u64 = 0;
const WORK: u64 = 1;
const DECIDE: u64 = 2;
const LOD_TEST: u64 = 3;
const TESSELLATE: u64 = 4;
const TRIANGLES: u64 = 5;
const POP: u64 = 6;
const END: u64 = 7;
/// With the three lower bits of a node's shape in place of the zeros.
const CHILDREN: u64 = 8;

/// A step, as whoever only reads its lines sees it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Asking {
    /// The first line.
    pub first: u32,
    /// How many, 0 to [`MAX_FETCH_LINES`].
    pub lines: u32,
    /// What they hold.
    pub section: SectionId,
    /// They are asked for together with those before.
    pub joins: bool,
    /// They are written.
    pub stores: bool,
    /// The ray ends.
    pub ends: bool,
}

/// A [`Step`] as a word.
#[derive(Clone, Copy, PartialEq, Eq)]
pub struct StepWord(u64);

impl StepWord {
    /// The word.
    ///
    /// # Panics
    /// More lines than [`MAX_FETCH_LINES`] or none, more tests than [`MAX_RUN`], work beyond [`MAX_WORKS`], a place beyond [`MAX_PLACES`] (of a packet 32), no rays or more than [`MAX_RUN`], or tests of triangles, work or the end together with lines.
    #[inline(always)]
    pub fn pack(step: Step) -> Self {
        let (act, number, flag, mapped, hits) = match step.act {
            Act::Fetch => (FETCH, 0, false, false, 0),
            Act::Children { shape, met } => {
                (CHILDREN | u64::from(shape as u8 & 7), met, shape as u8 >> 3 & 1 == 1, shape as u8 >> 4 == 1, 0)
            }
            Act::Decide => (DECIDE, 0, false, false, 0),
            Act::LodTest { refine } => (LOD_TEST, 0, refine, false, 0),
            Act::Tessellate => (TESSELLATE, 0, false, false, 0),
            Act::Triangles { count, hits } => (TRIANGLES, count, false, false, hits),
            Act::Work { work, count } => (WORK, work, false, false, count),
            Act::Pop { dropped } => (POP, 0, dropped, false, 0),
            Act::End { found, mapped } => (END, found, false, mapped, 0),
        };
        let most = if act == WORK { MAX_WORKS as u32 - 1 } else { MAX_RUN };
        assert!(number <= most, "{step:?}: more than a step holds");
        let mut word = act << ACT | u64::from(number) << NUMBER | u64::from(flag) << FLAG | u64::from(mapped) << MAPPED;
        word |= u64::from(step.visits) << VISITS | u64::from(hits) << UPPER;
        let places = if step.lanes == 1 { MAX_PLACES } else { PACKET_PLACES };
        if step.lanes != 1 {
            assert!((2..=MAX_RUN).contains(&step.lanes), "{step:?}: more than a step holds");
            word |= 1 << PACKET | u64::from(step.lanes - 1) << LANES;
        }
        if let Some(fetch) = step.fetch {
            let fits = (1..=MAX_FETCH_LINES).contains(&fetch.lines) && fetch.place < places && !matches!(act, TRIANGLES | WORK | END);
            assert!(fits, "{step:?}: more than a step holds");
            word |= u64::from(fetch.line) << UPPER
                | (fetch.section.place() as u64) << SECTION
                | u64::from(fetch.lines) << LINES
                | u64::from(fetch.place) << PLACE
                | u64::from(fetch.joins) << JOINS
                | u64::from(fetch.stores) << STORES;
        }
        Self(word)
    }

    #[inline(always)]
    fn bits(self, from: u32, mask: u64) -> u32 {
        (self.0 >> from & mask) as u32 // masks have at most ten bits
    }

    /// What a ray does with its step towards its next lines. (Of every step, that is all the replay without compute looks at.)
    #[inline(always)]
    pub fn asking(self) -> Asking {
        Asking {
            first: (self.0 >> UPPER) as u32,
            lines: self.bits(LINES, 7),
            section: SectionId::new(self.bits(SECTION, 7) as usize),
            joins: self.bits(JOINS, 1) == 1,
            stores: self.bits(STORES, 1) == 1,
            ends: self.0 >> ACT & 15 == END,
        }
    }

    /// The step.
    #[inline(always)]
    pub fn step(self) -> Step {
        let (number, flag, upper) = (self.bits(NUMBER, 63), self.bits(FLAG, 1) == 1, (self.0 >> UPPER) as u32);
        let act = match self.0 >> ACT & 15 {
            FETCH => Act::Fetch,
            DECIDE => Act::Decide,
            LOD_TEST => Act::LodTest { refine: flag },
            TESSELLATE => Act::Tessellate,
            TRIANGLES => Act::Triangles { count: number, hits: upper },
            WORK => Act::Work { work: number, count: upper },
            POP => Act::Pop { dropped: flag },
            END => Act::End { found: number, mapped: self.bits(MAPPED, 1) == 1 },
            children => {
                let shape = (children & 7) as u32 | u32::from(flag) << 3 | self.bits(MAPPED, 1) << 4; // five bits
                Act::Children { shape: NodeShape::of_number(shape), met: number }
            }
        };
        let low = self.bits(PLACE, u64::from(MAX_PLACES) - 1);
        let (lanes, place) = match self.bits(PACKET, 1) {
            0 => (1, low),
            _ => (1 + (low >> LANES), low & (PACKET_PLACES - 1)),
        };
        let fetch = Fetch {
            section: SectionId::new(self.bits(SECTION, 7) as usize),
            line: upper,
            lines: self.bits(LINES, 7),
            place,
            joins: self.bits(JOINS, 1) == 1,
            stores: self.bits(STORES, 1) == 1,
        };
        Step { visits: self.bits(VISITS, 1) == 1, fetch: (fetch.lines > 0).then_some(fetch), act, lanes }
    }
}

impl std::fmt::Debug for StepWord {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        self.step().fmt(f)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn same(step: Step) {
        let word = StepWord::pack(step);
        assert_eq!(word.step(), step);
        let asking = word.asking();
        let fetch = step.fetch.map(|f| (f.line, f.lines, f.section, f.joins, f.stores));
        assert_eq!((asking.lines > 0).then_some((asking.first, asking.lines, asking.section, asking.joins, asking.stores)), fetch);
        assert_eq!(asking.ends, matches!(step.act, Act::End { .. }));
    }

    #[test]
    fn words_give_back_their_steps() {
        let acts = [
            Act::Fetch,
            Act::Decide,
            Act::LodTest { refine: true },
            Act::LodTest { refine: false },
            Act::Tessellate,
            Act::Pop { dropped: true },
            Act::Pop { dropped: false },
            Act::End { found: 1, mapped: false },
            Act::End { found: 32, mapped: true },
            Act::End { found: 0, mapped: true },
        ];
        let children = NodeShape::ALL.into_iter().zip(0..).map(|(shape, met)| Act::Children { shape, met });
        for (k, act) in acts.into_iter().chain(children).enumerate() {
            let fetch = Fetch {
                section: SectionId::new(k % 8),
                line: u32::MAX - k as u32,
                lines: 1 + k as u32 % MAX_FETCH_LINES,
                place: k as u32 * 93 % MAX_PLACES,
                joins: k % 2 == 0,
                stores: k % 3 == 0,
            };
            same(Step::of(act));
            same(Step::of(act).visiting());
            for lanes in [2, 17, 32] {
                same(Step::of(act).by(lanes));
            }
            if !matches!(act, Act::End { .. }) {
                same(Step::on(fetch, act));
                same(Step::on(fetch, act).visiting());
                same(Step::on(Fetch { place: fetch.place % 32, ..fetch }, act).by(2 + k as u32).visiting());
            }
        }
        for work in [0, 15] {
            same(Step::of(Act::Work { work, count: u32::MAX - work }));
        }
        for (count, hits) in [(1, 1), (4, 0), (32, u32::MAX), (32, 1 << 31)] {
            same(Step::of(Act::Triangles { count, hits }));
        }
    }

    #[test]
    fn what_does_not_fit_is_refused_in_every_build() {
        let fetch = Fetch::new(SectionId::new(1), 3, 1);
        let bad = [
            Step::of(Act::Triangles { count: MAX_RUN + 1, hits: 0 }),
            Step::of(Act::Children { shape: NodeShape::Tree, met: 33 }),
            Step::on(Fetch { lines: MAX_FETCH_LINES + 1, ..fetch }, Act::Fetch),
            Step::on(Fetch { lines: 0, ..fetch }, Act::Fetch),
            Step::on(Fetch { place: MAX_PLACES, ..fetch }, Act::Fetch),
            Step::on(fetch, Act::Triangles { count: 1, hits: 1 }),
            Step::on(fetch, Act::Work { work: 0, count: 1 }),
            Step::of(Act::Work { work: 16, count: 1 }),
            Step::on(fetch, Act::End { found: 1, mapped: true }),
            Step::of(Act::Tessellate).by(0),
            Step::of(Act::Tessellate).by(MAX_RUN + 1),
            Step::on(Fetch { place: 32, ..fetch }, Act::Fetch).by(2),
        ];
        for step in bad {
            assert!(std::panic::catch_unwind(|| StepWord::pack(step)).is_err(), "{step:?}");
        }
    }
}
