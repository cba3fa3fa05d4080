//! The program as typed, and the house that it stands in.

mod bad_input;
mod cli;
mod exactness;
mod folders;
mod import;
mod layers;
mod refit;
mod shards;
mod unit;
