//! `refit` as typed.

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use lodray_test_support::program::{Desk, FAILS, USAGE};
use npyz::WriterBuilder;
use serde_json::json;
use std::fs;

fn desk() -> Desk {
    Desk::new(assert_cmd::cargo::cargo_bin!("lodray"))
}

/// The `v` lines of an OBJ.
fn vertices(text: &str) -> Vec<f64> {
    let lines = text.lines().filter_map(|line| line.strip_prefix("v "));
    lines.flat_map(|line| line.split(' ').map(|c| c.parse().unwrap()).collect::<Vec<f64>>()).collect()
}

fn write_array(desk: &Desk, name: &str, shape: &[u64], values: &[f64]) {
    let file = fs::File::create(desk.path(name)).unwrap();
    let mut writer = npyz::WriteOptions::new().default_dtype().shape(shape).writer(file).begin_nd().unwrap();
    writer.extend(values.iter()).unwrap();
    writer.finish().unwrap();
}

#[test]
fn a_scene_that_moved_says_nothing_of_distances_to_its_mesh() {
    let desk = desk();
    desk.run("generate spikes --levels 1 --base 32 -o a.lod --quiet");
    desk.run("export a.lod -o a.obj --quiet");
    assert!(desk.run("build a.obj -o b.lod --levels 1").contains("\naccuracy "));
    let moved = desk.run("refit b.lod --motion wave --time 0.25 -o moved.lod");
    assert!(moved.contains(" of a.obj; vertices were moved since (refit)") && !moved.contains("accuracy"), "{moved}");
    let all = desk.json("info moved.lod");
    assert!(all.get("distance").is_none_or(serde_json::Value::is_null), "{all}");
    assert_eq!(all["origin"]["file_at_rest"]["name"], "a.obj");
    // The mesh is another surface now.
    desk.run("simulate b.lod --method input-bvh --size 8x8");
    desk.refused("simulate moved.lod --method input-bvh --size 8x8", FAILS, &["its vertices were moved (refit), and a.obj"]);
    desk.refused("simulate b.lod --method input-bvh --size 8x8 --mesh c.obj", FAILS, &["--mesh c.obj: there is no such file"]);
    let (code, said) = desk.hear("simulate b.lod --size 8x8 --mesh a.obj");
    assert!(code == 0 && said.contains("note: --mesh is not used"), "{said}");
}

#[test]
fn arrays_meshes_and_sequences_move_a_scene() {
    let desk = desk();
    desk.run("generate sphere --levels 3 --base 32 -o a.lod --quiet");
    desk.run("export a.lod -o a.obj --quiet");
    let mut at = vertices(&desk.text("a.obj"));
    at.chunks_exact_mut(3).for_each(|p| p[1] *= 1.0 + 0.5 * p[0]);
    let count = at.len() as u64 / 3;
    write_array(&desk, "one.npy", &[count, 3], &at);
    let said = desk.run("refit a.lod one.npy -o one.lod");
    assert!(said.starts_with("one.lod:\n"), "{said}");
    desk.run("verify one.lod --quiet");

    // As a mesh: the same.
    let text: String = at.chunks_exact(3).map(|p| format!("v {} {} {}\n", p[0], p[1], p[2])).collect();
    desk.write("two.obj", &text);
    desk.run("refit a.lod two.obj -o two.lod --quiet");
    assert!(desk.bytes("one.lod") == desk.bytes("two.lod"));

    // Frames of an array, each what it is alone.
    let rest = vertices(&desk.text("a.obj"));
    let both: Vec<f64> = rest.iter().chain(&at).copied().collect();
    write_array(&desk, "both.npy", &[2, count, 3], &both);
    assert_eq!(desk.run("refit a.lod both.npy -o frame.lod").trim(), "2 frames: frame-00000.lod to frame-00001.lod");
    assert!(desk.bytes("frame-00001.lod") == desk.bytes("one.lod") && desk.bytes("frame-00000.lod") != desk.bytes("one.lod"));

    // Motions: frames are times; one thread or many.
    for motion in ["wave", "twist", "breathe"] {
        let told = desk.json(&format!("refit a.lod --motion {motion} --frames 4 -o {motion}.lod"));
        assert_eq!((told["frames"].as_u64(), told["files"].as_array().map(Vec::len)), (Some(4), Some(4)));
        desk.run_on(1, &format!("refit a.lod --motion {motion} --time 0.25 -o quarter.lod --quiet"));
        assert!(desk.bytes("quarter.lod") == desk.bytes(&format!("{motion}-00001.lod")), "{motion}");
        desk.run("verify quarter.lod --quiet");
    }
}

