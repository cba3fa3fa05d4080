//! Shadings on surfaces of which the light is known, and pictures with samples.

use lodray::bvh::over_trees;
use lodray::format::{self, Scene, SceneInfo};
use lodray::mesh::Surface;
use lodray::mesh::procedural::{self, Options};
use lodray::method::bvh::NoStore;
use lodray::method::{Knobs, Method, bvh, lod, reference};
use lodray::picture::{Light, Shader, Shading, render, sampled, shaded, view_cosine};
use lodray::rays::{Camera, ModelSpace, Query, RayFile, Sight, View};
use lodray_test_support::surfaces;

const LEVELS: u32 = 6;
/// Facets from a ridge to the next valley.
const RUN: f64 = 16.0;

/// The unit square with ridges along y, both sides of that slope; shaded with the normals of its sides.
fn roof(slope: f64) -> Scene {
    let steps = f64::from(1 << LEVELS);
    let vertices = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let height = |x: f64| {
        let at = (x * steps).rem_euclid(2.0 * RUN);
        slope * at.min(2.0 * RUN - at) / steps
    };
    let bent = surfaces::surface(LEVELS, &vertices, &[[0, 1, 2], [0, 2, 3]], |[x, y, _]| [x, y, height(x)]);
    let normal = |p: &[f64; 3]| {
        let at = (p[0] * steps).round().rem_euclid(2.0 * RUN);
        let side = if at == 0.0 || at == RUN { 0.0 } else { (RUN - at).signum() };
        [(-side * slope) as f32, 0.0, 1.0]
    };
    let normals = bent.positions.iter().map(normal).collect();
    let surface = Surface { normals, materials: Vec::new(), colours: Vec::new(), ..bent };
    format::build(&surface, SceneInfo::default(), over_trees).unwrap()
}

/// Cosine that a pixel sees which holds most of the scene, from `degrees` off its upright towards +x; the cone says how coarse it is met.
fn seen(scene: &Scene, shading: Shading, degrees: f64, cone: f64) -> f64 {
    let space = ModelSpace::of(scene);
    let method = (lod::METHOD.make)(scene, &Knobs::default(), &NoStore).unwrap();
    let (x, z) = degrees.to_radians().sin_cos();
    // Evenly over the plane of the corners, and off the edges between triangles.
    let place = |k: u32| (f64::from(k) + 0.37) / 64.0;
    let rays = (0..64 * 64).map(|k| Query::new([place(k % 64) + 4.0 * x, place(k / 64), 4.0 * z], [-x, 0.0, -z]).with_cone(cone, 0.0));
    let rays: Vec<_> = rays.collect();
    let mut light = Light::default();
    let file = RayFile::new(rays.clone());
    let mut tracer = method.tracer(&Sight::new(&file, &space, 1.0));
    let shader = Shader::new(scene, &space, shading);
    for ray in &rays {
        let hit = tracer.hit(ray);
        assert!(hit.is_some_and(|hit| (cone == 0.0) || hit.level == 0), "{shading:?}: {hit:?}");
        shader.add(&mut light, ray, hit.as_ref());
    }
    assert_eq!(light.coverage(), 1.0);
    (f64::from(light.mean().x) / 0.8 - 0.06) / 0.94
}

#[test]
fn on_a_flat_surface_all_shadings_agree() {
    let flat = roof(0.0);
    for degrees in [0.0, 30.0, 70.0] {
        for (shading, cone) in Shading::ALL.into_iter().flat_map(|shading| [(shading, 0.0), (shading, 1.0)]) {
            let cosine = seen(&flat, shading, degrees, cone);
            assert!((cosine - degrees.to_radians().cos()).abs() < 1e-3, "{shading:?} {degrees}: {cosine}");
        }
    }
}

#[test]
fn on_a_roof_each_shading_sees_what_it_says() {
    let slope = 1.0f64;
    let scene = roof(slope);
    for degrees in [0.0f64, 20.0, 35.0, 60.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        // What a side shows of itself for each unit of the ground that it covers; beyond 45 degrees the far one shows its back.
        let shown = [cos + slope * sin, cos - slope * sin];
        let cosine = shown.map(|a| a / slope.hypot(1.0));
        let by = |power: f64| {
            let weight = shown.map(|a| a.max(0.0).powf(power));
            (weight[0] * cosine[0] + weight[1] * cosine[1]) / (weight[0] + weight[1])
        };
        for (shading, expected) in [
            (Shading::Full, 0.5 * (cosine[0].abs() + cosine[1].abs())),
            (Shading::Level, cos),
            // Where nothing is hidden by others, what is seen.
            (Shading::Weighted, by(1.0)),
            // What is flat to the eye is taken to be hidden in part.
            (Shading::Facets, by(1.5)),
        ] {
            let found = seen(&scene, shading, degrees, 8.0);
            // Ridges and valleys are shaded round, two facets of sixteen.
            assert!((found - expected).abs() < 0.03, "{shading:?} {degrees}: {found} {expected}");
        }
    }
}

