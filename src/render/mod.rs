//! Floor 5: frames: camera, one ray per pixel through any method, shading, and the maps that show what was done.

mod camera;
mod frame;
mod geometry;
mod layouts;
mod legend;
mod lines;
mod orbit;
mod picture;
mod shade;
mod sheet;
mod steps;
mod text;

pub use camera::{Camera, CameraError, DEFAULT_DIRECTION, DEFAULT_VIEW_ANGLE_DEGREES, MAX_PIXELS, MAX_SIDE, View};
pub use frame::{Frame, FrameStats, KindCount, Method, Pixel, render};
pub use geometry::{GeometricError, geometric_error};
pub use layouts::distinct_lines;
pub use legend::Legend;
pub use lines::LineSets;
pub use picture::{ImageError, compare, save_png};
pub use shade::{error_map, level_map, normal_map, shaded, view_cosine};
pub use sheet::Sheet;
pub use steps::FrameRays;
