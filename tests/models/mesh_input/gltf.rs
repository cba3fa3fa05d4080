//! glTF and GLB.

use super::files::Files;
use super::glb::{F32, Glb, SQUARE, U8, U16, U32, UP, square};
use base64::Engine;
use lodray::mesh::TriangleMesh;
use serde_json::{Value, json};

#[test]
fn all_kinds_of_indices_give_the_same_mesh() {
    let expected = square().mesh();
    assert_eq!((expected.triangles.as_slice(), expected.positions.len()), (&[[0, 1, 2], [0, 2, 3]][..], 4));
    assert_eq!(expected.normals, [[[0.0, 0.0, 1.0]; 3]; 2]);
    for kind in [U8, U16, U32] {
        let mut glb = Glb::new();
        glb.vectors("POSITION", &SQUARE);
        glb.indices(kind, &[0, 1, 2, 0, 2, 3]);
        let mesh = glb.mesh();
        assert_eq!((mesh.positions, mesh.triangles), (expected.positions.clone(), expected.triangles.clone()));
        assert!(mesh.normals.is_empty());
    }
    let mut glb = Glb::new();
    glb.vectors("POSITION", &[0, 1, 2, 0, 2, 3].map(|i: usize| SQUARE[i]));
    let mesh = glb.mesh();
    assert_eq!((mesh.positions, mesh.triangles), (expected.positions, expected.triangles));
}

#[test]
fn strips_and_fans_are_cut_and_points_and_lines_left() {
    let mut glb = Glb::new();
    glb.vectors("POSITION", &SQUARE);
    let fan = glb.set("/meshes/0/primitives/0/mode", json!(6)).mesh();
    assert_eq!(fan.triangles, [[0, 1, 2], [0, 2, 3]]);
    glb.indices(U8, &[0, 1, 3, 2]);
    let strip = glb.set("/meshes/0/primitives/0/mode", json!(5)).mesh();
    assert_eq!(strip.triangles, [[0, 1, 3], [1, 2, 3]], "the second runs the same way around as the first");
    for mode in 0..4 {
        glb.refuses("/meshes/0/primitives/0/mode", json!(mode), &["scene", "no triangles"]);
        let mut mixed = fan_beside(&glb, mode);
        assert_eq!(mixed.mesh().triangles.len(), 2);
        mixed.json["meshes"][0]["primitives"].as_array_mut().unwrap().reverse();
        assert_eq!(mixed.mesh().triangles.len(), 2);
    }
    glb.refuses("/meshes/0/primitives/0/mode", json!(7), &["mesh 0, primitive 0", "mode is not known"]);
    glb.refuses("/meshes/0/primitives/0/mode", json!(4), &["mesh 0, primitive 0", "4 corners are not a whole number of triangles"]);
}

/// The primitive in this mode, and as a fan.
fn fan_beside(glb: &Glb, mode: u32) -> Glb {
    let mut mixed = glb.set("/meshes/0/primitives/0/mode", json!(mode));
    let mut fan = mixed.primitive().clone();
    fan["mode"] = json!(6);
    mixed.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(fan);
    mixed
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    std::array::from_fn(|k| a[k] - b[k])
}

/// Each corner's normal is the triangle's own.
fn normals_fit(mesh: &TriangleMesh) {
    for (triangle, normals) in mesh.triangles.iter().zip(&mesh.normals) {
        let [a, b, c] = triangle.map(|v| mesh.positions[v as usize]);
        let (u, v) = (sub(b, a), sub(c, a));
        let cross: [f64; 3] = std::array::from_fn(|k| u[(k + 1) % 3] * v[(k + 2) % 3] - u[(k + 2) % 3] * v[(k + 1) % 3]);
        let length = cross.iter().map(|v| v * v).sum::<f64>().sqrt();
        for n in normals {
            (0..3).for_each(|k| assert!((f64::from(n[k]) - cross[k] / length).abs() < 1e-6, "{n:?} is not {cross:?}"));
        }
    }
    assert_eq!(mesh.normals.len(), mesh.triangles.len());
}

