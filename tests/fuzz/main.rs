//! Every reader against damaged files: no panic, no hang, and no more memory than a file's size and stated limits allow.
//!
//! Each reader gets the files of its corpus as they are, then damaged ones made from these. `LODRAY_FUZZ_SECONDS` is how long each goes on (not set:
//! 512 files, the same on every machine), `LODRAY_FUZZ_SEED` is where its random numbers begin. What a reader fails on is written to a file, made as small as `proptest` can.

mod damage;
mod jobs;
mod lines;
mod memory;
mod meshes;
mod positions;
mod rays;
mod round;
mod scenes;
mod tables;

#[global_allocator]
static MEMORY: memory::Counting = memory::Counting;
