//! What hunts climb towards.

use crate::golden::Ties;
use serde::{Deserialize, Serialize};

/// What a climb goes for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Goal {
    /// The smallest edge function that is not 0.
    Edge,
    /// Many edge functions that are exactly 0.
    Zeros,
    /// An LOD decision on its border.
    Lod,
    /// Two hits at one distance.
    Gap,
    /// A division without remainder, or with all but one.
    Remainder,
}

/// All goals.
pub const GOALS: [Goal; 5] = [Goal::Edge, Goal::Zeros, Goal::Lod, Goal::Gap, Goal::Remainder];

impl Goal {
    /// Name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Edge => "smallest edge function but 0",
            Self::Zeros => "edge functions that are 0 at once",
            Self::Lod => "LOD decision from its border (2^-shift units)",
            Self::Gap => "two hits' t apart (2^-32)",
            Self::Remainder => "quotient from a whole step",
        }
    }

    /// How far the ray is from the goal; less is nearer, infinite where there is nothing to go by.
    pub(super) fn distance(self, ties: &Ties) -> f64 {
        let integer = |v: Option<u128>| v.map_or(f64::INFINITY, |v| v as f64);
        match self {
            Self::Edge => integer(ties.edge),
            Self::Zeros => -f64::from(ties.edge_zeros),
            Self::Lod => integer(ties.lod),
            Self::Gap => ties.t_gap.unwrap_or(f64::INFINITY),
            Self::Remainder => ties.remainder.unwrap_or(f64::INFINITY),
        }
    }
}
