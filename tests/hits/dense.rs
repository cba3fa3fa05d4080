//! Leaves in blocks of the dense geometry format: hits in every field are those of leaves in lines, from cameras and surfaces, whatever the nodes; triangles that no block holds are refused.

use super::grid::{fan, pillow};
use lodray::bvh::BvhError;
use lodray::mesh::Hierarchy;
use lodray::method::ClosestHit;
use lodray::method::bvh::{BvhTraverser, FullBvh, FullOptions, LeafLayout, NodeBoxes, NodeOrder};
use lodray::num::{Cone, Ray};
use lodray::step::{NoSteps, StepCounts};
use lodray_test_support::bounces::leaving;
use lodray_test_support::models::{Rng, any_rays, ball, terrain};

/// The model with coordinates of 16 bits: any triangle fits.
fn coarse(mut h: Hierarchy) -> Hierarchy {
    h.points.iter_mut().flatten().for_each(|c| *c &= !0xffff);
    h
}

#[test]
fn hits_are_those_of_leaves_in_lines() {
    let kinds = [
        (NodeBoxes::Six, 4, NodeOrder::Depth),
        (NodeBoxes::Six, 2, NodeOrder::Levels),
        (NodeBoxes::Oriented, 3, NodeOrder::Treelets),
        (NodeBoxes::Local, 4, NodeOrder::VanEmdeBoas),
        (NodeBoxes::Codes, 1, NodeOrder::Depth),
        (NodeBoxes::Wide, 4, NodeOrder::Depth),
    ];
    let (mut hits, mut followed, mut lines) = (0, 0, [0u64; 2]);
    for seed in 0..3 {
        let levels = 2 + seed as u32;
        for (name, h) in [
            ("ball", ball(levels, 0.3, seed)),
            ("terrain", terrain(3, levels, 0.5, seed)),
            ("fan", fan(levels)),
            ("pillow", pillow(levels)),
        ] {
            let h = coarse(h);
            let rays = any_rays(&h, 150, seed);
            for (boxes, size, order) in kinds {
                let of =
                    |layout| FullBvh::build(&h, &FullOptions { order, ..FullOptions::new(size, boxes, layout) }).expect("a valid model");
                let [mut wanted, mut own] = [LeafLayout::Line, LeafLayout::Dgf].map(|layout| BvhTraverser::new(&of(layout)));
                let mut rng = Rng(5);
                for ray in &rays {
                    let (mut a, mut b) = (ClosestHit::new(h.levels), ClosestHit::new(h.levels));
                    let mut counts = [StepCounts::default(), StepCounts::default()];
                    wanted.trace(ray, &mut counts[0], &mut a);
                    own.trace(ray, &mut counts[1], &mut b);
                    assert_eq!(b.record(), a.record(), "{name}, {boxes:?}, {ray:?}");
                    lines.iter_mut().zip(&counts).for_each(|(lines, counts)| *lines += counts.lines.iter().sum::<u64>());
                    let (Some(hit), Some(corners)) = (a.record(), a.corners()) else { continue };
                    hits += 1;
                    let from = BvhTraverser::departure(&hit, &corners);
                    let at = h.points[rng.below(h.points.len() as u64) as usize].map(i64::from);
                    let next = Ray {
                        origin: from.start.point,
                        direction: leaving(&mut rng, &corners, from.start.point, at),
                        cone: Cone::default(),
                    };
                    let (mut a, mut b) = (ClosestHit::new(h.levels), ClosestHit::new(h.levels));
                    wanted.trace_from(&next, &from, &mut NoSteps, &mut a);
                    own.trace_from(&next, &from, &mut NoSteps, &mut b);
                    assert_eq!(b.record(), a.record(), "{name}, {boxes:?}, from {from:?}, {next:?}");
                    followed += usize::from(a.record().is_some());
                }
            }
        }
    }
    assert!(hits > 1000 && followed > hits / 20, "{followed} of {hits}");
    // A leaf of one to four triangles is four lines.
    assert!(lines[1] > lines[0], "{lines:?}");
}

#[test]
fn what_no_block_holds_is_refused() {
    let fine = ball(2, 0.3, 1);
    let of = |h: &Hierarchy| FullBvh::build(h, &FullOptions::new(4, NodeBoxes::Six, LeafLayout::Dgf));
    assert_eq!(of(&fine), Err(BvhError::Dense));
    assert!(of(&coarse(fine)).is_ok());
}
