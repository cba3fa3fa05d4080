//! Pictures: one ray per pixel through any method, shading, the maps that show what was done, and how far one picture is from another.

mod error;
mod flip;
mod frame;
mod geometry;
mod image;
mod kernel;
mod layouts;
mod legend;
mod popping;
mod sampled;
mod shade;
mod shading;
mod sheet;
mod spread;
mod ssim;
mod surface_error;
mod text;

pub use error::PictureError;
pub use flip::{PIXELS_PER_DEGREE, flip};
pub use frame::{Frame, FrameStats, KindCount, render};
pub use geometry::{GeometricError, geometric_error};
pub use image::{ImageError, compare, save_png};
pub use layouts::distinct_lines;
pub use legend::Legend;
pub use popping::{Pop, Pops, popping};
pub use sampled::{Sampled, sampled};
pub use shade::{HOTTEST, cosine_to, error_map, level_colour, level_map, normal_map, normal_map_by, shaded, shaded_by, view_cosine};
pub use shading::{Light, Shader, Shading};
pub use sheet::Sheet;
pub use spread::ErrorSpread;
pub use ssim::structural_similarity;
pub use surface_error::{FullResolution, Silhouette, SurfaceError};
