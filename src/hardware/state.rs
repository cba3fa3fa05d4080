//! States of a context, and how its ray can end early (`docs/traversal-unit.md`).

use crate::num::U;
use std::fmt;

/// Declares the states with their numbers and the names of `lod_pkg::context_state_t`.
macro_rules! states {
    ($($state:ident = $name:literal),+ $(,)?) => {
        /// State of a context.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
        #[repr(u8)]
        #[expect(missing_docs, reason = "docs/traversal-unit.md gives every state")]
        pub enum State {
            #[default]
            $($state),+
        }

        impl State {
            /// All states, by number.
            pub const ALL: &[Self] = &[$(Self::$state),+];

            /// Name in the RTL.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Self::$state => $name),+
                }
            }
        }
    };
}

states! {
    Idle = "IDLE",
    Setup = "SETUP",
    SetupWait = "SETUP_WAIT",
    Visit = "VISIT",
    Fetch = "FETCH",
    Child = "CHILD",
    ChildWait = "CHILD_WAIT",
    Push = "PUSH",
    Pop = "POP",
    Decide = "DECIDE",
    DecideWait = "DECIDE_WAIT",
    Lod = "LOD",
    LodWait = "LOD_WAIT",
    Morph = "MORPH",
    MorphWait = "MORPH_WAIT",
    Tri = "TRI",
    DivideV = "DIVIDE_V",
    DivideW = "DIVIDE_W",
    DivideWait = "DIVIDE_WAIT",
    Sum = "SUM",
    Map = "MAP",
    MapWait = "MAP_WAIT",
    Done = "DONE",
}

/// Why a ray ended early.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum RayError {
    /// A line came with an error.
    Memory = 1,
    /// A line did not come in time.
    Late = 2,
    /// A line holds what no scene of this configuration has there.
    Image = 3,
    /// More entries were visited than the scene has.
    Visits = 4,
    /// More entries wait than the stack has room for.
    Stack = 5,
    /// The scene is not for this hardware.
    Scene = 6,
    /// The unit was flushed.
    Aborted = 7,
}

impl RayError {
    /// All, by code from 1 on.
    pub const ALL: [Self; 7] = [Self::Memory, Self::Late, Self::Image, Self::Visits, Self::Stack, Self::Scene, Self::Aborted];

    /// Name in the RTL, and what it says.
    pub const fn named(self) -> (&'static str, &'static str) {
        match self {
            Self::Memory => ("ERROR_MEMORY", "a line came with an error"),
            Self::Late => ("ERROR_LATE", "a line did not come in time"),
            Self::Image => ("ERROR_IMAGE", "a line holds what no scene of this configuration has there"),
            Self::Visits => ("ERROR_VISITS", "more entries were visited than the scene has"),
            Self::Stack => ("ERROR_STACK", "more entries wait than the stack has room for"),
            Self::Scene => ("ERROR_SCENE", "the scene is not for this hardware"),
            Self::Aborted => ("ERROR_ABORTED", "the unit was flushed"),
        }
    }

    /// The code of `error`, 0 for none.
    pub fn code(error: Option<Self>) -> U<3> {
        U::new(error.map_or(0, |error| error as u64))
    }

    /// The error of a code.
    pub fn of_code(code: U<3>) -> Option<Self> {
        Self::ALL.into_iter().find(|&error| Self::code(Some(error)) == code)
    }
}

impl fmt::Display for RayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.named().1)
    }
}

/// What a context fetches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Fetch {
    /// Quad-BVH node.
    #[default]
    Node = 0,
    /// L0 record.
    Record = 1,
    /// Split: of a node whose children are nodes its record, and inserted vertices where they are not in that.
    Split = 2,
}
