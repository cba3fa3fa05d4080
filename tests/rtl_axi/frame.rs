//! The unit behind its adapter, with a scene's file as memory: a frame equals the golden traverser's hits, and errors end their rays alone.

use crate::bus::{Bus, Manners, Memory, input, output};
use lodray::golden::exact::Exact;
use lodray::hardware::RayError;
use lodray::hardware::ports::{HitOut, RayIn, SceneConfig};
use lodray::mesh::procedural::{self, Options};
use lodray::num::{Ray, U, VertexForm};
use lodray::rays::{Camera, ModelSpace, View};
use lodray::sim::unit::file_config;
use lodray_test_support::models::{Rng, build_with};
use lodray_test_support::plain::plain;
use tb::{Build, Sim};

/// A frame of a scene on a unit of so many contexts and edge functions, over a bus of `N` words of 32 bits with ids of `ID` bits.
fn frame<const N: usize, const ID: u32>(kind: procedural::Scene, form: VertexForm, contexts: u32, edges: u32, manners: Manners) {
    const SIDE: u32 = 48;
    let options = Options { levels: Some(3), base: Some(32), ..Options::new(kind) };
    let scene = build_with(&procedural::generate(&options).expect("options"), form);
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View { distance: Some(2.5), ..View::default() }, &space, SIDE, SIDE).expect("a view");
    let pixels = (0..SIDE * SIDE).map(|i| camera.ray(i % SIDE, i / SIDE));
    let rays: Vec<Ray> = pixels.filter_map(|world| Some(space.enter(&world, 1.0)?.ray)).collect();

    let seed = tb::seed(0xf4a).unwrap_or_else(|error| panic!("{error}"));
    let mut rng = Rng(seed);
    // Any line, above what 32 bits reach.
    let base = (1 << 40) + 32 * rng.below(1 << 20);
    let bytes = scene.bytes();
    let mut memory = Memory::new(manners, rng.draw(), |address| {
        let at = (address - base) as usize; // within the file
        u32::from_le_bytes([0, 1, 2, 3].map(|k| bytes[at + k]))
    });

    let build = Build::rtl("traversal_unit_axi").parameter("CONTEXTS", contexts).parameter("EDGES_PER_CYCLE", edges);
    let model = build.parameter("DATA_W", 32 * N).parameter("ADDRESS_W", 48).model().unwrap_or_else(|error| panic!("{error}"));
    let mut sim = Sim::new(&model, seed);
    let bus = Bus::<N, ID, 48>::new(&sim);
    let (reset, scene_i, base_i) = (input::<bool>(&sim, "rst_ni"), input::<SceneConfig>(&sim, "scene_i"), input::<U<48>>(&sim, "base_i"));
    let flush_i = input::<bool>(&sim, "flush_i");
    let (valid_i, ready_o, in_i) = (input::<bool>(&sim, "valid_i"), output::<bool>(&sim, "ready_o"), input::<RayIn>(&sim, "in_i"));
    let (valid_o, ready_i, out_o) = (output::<bool>(&sim, "valid_o"), input::<bool>(&sim, "ready_i"), output::<HitOut>(&sim, "out_o"));
    let (busy, error) = (output::<bool>(&sim, "reads_busy_o"), output::<bool>(&sim, "read_error_o"));
    sim.poke(scene_i, &file_config(&scene));
    sim.poke(base_i, &U::<48>::new(base));
    sim.poke(flush_i, &false);
    sim.poke(valid_i, &false);
    sim.poke(reset, &false);
    bus.drive(&mut sim, false, None, &mut rng);
    (0..2).for_each(|_| sim.clock());
    sim.poke(reset, &true);

    let (mut next, mut offering, mut held) = (0, false, None);
    let mut hits: Vec<Option<HitOut>> = vec![None; rays.len()];
    let (mut done, mut cycles, mut met) = (0, 0u64, 0);
    let (mut wrong, mut shown, mut still) = (0, 0, 0);
    // Until the last answer is over, too.
    while still < 4 {
        still = if done < rays.len() || sim.peek::<bool>(busy) { 0 } else { still + 1 };
        let (beat, takes, takes_hit) = (memory.beat(), memory.ready(), rng.below(4) > 0);
        offering |= next < rays.len() && rng.below(4) > 0;
        bus.drive(&mut sim, takes, beat, &mut rng);
        sim.poke(valid_i, &offering);
        sim.poke(in_i, &if offering { RayIn { tag: U::new(next as u64), ray: rays[next] } } else { RayIn::default() });
        sim.poke(ready_i, &takes_hit);
        sim.eval();
        if let Some(request) = bus.request(&mut sim).filter(|_| takes) {
            assert!(sim.peek::<bool>(busy));
            memory.take(request);
        }
        if offering && sim.peek::<bool>(ready_o) {
            (next, offering) = (next + 1, false);
        }
        let hit: Option<HitOut> = if sim.peek(valid_o) { Some(sim.peek(out_o)) } else { None };
        assert!(held.is_none() || hit == held, "cycle {cycles}: a hit was not held");
        held = hit.filter(|_| !takes_hit);
        if let Some(hit) = hit.filter(|_| takes_hit) {
            assert!(hits[hit.tag.get() as usize].replace(hit).is_none());
            done += 1;
        }
        shown += u64::from(sim.peek::<bool>(error));
        wrong += memory.finished.drain(..).filter(|(_, wrong)| *wrong).count() as u64;
        sim.clock();
        cycles += 1;
        assert!(cycles < 100_000_000, "seed {seed}: no end");
    }
    assert!(!sim.failed(), "seed {seed}: an assertion of the RTL failed");
    assert!(shown == wrong && (wrong > 0) == (manners.errors > 0), "seed {seed}: {wrong} answers with errors, {shown} shown");
    let h = scene.decode();
    let golden = Exact::new(&h);
    // A ray whose line came with an error says so; all others have the golden traverser's hits.
    let mut ended = 0;
    for (ray, hit) in rays.iter().zip(&hits) {
        let hit = hit.expect("every ray is done");
        if let Some(error) = hit.error() {
            assert!(error == RayError::Memory && !hit.found, "seed {seed}: {error}");
            ended += 1;
            continue;
        }
        assert_eq!(hit.found.then(|| plain(&hit.hit)), golden.trace(ray), "seed {seed}: {ray:?}");
        met += u64::from(hit.found);
    }
    assert!(ended <= wrong && (ended > 0) == (wrong > 0), "seed {seed}: {ended} rays ended early by {wrong} answers");
    if wrong > 0 {
        assert!(met > 100, "seed {seed}: {met} hits beside {ended} rays that ended early");
        println!("{} rays, {wrong} answers with errors, {ended} rays ended early", rays.len());
        return;
    }
    println!("{kind:?} over {} bits: {} rays, {met} hits, {cycles} cycles, {} reads under way", 32 * N, rays.len(), memory.most);
    assert!(met > 500 && memory.most > 1);
}

