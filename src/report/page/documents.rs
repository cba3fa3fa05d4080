//! What a page is made of.

use super::ledger::Ledger;
use super::pictures::Embedded;
use super::stability::StabilityReport;
use crate::report::error_time::ErrorTime;
use crate::report::result::SimResult;
use serde::{Deserialize, Serialize};

/// What a page is made of; whatever is empty has no section.
#[derive(Clone, Debug, Default)]
pub struct Documents {
    /// The page's title.
    pub title: String,
    /// Error against cost.
    pub error_time: Option<ErrorTime>,
    /// Its pictures, embedded.
    pub pictures: Vec<Embedded>,
    /// Results of simulations.
    pub simulations: Vec<Simulation>,
    /// Reports of the stability lab.
    pub stability: Vec<StabilityReport>,
    /// Tables of claims.
    pub ledger: Vec<Ledger>,
    /// The runs that made all this.
    pub runs: Vec<RunFacts>,
    /// The files that it was read from.
    pub documents: Vec<DocumentFacts>,
}

/// A result of a simulation.
#[derive(Clone, Debug, Serialize)]
pub struct Simulation {
    /// The scene's name, where a list of jobs gave it one.
    pub scene: Option<String>,
    /// The figures.
    pub result: SimResult,
    /// How far the picture is from full resolution, if it was compared.
    pub image: Option<ImageFigures>,
}

/// How far a picture is from full resolution.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ImageFigures {
    /// Root mean square difference, channels from 0 to 255.
    pub rmse: f64,
    /// Peak signal to noise ratio in dB; none for equal pictures.
    pub psnr_db: Option<f64>,
    /// Mean distance between the surfaces in pixels; none if no pixel hits in both pictures.
    pub geometry_pixels_mean: Option<f64>,
}

/// A run of the program, as `run.json` in its folder has it.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunFacts {
    /// Version of the program.
    pub lodray: String,
    /// Subcommand.
    pub command: String,
    /// Its arguments.
    pub arguments: Vec<String>,
    /// Files that were read.
    pub inputs: Vec<RunInput>,
    /// What is to be said of the run.
    #[serde(default)]
    pub notes: Vec<String>,
}

/// A file that a run has read.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct RunInput {
    /// Its name.
    pub name: String,
    /// Its size.
    pub bytes: u64,
    /// Its checksum: 64 bits, hexadecimal; none of a pipe.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub xxh3: Option<String>,
}

/// A file that the page was made of.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct DocumentFacts {
    /// What it is, such as `results of a sweep`.
    pub kind: String,
    /// Its name, without folders; with the one that it lies in where another has the same name.
    pub name: String,
    /// Its size.
    pub bytes: u64,
    /// Its checksum: 64 bits, hexadecimal.
    pub xxh3: String,
}
