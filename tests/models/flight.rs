//! Flights: what pops between frames, ours and discrete levels'.

use lodray::format::Scene;
use lodray::mesh::procedural::{self, Options};
use lodray::method::bvh::NoStore;
use lodray::method::{Knobs, Method, Registered, discrete, lod, stochastic};
use lodray::picture::Pops;
use lodray::rays::{Camera, ModelSpace, View};
use lodray::study::{Fly, Silent, fly};
use std::convert::Infallible;

fn scene() -> Scene {
    Scene::generate(&Options { levels: Some(5), base: Some(128), ..Options::new(procedural::Scene::Sphere) }).expect("a sphere")
}

fn cameras(scene: &Scene, from: f64, to: f64, frames: u32) -> Vec<Camera> {
    let space = ModelSpace::of(scene);
    let at = |k: u32| from * (to / from).powf(f64::from(k) / f64::from(frames - 1));
    let view = |k| View { distance: Some(at(k)), ..View::default() };
    (0..frames).map(|k| Camera::new(&view(k), &space, 96, 96).expect("a camera")).collect()
}

fn flown(scene: &Scene, registered: &Registered, knobs: &Knobs, cameras: &[Camera]) -> Vec<Pops> {
    let method: Box<dyn Method> = (registered.make)(scene, knobs, &NoStore).expect("a method");
    let what = Fly { scene, method: &*method, delta: 1.0, cameras };
    let frames = fly(&what, &Silent, &mut |_, _| Ok::<_, Infallible>(())).unwrap_or_else(|never| match never {});
    assert_eq!(frames.len(), cameras.len());
    frames.iter().filter_map(|frame| frame.pops).collect()
}

/// Of the frame that pops most.
fn most(pops: &[Pops]) -> f64 {
    pops.iter().map(|pops| pops.surface.mean).fold(0.0, f64::max)
}

/// The smaller the step, the less pops of ours: its surface follows the camera. A discrete level is another surface from one frame to the next, however near these are.
#[test]
fn ours_changes_as_little_as_the_camera_moves_and_levels_do_not() {
    let scene = scene();
    let [coarse, fine] = [9, 129].map(|frames| cameras(&scene, 9.0, 6.0, frames));
    let of = |registered, knobs: &Knobs| [&coarse, &fine].map(|cameras| most(&flown(&scene, registered, knobs, cameras)));
    let none = Knobs::default();
    let ours = of(&lod::METHOD, &none);
    let levels = of(&discrete::METHOD, &none);
    let drawn = of(&stochastic::METHOD, &none);
    println!("most pops, 8 and 128 steps: ours {ours:?}, discrete {levels:?}, stochastic {drawn:?}");
    assert!(ours[1] < 0.25 * ours[0], "sixteen times smaller steps: {ours:?}");
    assert!(levels[1] > 0.7 * levels[0] && levels[1] > 4.0 * ours[1], "{levels:?}, {ours:?}");
    assert!(drawn[1] > 2.0 * ours[1], "{drawn:?}, {ours:?}");
}

/// What changes from one frame to the next is at most what both are off by: delta's promise, twice.
#[test]
fn no_step_changes_the_surface_by_more_than_delta_promises() {
    let scene = scene();
    let pops = flown(&scene, &lod::METHOD, &Knobs::default(), &cameras(&scene, 12.0, 1.5, 60));
    let (pixels, largest) =
        pops.iter().fold((0, 0.0f64), |(pixels, largest), pops| (pixels + pops.pixels, largest.max(pops.surface.largest)));
    println!("{pixels} pixels, largest pop {largest:.3} pixel widths");
    assert!(pixels > 100_000 && largest < 2.0 * 1.55, "{largest}");
}

#[test]
fn full_detail_and_a_camera_that_stands_still_pop_nothing() {
    let scene = scene();
    let still = cameras(&scene, 3.0, 3.0, 3);
    let moving = cameras(&scene, 3.0, 2.0, 4);
    let full = Knobs::default().with(&discrete::LEVEL, "5").expect("the finest");
    for pops in flown(&scene, &lod::METHOD, &Knobs::default(), &still) {
        assert!(pops.pixels > 500 && pops.surface.percentile_999 < 1e-3 && pops.surface.mean < 1e-3, "{pops:?}");
    }
    // What a moving camera sees at outlines is all there is, a tenth of what a switch of levels changes.
    for pops in flown(&scene, &discrete::METHOD, &full, &moving) {
        assert!(pops.pixels > 500 && pops.surface.mean < 0.01, "{pops:?}");
    }
}
