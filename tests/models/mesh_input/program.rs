//! `lodray build` from files and standard input.

use super::files::Files;
use super::{glb, obj, stl};
use serde_json::Value;

/// The figures that the program prints, or its error.
fn build(files: &Files, args: &str, input: &[u8]) -> Result<Value, String> {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("lodray");
    let output = command.current_dir(files.folder()).args(args.split_whitespace()).write_stdin(input).output().unwrap();
    if output.status.success() {
        return Ok(serde_json::from_slice(&output.stdout).unwrap());
    }
    Err(String::from_utf8(output.stderr).unwrap())
}

#[test]
fn standard_input_is_read_in_every_format() {
    let files = Files::new();
    let inputs = [
        ("obj", obj::TETRAHEDRON.as_bytes().to_vec()),
        ("stl", stl::ASCII.into()),
        ("stl", stl::binary("solid", &stl::TRIANGLES)),
        ("glb", glb::square().bytes()),
        ("gltf", glb::square().embedded().into()),
    ];
    for (format, bytes) in inputs {
        let made = build(&files, &format!("build - --format {format} -o a.lod --levels 1 --json"), &bytes).unwrap();
        assert_eq!(made["name"], "stdin");
        files.write("b.mesh", &bytes);
        let from_file = build(&files, &format!("build b.mesh --format {format} -o b.lod --levels 1 --json"), b"").unwrap();
        let [mut named, unnamed] = [from_file["origin"].clone(), made["origin"].clone()];
        // Which file it was is all that is to know of a file.
        let file = named.as_object_mut().unwrap().remove("file").unwrap();
        assert_eq!((&from_file["name"], &file["name"]), (&Value::from("b"), &Value::from("b.mesh")));
        assert_eq!(named, unnamed, "{format}");
    }
}

#[test]
fn a_material_library_of_standard_input_is_in_the_current_folder() {
    let files = Files::new();
    files.write("a.mtl", "newmtl red\nKd 1 0 0\n");
    let text = format!("mtllib a.mtl\nusemtl red\n{}", obj::TETRAHEDRON);
    build(&files, "build - --format obj -o a.lod --levels 1 --json", text.as_bytes()).unwrap();
    let scene = lodray::format::Scene::open(&files.folder().join("a.lod")).unwrap();
    std::fs::remove_file(files.folder().join("a.mtl")).unwrap();
    build(&files, "build - --format obj -o b.lod --levels 1 --json", text.as_bytes()).unwrap();
    let plain = lodray::format::Scene::open(&files.folder().join("b.lod")).unwrap();
    assert!(!scene.colours().is_empty() && plain.colours().is_empty());
    let error = build(&files, "build - -o b.lod", text.as_bytes()).unwrap_err();
    assert!(error.contains("--format <FORMAT>"), "{error}");
}
