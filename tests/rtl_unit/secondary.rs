//! Rays from where rays hit, on the unit: exact starts, ranges of t, any hit, and rays that decide for others.

use crate::{SideBySide, any_traffic, cycles_wanted};
use lodray::format::Scene;
use lodray::golden::Exact;
use lodray::hardware::Hardware;
use lodray::mesh::procedural::{self, Options};
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::num::{Ray, VertexForm};
use lodray::rays::{Camera, ModelSpace, View};
use lodray::sim::unit::environment::{RunReport, run_secondary};
use lodray::sim::unit::{Latency, SceneMemory, Traffic};
use lodray_test_support::bounces::{Bounce, next};
use lodray_test_support::hardware::{SECONDARIES, SECONDARY, SECONDARY_AT_ONCE, form_for, most_levels, ray_for, scene_for};
use lodray_test_support::is_nightly;
use lodray_test_support::models::{Rng, any_rays, ball, build_with, terrain, with_vertices};

/// Runs these rays through model and RTL, and compares every hit with the blocks' and the golden traverser's.
fn compare(scene: &Scene, config: Hardware, traffic: &Traffic, bounces: &[Bounce], seed: u64) -> RunReport {
    let memory = SceneMemory::new(LodImage::of(scene), seed % (1 << 35));
    let what = format!("seed {seed}, {config:?}, {traffic:?}");
    let mut both = SideBySide::new(config, &memory.config(), seed, what.clone());
    let (rays, secondary): (Vec<_>, Vec<_>) = bounces.iter().map(|bounce| (bounce.ray, bounce.secondary())).unzip();
    let report = run_secondary(&mut both, &memory, traffic, &rays, &secondary).unwrap_or_else(|error| panic!("{what}: {error}"));
    assert!(!both.rtl.sim.failed(), "{what}: an assertion of the RTL failed");
    let h = scene.decode();
    let (golden, mut traverser) = (Exact::new(&h), LodTraverser::new(LodImage::of(scene)));
    for (bounce, traced) in bounces.iter().zip(&report.rays) {
        bounce.check(&mut traverser, &golden, &traced.hit, &traced.corners, &what);
    }
    report
}

/// One that is compiled for waveforms too.
const ONE_CONTEXT: Hardware = Hardware { secondary: true, ..Hardware::one_context() };

#[test]
fn random_paths_under_random_traffic() {
    let (seed, wanted) = (tb::seed(1).unwrap_or_else(|error| panic!("{error}")), cycles_wanted() / 2);
    let hardware = if is_nightly() { &SECONDARIES[..] } else { &[SECONDARY_AT_ONCE, ONE_CONTEXT] };
    let [mut cycles, mut traced, mut hits, mut decided, mut ranged] = [0; 5];
    for round in 0.. {
        let seed = seed + round;
        let mut rng = Rng(seed);
        let config = hardware[round as usize % hardware.len()];
        let levels = rng.below(u64::from(most_levels(&config).min(5) + 1)) as u32;
        let roughness = [0.05, 0.4, 1.5][rng.below(3) as usize];
        let h = if rng.below(2) == 0 { ball(levels, roughness, seed) } else { terrain(2, levels, roughness, seed) };
        let h = with_vertices(form_for(&config, VertexForm::ALL[rng.below(3) as usize]), h);
        let scene = scene_for(&config, &h);
        let h = scene.decode();
        let mut traverser = LodTraverser::new(LodImage::of(&scene));
        let first = any_rays(&h, 10 * config.contexts, seed);
        let mut bounces: Vec<Bounce> = first.iter().enumerate().map(|(k, ray)| Bounce::primary(ray_for(&config, ray, k))).collect();
        for _ in 0..4 {
            let report = compare(&scene, config, &any_traffic(&mut rng), &bounces, seed);
            cycles += report.cycles;
            traced += bounces.len() as u64;
            hits += report.rays.iter().filter(|ray| ray.hit.found).count() as u64;
            decided += bounces.iter().filter(|bounce| bounce.secondary().prior).count() as u64;
            ranged += bounces.iter().filter(|bounce| bounce.any || bounce.range != Bounce::primary(bounce.ray).range).count() as u64;
            bounces = next(&config, &h, &mut traverser, &bounces, &mut rng);
            if bounces.is_empty() {
                break;
            }
        }
        if cycles >= wanted {
            break;
        }
    }
    println!("seed {seed}: {cycles} cycles compared, {traced} rays, {decided} with rays before them, {ranged} within a range, {hits} hits");
    assert!(hits > 100 && decided > 100 && ranged > 50);
}

/// A frame with two bounces, and at each hit a ray towards something; in `scripts/nightly` also one of exact vertices.
#[test]
fn a_frame_of_two_bounces() {
    const SIDE: u32 = 64;
    let frames =
        [(procedural::Scene::Terrain, VertexForm::Compact, SECONDARY_AT_ONCE), (procedural::Scene::Sphere, VertexForm::Exact, SECONDARY)];
    for &(kind, form, config) in &frames[..if is_nightly() { 2 } else { 1 }] {
        let options = Options { levels: Some(3), base: Some(32), ..Options::new(kind) };
        let scene = build_with(&procedural::generate(&options).expect("options"), form);
        let space = ModelSpace::of(&scene);
        let camera = Camera::new(&View { distance: Some(2.5), ..View::default() }, &space, SIDE, SIDE).expect("a view");
        let pixels = (0..SIDE * SIDE).map(|i| camera.ray(i % SIDE, i / SIDE));
        let rays: Vec<Ray> = pixels.filter_map(|world| Some(space.enter(&world, 1.0)?.ray)).collect();
        let h = scene.decode();
        let mut traverser = LodTraverser::new(LodImage::of(&scene));
        let mut bounces: Vec<Bounce> = rays.iter().enumerate().map(|(k, ray)| Bounce::primary(ray_for(&config, ray, k))).collect();
        let mut rng = Rng(1);
        for bounce in 0..3 {
            let report = compare(&scene, config, &Traffic::smooth(Latency::Random { min: 5, max: 60, seed: 1 }), &bounces, 1);
            let hits = report.rays.iter().filter(|ray| ray.hit.found).count();
            println!("{kind:?}, bounce {bounce}: {} rays, {hits} hits, {} cycles", bounces.len(), report.cycles);
            assert!(hits > 200, "only {hits} hits");
            bounces = next(&config, &h, &mut traverser, &bounces, &mut rng);
        }
    }
}
