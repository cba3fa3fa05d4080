//! What can go wrong with a drawing.

use thiserror::Error;

/// A diagram that cannot be drawn.
#[derive(Debug, Error)]
#[error("cannot draw a diagram: {0}")]
pub struct DiagramFault(String);

/// Errors of the plotting library borrow their picture.
pub(super) fn wrong(error: impl std::fmt::Display) -> DiagramFault {
    DiagramFault(error.to_string())
}
