//! Scene files: what is written comes back, and what is broken is refused.

use lodray::format::{Scene, export_level};
use lodray::mesh::{BoundKind, lattice, quantise};
use lodray_test_support::surfaces::{fan, grid, octahedron, scene};

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

#[test]
fn images_decode_to_the_hierarchy_that_they_were_made_from() {
    for levels in [0, 1, 2, 5] {
        for surface in [grid(levels, 3), octahedron(levels), fan(levels)] {
            let hierarchy = quantise(&surface, BoundKind::Largest).unwrap();
            let scene = scene(&surface);
            let back = scene.decode();
            assert_eq!((back.levels, back.base_vertices, back.placement), (levels, surface.base_vertices, hierarchy.placement));
            assert_eq!(back.triangles, surface.triangles);
            assert!(back.points == hierarchy.points && back.bounds == hierarchy.bounds);
            for tree in 0..scene.trees() {
                assert_eq!(scene.record(tree).material.get(), tree as u64 % 2);
                for i in 0..1usize << (2 * levels) {
                    let places = lattice::node(levels, levels, i as u32);
                    let expected = places.map(|p| hierarchy.tree(tree)[lattice::index(levels, p)]);
                    assert_eq!(scene.full_resolution_triangle(tree, i), expected);
                    let given = surface.normals[tree * lattice::len(levels) + lattice::index(levels, places[0])];
                    let length = given.iter().map(|c| c * c).sum::<f32>().sqrt();
                    let normal = scene.normal_at(tree, places[0]);
                    assert!((0..3).all(|k| (normal[k] - given[k] / length).abs() < 1e-4));
                }
            }
            let size = surface.positions.iter().flatten().fold(0f64, |a, b| a.max(b.abs()));
            for (point, position) in back.points.iter().zip(&surface.positions) {
                let world = back.to_world(*point);
                assert!((0..3).all(|k| (world[k] - position[k]).abs() < 1e-6 * size));
            }
        }
    }
}

#[test]
fn bytes_do_not_depend_on_the_number_of_threads() {
    let surface = grid(5, 4);
    let with = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| scene(&surface));
    assert!(with(1).bytes() == with(3).bytes());
}

/// What opening these bytes says.
fn open(bytes: &[u8]) -> Result<Scene, String> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("broken.lod");
    std::fs::write(&path, bytes).unwrap();
    Scene::open(&path).map_err(|e| {
        let message = e.to_string();
        assert!(message.contains("broken.lod"), "{message} does not name the file");
        message
    })
}

#[test]
fn every_flipped_bit_is_noticed() {
    let good = scene(&octahedron(2)).bytes().to_vec();
    assert!(open(&good).is_ok());
    for at in 0..good.len() {
        let mut bytes = good.clone();
        bytes[at] ^= 1 << (at % 8);
        assert!(open(&bytes).is_err(), "byte {at}");
    }
    for (kind, name) in ["META", "NODES", "RECORDS", "BOUNDS", "VERTICES", "NORMALS", "TRIANGLES", "COLOURS"].into_iter().enumerate() {
        let (offset, length) = lodray_test_support::surfaces::section(&good, kind + 1);
        let mut bytes = good.clone();
        bytes[offset + length / 2] ^= 0x10;
        let message = open(&bytes).unwrap_err();
        assert!(message.contains(name) && message.contains("checksum"), "{message}");
    }
}

#[test]
fn truncated_long_foreign_and_newer_files_are_refused() {
    let good = scene(&octahedron(1)).bytes().to_vec();
    for length in 0..good.len() {
        assert!(open(&good[..length]).is_err(), "{length} bytes");
    }
    assert!(open(&good[..good.len() - 1]).unwrap_err().contains("truncated"));
    assert!(open(&[&good[..], &[0]].concat()).unwrap_err().contains("too long"));
    assert!(open(b"").unwrap_err().contains("magic"));
    assert!(open(b"solid ascii\nfacet normal 0 0 1").unwrap_err().contains("magic"));
    let mut newer = good.clone();
    newer[8] = 2;
    lodray_test_support::surfaces::reseal(&mut newer);
    assert!(open(&newer).unwrap_err().contains("newer"));
    assert!(Scene::open(std::path::Path::new("/nonexistent/x.lod")).unwrap_err().to_string().contains("x.lod"));
    assert!(Scene::open(&std::env::temp_dir()).is_err());
}

/// Replaces text in META (of the same length) and opens the resealed file.
fn with_meta(good: &[u8], from: &str, to: &str) -> Result<Scene, String> {
    let (offset, length) = lodray_test_support::surfaces::section(good, 1);
    let at = good[offset..offset + length].windows(from.len()).position(|w| w == from.as_bytes()).expect("META holds the text");
    let mut bytes = good.to_vec();
    bytes[offset + at..][..to.len()].copy_from_slice(to.as_bytes());
    lodray_test_support::surfaces::reseal(&mut bytes);
    open(&bytes)
}

