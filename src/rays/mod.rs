//! Rays as they are asked for: a [`Query`] in the world, from a camera or a file, and its way into the model's integers.

mod camera;
mod camera_path;
mod cone;
mod eye;
mod file;
mod job;
mod orbit;
mod query;
mod rows;
mod source;
mod space;
mod view;

pub use camera::{Camera, CameraError, MAX_PIXELS, MAX_SIDE, MOST_IN_TURN, TILE, may_be_in_turn};
pub use camera_path::CameraPath;
pub use cone::{cone, is_full_detail};
pub use eye::{Eye, ViewCone};
pub use file::{RayFile, RayFileError};
pub use query::Query;
pub use rows::{Column, RAY_COLUMNS, RayRows, RowError};
pub use source::{RaySource, Sight};
pub use space::{ModelRay, ModelSpace};
pub use view::{DEFAULT_DIRECTION, DEFAULT_VIEW_ANGLE_DEGREES, View};
