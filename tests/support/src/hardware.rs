//! Hardware other than the default, which tests build and compare too. Of few contexts: what a unit takes to compile grows with them, and the default has sixteen.

use crate::models::scene_of;
use lodray::block::{BoxesPerCycle, EdgesPerCycle};
use lodray::format::{Job, Scene};
use lodray::hardware::Hardware;
use lodray::mesh::Hierarchy;
use lodray::num::{Ray, U, VertexForm};
use lodray::rays::cone;

/// Small: few levels, a stack for scenes of which is known how many can wait, two rays under way, one edge, one box and one bit of each division a cycle, three
/// divisions in turns, registers on all ways between contexts and blocks.
pub const SMALL: Hardware = Hardware {
    levels: 6,
    bvh_depth: 16,
    fewer_stack_entries: Some(40),
    contexts: 2,
    context_bits: 1,
    edges_per_cycle: EdgesPerCycle::One,
    lod_edges_per_cycle: EdgesPerCycle::One,
    divide_bits: 1,
    setup_bits: 1,
    divide_copies: 3,
    boxes_per_cycle: BoxesPerCycle::One,
    link_registers: 2,
    ..Hardware::DEFAULT
};
/// Between it and the default in depth, with more rays under way, not a power of two; all edges and boxes at once, two bits of each division a cycle
/// by blocks in turns, and registers for operands.
pub const MIDDLE: Hardware = Hardware {
    levels: 9,
    bvh_depth: 20,
    contexts: 5,
    context_bits: 3,
    edges_per_cycle: EdgesPerCycle::Three,
    lod_edges_per_cycle: EdgesPerCycle::Three,
    boxes_per_cycle: BoxesPerCycle::Four,
    divide_bits: 2,
    setup_bits: 2,
    setup_copies: 3,
    divide_copies: 2,
    link_registers: 1,
    ..Hardware::DEFAULT
};
/// For coordinates and directions of fewer bits: products of other limbs and other latencies than the default's; all edges at once, two boxes a cycle.
pub const NARROW: Hardware = Hardware {
    levels: 5,
    bvh_depth: 18,
    contexts: 3,
    context_bits: 2,
    edges_per_cycle: EdgesPerCycle::Three,
    lod_edges_per_cycle: EdgesPerCycle::Three,
    boxes_per_cycle: BoxesPerCycle::Two,
    setup_copies: 4,
    coordinate_zeros: 11,
    direction_zeros: 13,
    ..Hardware::DEFAULT
};
/// A little narrower, as many limbs, one edge a cycle.
pub const NARROWER_BY_FEW: Hardware = Hardware {
    contexts: 4,
    coordinate_zeros: 3,
    direction_zeros: 5,
    edges_per_cycle: EdgesPerCycle::One,
    lod_edges_per_cycle: EdgesPerCycle::One,
    ..Hardware::DEFAULT
};
/// For rays of full detail or none of models of compact vertices: no LOD test, nothing morphed, and fewer bits of every number of nodes, trees and lines.
pub const FULL_DETAIL: Hardware = Hardware {
    levels: 4,
    bvh_depth: 17,
    contexts: 3,
    context_bits: 2,
    index_bits: 15,
    lod_test: false,
    exact_vertices: false,
    ..Hardware::DEFAULT
};
/// For views so far away that trees of up to seven levels are stored to one, of exact vertices, from inside of the model.
pub const SHALLOW: Hardware = Hardware {
    levels: 7,
    contexts: 2,
    context_bits: 1,
    fewer_stored_levels: Some(1),
    lod_edges_per_cycle: EdgesPerCycle::Three,
    boxes_per_cycle: BoxesPerCycle::Four,
    index_bits: 20,
    start_radius: false,
    compact_vertices: false,
    ..Hardware::DEFAULT
};
/// For base meshes alone: nothing is split, and every hit is where it is.
pub const FLAT: Hardware =
    Hardware { fewer_stored_levels: Some(0), lod_test: false, start_radius: false, hit_mapping: false, contexts: 2, ..Hardware::DEFAULT };
/// For rays from a surface too.
pub const SECONDARY: Hardware =
    Hardware { contexts: 3, context_bits: 2, setup_copies: 2, divide_copies: 4, secondary: true, ..Hardware::DEFAULT };
/// The same with all edges and boxes at once, other steps of divisions, cones from points, compact vertices and fewer bits of every number.
pub const SECONDARY_AT_ONCE: Hardware = Hardware {
    levels: 6,
    contexts: 6,
    context_bits: 3,
    edges_per_cycle: EdgesPerCycle::Three,
    lod_edges_per_cycle: EdgesPerCycle::Three,
    boxes_per_cycle: BoxesPerCycle::Four,
    divide_bits: 1,
    setup_bits: 2,
    setup_copies: 2,
    divide_copies: 4,
    index_bits: 15,
    link_registers: 2,
    start_radius: false,
    exact_vertices: false,
    secondary: true,
    ..Hardware::DEFAULT
};
/// Of full detail or none: no ray decides for another.
pub const SECONDARY_FULL_DETAIL: Hardware =
    Hardware { levels: 4, contexts: 4, context_bits: 2, divide_bits: 2, lod_test: false, secondary: true, ..Hardware::DEFAULT };
/// All for rays from a surface.
pub const SECONDARIES: [Hardware; 3] = [SECONDARY, SECONDARY_AT_ONCE, SECONDARY_FULL_DETAIL];
/// The one that `scripts/synth --fpga` places.
pub const FPGA: Hardware = Hardware::fpga(2);
/// The others.
pub const OTHERS: [Hardware; 11] =
    [SMALL, MIDDLE, NARROW, NARROWER_BY_FEW, FULL_DETAIL, SHALLOW, FLAT, SECONDARY, SECONDARY_AT_ONCE, SECONDARY_FULL_DETAIL, FPGA];
/// The most levels of the models that such hardware is for.
pub fn most_levels(hardware: &Hardware) -> u32 {
    if hardware.hit_mapping { hardware.levels } else { hardware.stored_levels() }
}

/// The form of vertices that is wanted, or the one that such hardware has.
pub fn form_for(hardware: &Hardware, wanted: VertexForm) -> VertexForm {
    match (hardware.compact_vertices, hardware.exact_vertices) {
        (true, true) => wanted,
        (compact, _) => {
            if !compact {
                VertexForm::Exact
            } else if wanted.is_compact() {
                wanted
            } else {
                VertexForm::Compact
            }
        }
    }
}

/// The scene of a model, its trees stored as deep as such hardware takes them.
pub fn scene_for(hardware: &Hardware, h: &Hierarchy) -> Scene {
    let scene = scene_of(h);
    let depths = vec![hardware.stored_levels(); scene.trees()];
    scene.pruned(&depths, Job::default()).expect("memory")
}

/// The ray as such hardware takes it, by turns of full detail and of none if it has no LOD test.
pub fn ray_for(hardware: &Hardware, ray: &Ray, number: usize) -> Ray {
    let mut ray = *ray;
    if !hardware.lod_test {
        ray.cone = cone(if number % 4 == 3 { 0.0 } else { f64::INFINITY }, 1e6, 0.1);
    } else if !hardware.start_radius {
        ray.cone.offset = U::ZERO;
    }
    ray
}

/// Those that leave out features.
pub const LESS: [Hardware; 3] = [FULL_DETAIL, SHALLOW, FLAT];
/// Those that leave out low bits.
pub const NARROWS: [Hardware; 2] = [NARROW, NARROWER_BY_FEW];
