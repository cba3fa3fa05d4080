//! Two measures of how different pictures look: FLIP and SSIM.

mod flip;
mod kernel;
mod opponent;
#[cfg(test)]
mod pairs;
mod ssim;

pub use flip::{FlipError, PIXELS_PER_DEGREE, flip};
pub use ssim::structural_similarity;