#[test]
fn nodes_place_meshes_and_mirrors_turn_them_around() {
    // A slope, so that a scale by axis turns its normal.
    let slope = [[0.0, 0.0, 0.0], [2.0, 0.0, 1.0], [2.0, 2.0, 1.0], [0.0, 2.0, 0.0]];
    let glb = Glb::triangles(&slope, Some(&[[-0.5, 0.0, 1.0]; 4]), &[[0, 1, 2], [0, 2, 3]]);
    normals_fit(&glb.mesh());
    let place = |node: Value| glb.set("/nodes/0", node).mesh();
    let corner = |mesh: &TriangleMesh, p: [f64; 3]| {
        let near = |q: &[f64; 3]| (0..3).all(|k| (p[k] - q[k]).abs() < 1e-6);
        assert!(mesh.positions.iter().any(near), "no {p:?} in {:?}", mesh.positions);
        normals_fit(mesh);
    };
    corner(&place(json!({"mesh": 0, "translation": [1e6, 0, 0.5]})), [1e6 + 2.0, 2.0, 1.5]);
    corner(&place(json!({"mesh": 0, "scale": [3, 1, 0.1]})), [6.0, 2.0, 0.1]);
    corner(&place(json!({"mesh": 0, "scale": [-3, 1, 1]})), [-6.0, 2.0, 1.0]);
    corner(&place(json!({"mesh": 0, "scale": [-1, -2, -3]})), [-2.0, -4.0, -3.0]);
    // A quarter turn about z, not quite of length 1.
    corner(&place(json!({"mesh": 0, "rotation": [0, 0, 0.71, 0.71], "scale": [1, 2, 1]})), [-4.0, 2.0, 1.0]);
    // Column by column: x to y, y to x (a mirror), z to 4 z, and a step.
    corner(&place(json!({"mesh": 0, "matrix": [0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 4, 0, 10, 20, 30, 1]})), [12.0, 22.0, 34.0]);
    // Parents act after children; two mirrors are none.
    let family = glb.set(
        "/nodes",
        json!([{"children": [1, 2], "scale": [-1, 1, 1]}, {"mesh": 0, "translation": [5, 0, 0]}, {"mesh": 0, "scale": [-1, 1, 1]}]),
    );
    let mesh = family.mesh();
    assert_eq!((mesh.triangles.len(), mesh.positions.len()), (4, 8));
    corner(&mesh, [-7.0, 2.0, 1.0]);
    corner(&mesh, [2.0, 2.0, 1.0]);
    // A flat transform leaves nothing.
    glb.refuses("/nodes/0", json!({"mesh": 0, "scale": [0, 1, 0]}), &["no triangle is left of 2"]);
    // A skin stays in its rest pose; morph targets have their weights.
    let mut posed = glb.set("/nodes/0", json!({"mesh": 0, "skin": 0, "translation": [0, 1, 0], "weights": [1]}));
    posed.json["skins"] = json!([{"joints": [0]}]);
    posed.primitive()["targets"] = json!([{"POSITION": 0}]);
    corner(&posed.mesh(), [4.0, 5.0, 2.0]);
}

#[test]
fn the_default_scene_is_taken_or_the_first_or_all_nodes() {
    let mut glb = square();
    glb.json["nodes"] =
        json!([{"mesh": 0}, {"mesh": 0, "translation": [0, 0, 1]}, {"children": [0]}, {"mesh": 0, "translation": [0, 0, 2]}]);
    glb.json["scenes"] = json!([{"nodes": [2]}, {"nodes": [1, 3]}]);
    let heights = |glb: &Glb| {
        let mut z: Vec<f64> = glb.mesh().positions.iter().map(|p| p[2]).collect();
        z.sort_by(f64::total_cmp);
        z.dedup();
        z
    };
    assert_eq!(heights(&glb), [0.0]);
    assert_eq!(heights(&glb.set("/scene", json!(1))), [1.0, 2.0]);
    glb.json.as_object_mut().unwrap().remove("scene");
    assert_eq!(heights(&glb), [0.0]);
    glb.json.as_object_mut().unwrap().remove("scenes");
    assert_eq!(heights(&glb), [0.0, 1.0, 2.0]);
    glb.refuses("/nodes/0", json!({"mesh": 0, "children": [2]}), &["node 0", "child of itself"]);
    glb.refuses("/scene", json!(2), &["scene", "scene 2 is not there"]);
}

