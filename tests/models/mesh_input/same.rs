//! One model in every format: the same triangles at the same places.

use super::files::Files;
use super::glb::Glb;
use super::stl;
use lodray::mesh::TriangleMesh;
use std::fmt::Write;

type Triples<T> = Vec<[T; 3]>;

/// A bumpy torus, closed: vertices, normals (not of length 1) and triangles.
fn torus(n: u32) -> (Triples<f32>, Triples<f32>, Triples<u32>) {
    let (mut positions, mut normals, mut triangles) = (Vec::new(), Vec::new(), Vec::new());
    for (i, j) in (0..n).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let [a, b] = [i, j].map(|k| k as f64 / n as f64 * std::f64::consts::TAU);
        let r = 0.4 + 0.1 * (3.0 * a).sin() * (2.0 * b).cos();
        let out = [a.cos() * b.cos(), a.sin() * b.cos(), b.sin()];
        positions.push([a.cos() + r * out[0], a.sin() + r * out[1], r * out[2]].map(|v| v as f32));
        normals.push(out.map(|v| (3.0 * v) as f32));
        let at = |i: u32, j: u32| i % n * n + j % n;
        let corners = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
        triangles.extend([[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]);
    }
    (positions, normals, triangles)
}

/// The corners of each triangle, and the positions in an order of their own.
fn shape(mesh: &TriangleMesh) -> (Vec<[[f64; 3]; 3]>, Vec<[f64; 3]>) {
    let mut positions = mesh.positions.clone();
    positions.sort_by(|a, b| a.partial_cmp(b).unwrap());
    (mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize])).collect(), positions)
}

#[test]
fn a_model_is_the_same_in_every_format() {
    let (positions, normals, triangles) = torus(20);
    let corners: Vec<[[f32; 3]; 3]> = triangles.iter().map(|t| t.map(|v| positions[v as usize])).collect();

    let (mut obj, mut ply, mut ascii) = (String::new(), String::new(), String::from("solid torus\n"));
    positions.iter().for_each(|[x, y, z]| _ = writeln!(obj, "v {} {} {}", f64::from(*x), f64::from(*y), f64::from(*z)));
    normals.iter().for_each(|[x, y, z]| _ = writeln!(obj, "vn {} {} {}", f64::from(*x), f64::from(*y), f64::from(*z)));
    for [a, b, c] in triangles.iter().map(|t| t.map(|v| v + 1)) {
        _ = writeln!(obj, "f {a}//{a} {b}//{b} {c}//{c}");
    }
    ply += "ply\nformat ascii 1.0\n";
    _ = write!(
        ply,
        "element vertex {}\n{}",
        positions.len(),
        ["x", "y", "z", "nx", "ny", "nz"].map(|p| format!("property float {p}\n")).concat()
    );
    _ = write!(ply, "element face {}\nproperty list uchar uint vertex_index\nend_header\n", triangles.len());
    for ([x, y, z], [nx, ny, nz]) in positions.iter().zip(&normals) {
        _ = writeln!(ply, "{x} {y} {z} {nx} {ny} {nz}");
    }
    triangles.iter().for_each(|[a, b, c]| _ = writeln!(ply, "3 {a} {b} {c}"));
    for triangle in &corners {
        ascii += "facet normal 0 0 0\nouter loop\n";
        triangle.iter().for_each(|[x, y, z]| _ = writeln!(ascii, "vertex {} {} {}", f64::from(*x), f64::from(*y), f64::from(*z)));
        ascii += "endloop\nendfacet\n";
    }
    ascii += "endsolid\n";
    let glb = Glb::triangles(&positions, Some(&normals), &triangles);

    let files = Files::new();
    let expected = files.read("torus.obj", obj);
    assert_eq!((expected.triangles.len(), expected.positions.len(), expected.report.border_edges), (800, 400, 0));
    let others = [
        files.read("torus.ply", ply),
        files.read("torus.glb", glb.bytes()),
        files.read("torus.gltf", glb.embedded()),
        files.read("text.stl", ascii),
        files.read("binary.stl", stl::binary("solid", &corners)),
    ];
    for (i, mesh) in others.iter().enumerate() {
        assert!(shape(mesh) == shape(&expected), "{i}");
        assert_eq!(mesh.normals, if i < 3 { expected.normals.clone() } else { vec![] }, "{i}");
    }
}
