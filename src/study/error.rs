//! Why something was not measured.

use super::chosen::ChosenError;
use super::job_lines::LinesError;
use super::pruned::PrunedError;
use crate::format::SceneError;
use crate::machine::MachineError;
use crate::method::KnobError;
use crate::rays::{CameraError, MAX_PIXELS, MAX_SIDE};
use crate::scene::SimulateError;
use std::error::Error;
use std::io;
use std::path::PathBuf;

/// A view that no camera has.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
// A list has keys where the command line has options.
#[error("{}", .0.to_string().replace("--", ""))]
pub struct ViewError(CameraError);

// The camera's own words would be said again as a cause.
impl From<CameraError> for ViewError {
    fn from(error: CameraError) -> Self {
        Self(error)
    }
}

/// Why something was not measured.
#[derive(Debug, thiserror::Error)]
pub enum StudyError {
    /// A view that no camera has.
    #[error(transparent)]
    View(#[from] ViewError),
    /// A camera that cannot be.
    #[error(transparent)]
    Camera(#[from] CameraError),
    /// A method that the scene does not serve.
    #[error(transparent)]
    Method(#[from] ChosenError),
    /// A knob without such a value.
    #[error(transparent)]
    Knob(#[from] KnobError),
    /// A machine whose files cannot be read.
    #[error(transparent)]
    Machine(#[from] MachineError),
    /// A machine on which a frame cannot run.
    #[error(transparent)]
    Simulate(#[from] SimulateError),
    /// A scene with less in it that cannot be made.
    #[error(transparent)]
    Scene(#[from] SceneError),
    /// Rays that a pruned scene does not serve.
    #[error(transparent)]
    Pruned(#[from] PrunedError),
    /// Results that cannot be kept.
    #[error(transparent)]
    Lines(#[from] LinesError),
    /// A job that JSON cannot say.
    #[error(transparent)]
    Json(#[from] serde_json::Error),
    /// A picture that cannot be written.
    #[error("cannot write {}", path.display())]
    Picture {
        /// Its file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// More samples than a picture can have.
    #[error("--samples {samples}: too many for pictures of {}x{}: {MAX_PIXELS} in all, {MAX_SIDE} along a side", .size[0], .size[1])]
    Samples {
        /// Of a pixel.
        samples: u64,
        /// Of the picture, in pixels.
        size: [u32; 2],
    },
    /// A converged picture with no more samples than those that are held against it.
    #[error("--most-samples {samples}: a converged picture has at least {least} here, four times as many as the others; 0 leaves it out")]
    Converged {
        /// Of a pixel.
        samples: u64,
        /// The fewest.
        least: u64,
    },
    /// There is no machine.
    #[error("no machine")]
    NoMachine,
    /// An error of a picture over triangles that are not the scene's.
    #[error("error: a sweep has no errors of {0}, whose triangles are not the scene's: error-time has")]
    OtherTriangles(&'static str),
}

/// The whole chain on one line: what was tried, then why it failed, leaving out causes that the error before already spells out.
pub fn one_line(error: &dyn Error) -> String {
    let mut line = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let said = error.to_string();
        if !line.ends_with(&said) {
            line = format!("{line}: {said}");
        }
        cause = error.source();
    }
    line
}