#[test]
fn base_colours_are_kept_per_triangle() {
    let mut glb = square();
    glb.json["materials"] = json!([{"pbrMetallicRoughness": {"baseColorFactor": [0.25, 0.5, 2, 0.5]}}, {"name": "plain"}]);
    let mut second = glb.primitive().clone();
    glb.primitive()["material"] = json!(0);
    second["material"] = json!(1);
    let mut third = second.clone();
    third.as_object_mut().unwrap().remove("material");
    // Of other corners, so that they are no repeats.
    for (primitive, corners) in [(&mut second, [0, 1, 3]), (&mut third, [1, 2, 3])] {
        primitive["indices"] = json!(glb.accessor(&corners, U8, "SCALAR", 3));
    }
    glb.json["meshes"][0]["primitives"].as_array_mut().unwrap().extend([second, third]);
    let mesh = glb.mesh();
    let colours: Vec<[f32; 3]> = mesh.materials.iter().map(|&m| mesh.colours[m as usize]).collect();
    assert_eq!(colours, [[0.25, 0.5, 1.0], [0.25, 0.5, 1.0], [1.0; 3], [1.0; 3]]);
    glb.refuses("/meshes/0/primitives/1/material", json!(2), &["mesh 0, primitive 1", "material 2 is not there"]);
    assert!(square().mesh().materials.is_empty());
}

#[test]
fn buffers_lie_within_the_file_or_beside_it() {
    let (files, glb) = (Files::new(), square());
    files.write("my buffer.bin", &glb.bin);
    std::fs::create_dir(files.folder().join("folder.bin")).unwrap();
    let expected = glb.mesh();
    let encoded = base64::prelude::BASE64_STANDARD.encode(&glb.bin);
    let uris = [
        "my%20buffer.bin".to_owned(),
        "my buffer.bin".to_owned(),
        "./my%20buffer.bin".to_owned(),
        format!("data:application/gltf-buffer;base64,{encoded}"),
        format!("data:;base64,{}", encoded.trim_end_matches('=')),
    ];
    for uri in uris {
        let mesh = files.read("a.gltf", glb.with_uri(&uri));
        assert_eq!(
            (&mesh.positions, &mesh.triangles, &mesh.normals),
            (&expected.positions, &expected.triangles, &expected.normals),
            "{uri}"
        );
    }
    // A GLB file in a .gltf, and the other way around.
    files.read("a.gltf", glb.bytes());
    files.refuses("a.glb", glb.embedded(), &["header", "not a GLB file"]);
    let bad = |uri: &str, parts: &[&str]| {
        files.refuses("a.gltf", glb.with_uri(uri), &[&["mesh 0, primitive 0, POSITION: accessor 0: buffer 0: "], parts].concat())
    };
    bad("none.bin", &["its file 'none.bin': No such file"]);
    bad("folder.bin", &["folder.bin': it is not an ordinary file"]);
    bad("", &["it is not an ordinary file"]);
    bad("https://example.org/a.bin", &["'https://example.org/a.bin' is neither data nor a file beside the model"]);
    bad("file:///etc/passwd", &["neither data nor a file"]);
    bad("data:;base64,####", &["not valid base64"]);
    bad("data:;base64", &["no comma"]);
    bad("data:;base64,AAAA", &["it has 3 bytes, ", " are promised"]);
    files.write("short.bin", &glb.bin[1..]);
    bad("short.bin", &["are promised"]);
    files.refuses("a.gltf", glb.json.to_string(), &["buffer 0: it has no data: neither a URI nor the binary chunk"]);
    // What the mesh does not need may be missing.
    let mut more = glb.clone();
    more.json["buffers"].as_array_mut().unwrap().push(json!({"byteLength": 8, "uri": "animation.bin"}));
    more.json["images"] = json!([{"uri": "missing.png"}]);
    files.read("a.glb", more.bytes());
}

