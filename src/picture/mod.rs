//! Pictures: one ray per pixel through any method, shading, and the maps that show what was done.

mod frame;
mod geometry;
mod image;
mod layouts;
mod legend;
mod shade;
mod sheet;
mod text;

pub use frame::{Frame, FrameStats, KindCount, render};
pub use geometry::{GeometricError, geometric_error};
pub use image::{ImageError, compare, save_png};
pub use layouts::distinct_lines;
pub use legend::Legend;
pub use shade::{HOTTEST, error_map, level_colour, level_map, normal_map, shaded, view_cosine};
pub use sheet::Sheet;
