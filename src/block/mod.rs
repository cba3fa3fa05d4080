//! The hardware's blocks as pure functions, one file each, without float or clock.
//!
//! A block's `In` and `Out` are [`Wire`] structs with the field names of the SystemVerilog; its mathematics stands at the head of its
//! file, every width beside the line that needs it. `docs/numbers.md` states the formats.

#![cfg_attr(not(test), warn(clippy::as_conversions))]

pub mod bary_map;
pub mod bound_decode;
pub mod box_decode;
pub mod box_decode8;
pub mod box_test;
pub mod box_test32;
pub mod child_boxes;
pub mod child_prisms;
pub mod child_sort;
pub mod child_sort6;
pub mod child_test;
mod form;
pub mod hit_divide;
pub mod hit_select;
pub mod lod_test;
pub mod lod_test_by;
pub mod node_address;
pub mod node_deciders;
mod operation;
pub mod parts;
pub mod prism_frame;
pub mod prism_test;
pub mod ray_setup;
pub mod start_divide;
pub mod start_setup;
pub mod start_test;
pub mod tessellate;
pub mod tree_deciders;
pub mod tri_test;

pub use form::{BoxesPerCycle, EdgesPerCycle, Form, MOST_DIVIDE_BITS};
pub use operation::{FIRST_SHARED, INSTANCE, INSTANCE_BIN, INSTANCE_BOX, MAX_WORKS, Operation, Operations, SHARED_WORKS, Work};

use crate::num::Wire;
use parts::Parts;

/// Cycles of a block's pipeline in `rtl/`, with nothing in its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// Cycles from the one in which the input is taken to the first in which the output is offered.
    pub latency: u32,
    /// Cycles from one input taken to the next.
    pub interval: u32,
}

impl Timing {
    /// A pipeline of `latency` stages that takes an input in every cycle.
    pub const fn pipelined(latency: u32) -> Self {
        Self { latency, interval: 1 }
    }

    /// As often, with the result a cycle later: no block's, but what latency costs ([`Eased`](crate::hardware::Eased)).
    pub(crate) const fn at_once(self) -> Self {
        Self { latency: 1, ..self }
    }
}

/// A combinational block: what it computes, and the cycles its pipeline takes for it.
pub trait Block {
    /// Its name: the file here, the file and module in `rtl/`.
    const NAME: &'static str;
    /// Cycles of its RTL as it stands in `rtl/`: that of the default hardware, [`Form::FULL`].
    const TIMING: Timing;
    /// What goes in.
    type In: Wire;
    /// What comes out.
    type Out: Wire;
    /// Cycles of its RTL in hardware of another form.
    fn timing(_form: &Form) -> Timing {
        Self::TIMING
    }
    /// What its RTL is made of in hardware of this form, with a tag of [`TAG`](parts::TAG) bits.
    fn parts(form: &Form) -> Parts;
    /// The function, exact and total over the legal inputs stated at the head of the block's file.
    fn eval(input: &Self::In) -> Self::Out;
}

/// Dot product of two integer vectors; the caller proves that it and its partial sums fit 64 bits.
#[inline(always)]
pub(crate) fn dot(a: [i64; 3], b: [i64; 3]) -> i64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