fn terrain() -> Scene {
    let options = Options { levels: Some(4), base: Some(32), roughness: Some(0.6), ..Options::new(procedural::Scene::Terrain) };
    format::build(&procedural::generate(&options).unwrap(), SceneInfo::default(), over_trees).unwrap()
}

#[test]
fn one_sample_is_the_frame_and_full_is_what_it_always_was() {
    let scene = terrain();
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View::default(), &space, 61, 43).unwrap();
    let method = (lod::METHOD.make)(&scene, &Knobs::default(), &NoStore).unwrap();
    let (frame, _) = render(&*method, &space, &camera, 1.0, &|| ());
    for shading in Shading::ALL {
        let shader = Shader::new(&scene, &space, shading);
        let image = shaded(&frame, &shader, &camera);
        assert!(image == sampled(&*method, &shader, &space, &camera, 1.0, &|| ()).image(), "{shading:?}");
        if shading == Shading::Full {
            for ((at, pixel), hit) in image.pixels().enumerate().zip(&frame.pixels) {
                let light = hit.as_ref().map(|hit| 0.8 * (0.06 + 0.94 * view_cosine(&scene, &camera, at, hit)));
                assert_eq!(pixel.0, light.map_or([0.012, 0.016, 0.024], |light| [light; 3]).map(format::to_srgb));
            }
        }
    }
}

/// At full resolution nothing was left out: shadings do not differ, whatever the method.
#[test]
fn at_full_resolution_all_shadings_agree() {
    let scene = terrain();
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View::default(), &space, 40, 30).unwrap().with_samples(2).unwrap();
    let picture = |method: &dyn Method, delta, shading| {
        sampled(method, &Shader::new(&scene, &space, shading), &space, &camera, delta, &|| ()).image()
    };
    for (registered, delta) in [(&lod::METHOD, f64::INFINITY), (&bvh::METHOD, 1.0), (&reference::METHOD, 1.0)] {
        let method = (registered.make)(&scene, &Knobs::default(), &NoStore).unwrap();
        let full = picture(&*method, delta, Shading::Full);
        assert!(Shading::ALL.into_iter().all(|shading| picture(&*method, delta, shading) == full), "{registered:?}");
    }
}

#[test]
fn samples_are_the_same_at_any_number_of_threads() {
    let scene = terrain();
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View::default(), &space, 33, 30).unwrap().with_samples(3).unwrap();
    let method = (lod::METHOD.make)(&scene, &Knobs::default(), &NoStore).unwrap();
    let shader = Shader::new(&scene, &space, Shading::Facets);
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            sampled(&*method, &shader, &space, &camera, 0.5, &|| ())
                .pixels
                .iter()
                .map(|light| light.mean().to_array().map(f32::to_bits))
                .collect::<Vec<_>>()
        })
    };
    assert!(with(1) == with(3));
}

/// The normal that pictures get is that of the triangle that was met: hits of one triangle lie in its plane.
#[test]
fn planes_hold_what_was_met() {
    let scene = terrain();
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View::default(), &space, 300, 300).unwrap();
    for (registered, delta) in [(&lod::METHOD, 0.25), (&lod::METHOD, 1.0), (&reference::METHOD, 1.0)] {
        let method = (registered.make)(&scene, &Knobs::default(), &NoStore).unwrap();
        let (frame, _) = render(&*method, &space, &camera, delta, &|| ());
        let point = |at: usize, distance: f64| {
            let ray = camera.ray(at as u32 % 300, at as u32 / 300);
            glam::DVec3::from_array(ray.origin) + glam::DVec3::from_array(ray.direction) * distance
        };
        let mut pairs = 0;
        for at in 1..frame.pixels.len() {
            let (Some(a), Some(b)) = (frame.pixels[at - 1], frame.pixels[at]) else { continue };
            // The same triangle, and the same morph of it: rays beside each other choose nearly alike.
            if (a.tree, a.level, a.node, a.plane) != (b.tree, b.level, b.node, b.plane) {
                continue;
            }
            let [a, b] = [point(at - 1, a.distance), point(at, b.distance)];
            let normal = frame.pixels[at].unwrap().plane_normal().unwrap().as_dvec3();
            assert!(normal.dot((b - a).normalize()).abs() < 1e-2, "{registered:?} {at}");
            pairs += 1;
        }
        assert!(pairs > 1000, "{registered:?}: {pairs}");
    }
}
