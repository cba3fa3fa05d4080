//! What machines cost: lines, frames, sweeps, traces.

mod cache;
mod error_time;
mod frames;
mod input;
mod lines;
mod own_method;
mod simulate;
mod study;
mod sweep_jobs;
mod trace;
mod units;
