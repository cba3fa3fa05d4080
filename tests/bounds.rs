//! The displacement bounds that scenes store equal those of the plain definition, code by code.

use lodray::golden::naive_bounds;
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{Surface, quantise};
use lodray_test_support::surfaces::{bumps, fan, grid, octahedron, surface};

fn check(surface: &Surface, name: &str) -> usize {
    let built = quantise(surface).expect("a valid surface");
    let mut plain = built.clone();
    naive_bounds(&mut plain);
    assert_eq!(built.bounds.scale, plain.bounds.scale, "{name}");
    let differing = built.bounds.codes.iter().zip(&plain.bounds.codes).position(|(a, b)| a != b);
    assert_eq!(differing, None, "{name}: first differing edge");
    assert_eq!(built.bounds.codes.len(), plain.bounds.codes.len(), "{name}");
    built.bounds.codes.iter().filter(|&&c| c > 0).count()
}

#[test]
fn stored_bounds_are_those_of_the_definition() {
    let mut edges = 0;
    for levels in 0..=5 {
        edges += check(&grid(levels, 3), "grid") + check(&octahedron(levels), "octahedron") + check(&fan(levels), "fan");
        // Two trees back to back on the same three vertices, and a third one turned.
        let v = [[0.0, 0.0, 0.0], [1.0, 0.2, 0.1], [0.3, 1.0, -0.2]];
        edges += check(&surface(levels, &v, &[[0, 1, 2], [2, 1, 0], [1, 2, 0]], bumps), "back to back");
    }
    for scene in [procedural::Scene::Terrain, procedural::Scene::Cloth, procedural::Scene::Spikes, procedural::Scene::Room] {
        let options = Options { levels: Some(4), base: Some(40), ..Options::new(scene) };
        edges += check(&procedural::generate(&options).expect("options"), "procedural");
    }
    println!("{edges} edges with a bound");
    assert!(edges > 50_000);
}
