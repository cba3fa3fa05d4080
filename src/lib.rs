//! Locally adaptive level of detail for ray tracing hardware, bit for bit.
//!
//! The floors, lowest first; each uses those below only:
//! [`num`] (fixed point, roundings, bits), [`block`] (the hardware's combinational blocks), [`mesh`] (triangle meshes to hierarchies),
//! [`mod@format`] (memory images and the scene file), [`bvh`] (the quad-BVH), [`step`] (what rays do, as steps), [`rays`] (queries, cameras,
//! files of rays), [`method`] (ways to find hits, built from blocks), [`hardware`] (its sizes as one value), [`machine`] (descriptions),
//! [`sim`] (the cycle level; its [`sim::dram`] lies below [`machine`]), [`run`] (rays cast, frames on machines), [`plan`] (what a scene and a job do not need), [`picture`], [`paths`] (path tracing), [`report`]
//! (figures), [`scene`] (scenes for programs), [`study`] (measuring: errors against costs, sweeps), [`lab`] (stiff cases, and a hunt for counterexamples).
//! Apart from them stands [`golden`]: the plain exact traverser and the `f64` reference that everything is checked against.
//!
//! One ray's journey: a camera makes it in `f64`; [`rays::ModelSpace`] moves it to the model's box and rounds it once to a
//! [`num::Ray`]; the loop of the paper's figure 9 ([`method::lod`]) walks the quad-BVH over the base triangles and, inside a
//! tessellation tree, asks [`block::lod_test`] whether a node's triangle serves; if not, [`block::tessellate`] morphs the inserted vertices, and
//! [`block::box_test`] and [`block::child_sort`] choose where to go next; if it does, [`block::tri_test`] and
//! [`block::hit_divide`] find the hit and [`block::bary_map`] maps it to the full-resolution mesh.

pub mod block;
pub mod bvh;
pub mod format;
pub mod golden;
pub mod hardware;
pub mod lab;
pub mod machine;
pub mod mesh;
pub mod method;
pub mod num;
pub mod paths;
pub mod picture;
pub mod plan;
pub mod rays;
pub mod report;
pub mod run;
pub mod scene;
pub mod sim;
pub mod step;
pub mod study;
