//! Transaction-level testbench of the RTL: Verilator models built on demand, driven in batches, compared with the Rust blocks.
//!
//! [`Build`] names a top of `rtl/` (or a netlist), its parameters and options, and turns it into a [`Model`]: a shared library under
//! `target/verilator`, compiled once for each content. [`check_block`] plays transactions of a [`lodray::block::Block`] through a
//! model with a [`Plan`] (free-running or stalled, a seed), and holds every bit, tag and cycle against the Rust block. [`Sim`]
//! drives any top port by port and cycle by cycle.
//!
//! Environment: `LODRAY_VERILATOR` (another Verilator), `LODRAY_RTL` (another folder than `rtl/`), `LODRAY_NETLISTS=DIR` (synthesised
//! netlists in place of the RTL), `LODRAY_SEED` (replays a seed), `LODRAY_WAVES=DIR` (waveforms of mismatches), `LODRAY_COVERAGE=DIR` (coverage data of every model).
//!
//! ```no_run
//! use lodray::block::bound_decode::{BoundDecode, In};
//! use tb::{Build, Mode, Plan, check_block};
//!
//! let build = Build::block::<BoundDecode>();
//! let inputs = (0..1_000_000).map(|_| In::default());
//! let report = check_block::<BoundDecode>(&build, &Plan::new(Mode::Stalled, 7), inputs)?;
//! assert_eq!(report.transactions, 1_000_000);
//! # Ok::<(), tb::Error>(())
//! ```

mod batch;
mod build;
mod check;
mod compile;
mod cxx;
mod error;
mod failure;
mod library;
mod lint;
mod model;
mod ports;
mod sim;
mod sources;
mod tool;
mod verdict;

pub use build::Build;
pub use check::{Mode, Plan, Report, check_block, seed};
pub use error::Error;
pub use failure::{Failure, Fault};
pub use lint::{elaborate, lint, registers, tool, verible, yosys};
pub use model::Model;
pub use ports::{Direction, Port};
pub use sim::{PortId, Sim};
pub use sources::{root, rtl};
pub use tool::Verilator;
pub use verdict::Question;
