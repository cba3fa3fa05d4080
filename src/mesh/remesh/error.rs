//! Why a mesh was not remeshed, and what would do.

use crate::num::MAX_LEVELS;
use std::fmt;

/// Most finest triangles that are made: they need about 12 GB while they are.
pub(super) const MAX_TRIANGLES: u64 = 1 << 26;

/// Why a mesh was not remeshed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RemeshError {
    /// Too many splits.
    #[error("{levels} levels are more than the {MAX_LEVELS} there can be")]
    Levels {
        /// What was asked for.
        levels: u32,
    },
    /// A base mesh of no triangles was asked for.
    #[error("a base mesh needs at least one triangle")]
    NoBase,
    /// The result would not fit in memory.
    #[error("{base} base triangles and {levels} levels make {triangles} triangles, more than the {MAX_TRIANGLES} there can be{works}")]
    TooMany {
        /// Base triangles reached.
        base: u64,
        /// Number of splits.
        levels: u32,
        /// What they would make.
        triangles: u64,
        /// What would do.
        works: Works,
    },
    /// The base mesh that the original needs would not fit in memory with so many splits.
    #[error("this mesh needs {base} base triangles or more, too many for {levels} levels: {MAX_TRIANGLES} triangles in all fit{works}")]
    NeedsBase {
        /// Base triangles needed.
        base: u64,
        /// Number of splits.
        levels: u32,
        /// What would do.
        works: Works,
    },
    /// A limit that cannot be.
    #[error("{name} is {value}, but must be {range}")]
    Range {
        /// Which option.
        name: &'static str,
        /// What was asked for.
        value: f64,
        /// What can be.
        range: &'static str,
    },
    /// A largest error that rounding to the format's grid alone may take.
    #[error(
        "no result is sure to be within {wanted} % of the diagonal, as rounding to the grid of {levels} levels alone may take more: give a --max-error of {least} or more"
    )]
    Grid {
        /// What was asked for, in percent of the diagonal.
        wanted: f64,
        /// Number of splits.
        levels: u32,
        /// What can be met.
        least: f64,
    },
    /// The mesh breaks a promise of [`TriangleMesh`](crate::mesh::TriangleMesh).
    #[error("the mesh cannot be remeshed, it has {what}")]
    BadMesh {
        /// What is wrong with it.
        what: &'static str,
    },
}

/// What does not make too many triangles; shown as advice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Works {
    /// The most splits of the same base mesh, if it fits at all.
    pub levels: Option<u32>,
    /// Base triangles to ask for with the same splits, if removal comes that far.
    pub base: Option<u64>,
    /// Whether the base mesh is what the largest error asks for: a larger one may need less.
    pub error: bool,
}

impl fmt::Display for Works {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let ways = [
            self.levels.map(|levels| format!("with --levels {levels} at most")),
            self.base.map(|base| format!("with --base {base}, whatever is lost")),
            self.error.then(|| "maybe with a larger --max-error".to_owned()),
        ];
        let ways: Vec<String> = ways.into_iter().flatten().collect();
        if ways.is_empty() { Ok(()) } else { write!(f, "; there is room {}", ways.join(", or ")) }
    }
}