#[test]
fn resealed_nonsense_is_refused_with_section_and_field() {
    let good = scene(&octahedron(2)).bytes().to_vec();
    let word = |bytes: &mut [u8], at: usize, v: u64| bytes[at..at + 8].copy_from_slice(&v.to_le_bytes());
    let broken = |f: &dyn Fn(&mut [u8])| {
        let mut bytes = good.clone();
        f(&mut bytes);
        let sum_header_only = |bytes: &mut [u8]| {
            bytes[24..32].fill(0);
            let sum = xxhash_rust::xxh3::xxh3_64(&bytes[..320]);
            bytes[24..32].copy_from_slice(&sum.to_le_bytes());
        };
        sum_header_only(&mut bytes);
        open(&bytes).unwrap_err()
    };
    let (vertices, _) = lodray_test_support::surfaces::section(&good, 5);
    let entry = 64 + 32 * 4;
    for (message, parts) in [
        (broken(&|b| word(b, entry + 8, vertices as u64 + 4)), ["VERTICES", "misaligned"]),
        (broken(&|b| word(b, entry + 8, vertices as u64 - 64)), ["VERTICES", "offset"]),
        (broken(&|b| word(b, entry + 16, u64::MAX)), ["VERTICES", "past the end"]),
        (broken(&|b| word(b, entry, 9)), ["section table", "kind 9"]),
        (with_meta(&good, "\"levels\":2", "\"levels\":3").unwrap_err(), ["RECORDS", "BOUNDS"]),
        (with_meta(&good, "\"trees\":8", "\"trees\":7").unwrap_err(), ["RECORDS", "length"]),
        (with_meta(&good, "\"base_vertices\":6", "\"base_vertices\":5").unwrap_err(), ["TRIANGLES", "below 5"]),
        (with_meta(&good, "\"levels\":2", "\"levels\":x").unwrap_err(), ["META", "line"]),
        (with_meta(&good, "\"scale\":", "\"scale\":-").map(|_| ()).unwrap_err(), ["META", ""]),
    ] {
        assert!(parts.iter().any(|p| message.contains(p)), "{message}");
    }
    // A quad-BVH that leads in a circle or nowhere.
    let (nodes, _) = lodray_test_support::surfaces::section(&good, 2);
    for reference in [1u64 << 30, 1 << 30 | 999, 2 << 30 | 8, 2 << 30 | 3 << 28 | 6, 3 << 30] {
        let mut bytes = good.clone();
        bytes[nodes + 12..nodes + 16].copy_from_slice(&(reference as u32).to_le_bytes());
        lodray_test_support::surfaces::reseal(&mut bytes);
        assert!(open(&bytes).unwrap_err().contains("NODES"));
    }
}

#[test]
fn writing_where_nothing_can_be_written_is_an_error() {
    let scene = scene(&octahedron(1));
    for path in ["/nonexistent/a.lod", "/proc/a.lod"] {
        assert!(scene.save(std::path::Path::new(path)).unwrap_err().to_string().contains(path));
    }
}

#[test]
fn exported_levels_are_welded_by_topology() {
    for level in 0..=3u64 {
        let k = 1 << level;
        for (surface, vertices) in [(octahedron(3), 4 * k * k + 2), (fan(3), 5 + 7 * (k - 1) + 3 * (k - 1) * (k.max(2) - 2) / 2)] {
            let scene = scene(&surface);
            let mut obj = Vec::new();
            let counts = export_level(&scene, level as u32, &mut obj).unwrap();
            assert_eq!(counts.vertices, vertices);
            assert_eq!(counts.faces, scene.trees() as u64 * k * k);
            let options = tobj::LoadOptions::default();
            let (models, _) = tobj::load_obj_buf(&mut &obj[..], &options, |_| Err(tobj::LoadError::GenericFailure)).unwrap();
            assert_eq!(models[0].mesh.positions.len() as u64, 3 * vertices);
            assert_eq!(models[0].mesh.indices.len() as u64, 3 * counts.faces);
            // Faces stand in node order with their own corners.
            let node = k as usize * k as usize - 1;
            for (index, corner) in models[0].mesh.indices[3 * node..][..3].iter().zip(scene.triangle(0, level as u32, node)) {
                let world = scene.decode().to_world(corner);
                let found = &models[0].mesh.positions[3 * *index as usize..][..3];
                assert!((0..3).all(|c| (found[c] - world[c]).abs() < 1e-5));
            }
        }
    }
    assert!(export_level(&scene(&fan(1)), 2, Vec::new()).is_err());
}
