//! The list of jobs as it stands in its file; every value knows where.

use crate::cli::method::Listed;
use crate::cli::output::{brief, in_plain_words};
use lodray::mesh::{BoundKind, procedural};
use lodray::num::VertexForm;
use lodray::run::Compute;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use std::collections::BTreeMap;
use std::fmt::{self, Display};
use std::ops::Range;
use std::path::{Path, PathBuf};
pub use toml::Spanned;

/// A value that may be left out, or whose absence is told where it is missed.
pub type Maybe<T> = Option<Spanned<T>>;

/// The file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct List {
    pub size: Maybe<String>,
    pub distances: Maybe<Vec<f64>>,
    pub methods: Maybe<Vec<Listed>>,
    pub deltas: Maybe<Vec<Value>>,
    pub compute: Maybe<Vec<Compute>>,
    pub leaf_layout: Maybe<String>,
    pub leaf_size: Maybe<u32>,
    /// Of generated scenes.
    pub bounds: Maybe<BoundKind>,
    pub vertices: Maybe<VertexForm>,
    /// Other knobs of methods, by name.
    #[serde(default)]
    pub knobs: BTreeMap<String, Spanned<Value>>,
    /// Tiles whose rays are handed out in turn.
    pub tiles_in_turn: Maybe<u32>,
    /// Measure the error of each picture against full resolution.
    #[serde(default)]
    pub error: bool,
    /// Keep what happened over time.
    #[serde(default)]
    pub intervals: bool,
    #[serde(default)]
    pub scene: Vec<Spanned<SceneEntry>>,
    #[serde(default)]
    pub machine: Vec<Spanned<MachineEntry>>,
}

/// A scene: a file, or how to generate one; and its cameras.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneEntry {
    pub name: Maybe<String>,
    pub file: Maybe<PathBuf>,
    pub generate: Maybe<procedural::Scene>,
    pub levels: Maybe<u32>,
    pub base: Maybe<u32>,
    pub seed: Maybe<u64>,
    pub roughness: Maybe<f64>,
    /// World units across a terrain.
    pub width: Maybe<f64>,
    pub bounds: Maybe<BoundKind>,
    pub vertices: Maybe<VertexForm>,
    pub size: Maybe<String>,
    pub tiles_in_turn: Maybe<u32>,
    pub distances: Maybe<Vec<f64>>,
    /// From the target to the eye, for distances.
    pub directions: Maybe<Vec<[f64; 3]>>,
    /// Positions, in place of distances.
    pub eyes: Maybe<Vec<[f64; 3]>>,
    /// Boxes that cameras stay in, in place of views or beside the scene's own; of `lodray plan` alone.
    pub regions: Maybe<Vec<RegionEntry>>,
    pub target: Maybe<[f64; 3]>,
    pub up: Maybe<[f64; 3]>,
    pub fov: Option<f64>,
}

/// A box that cameras stay in: two opposite corners.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct RegionEntry {
    pub from: [f64; 3],
    pub to: [f64; 3],
}

/// A machine and its variants: each combination of the values.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MachineEntry {
    pub name: Maybe<String>,
    #[serde(default)]
    pub set: BTreeMap<String, Spanned<Values>>,
}

/// What a key of a machine takes, one after the other.
#[derive(Deserialize)]
#[serde(untagged, expecting = "must be a number, a text, or a list of such")]
pub enum Values {
    One(Value),
    Many(Vec<Value>),
}

impl Values {
    pub fn all(&self) -> &[Value] {
        match self {
            Self::One(value) => std::slice::from_ref(value),
            Self::Many(values) => values,
        }
    }
}

/// A value, shown as one would write it on the command line.
#[derive(Deserialize)]
#[serde(untagged, expecting = "must be a number or a text")]
pub enum Value {
    Integer(i64),
    Number(f64),
    Text(String),
}

impl Display for Value {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Integer(value) => value.fmt(f),
            Self::Number(value) => value.fmt(f),
            Self::Text(value) => value.fmt(f),
        }
    }
}

/// The file's text, to say where a mistake is.
pub struct ListText<'a> {
    pub path: &'a Path,
    pub text: &'a str,
}

impl ListText<'_> {
    /// What the file says.
    pub fn parse<T: DeserializeOwned>(&self) -> anyhow::Result<T> {
        // The reader's own messages are several lines, with a picture of the place.
        toml::from_str(self.text).map_err(|e| {
            let brackets =
                if e.message() == "invalid type: map, expected a sequence" { "; [[scene]] and [[machine]] have two brackets" } else { "" };
            let message = in_plain_words(&e.message().lines().collect::<Vec<_>>().join(", "));
            self.wrong(e.span().unwrap_or(0..0), format!("{message}{brackets}"))
        })
    }

    /// The error for a mistake that stands there.
    pub fn wrong(&self, place: Range<usize>, what: impl Display) -> anyhow::Error {
        let line = self.text.as_bytes().iter().take(place.start).filter(|&&byte| byte == b'\n').count() + 1;
        anyhow::anyhow!("{}: line {line}: {}", self.path.display(), brief(&what.to_string()))
    }
}
