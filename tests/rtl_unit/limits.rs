//! The unit where its parts are at their limits: the hit queue full, boxes that are entered exactly where the closest hit is, and surroundings that break a rule.

use crate::port::Rtl;
use crate::{Compared, QUEUED, compare};
use lodray::hardware::Hardware;
use lodray::hardware::ports::{MemoryAnswer, RayIn, SceneConfig};
use lodray::mesh::Hierarchy;
use lodray::method::lod::LodImage;
use lodray::num::{Cone, Ray, U, VertexForm};
use lodray::sim::unit::environment::{UnitPort, run};
use lodray::sim::unit::ray_trace::{RayTrace, TraceEvent};
use lodray::sim::unit::{Inputs, Latency, SceneMemory, Stall, Traffic, TraversalUnit};
use lodray_test_support::is_nightly;
use lodray_test_support::models::{Rng, model, ray, scene_of, with_vertices};

/// A tree of one level whose four children all lie across the z axis, one behind the other: each inserted vertex is turned to where the opposite corner is.
fn stacked() -> Hierarchy {
    let base = [[2, 0, 0], [0, 2, 0], [0, 0, 2]];
    model(1, &base, vec![[0, 1, 2]], |p, level| {
        // Corners have one coordinate of 4, midpoints a 0 where the opposite corner has it.
        let axis = if level == 0 { p.iter().position(|&v| v == 4) } else { p.iter().position(|&v| v == 0) };
        let angle = axis.unwrap_or(0) as f64 * std::f64::consts::TAU / 3.0;
        let [r, z] = if level == 0 { [4e8, 0.0] } else { [3e8, 1e8 * (1.0 + angle)] };
        [r * angle.cos(), r * angle.sin(), z]
    })
}

#[test]
fn the_hit_queue_filled() {
    let h = with_vertices(VertexForm::Exact, stacked());
    let scene = scene_of(&h);
    // None but the first division ends before all hits are there. One context too in `scripts/nightly`.
    for contexts in if is_nightly() { &[1, 4][..] } else { &[4] } {
        let contexts = *contexts;
        let config = Hardware { contexts, ..QUEUED };
        let mut longest = 0;
        for seed in 0..24 {
            let mut rng = Rng(seed);
            let rays: Vec<Ray> = (0..8 * contexts)
                .map(|_| {
                    let [x, y] = [0; 2].map(|_| (1e7 * rng.signed()) as i64);
                    ray([x, y, 1 << 30], [0, 0, -(1 << 29)], Cone::default())
                })
                .collect();
            // All contexts wait for the port, and go on together.
            let memory_stall = Stall::Random { eighths: 6, stretch: 300, seed };
            let traffic = Traffic { memory_stall, ..Traffic::smooth(Latency::Fixed(1)) };
            let Compared { hits, longest_queue, .. } = compare(&scene, config, &traffic, &rays, seed);
            assert_eq!(hits, rays.len() as u64);
            longest = longest.max(longest_queue);
        }
        println!("{contexts} contexts: {longest} hits in the queue");
        // The first goes to the division at once.
        assert_eq!(longest, 4 * contexts - 1, "{contexts} contexts");
    }
}

/// Some trees in the same places of a plane on a step of box codes.
fn doubled() -> Hierarchy {
    let corners = [[-1, -1, 0], [1, -1, 0], [0, 1, 0]];
    let base: Vec<[i64; 3]> = (0..4).flat_map(|_| corners).collect();
    let triangles = (0..4).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    model(1, &base, triangles, |p, _| [p[0] as f64 * f64::from(1 << 28), p[1] as f64 * f64::from(1 << 28), 0.0])
}

#[test]
fn boxes_entered_where_the_closest_hit_is() {
    let h = doubled();
    let scene = scene_of(&h);
    // Distances and components that are powers of two: nothing is rounded.
    let rays: Vec<Ray> = (0..8).map(|k| ray([k << 20, 0, 1 << (22 + k)], [0, 0, -(1 << 29)], Cone::default())).collect();
    let config = Hardware::one_context();
    let memory = SceneMemory::new(LodImage::of(&scene), 0);
    let traffic = Traffic::smooth(Latency::Fixed(3));
    let mut traced = RayTrace::new(TraversalUnit::new(config, memory.config()), &memory);
    run(&mut traced, &memory, &traffic, &rays).unwrap_or_else(|error| panic!("{error}"));
    let (mut closest, mut level) = (u64::MAX, 0);
    for (_, event) in traced.events() {
        match event {
            TraceEvent::Compared { t, .. } => closest = closest.min(*t),
            TraceEvent::Popped { entry, dropped } => level += u64::from(!dropped && entry.t_near.get() << 18 == closest),
            TraceEvent::Hit(_) => closest = u64::MAX,
            _ => (),
        }
    }
    println!("{level} entries visited at the distance of the closest hit");
    assert!(level > 0);
    let Compared { hits, .. } = compare(&scene, config, &traffic, &rays, 1);
    assert_eq!(hits, rays.len() as u64);
}

/// What the rules of the ports say of some cycles of a unit of one context.
fn kept(of: impl Fn(usize, &mut Rtl) -> Inputs) -> bool {
    let h = doubled();
    let scene = scene_of(&h);
    let config = Hardware::one_context();
    let memory = SceneMemory::new(LodImage::of(&scene), 0);
    let mut rtl = Rtl::new(config, &memory.config(), 1);
    for cycle in 0..60 {
        rtl.outputs();
        let inputs = of(cycle, &mut rtl);
        rtl.tick(&inputs);
    }
    !rtl.sim.failed()
}

#[test]
fn surroundings_that_break_a_rule_are_noticed() {
    let some = |tag| RayIn { tag: U::new(tag), ..RayIn::default() };
    let quiet = Inputs { hit_ready: true, mem_ready: true, ..Inputs::default() };
    // Rays come until one is taken, and the next one waits.
    let rays = |cycle: usize| Inputs { ray: Some(some(u64::from(cycle > 0))), ..quiet };
    assert!(kept(|cycle, _| rays(cycle)));
    assert!(!kept(|cycle, _| if cycle == 5 { quiet } else { rays(cycle) }), "a ray was withdrawn");
    assert!(!kept(|cycle, _| Inputs { ray: Some(some(cycle as u64)), ..quiet }), "a ray was changed");
    let answer = |tag| Some(MemoryAnswer { tag: U::new(tag), ..MemoryAnswer::default() });
    assert!(!kept(|cycle, _| Inputs { answer: answer(1).filter(|_| cycle == 20), ..rays(cycle) }), "an answer without a request");
    let moved = |at: usize, first: usize| {
        kept(|cycle, rtl| {
            if cycle == at {
                rtl.scene(&SceneConfig { levels: U::new(1), ..SceneConfig::default() });
            }
            if cycle < first { quiet } else { rays(cycle - first) }
        })
    };
    assert!(!moved(10, 0), "the scene was changed while a ray was under way");
    assert!(!moved(3, 3), "the scene was changed in the cycle in which a ray was taken");
    assert!(moved(3, 4));
}
