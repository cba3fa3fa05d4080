//! What happens in the memory hierarchy, and what others are told of it.

use super::counts::Supplier;
use crate::step::SectionId;

/// Bits of the number of who has an event; its kind stands above.
const ID_BITS: u32 = 28;

/// Classes of the wheel: within a cycle lines are moved and given first, then asked for. (The shared side has two: misses that come, and all else.)
pub const MOVES: usize = 0;
pub const SERVES: usize = 1;
pub const ANSWERS: usize = 2;
pub const WAKES: usize = 3;
/// (Of its own: how grants and wakes of a cycle are entered depends on where rounds end.)
pub const GRANTS: usize = 4;

/// How many events ahead of it an event's own state is fetched, and how many what that leads to.
pub const FAR: usize = 5;
pub const NEAR: usize = 2;

/// What happens.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum EventKind {
    Wake,
    AnswerL1,
    AnswerL2,
    AnswerDram,
    ServeL1,
    Crossbar,
    ArriveL2,
    ServeL2,
    PushDram,
    FillL2,
    FreeL2,
    FillL1FromL2,
    FillL1FromDram,
    Miss,
    Grant,
}

impl EventKind {
    /// The kind of an event.
    #[inline(always)]
    pub fn of(event: u32) -> Self {
        KINDS[(event >> ID_BITS) as usize]
    }

    /// The event of this kind that `id` has.
    #[inline(always)]
    pub fn event(self, id: u32) -> u32 {
        debug_assert!(id < 1 << ID_BITS);
        (self as u32) << ID_BITS | id
    }

    /// Its class.
    #[inline(always)]
    pub const fn class(self) -> usize {
        match self {
            Self::Wake => WAKES,
            Self::Grant => GRANTS,
            Self::AnswerL1 | Self::AnswerL2 | Self::AnswerDram => ANSWERS,
            Self::ServeL1 | Self::Miss => SERVES,
            _ => MOVES,
        }
    }
}

/// Who has an event.
#[inline(always)]
pub fn id(event: u32) -> u32 {
    event & ((1 << ID_BITS) - 1)
}

const KINDS: [EventKind; 15] = [
    EventKind::Wake,
    EventKind::AnswerL1,
    EventKind::AnswerL2,
    EventKind::AnswerDram,
    EventKind::ServeL1,
    EventKind::Crossbar,
    EventKind::ArriveL2,
    EventKind::ServeL2,
    EventKind::PushDram,
    EventKind::FillL2,
    EventKind::FreeL2,
    EventKind::FillL1FromL2,
    EventKind::FillL1FromDram,
    EventKind::Miss,
    EventKind::Grant,
];

/// A request for a line.
#[derive(Clone, Copy, Debug)]
pub struct Ask {
    /// Which.
    pub line: u32,
    /// What it holds.
    pub section: SectionId,
    /// It is written: the answer says that the L2 has it.
    pub stores: bool,
}

/// What became of a request.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked {
    /// The line comes in this cycle, which nobody will be told.
    Comes(u64),
    /// Its [`Happening::Answer`] will come.
    Taken,
    /// Its bank's queue is full: it is held, and taken later, of which the port is woken; until then the port may ask for nothing.
    Held,
}

/// What whoever uses the hierarchy is told.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Happening {
    /// The cycle that was asked for with [`GroupSide::wake_at`](super::group_side::GroupSide::wake_at), or the port's request was taken that had been held.
    Wake(u32),
    /// The line that was asked for comes in this cycle from the L1, which nobody will be told again.
    Comes(u32, u64),
    /// The line that was asked for came.
    Answer(u32, Supplier),
    /// The group has rays again.
    Granted(u32),
}
