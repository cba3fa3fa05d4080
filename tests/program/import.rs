//! glTF scenes as descriptions.

use lodray_test_support::program::Desk;
use npyz::WriterBuilder;
use std::fs;

/// A quad twice, once mirrored and as a child, beside a flat node, with a camera.
#[test]
fn a_gltf_scene_becomes_a_description() {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    let numbers = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 1.0, 0.0];
    fs::write(desk.path("points.bin"), numbers.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>()).unwrap();
    let mut gltf = serde_json::json!({
        "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2, 3]}],
        "nodes": [
            {"mesh": 0, "name": "first", "children": [1]}, {"mesh": 0, "scale": [-2, 1, 1], "translation": [5, 0, 0]},
            {"mesh": 0, "scale": [0, 1, 1]}, {"camera": 0, "name": "its \"eye\"", "translation": [1, 0.5, 8]},
        ],
        "meshes": [{"name": "quad", "primitives": [{"attributes": {"POSITION": 0}, "mode": 6}]}],
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.5, "znear": 0.1}}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 4}],
        "bufferViews": [{"buffer": 0, "byteLength": 48}], "buffers": [{"byteLength": 48, "uri": "points.bin"}],
    });
    fs::write(desk.path("a.gltf"), gltf.to_string()).unwrap();
    let (code, said) = desk.hear("import a.gltf --levels 1 -o out");
    assert!(
        code == 0 && said.contains("warning: a.gltf: 1 node such as 'node 2' are left out") && said.contains("1 mesh file, 2 places"),
        "{said}"
    );
    let text = fs::read_to_string(desk.path("out/scene.toml")).unwrap();
    assert!(
        text.contains("matrix = [[-2.0, 0.0, 0.0, 5.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0]]") && text.contains("its \"eye\""),
        "{text}"
    );
    let record: serde_json::Value = serde_json::from_slice(&fs::read(desk.path("out/run.json")).unwrap()).unwrap();
    assert_eq!(record["inputs"].as_array().unwrap().len(), 2);
    // Rays down on each, and one between them.
    let row = |x: f64| [x, 0.5, 3.0, 0.0, 0.0, -1.0];
    let rays = ndarray_file(&[row(0.5), row(4.0), row(2.0)]);
    fs::write(desk.path("rays.npy"), rays).unwrap();
    let met = desk.json("cast out/scene.toml rays.npy --follow false -o hits.npy");
    assert_eq!((&met["models"], &met["hits"]), (&2.into(), &2.into()));
    // Without a camera one looks at all; what is no scene of nodes is refused.
    gltf["nodes"][2] = serde_json::json!({});
    gltf["nodes"][3] = serde_json::json!({});
    fs::write(desk.path("a.gltf"), gltf.to_string()).unwrap();
    desk.run("import a.gltf --levels 1 -o out");
    assert!(fs::read_to_string(desk.path("out/scene.toml")).unwrap().contains("name = \"all\""));
    fs::write(desk.path("a.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    desk.refused("import a.obj -o other", 1, &["a.obj: only .gltf and .glb place meshes"]);
    gltf["nodes"][0]["children"] = serde_json::json!([0]);
    fs::write(desk.path("a.gltf"), gltf.to_string()).unwrap();
    desk.refused("import a.gltf -o other", 1, &["node 0: it has two parents, or is a child of itself"]);
    assert!(!desk.path("other").exists());
}

/// Rays as NumPy writes them.
fn ndarray_file(rows: &[[f64; 6]]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut writer = npyz::WriteOptions::<f64>::new().default_dtype().shape(&[rows.len() as u64, 6]).writer(&mut bytes).begin_nd().unwrap();
    writer.extend(rows.iter().flatten().copied()).unwrap();
    writer.finish().unwrap();
    bytes
}
