//! Fixed point with stated widths, exact vectors, the roundings, and [`Wire`] (structs as bits).
//!
//! `docs/numbers.md` states every format and rounding once; the names there are the names here.

mod bits;
mod box16;
mod displacement;
mod fixed;
mod formats;
pub mod prism;
pub mod random;
mod rotation;
mod round;
mod step;
mod vec3;
mod wire;

pub use bits::{BitReader, BitVec, BitWriter};
pub use box16::Box16;
pub use displacement::{VertexForm, displaced, displacement_shift, displacement_steps, short_steps};
pub use fixed::{S, U, WS, WU};
pub use formats::*;
pub use random::Random;
pub use rotation::{LET_OUT, ROTATION_BITS, ROTATIONS, Rotation};
pub use round::*;
pub use step::{BoxStep, box_steps};
pub use vec3::Vec3;
pub(crate) use wire::wire_struct;
pub use wire::{Field, Layout, Wire};