#[test]
fn items_may_be_apart_quantised_or_sparse() {
    let expected = square().mesh();
    // Positions and normals side by side.
    let mut glb = Glb::new();
    let bytes: Vec<u8> = SQUARE.into_iter().zip(UP).flat_map(|(p, n)| p.into_iter().chain(n)).flat_map(f32::to_le_bytes).collect();
    let view = glb.view(&bytes);
    glb.json["bufferViews"][view]["byteStride"] = json!(24);
    glb.json["accessors"] = json!([
        {"bufferView": view, "componentType": F32, "type": "VEC3", "count": 4},
        {"bufferView": view, "byteOffset": 12, "componentType": F32, "type": "VEC3", "count": 4},
    ]);
    glb.primitive()["attributes"] = json!({"POSITION": 0, "NORMAL": 1, "_OWN": 7});
    glb.primitive()["mode"] = json!(6);
    let mesh = glb.mesh();
    assert_eq!((&mesh.positions, &mesh.triangles, &mesh.normals), (&expected.positions, &expected.triangles, &expected.normals));
    glb.refuses("/bufferViews/0/byteStride", json!(8), &["a stride of 8 bytes is too short for items of 12"]);
    glb.refuses("/accessors/1/byteOffset", json!(13), &["NORMAL: accessor 1: 4 items from byte 13 on are more than the 96 bytes"]);

    // 16-bit positions, 8-bit normals of -127 to 127, each padded to four bytes.
    let mut glb = Glb::new();
    glb.json["extensionsRequired"] = json!(["KHR_mesh_quantization", "KHR_materials_unlit"]);
    let bytes: Vec<u8> = SQUARE.iter().flat_map(|p| [p[0] as u16, p[1] as u16, p[2] as u16, 0]).flat_map(u16::to_le_bytes).collect();
    let positions = glb.accessor(&bytes, U16, "VEC3", 4);
    glb.json["bufferViews"][0]["byteStride"] = json!(8);
    let normals = glb.accessor(&[0, 0, 127, 0].repeat(4), 5120, "VEC3", 4);
    glb.json["bufferViews"][1]["byteStride"] = json!(4);
    glb.json["accessors"][1]["normalized"] = json!(true);
    glb.primitive()["attributes"] = json!({"POSITION": positions, "NORMAL": normals});
    glb.primitive()["mode"] = json!(6);
    // Texture coordinates of 8 bits, whose v leads down.
    let texture = glb.accessor(&[0, 255, 255, 255, 255, 0, 0, 0], U8, "VEC2", 4);
    glb.json["accessors"][texture]["normalized"] = json!(true);
    glb.primitive()["attributes"]["TEXCOORD_0"] = json!(texture);
    glb.refuses("/accessors/2/type", json!("VEC3"), &["TEXCOORD_0: accessor 2: it is not of type VEC2"]);
    glb.refuses("/accessors/2/count", json!(3), &["it has 4 positions and 3 texture coordinates"]);
    let mesh = glb.mesh();
    assert_eq!(mesh.texture[0], [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]]);
    assert_eq!((&mesh.positions, &mesh.triangles, &mesh.normals), (&expected.positions, &expected.triangles, &expected.normals));
    let small = glb.set("/accessors/0/normalized", json!(true)).mesh();
    assert_eq!(small.positions[2], [1.0 / 65535.0, 1.0 / 65535.0, 0.0]);

    // All zero but for three items; then over a base.
    let mut glb = Glb::new();
    let places = glb.view(&[1, 2, 3]);
    let values: Vec<u8> = SQUARE[1..].iter().flatten().flat_map(|v| v.to_le_bytes()).collect();
    let values = glb.view(&values);
    let sparse = json!({"count": 3, "indices": {"bufferView": places, "componentType": U8}, "values": {"bufferView": values}});
    glb.json["accessors"] = json!([{"componentType": F32, "type": "VEC3", "count": 4, "sparse": sparse}]);
    glb.primitive()["attributes"] = json!({"POSITION": 0});
    glb.primitive()["mode"] = json!(6);
    assert_eq!(glb.mesh().positions, expected.positions);
    glb.refuses("/accessors/0/count", json!(3), &["POSITION: accessor 0: sparse index 3 is out of range, there are 3 items"]);
    glb.refuses("/accessors/0/count", json!(1u64 << 50), &["it has no bytes for its 1125899906842624 items"]);
    // Few words that ask for much memory.
    glb.refuses("/accessors/0/count", json!(65537), &["POSITION: accessor 0: it has no bytes for its 65537 items"]);
    assert_eq!(glb.set("/accessors/0/count", json!(65536)).mesh().triangles.len(), expected.triangles.len());
    let mut other = glb.clone();
    other.json["accessors"].as_array_mut().unwrap().push(json!({"componentType": F32, "type": "VEC3", "count": 5, "sparse": sparse}));
    other.refuses("/meshes/0/primitives/0/attributes/NORMAL", json!(1), &["NORMAL: accessor 1: it has no bytes for its 5 items"]);
    other.json["meshes"][0]["weights"] = json!([1.0]);
    other.refuses(
        "/meshes/0/primitives/0/targets",
        json!([{"POSITION": 1}]),
        &["target 0, POSITION: accessor 1: it has no bytes for its 5 items"],
    );
    let indices = json!({"componentType": U32, "type": "SCALAR", "count": 65538, "sparse": sparse});
    other.json["accessors"][1] = indices;
    other.refuses("/meshes/0/primitives/0/indices", json!(1), &["indices: accessor 1: it has no bytes for its 65538 items"]);
    glb.refuses("/accessors/0/sparse/count", json!(0), &["it has no items"]);
    let base = glb.view(&[0; 48]);
    assert_eq!(glb.set("/accessors/0/bufferView", json!(base)).mesh().positions, expected.positions);
}

