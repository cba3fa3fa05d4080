//! What a program outside does with a scene: build one, cast rays, keep methods longer than what they were made from.

use lodray::format::Scene;
use lodray::mesh::RemeshOptions;
use lodray::method::{METHODS, Over};
use lodray::rays::{Query, RayFile};
use lodray::scene::{BuildOptions, moved_percent};
use lodray_test_support::models::octahedron;

/// A cube of side 2 around the origin, 12 triangles outward.
fn cube() -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let corner = |k: u32| std::array::from_fn(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 });
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    ((0..8).map(corner).collect(), sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect())
}

fn straight(count: u32) -> RayFile {
    let at = |k: u32| -0.9 + 1.8 * f64::from(k) / f64::from(count - 1);
    RayFile::new((0..count * count).map(|k| Query::new([at(k % count), at(k / count), 5.0], [0.0, 0.0, -1.0])).collect())
}

#[test]
fn every_method_finds_the_front_of_a_cube_by_the_cubes_own_triangles() {
    let (vertices, faces) = cube();
    let scene = Scene::build(&vertices, &faces, &BuildOptions::own_triangles()).unwrap();
    assert_eq!((scene.trees(), scene.levels()), (12, 0));
    let rays = straight(31);
    for method in METHODS.iter().filter(|method| !method.of_input()) {
        for hit in scene.method(method.name).unwrap().cast(&rays) {
            assert!((hit.t - 4.0).abs() < 1e-8 && hit.front == 1, "{}: {hit:?}", method.name);
            // The side at z = 1 is the second. Clusters name triangles of their own.
            let is_named = method.over == Over::Scene;
            assert!(!is_named || [2, 3].contains(&scene.source(hit.tree.cast_unsigned() as usize)), "{}: {hit:?}", method.name);
        }
    }
}

#[test]
fn a_mesh_is_remeshed_within_the_error_that_was_asked_for() {
    let (positions, triangles) = octahedron();
    let vertices: Vec<_> = positions.iter().map(|p| p.map(|c| c as f64)).collect();
    let remesh = RemeshOptions { levels: Some(3), max_error: 0.1, ..RemeshOptions::default() };
    let options = BuildOptions { name: "ball".to_owned(), remesh: Some(remesh), ..BuildOptions::default() };
    let scene = Scene::build(&vertices, &triangles, &options).unwrap();
    assert_eq!((scene.meta().name.as_str(), scene.levels(), scene.trees()), ("ball", 3, 8));
    assert!(moved_percent(&scene) < 0.1 && scene.meta().origin["remesh"]["warning"].is_null());
    let wrong = Scene::build(&vertices, &triangles, &BuildOptions { direction_zeros: 20, ..options.clone() }).unwrap_err().to_string();
    assert_eq!(wrong, "scene: direction_zeros: 20 is more than 14");
    let wrong = Scene::build(&vertices, &[[0, 1, 6]], &options).unwrap_err().to_string();
    assert_eq!(wrong, "triangle 0: vertex index 6 is out of range (there are 6 vertices)");
}

#[test]
fn methods_outlive_their_scene_and_go_to_other_threads() {
    let (vertices, faces) = cube();
    let methods: Vec<_> = {
        let scene = Scene::build(&vertices, &faces, &BuildOptions::own_triangles()).unwrap();
        METHODS.iter().filter(|method| !method.of_input()).map(|method| scene.method(method.name).unwrap()).collect()
    };
    let threads: Vec<_> = methods.into_iter().map(|method| std::thread::spawn(move || method.cast(&straight(9)).len())).collect();
    assert!(threads.into_iter().all(|thread| thread.join().unwrap() == 81));
}

#[test]
fn what_there_is_not_is_named_with_what_there_is() {
    let (vertices, faces) = cube();
    let scene = Scene::build(&vertices, &faces, &BuildOptions::own_triangles()).unwrap();
    let why = |method: &str, knobs: &[(&str, &str)]| scene.method_with(method, knobs).err().unwrap().to_string();
    assert!(why("nanite", &[]).starts_with("there is no method 'nanite', but: lod, bvh, "));
    assert_eq!(why("bvh32", &[("delta", "1")]), "bvh32 has no knob 'delta', but: node-order, leaf-layout, leaf-size, packet");
    assert!(why("lod", &[("delta", "-1")]).starts_with("delta: '-1' is not a quality"));
    assert_eq!(why("input-bvh", &[]), "the mesh that the scene was made from is not at hand");
}
