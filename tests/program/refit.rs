//! `refit` as typed.

use lodray_test_support::program::{Desk, FAILS, USAGE};
use npyz::WriterBuilder;
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
    desk.refused("refit a.lod bad.obj -o b.lod", FAILS, &["bad.obj", "line 2", "three numbers"]);
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
