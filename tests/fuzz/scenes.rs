//! Scene files, damaged with checksums that are right again, so that what they hold is looked at; what is opened is audited and cast at, by the blocks and by
//! the golden traverser.

use super::damage::{Damaged, File};
use super::round::{Limit, folder, round};
use lodray::format::Scene;
use lodray::format::audit::audit;
use lodray::num::VertexForm;
use lodray::rays::{ModelSpace, Query, RayFile};
use lodray_test_support::models::build_with;
use lodray_test_support::surfaces::{fan, octahedron, reseal, section};
use std::fs;

/// Bytes of header and section table.
const HEADER: usize = 64 + 32 * 9;

fn corpus() -> Vec<File> {
    let mut files = Vec::new();
    for form in VertexForm::ALL {
        for (name, surface) in [("octahedron 0", octahedron(0)), ("octahedron 2", octahedron(2)), ("fan", fan(1))] {
            files.push(File::new(&format!("{name} {form:?}"), build_with(&surface, form).bytes()));
        }
    }
    files
}

/// The same with checksums that are right, if its sections lie in the file.
fn sealed(bytes: &[u8]) -> Damaged {
    let mut bytes = bytes.to_vec();
    let inside = |(offset, length): (usize, usize)| offset.checked_add(length).is_some_and(|end| end <= bytes.len());
    if bytes.len() >= HEADER && (1..=9).all(|kind| inside(section(&bytes, kind))) {
        reseal(&mut bytes);
    }
    Damaged(bytes)
}

/// Rays at all sides of a model.
fn rays(space: &ModelSpace) -> RayFile {
    let (centre, radius) = (space.centre(), space.radius().max(f64::MIN_POSITIVE));
    let query = |k: u32| {
        let toward: [f64; 3] = std::array::from_fn(|axis| if k >> axis & 1 == 1 { 0.7 } else { -0.9 } + f64::from(k) * 0.01);
        let origin = std::array::from_fn(|axis| centre[axis] + 3.0 * radius * toward[axis]);
        Query::new(origin, toward.map(|c| -c)).with_cone(0.0, f64::from(k % 3) * 0.01)
    };
    RayFile::new((0..8).map(query).collect())
}

#[test]
fn scenes() {
    let path = folder().join("scene.lod");
    round("scenes", corpus, Limit { bytes: 4 << 20, each: 300 }, |bytes| {
        fs::write(&path, &sealed(bytes).0).unwrap();
        let scene = match Scene::open(&path) {
            Ok(scene) => scene,
            Err(error) => {
                let message = error.to_string();
                assert!(message.starts_with(&path.display().to_string()) && message.len() < 1000, "{message:?}");
                return false;
            }
        };
        assert!(!audit(&scene).checks.is_empty());
        let rays = rays(&ModelSpace::of(&scene));
        for method in ["lod", "bvh"] {
            assert_eq!(scene.method(method).unwrap().cast(&rays).len(), rays.queries().len());
        }
        assert_eq!(scene.golden().cast(&rays, 1.0).len(), rays.queries().len());
        true
    });
}
