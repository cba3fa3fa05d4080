//! Measuring: what an error costs, sweeps over scenes, views, methods and machines, and what both go on with.
//!
//! A [`Progress`] is told how far it is; [`Silent`] tells nobody. What is done is kept as lines of a file ([`JobLines`]), with which a study that is begun again goes on.
//!
//! A sweep of one view of a procedural scene:
//!
//! ```
//! use lodray::machine::Machine;
//! use lodray::mesh::{BoundKind, procedural};
//! use lodray::method::find;
//! use lodray::num::VertexForm;
//! use lodray::report::result::MachineFacts;
//! use lodray::run::Compute;
//! use lodray::scene::Target;
//! use lodray::study::{Cache, Chosen, Generated, JobLines, Jobs, Means, Origin, SceneJobs, Silent, ViewJob, csv, sweep};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let options = procedural::Options { levels: Some(2), base: Some(8), ..procedural::Options::new(procedural::Scene::Sphere) };
//! let origin = Origin::Generate(Generated { options, bounds: BoundKind::default(), vertices: VertexForm::default() });
//! let scene = SceneJobs { views: vec![ViewJob::at([32, 32], 4.0)], ..SceneJobs::new("sphere", origin) };
//! let machine = MachineFacts { label: "haydel2023".to_owned(), set: Vec::new(), description: Machine::shipped("haydel2023")? };
//! let methods = ["lod", "bvh"].into_iter().filter_map(find).map(Chosen::plain).collect();
//! let jobs = Jobs::new(vec![scene], methods, vec![Target { machine, compute: Compute::Free, window: None }]);
//!
//! let folder = tempfile::tempdir()?;
//! let mut rows = JobLines::open(&folder.path().join("results.jsonl"), &Silent)?;
//! let means = Means { cache: &Cache::NONE, open: &|scene| Ok(scene.open()?), progress: &Silent };
//! let keys = sweep(&jobs, &mut rows, 1, &means)?;
//! let cycles: Vec<_> = rows.of(&keys).filter_map(|row| Some(row.result.as_ref()?.cycles)).collect();
//! assert!(cycles.len() == 2 && cycles.iter().all(|&cycles| cycles > 0));
//! println!("{}", csv(rows.of(&keys)));
//! # Ok(())
//! # }
//! ```

mod cache;
mod chosen;
mod error;
mod error_time;
mod fault;
mod fly;
mod job_lines;
mod jobs;
mod means;
mod models;
mod pass;
mod progress;
pub mod pruned;
mod results;
mod rows;
pub mod shards;
mod shot;
mod sweep;
mod turning;
mod words;
mod workers;
mod world_shot;

pub use cache::{Cache, LEAST_TRIANGLES, Lookup};
pub use chosen::{Chosen, ChosenError};
pub use error::{StudyError, ViewError, one_line};
pub use error_time::{
    BuildTime, ErrorTimePlan, HostTime, Measure, Measured, ViewRow, document, error_time, error_time_part, error_time_pieces, in_machine,
    least_converged,
};
pub use fault::{fault, fault_at};
pub use fly::{Flown, Fly, fly, fly_models};
pub use job_lines::{JobLine, JobLines, LinesError, aside};
pub use jobs::{Generated, Jobs, Origin, RegionJob, SceneJobs, ViewJob};
pub use means::{Means, Open};
pub use models::{ModelError, models};
pub use pass::{simulate, simulate_models};
pub use progress::{Progress, Silent, Work, busy};
pub use results::{NoResult, results};
pub use rows::{Row, csv};
pub use shot::{Comparison, Shot};
pub use sweep::{sweep, sweep_part, sweep_pieces};
pub use turning::Turning;
pub use words::{count, grouped};
pub use workers::{at_once, in_order};
pub use world_shot::WorldShot;
