//! Hardware other than the default, which tests build and compare too.

use lodray::block::EdgesPerCycle;
use lodray::hardware::Hardware;

/// Small: few levels, a stack for scenes of which is known how many can wait, two rays under way, one edge a cycle.
pub const SMALL: Hardware =
    Hardware { levels: 6, bvh_depth: 16, fewer_stack_entries: Some(40), contexts: 2, context_bits: 1, edges_per_cycle: EdgesPerCycle::One };
/// Between it and the default in depth, with more rays under way, not a power of two.
pub const MIDDLE: Hardware = Hardware { levels: 9, bvh_depth: 20, contexts: 5, context_bits: 3, ..Hardware::DEFAULT };
/// The others.
pub const OTHERS: [Hardware; 2] = [SMALL, MIDDLE];