#[test]
fn bad_gltf_files_are_named_with_the_place() {
    let glb = square();
    let bad = |pointer: &str, value: Value, parts: &[&str]| glb.refuses(pointer, value, parts);
    let accessor = "mesh 0, primitive 0, POSITION: accessor 0: ";
    bad("/accessors/0/count", json!(5), &[accessor, "5 items from byte 0 on are more than the 48 bytes of buffer view 0"]);
    bad("/accessors/0/count", json!(0), &[accessor, "it has no items"]);
    bad("/accessors/0/count", json!(u64::MAX), &[accessor, "are more than"]);
    bad("/accessors/0/byteOffset", json!(u64::MAX), &[accessor, "are more than"]);
    bad("/accessors/0/bufferView", json!(9), &[accessor, "buffer view 9 is not there"]);
    bad("/accessors/0/bufferView", Value::Null, &[accessor, "it has no bytes"]);
    bad("/accessors/0/componentType", json!(5124), &[accessor, "component type is not known"]);
    bad("/accessors/0/type", json!("VEC2"), &[accessor, "not of type VEC3"]);
    bad("/bufferViews/0/byteLength", json!(u64::MAX), &[accessor, "the end of buffer view 0 is outside of its buffer"]);
    bad("/bufferViews/0/byteOffset", json!(u64::MAX), &[accessor, "outside of its buffer"]);
    bad("/bufferViews/0/buffer", json!(1), &[accessor, "buffer 1 is not there"]);
    bad("/bufferViews/0/byteStride", json!(u32::MAX), &[accessor, "are more than"]);
    bad("/buffers/0/byteLength", json!(10_000), &["buffer 0: it has 120 bytes, 10000 are promised"]);
    bad("/accessors/1/count", json!(3), &["mesh 0, primitive 0", "4 positions and 3 normals"]);
    bad("/accessors/2/componentType", json!(F32), &["mesh 0, primitive 0, indices: accessor 2", "without a sign"]);
    bad("/accessors/2/type", json!("VEC3"), &["mesh 0, primitive 0, indices: accessor 2", "SCALAR"]);
    bad("/accessors/2/normalized", json!(true), &["mesh 0, primitive 0, indices: accessor 2", "not normalized"]);
    bad("/accessors/2/count", json!(4), &["4 corners are not a whole number of triangles"]);
    bad("/meshes/0/primitives/0/indices", json!(3), &["indices: accessor 3: it is not there"]);
    bad("/meshes/0/primitives/0/attributes", json!({}), &["mesh 0, primitive 0: it has no attribute POSITION"]);
    bad("/meshes/0/primitives/0/attributes/POSITION", json!(1000), &["POSITION: accessor 1000: it is not there"]);
    bad("/nodes/0/mesh", json!(1), &["node 0: mesh 1 is not there"]);
    bad("/nodes/0/scale", json!([1, 1e39, 1]), &["JSON, line 1, column", "number out of range"]);
    bad("/nodes/0/rotation", json!([0, 0, 0, 0]), &["node 0: its rotation is not a unit quaternion"]);
    bad("/nodes/0/children", json!([0]), &["node 0: it has two parents, or is a child of itself"]);
    bad("/nodes", json!([{"mesh": 0, "children": [1]}, {"children": [2]}, {"children": [1]}]), &["node 1: it has two parents"]);
    bad("/nodes", json!([{"mesh": 0, "children": [4]}]), &["node 4: it is not there"]);
    bad("/scenes/0/nodes", json!([7]), &["node 7: it is not there"]);
    bad("/scenes/0/nodes", json!([]), &["scene: there are no triangles"]);
    bad("/asset/version", json!("1.0"), &["asset: version '1.0' is not known"]);
    bad("/nodes", json!({"a": {}}), &["JSON, line 1, column ", "expected a sequence"]);
    for name in ["KHR_draco_mesh_compression", "EXT_meshopt_compression"] {
        bad("/extensionsRequired", json!([name]), &["extensionsRequired: the file needs", name, "compress"]);
    }
    bad("/extensionsRequired", json!(["EXT_mesh_gpu_instancing"]), &["needs EXT_mesh_gpu_instancing, which is not read"]);
    // A deep family, a chain of scales beyond the range of numbers, and positions beyond what can be computed with.
    let nodes: Vec<Value> = (0..5000).map(|i| if i < 4999 { json!({"children": [i + 1]}) } else { json!({"mesh": 0}) }).collect();
    assert_eq!(glb.set("/nodes", json!(nodes)).mesh().triangles.len(), 2);
    let nodes: Vec<Value> = (0..50).map(|i| json!({"children": [i + 1], "scale": [1e30, 1, 1]})).collect();
    bad("/nodes", json!(nodes), &["its transform is not finite"]);
    bad(
        "/nodes",
        json!([{"children": [1], "scale": [1e30, 1, 1]}, {"children": [2], "scale": [1e30, 1, 1]}, {"mesh": 0, "scale": [1e30, 1, 1]}]),
        &["mesh 0, primitive 0: vertex 1, where node 2 places it"],
    );
    let mut nan = SQUARE;
    nan[2][1] = f32::NAN;
    Files::new().refuses("a.glb", Glb::triangles(&nan, None, &[[0, 1, 2]]).bytes(), &["vertex 2", "NaN"]);
    Files::new().refuses(
        "a.glb",
        Glb::triangles(&SQUARE, None, &[[0, 1, 4]]).bytes(),
        &["indices: accessor 1: item 2: vertex index 4 is out of range, there are 4 vertices"],
    );
    let mut normals = UP;
    normals[1] = [f32::NAN, 0.0, 1.0];
    assert_eq!(Glb::triangles(&SQUARE, Some(&normals), &[[0, 1, 2]]).mesh().normals, [[[0.0, 0.0, 1.0], [0.0; 3], [0.0, 0.0, 1.0]]]);
}

