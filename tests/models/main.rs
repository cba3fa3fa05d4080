//! Meshes, scenes, pictures and paths.

mod appearance;
mod audit;
mod cast;
mod chunked;
mod descriptions;
mod flight;
mod instances;
mod mesh_input;
mod paths;
mod picture_error;
mod pictures;
mod programs;
mod refit;
mod remesh;
mod scene_file;
