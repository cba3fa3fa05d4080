//! Scenes for programs: built from a mesh or opened, ways to find hits made by name, rays cast, frames simulated.
//!
//! ```no_run
//! use lodray::format::Scene;
//! use lodray::rays::{Query, RayFile};
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let scene = Scene::open("bunny.lod".as_ref())?;
//! let rays = RayFile::new(vec![Query::new([0.0, 0.1, 1.0], [0.0, 0.0, -1.0])]);
//! for hit in scene.method("lod")?.cast(&rays) {
//!     println!("{hit:?}");
//! }
//! # Ok(())
//! # }
//! ```

mod build;
mod given;
mod golden;
mod method;
mod models;
mod refit;
mod simulate;

pub use build::{BuildError, BuildOptions, moved_percent};
pub use given::Given;
pub use golden::{Golden, Judged};
pub use method::{MethodError, SceneMethod};
pub use models::WorldPass;
pub use simulate::{Outcome, Pass, PassRays, SimulateError, Target};
