//! Numbers, and what rays hit: exact arithmetic, the golden traverser, and whatever must give the same hits.

mod bounds;
mod box_test;
mod cluster;
mod dense;
mod entering;
mod equivalence;
mod golden;
mod grid;
mod packets;
mod plan;
mod promise;
mod prune;
mod quantise;
mod refit;
mod rlod;
mod secondary;
mod stability;
mod tightness;
mod tri_test;
mod watertight;
mod within;