#[test]
fn a_frame_over_wide_beats() {
    let manners = Manners { refuses: 3, rests: 1, latency: (4, 60), interleaves: true, errors: 0 };
    frame::<8, 3>(procedural::Scene::Sphere, VertexForm::Compact, 4, 3, manners);
}

#[test]
fn errors_of_the_bus_are_shown() {
    let manners = Manners { refuses: 0, rests: 0, latency: (1, 20), interleaves: true, errors: 30 };
    frame::<8, 3>(procedural::Scene::Sphere, VertexForm::Compact, 4, 3, manners);
}

#[test]
fn a_frame_over_narrow_beats() {
    let manners = Manners { refuses: 1, rests: 2, latency: (1, 30), interleaves: true, errors: 0 };
    frame::<1, 2>(procedural::Scene::Terrain, VertexForm::Exact, 2, 1, manners);
}

/// Whether a unit with a ray at its port, or on its way, passes the rules if the base moves in that cycle.
fn base_may_move(taken_before: u64, moves: bool) -> bool {
    let model = Build::rtl("traversal_unit_axi")
        .parameter("CONTEXTS", 2)
        .parameter("ADDRESS_W", 48)
        .model()
        .unwrap_or_else(|error| panic!("{error}"));
    let mut sim = Sim::new(&model, 5);
    let bus = Bus::<8, 2, 48>::new(&sim);
    let (reset, base_i, valid_i) = (input::<bool>(&sim, "rst_ni"), input::<U<48>>(&sim, "base_i"), input::<bool>(&sim, "valid_i"));
    let (scene_i, in_i) = (input::<SceneConfig>(&sim, "scene_i"), input::<RayIn>(&sim, "in_i"));
    let (ready_o, busy_o) = (output::<bool>(&sim, "ready_o"), output::<bool>(&sim, "busy_o"));
    sim.poke(scene_i, &SceneConfig::default());
    sim.poke(in_i, &RayIn::default());
    sim.poke(base_i, &U::<48>::new(0));
    sim.poke(valid_i, &false);
    sim.poke(reset, &false);
    bus.drive(&mut sim, false, None, &mut Rng(1));
    (0..2).for_each(|_| sim.clock());
    sim.poke(reset, &true);
    // A free base: no ray is there.
    sim.poke(base_i, &U::<48>::new(64));
    sim.clock();
    for cycle in 0..=taken_before {
        sim.poke(valid_i, &(cycle == 0));
        sim.poke(base_i, &U::<48>::new(if moves && cycle == taken_before { 128 } else { 64 }));
        sim.eval();
        assert!(if cycle == 0 { sim.peek::<bool>(ready_o) } else { sim.peek::<bool>(busy_o) });
        sim.clock();
    }
    !sim.failed()
}

#[test]
fn the_base_stands_still_while_a_ray_is_under_way() {
    for cycles in [0, 1, 3] {
        assert!(base_may_move(cycles, false), "a base that stood still was rejected");
        assert!(!base_may_move(cycles, true), "a base that moved {cycles} cycles behind a ray passed");
    }
}
