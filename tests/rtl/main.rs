//! Every block of `rtl/` against its Rust twin, at its ports: bit for bit, free-running and with random stalls on both sides.
//!
//! 200,000 transactions a block and mode (`scripts/nightly`: a million); `LODRAY_TRANSACTIONS` sets another number, `LODRAY_SEED` replays a seed. Each file here has the legal inputs of its
//! block by named category, and promises of what must have happened among them.

mod bary_map;
mod bound_decode;
mod box_decode;
mod box_decode8;
mod box_test;
mod box_test32;
mod boxes;
mod child_boxes;
mod child_prisms;
mod child_sort;
mod child_sort6;
mod child_test;
mod draw;
mod hit_divide;
mod hit_select;
mod lod_test;
mod lod_test_by;
mod memory_1w1r;
mod narrow_hardware;
mod node_address;
mod node_deciders;
mod other_hardware;
mod queues;
mod ray_setup;
mod rays;
mod start_divide;
mod start_setup;
mod start_test;
mod suite;
mod tessellate;
mod traversal_stack;
mod tree_deciders;
mod tri_test;
