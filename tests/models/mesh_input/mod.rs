//! Mesh files in: every form that is read, every fault that is named, every count of cleaning.

mod clean;
mod damaged;
mod files;
mod glb;
mod gltf;
mod lost;
mod obj;
mod ply;
mod program;
mod same;
mod stl;

use files::Files;
use lodray::mesh::{MeshFormat, read, read_as, read_bytes};
use std::path::Path;

#[test]
fn files_that_are_no_mesh_files_are_named() {
    let files = Files::new();
    files.refuses("mesh.dae", obj::TETRAHEDRON, &["must end in .obj, .ply, .gltf, .glb or .stl"]);
    files.refuses("mesh", obj::TETRAHEDRON, &["must end in .obj, .ply, .gltf, .glb or .stl"]);
    files.read("mesh.OBJ", obj::TETRAHEDRON);
    for path in [files.folder().join("none.obj"), files.folder().join("none.ply")] {
        let message = read(&path).unwrap_err().to_string();
        assert!(message.starts_with(path.to_str().unwrap()), "{message}");
    }
    let directory = files.folder().join("directory.ply");
    std::fs::create_dir(&directory).unwrap();
    let message = read(&directory).unwrap_err().to_string();
    assert!(message.starts_with(directory.to_str().unwrap()), "{message}");
    let nameless = read(files.folder()).unwrap_err().to_string();
    assert!(nameless.contains("is a directory"), "{nameless}");
}

#[test]
fn a_format_overrides_the_ending() {
    let files = Files::new();
    let path = files.write("mesh.stl", obj::TETRAHEDRON);
    assert_eq!(read_as(&path, MeshFormat::Obj).unwrap().triangles.len(), 4);
    let message = read_as(&path, MeshFormat::Ply).unwrap_err().to_string();
    assert!(message.contains("mesh.stl: header, line 1"), "{message}");
}

#[test]
fn bytes_are_read_under_a_name_and_beside_a_folder() {
    let files = Files::new();
    files.write("a.mtl", "newmtl red\nKd 1 0 0\n");
    let text = format!("mtllib a.mtl\nusemtl red\n{}", obj::TETRAHEDRON);
    let mesh = read_bytes(text.as_bytes(), MeshFormat::Obj, Path::new("stdin"), files.folder()).unwrap();
    assert_eq!(mesh.colours[mesh.materials[0] as usize], [1.0, 0.0, 0.0]);
    let error = read_bytes(b"v 0 0\n", MeshFormat::Obj, Path::new("stdin"), files.folder()).unwrap_err();
    assert_eq!(error.to_string(), "stdin: line 1: v needs 3 coordinates, found 2 numbers");
    assert_eq!(
        read_bytes(b"", MeshFormat::Glb, Path::new("stdin"), files.folder()).unwrap_err().to_string(),
        "stdin: line 1: the file is empty"
    );
}
