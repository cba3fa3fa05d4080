//! Hardware other than the default, which tests build and compare too.

use lodray::block::EdgesPerCycle;
use lodray::hardware::Hardware;

/// Small: few levels, a stack for scenes of which is known how many can wait, two rays under way, one edge a cycle.
pub const SMALL: Hardware = Hardware {
    levels: 6,
    bvh_depth: 16,
    fewer_stack_entries: Some(40),
    contexts: 2,
    context_bits: 1,
    edges_per_cycle: EdgesPerCycle::One,
    ..Hardware::DEFAULT
};
/// Between it and the default in depth, with more rays under way, not a power of two.
pub const MIDDLE: Hardware = Hardware { levels: 9, bvh_depth: 20, contexts: 5, context_bits: 3, ..Hardware::DEFAULT };
/// For coordinates and directions of fewer bits: products of other limbs and other latencies than the default's.
pub const NARROW: Hardware =
    Hardware { levels: 5, bvh_depth: 18, contexts: 3, context_bits: 2, coordinate_zeros: 11, direction_zeros: 13, ..Hardware::DEFAULT };
/// A little narrower, as many limbs, one edge a cycle.
pub const NARROWER_BY_FEW: Hardware =
    Hardware { coordinate_zeros: 3, direction_zeros: 5, edges_per_cycle: EdgesPerCycle::One, ..Hardware::DEFAULT };
/// The others.
pub const OTHERS: [Hardware; 4] = [SMALL, MIDDLE, NARROW, NARROWER_BY_FEW];
/// Those that leave out low bits.
pub const NARROWS: [Hardware; 2] = [NARROW, NARROWER_BY_FEW];
