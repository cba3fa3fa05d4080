//! Path tracing: pictures whose rays go on where they hit, with shadows, mirrors and light from surface to surface (paper section 3.8, figures 14 to 17).
//!
//! One path: a camera makes a ray; [`World`] finds what it meets among the models, each with a method of its own; a [`Material`] scatters it, lights are
//! asked for what they send there, and the next ray leaves exactly where the last one hit ([`Starts`]). Cones go along ([`PathCone`]). Shading is `f64` and
//! `f32`: what is exact is where rays start and what they meet.

mod boxes;
mod bsdf;
mod cast;
mod checked;
mod choices;
mod cone;
mod copies;
mod file;
mod film;
mod frame;
mod integrate;
mod light;
mod material;
mod memory;
mod moves;
#[cfg(feature = "exr")]
mod open_exr;
mod picture;
mod pose;
mod random;
mod rays;
mod rebuild;
mod world;

pub use cone::{Cones, PathCone};
pub use copies::{CopiesTable, MOST_COPIES};
pub use file::{CameraTable, MOST_DEPTH, MOST_SAMPLES, MeshTable, ModelTable, PictureTable, SceneFile, SceneFileError};
pub use film::{Film, LightCount, light_count, picture_error};
pub use frame::WorldFrame;
pub use integrate::{PathCounts, PathTracer, Paths};
pub use light::{Environment, Light};
pub use material::Material;
pub use memory::WorldMemory;
pub use moves::MovesTable;
#[cfg(feature = "exr")]
pub use open_exr::ExrError;
pub use picture::WorldView;
pub use pose::{MOST_STRETCH, NoPose, Pose};
pub use rays::PathFrame;
pub use world::{Instance, Starts, World};
