//! Scene files: what is written comes back, and what is broken is refused.

#[path = "common/surfaces.rs"]
mod common;

use common::{fan, grid, octahedron, scene};
use lodray::format::Scene;

#[test]
fn a_saved_scene_opens_with_the_same_bytes() {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("a.lod");
    for levels in [0, 1, 2, 5] {
        for surface in [grid(levels, 3), octahedron(levels), fan(levels)] {
            let built = scene(&surface);
            built.save(&path).unwrap();
            let opened = Scene::open(&path).unwrap();
            assert_eq!(opened.meta(), built.meta());
            assert!(opened.bytes() == built.bytes());
        }
    }
    assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1, "temporary files stay behind");
}
