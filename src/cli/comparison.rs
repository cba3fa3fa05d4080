//! How far a picture is from the one that it is compared with.

use serde::Serialize;

/// What a picture is compared with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Against {
    /// The scene's own finest triangles.
    FullResolution,
    /// The mesh that it was made from.
    Original,
}

impl Against {
    /// What to call it in text.
    pub const fn name(self) -> &'static str {
        match self {
            Self::FullResolution => "full resolution",
            Self::Original => "the original",
        }
    }
}
