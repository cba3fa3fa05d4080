//! States of a context (`docs/traversal-unit.md`).

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

/// What a context fetches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[repr(u8)]
pub enum Fetch {
    /// Quad-BVH node.
    #[default]
    Node = 0,
    /// L0 record.
    Record = 1,
    /// Inserted vertices and, but on the last split, the children's sibling group.
    Vertex = 2,
    /// The sibling group alone: the inserted vertices came with the L0 record.
    Group = 3,
}