/// The triangles of an OBJ as a glTF file: an animation that takes them 4 along x in 2 seconds, and one that makes them twice as large.
fn moving(obj: &str) -> serde_json::Value {
    let at = vertices(obj);
    let corners: Vec<u32> = obj
        .lines()
        .filter_map(|line| line.strip_prefix("f "))
        .flat_map(|line| line.split_whitespace().map(|corner| corner.split('/').next().unwrap().parse::<u32>().unwrap() - 1))
        .collect();
    let floats = |values: &[f64]| values.iter().flat_map(|&v| (v as f32).to_le_bytes()).collect::<Vec<u8>>();
    let indices: Vec<u8> = corners.iter().flat_map(|v| v.to_le_bytes()).collect();
    let parts = [floats(&at), indices, floats(&[0.0, 2.0]), floats(&[0.0, 0.0, 0.0, 4.0, 0.0, 0.0]), floats(&[0.0, 1.0])];
    let kinds =
        [("VEC3", 5126, at.len() / 3), ("SCALAR", 5125, corners.len()), ("SCALAR", 5126, 2), ("VEC3", 5126, 2), ("SCALAR", 5126, 2)];
    let begins: Vec<usize> = (0..parts.len()).map(|k| parts[..k].iter().map(Vec::len).sum()).collect();
    let bytes = parts.concat();
    let views: Vec<_> =
        parts.iter().zip(&begins).map(|(part, begin)| json!({ "buffer": 0, "byteOffset": begin, "byteLength": part.len() })).collect();
    let accessors: Vec<_> = kinds
        .iter()
        .enumerate()
        .map(|(k, (kind, component, count))| json!({ "bufferView": k, "type": kind, "componentType": component, "count": count }))
        .collect();
    let clip = |name: &str, input: usize, output: usize, path: &str| {
        json!({
            "name": name, "samplers": [{ "input": input, "output": output }],
            "channels": [{ "sampler": 0, "target": { "node": 0, "path": path } }],
        })
    };
    json!({
        "asset": { "version": "2.0" },
        "buffers": [{ "byteLength": bytes.len(), "uri": format!("data:;base64,{}", STANDARD.encode(&bytes)) }],
        "bufferViews": views, "accessors": accessors,
        "meshes": [{ "primitives": [{ "attributes": { "POSITION": 0 }, "indices": 1, "targets": [{ "POSITION": 0 }] }] }],
        "nodes": [{ "mesh": 0 }], "scenes": [{ "nodes": [0] }], "scene": 0,
        "animations": [clip("slide", 2, 3, "translation"), clip("grow", 2, 4, "weights")],
    })
}