#[test]
fn bad_heads_of_glb_files_are_named() {
    let (files, bytes) = (Files::new(), square().bytes());
    let with = |at: usize, value: u32| {
        let mut changed = bytes.clone();
        changed[at..at + 4].copy_from_slice(&value.to_le_bytes());
        changed
    };
    files.refuses("a.glb", "ply\nformat ascii 1.0\n", &["header", "not a GLB file"]);
    files.refuses("a.glb", with(4, 1), &["header", "version 1 is not known"]);
    files.refuses("a.glb", with(8, 3), &["header", "too small"]);
    files.refuses("a.glb", with(8, u32::MAX), &["header", "4294967283 bytes follow according to it"]);
    files.refuses("a.glb", with(12, u32::MAX), &["header", "the JSON chunk has 4294967295 bytes"]);
    files.refuses("a.glb", with(16, 7), &["header", "neither JSON nor binary"]);
    files.refuses("a.glb", &bytes[..7], &["header", "ends here"]);
    files.refuses("a.gltf", "{\n  \"asset\": ", &["JSON, line 2, column"]);
    files.refuses("a.gltf", "{\"asset\": {}}", &["JSON, line 1", "missing field `version`"]);
    // Any cut gives an error and no panic.
    (1..bytes.len()).for_each(|n| files.refuses("cut.glb", &bytes[..n], &[]));
    let text = square().embedded();
    (1..text.len()).for_each(|n| files.refuses("cut.gltf", &text[..n], &[]));
}