#[test]
fn an_animation_moves_the_scene_that_was_built_from_its_mesh() {
    let desk = desk();
    desk.run("generate sphere --levels 3 --base 32 -o a.lod --quiet");
    desk.run("export a.lod -o a.obj --quiet");
    let file = moving(&desk.text("a.obj"));
    desk.write("m.gltf", &file.to_string());
    let rest = vertices(&desk.text("a.obj"));
    let moved = |options: &str| {
        desk.run(&format!("refit a.lod m.gltf {options} -o b.lod --quiet"));
        desk.run("verify b.lod --quiet");
        desk.run("export b.lod -o b.obj --quiet");
        vertices(&desk.text("b.obj"))
    };
    for (options, shift, scale) in [
        ("", 0.0, 1.0),
        ("--time 1", 2.0, 1.0),
        ("--clip slide --time 9", 4.0, 1.0),
        ("--clip grow --time 2", 0.0, 2.0),
        ("--clip 1 --time 0.5", 0.0, 1.25),
    ] {
        let far = moved(options)
            .iter()
            .zip(&rest)
            .enumerate()
            .map(|(k, (now, rest))| (now - rest * scale - if k % 3 == 0 { shift } else { 0.0 }).abs())
            .fold(0.0, f64::max);
        assert!(far < 2e-4, "{options}: {far}");
    }
    // Frames are parts of its duration.
    desk.run("refit a.lod m.gltf --frames 4 -o f.lod --quiet");
    desk.run_on(1, "refit a.lod m.gltf --time 1 -o one.lod --quiet");
    assert!(desk.bytes("f-00002.lod") == desk.bytes("one.lod"));

    // A scene that was built from the file moves too, though its vertices are others.
    desk.run("build m.gltf --levels 3 -o own.lod --quiet");
    desk.run("refit own.lod m.gltf --clip grow --time 2 -o grown.lod --quiet");
    desk.run("verify grown.lod --quiet");
    let [own, grown] = ["own", "grown"].map(|name| {
        desk.run(&format!("export {name}.lod -o {name}.obj --quiet"));
        vertices(&desk.text(&format!("{name}.obj")))
    });
    assert!(own.iter().zip(&grown).all(|(own, grown)| (grown - 2.0 * own).abs() < 0.01));

    desk.refused("refit a.lod m.gltf --clip none -o c.lod", FAILS, &["m.gltf", "--clip none", "there are slide, grow"]);
    desk.refused("refit a.lod a.obj --clip slide -o c.lod", FAILS, &["--clip", "glTF"]);
    desk.refused("refit a.lod a.obj --time 1 -o c.lod", FAILS, &["--time", "--motion"]);
    desk.refused("refit a.lod m.gltf --motion wave -o c.lod", USAGE, &["--motion"]);
    let without = |key: &str| {
        let mut file = file.clone();
        file.as_object_mut().unwrap().remove(key);
        file.to_string()
    };
    desk.write("still.gltf", &without("animations"));
    desk.refused("refit a.lod still.gltf -o c.lod", FAILS, &["still.gltf", "animations: it has none"]);
    let mut elsewhere = file.clone();
    elsewhere["nodes"][0]["translation"] = json!([100, 0, 0]);
    desk.write("elsewhere.gltf", &elsewhere.to_string());
    desk.refused("refit a.lod elsewhere.gltf -o c.lod", FAILS, &["elsewhere.gltf", "away from the mesh at rest"]);
    assert!(!desk.path("c.lod").exists());
}

#[test]
fn what_cannot_be_is_refused_and_nothing_is_written() {
    let desk = desk();
    desk.run("generate sphere --levels 2 --base 8 -o a.lod --quiet");
    write_array(&desk, "few.npy", &[2, 3], &[0.0; 6]);
    write_array(&desk, "flat.npy", &[6], &[0.0; 6]);
    let count = desk.run("export a.lod -o a.obj --json");
    let count = serde_json::from_str::<serde_json::Value>(&count).unwrap()["vertices"].as_u64().unwrap();
    let mut values = vec![0.5; 3 * count as usize];
    values[7] = f64::NAN;
    write_array(&desk, "nan.npy", &[count, 3], &values);
    desk.write("bad.obj", "v 0 0 0\nv 1 x 0\n");
    desk.write("text.npy", "v 0 0 0\n");
    let vertices = format!("{count} vertices");
    desk.refused("refit a.lod few.npy -o b.lod", FAILS, &["few.npy", "2 positions", &vertices]);
    desk.refused("refit a.lod flat.npy -o b.lod", FAILS, &["flat.npy", "shape [6]", "vertices x 3"]);
    desk.refused("refit a.lod nan.npy -o b.lod", FAILS, &["nan.npy", "position 2 is"]);
    desk.refused("refit a.lod bad.obj -o b.lod", FAILS, &["bad.obj", "line 2", "x is not a number"]);
    desk.refused("refit a.lod text.npy -o b.lod", FAILS, &["text.npy", "no array"]);
    desk.refused("refit a.lod none.npy -o b.lod", FAILS, &["none.npy"]);
    desk.refused("refit a.lod a.stl -o b.lod", FAILS, &["a.stl", ".npy, .obj or .ply"]);
    desk.refused("refit a.lod few.npy -o a.lod", FAILS, &["it is the input file"]);
    desk.refused("refit a.lod -o b.lod", USAGE, &["POSITIONS"]);
    desk.refused("refit a.lod few.npy --motion wave -o b.lod", USAGE, &["--motion"]);
    desk.refused("refit a.lod few.npy --frames 3 -o b.lod", FAILS, &["--frames", "--motion"]);
    desk.refused("refit a.lod --motion wave --frames 0 -o b.lod", USAGE, &["--frames"]);
    assert!(!desk.path("b.lod").exists() && !desk.path("b-00000.lod").exists());
}
