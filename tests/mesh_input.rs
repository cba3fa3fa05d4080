//! Mesh files in: every form that is read, every fault that is named, every count of cleaning.

use lodray::mesh::{CleanReport, MeshError, TriangleMesh, read};
use std::path::PathBuf;

struct Files(tempfile::TempDir);

impl Files {
    fn new() -> Files {
        Files(tempfile::tempdir().unwrap())
    }

    fn write(&self, name: &str, content: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.path().join(name);
        std::fs::write(&path, content).unwrap();
        path
    }

    fn read(&self, name: &str, content: impl AsRef<[u8]>) -> TriangleMesh {
        read(&self.write(name, content)).unwrap()
    }

    /// The message for a bad file, which must name the file and all of `parts`.
    fn refuses(&self, name: &str, content: impl AsRef<[u8]>, parts: &[&str]) {
        let path = self.write(name, content);
        let message = read(&path).expect_err("a bad file was read").to_string();
        assert!(message.contains(path.to_str().unwrap()), "no file name in: {message}");
        assert!(!message.contains('\n'), "more than one line: {message}");
        for part in parts {
            assert!(message.contains(part), "no '{part}' in: {message}");
        }
    }
}

const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

#[test]
fn obj_triangles() {
    let mesh = Files::new().read("a.obj", TETRAHEDRON);
    // The parser numbers vertices in the order of their first use.
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [2, 1, 3], [1, 0, 3]]);
    let expected = CleanReport { vertices_read: 4, triangles_read: 4, ..Default::default() };
    let mut positions = mesh.positions.clone();
    positions.sort_by(|a, b| a.partial_cmp(b).unwrap());
    assert_eq!(positions, [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]]);
    assert_eq!(mesh.report, expected);
    assert!(mesh.materials.is_empty() && mesh.colours.is_empty());
}

#[test]
fn obj_index_forms_give_the_same_mesh() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 0.5\nvn 0 0 1\n";
    let files = Files::new();
    let plain = files.read("plain.obj", format!("{square}f 1 2 3 4\n"));
    assert_eq!(plain.triangles.len(), 2);
    for face in
        ["f 1/1 2/1 3/2 4/1", "f 1//1 2//1 3//1 4//1", "f 1/1/1 2/2/1 3/1/1 4/1/1", "f -4 -3 -2 -1", "f 1 2 \\\n 3 4", "f 1 2 3 4 # four"]
    {
        let mesh = files.read("form.obj", format!("{square}{face}\n"));
        assert_eq!((mesh.positions, mesh.triangles), (plain.positions.clone(), plain.triangles.clone()), "{face}");
    }
}

#[test]
fn obj_coordinates_keep_double_precision() {
    let mesh = Files::new().read("a.obj", "v 0.1 0 0\nv 1.000000000001 0 0\nv 0 1e-30 0\nf 1 2 3\n");
    let mut xs: Vec<f64> = mesh.positions.iter().map(|p| p[0]).collect();
    xs.sort_by(f64::total_cmp);
    assert_eq!(xs, [0.0, 0.1, 1.000000000001]);
}

/// Twice the area of the triangles, seen from +z, and the sum of the absolute values: equal if none is folded over.
fn areas(mesh: &TriangleMesh) -> (f64, f64) {
    mesh.triangles.iter().fold((0.0, 0.0), |(s, a), t| {
        let [p, q, r] = t.map(|v| mesh.positions[v as usize]);
        let area = (q[0] - p[0]) * (r[1] - p[1]) - (q[1] - p[1]) * (r[0] - p[0]);
        (s + area, a + area.abs())
    })
}

#[test]
fn concave_polygons_are_cut_without_folding() {
    // An L, a dart and a comb; a fan from the first corner folds each of them.
    let shapes: [(&[[f64; 2]], f64); 3] = [
        (&[[2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0], [0.0, 0.0]], 3.0),
        (&[[0.0, 0.0], [2.0, 1.0], [0.0, 2.0], [1.0, 1.0]], 1.0),
        (&[[0.0, 0.0], [5.0, 0.0], [5.0, 3.0], [4.0, 3.0], [4.0, 1.0], [3.0, 1.0], [3.0, 3.0], [2.0, 3.0], [2.0, 1.0], [0.0, 1.0]], 9.0),
    ];
    for (corners, area) in shapes {
        let mut text = String::new();
        corners.iter().for_each(|[x, y]| text += &format!("v {x} {y} 0\n"));
        text += "f";
        (1..=corners.len()).for_each(|i| text += &format!(" {i}"));
        let mesh = Files::new().read("polygon.obj", text);
        assert_eq!(mesh.triangles.len(), corners.len() - 2);
        assert_eq!(areas(&mesh), (2.0 * area, 2.0 * area));
    }
}

#[test]
fn obj_objects_are_joined_and_welded() {
    let text = "o a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no b\nv 1 0 0\nv 1 1 0\nv 0 1 -0\nl 4 5 6\nf 4 5 6\ng c\nf 1 2 5\n";
    let mesh = Files::new().read("a.obj", text);
    assert_eq!(mesh.positions.len(), 4);
    assert_eq!(mesh.triangles.len(), 3);
}

#[test]
fn obj_materials_are_kept_per_triangle() {
    let files = Files::new();
    files.write("two colours.mtl", "newmtl red one\nKd 1 0 0\nKs 1\nnewmtl blue\nKd 0 0 2\nnewmtl bad\nKd 1\n");
    let text = "mtllib two colours.mtl\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 5\nusemtl blue\nf 1 2 3 4\nusemtl red one\nf 2 3 5\nusemtl unknown\nf 3 4 5\n";
    let mesh = files.read("a.obj", text);
    let colours: Vec<[f32; 3]> = mesh.materials.iter().map(|&m| mesh.colours[m as usize]).collect();
    let (red, blue, none) = ([1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.8; 3]);
    assert_eq!(colours, [none, blue, blue, red, none]);
    let without = files.read("b.obj", text.replace("two colours.mtl", "missing.mtl"));
    assert_eq!(without.triangles, mesh.triangles);
    assert!(without.materials.is_empty() && without.colours.is_empty());
}

#[test]
fn bad_obj_files_are_named_with_the_line() {
    let files = Files::new();
    let bad = |name: &str, faces: &str, parts: &[&str]| {
        files.refuses(&format!("{name}.obj"), format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvt 0 0\n{faces}"), parts);
    };
    bad("range", "f 1 2 4\n", &["line 6", "index 4", "out of range", "3"]);
    bad("zero", "f 0 1 2\n", &["line 6", "index 0"]);
    bad("negative", "f -1 -2 -4\n", &["line 6", "-4"]);
    bad("texture", "f 1/1 2/2 3/1\n", &["line 6", "texture coordinate index 2"]);
    bad("normal", "f 1//1 2//1 3//7\n", &["line 6", "normal index 7"]);
    bad("missing", "f 1 2\n", &["line 6", "3 vertices or more"]);
    bad("empty_index", "f 1 2 /1\n", &["line 6", "vertex index"]);
    bad("word", "f 1 2 x\n", &["line 6", "x"]);
    bad("four", "f 1/1/1/1 2 3\n", &["line 6", "more than three"]);
    bad("nan", "v 0 nan 0\nf 1 2 3\n", &["line 6", "nan", "not finite"]);
    bad("infinite", "v 0 0 -inf\nf 1 2 3\n", &["line 6", "-inf", "not finite"]);
    bad("overflow", "v 0 0 1e999\nf 1 2 3\n", &["line 6", "1e999"]);
    bad("huge", "v 0 0 1e200\nf 1 2 3\n", &["line 6", "1e200"]);
    bad("weight", "v 1 1 1 0\nf 1 2 3\n", &["line 6", "position"]);
    bad("short", "v 1 2\nf 1 2 3\n", &["line 6", "3 coordinates"]);
    bad("letters", "v 1 2 three\nf 1 2 3\n", &["line 6", "three", "not a number"]);
    bad("bad_normal", "vn 1 2\nf 1 2 3\n", &["line 6", "vn"]);
    bad("no_faces", "", &["without a face"]);
    bad("flat", "f 1 2 2\n", &["no triangle is left", "1 degenerate"]);
    bad("truncated", "f 1 2 3\nf 1 2 \\", &["line 7"]);
    files.refuses("binary.obj", [b'v', b' ', 0, 1, 2, 255], &["line 1", "not text"]);
    files.refuses("noise.obj", [0xff, 0xfe, b'\n', b'f', b' ', 0xff], &["line 2"]);
    files.refuses("empty.obj", "", &["empty"]);
    files.refuses("later.obj", "v 0 0 0\nv 1 0 0\no a\nf 1 2 3\no b\nv 0 1 0\nf 1 2 3\n", &["out of"]);
}

#[test]
fn files_that_are_no_mesh_files_are_named() {
    let files = Files::new();
    files.refuses("mesh.stl", TETRAHEDRON, &[".obj or .ply"]);
    files.refuses("mesh", TETRAHEDRON, &[".obj or .ply"]);
    files.read("mesh.OBJ", TETRAHEDRON);
    for path in [files.0.path().join("none.obj"), files.0.path().join("none.ply")] {
        let message = read(&path).unwrap_err().to_string();
        assert!(message.starts_with(path.to_str().unwrap()), "{message}");
    }
    let directory = files.0.path().join("directory.ply");
    std::fs::create_dir(&directory).unwrap();
    let message = read(&directory).unwrap_err().to_string();
    assert!(message.starts_with(directory.to_str().unwrap()), "{message}");
    let nameless = read(files.0.path()).unwrap_err().to_string();
    assert!(nameless.contains("is a directory"), "{nameless}");
}

const PLY_VERTICES: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n";

fn ascii(rest: &str, data: &str) -> String {
    format!("ply\nformat ascii 1.0\ncomment a comment\n{PLY_VERTICES}{rest}end_header\n{data}")
}

const FACES: &str = "element face 2\nproperty list uchar int vertex_indices\n";
const CORNERS: &str = "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0.5 9\n";

#[test]
fn ply_ascii_faces() {
    let mesh = Files::new().read("a.ply", ascii(FACES, &format!("{CORNERS}3 0 1 2\n4 0 2 3 1\n")));
    assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.5]]);
    assert_eq!(mesh.report.triangles_read, 3);
    // Faces before the vertices, a windows line end, doubles and another name for the indices.
    let other = "ply\r\nformat ascii 1.0\r\nelement face 1\r\nproperty list uint uint vertex_index\r\nelement vertex 3\r\nproperty double z\r\nproperty double x\r\nproperty double y\r\nend_header\r\n3 0 1 2\r\n0 0 0\r\n0 1 0\r\n0 0 1\r\n";
    let mesh = Files::new().read("b.ply", other);
    assert_eq!((mesh.positions[1], mesh.triangles), ([1.0, 0.0, 0.0], vec![[0, 1, 2]]));
}

#[test]
fn ply_strips_alternate_and_restart() {
    let strips = "element tristrips 1\nproperty list int int vertex_indices\n";
    let mesh = Files::new().read("a.ply", ascii(strips, &format!("{CORNERS}8 0 1 2 3 -1 3 1 0\n")));
    assert_eq!(mesh.triangles, [[0, 1, 2], [2, 1, 3], [3, 1, 0]]);
}

fn binary(big: bool) -> Vec<u8> {
    let kind = if big { "big" } else { "little" };
    let mut bytes = format!("ply\nformat binary_{kind}_endian 1.0\n{PLY_VERTICES}{FACES}end_header\n").into_bytes();
    let mut put = |le: &[u8]| if big { bytes.extend(le.iter().rev()) } else { bytes.extend(le) };
    for p in [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.5]] {
        p.iter().for_each(|v| put(&v.to_le_bytes()));
        put(&[7]);
    }
    for face in [&[0i32, 1, 2][..], &[0, 2, 3]] {
        put(&[face.len() as u8]);
        face.iter().for_each(|v| put(&v.to_le_bytes()));
    }
    bytes
}

#[test]
fn ply_binary_of_both_byte_orders() {
    for big in [false, true] {
        let files = Files::new();
        let mesh = files.read("a.ply", binary(big));
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3]]);
        assert_eq!(mesh.positions[3], [0.0, 1.0, 0.5]);
        let bytes = binary(big);
        files.refuses("cut_face.ply", &bytes[..bytes.len() - 3], &["element face 1"]);
        files.refuses("cut_vertex.ply", &bytes[..bytes.len() - 27 - 20], &["element vertex 2"]);
        files.refuses("more.ply", [&bytes[..], b"abc"].concat(), &["3 bytes follow"]);
        let mut bad = bytes.clone();
        let last = bad.len() - if big { 1 } else { 4 };
        bad[last] = 4;
        files.refuses("range.ply", bad, &["element face 1", "index 4", "4 vertices"]);
    }
    // Any cut gives an error and no panic.
    let (files, bytes) = (Files::new(), binary(false));
    (1..bytes.len()).for_each(|n| files.refuses("cut.ply", &bytes[..n], &[]));
}

#[test]
fn bad_ply_files_are_named_with_the_element() {
    let files = Files::new();
    let bad = |name: &str, data: &str, parts: &[&str]| files.refuses(&format!("{name}.ply"), ascii(FACES, data), parts);
    bad("range", &format!("{CORNERS}3 0 1 2\n3 0 1 4\n"), &["element face 1", "index 4"]);
    bad("negative", &format!("{CORNERS}3 0 1 -2\n3 0 1 2\n"), &["element face 0", "-2"]);
    bad("two", &format!("{CORNERS}3 0 1 2\n2 0 1\n"), &["element face 1", "3 vertices or more"]);
    bad("missing", &format!("{CORNERS}3 0 1 2\n3 0 1\n"), &["line 17", "element face 1"]);
    bad("truncated", &format!("{CORNERS}3 0 1 2\n"), &["element face 1", "counts 2"]);
    bad("truncated_vertices", "0 0 0 9\n1 0 0 9\n", &["element vertex 2", "counts 4"]);
    bad("more", &format!("{CORNERS}3 0 1 2\n3 0 2 3\n3 1 2 3\n"), &["follow the last element"]);
    bad("nan", "0 0 0 9\n1 nan 0 9\n1 1 0 9\n0 1 0 9\n3 0 1 2\n3 0 2 3\n", &["vertex 1"]);
    bad("infinite", "0 0 0 9\n1 1e999 0 9\n1 1 0 9\n0 1 0 9\n3 0 1 2\n3 0 2 3\n", &["element vertex 1", "y", "inf"]);
    bad("words", "0 0 0 9\nhello world\n", &["line 13", "element vertex 1"]);
    bad("degenerate", &format!("{CORNERS}3 0 1 1\n3 0 2 0\n"), &["no triangle is left"]);
    let header = |name: &str, text: &str, parts: &[&str]| files.refuses(&format!("{name}.ply"), text, parts);
    header("not_ply", "solid mesh\n", &["header"]);
    header("not_text", "\u{1}\u{2}\u{0}", &["header"]);
    header("no_end", "ply\nformat ascii 1.0\nelement vertex 3\n", &["header", "end_header"]);
    header("no_faces", &format!("ply\nformat ascii 1.0\n{PLY_VERTICES}end_header\n{CORNERS}"), &["header", "no faces"]);
    header("zero_faces", &ascii("element face 0\nproperty list uchar int vertex_indices\n", CORNERS), &["element face", "no faces"]);
    header("no_vertex", "ply\nformat ascii 1.0\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n", &["element vertex"]);
    header(
        "no_z",
        "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nelement face 0\nproperty list uchar int vertex_indices\nend_header\n0 0\n",
        &["element vertex", "z"],
    );
    header("no_list", &ascii("element face 1\nproperty int vertex_indices\n", CORNERS), &["element face", "vertex_indices"]);
    header(
        "float_list",
        &ascii("element face 1\nproperty list uchar float vertex_indices\n", &format!("{CORNERS}3 0 1 2\n")),
        &["element face 0"],
    );
    header(
        "endless",
        "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\nproperty float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n1234",
        &["element vertex 0"],
    );
    header(
        "nothing",
        "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000000\nend_header\n",
        &["element vertex", "no properties"],
    );
    files.refuses("empty.ply", "", &["empty"]);
}

#[test]
fn cleaning_counts_what_it_drops_and_keeps() {
    let positions = [
        [0.0, 0.0, 0.0],
        [1.0, 0.0, 0.0],
        [0.0, 1.0, 0.0],
        [-0.0, 0.0, 0.0],
        [0.0, 0.0, 1.0],
        [0.0, 0.0, -1.0],
        [9.0, 9.0, 9.0],
        [2.0, 0.0, 0.0],
    ];
    // Three triangles on one edge, one of them wound the other way; repeats; a repeated vertex after welding; a line.
    let triangles = [[0, 1, 2], [3, 1, 4], [1, 0, 5], [2, 0, 1], [1, 3, 2], [0, 3, 1], [0, 1, 7]];
    let mesh = TriangleMesh::from_parts(&positions, &triangles, &[0, 1, 0, 0, 0, 0, 0], vec![[0.0; 3], [1.0; 3]]).unwrap();
    let expected = CleanReport {
        vertices_read: 8,
        triangles_read: 7,
        welded_vertices: 1,
        unreferenced_vertices: 2,
        degenerate_triangles: 2,
        duplicate_triangles: 2,
        non_manifold_edges: 1,
        border_edges: 6,
        inconsistent_edges: 0,
    };
    assert_eq!(mesh.report, expected);
    assert_eq!(mesh.triangles, [[0, 1, 2], [0, 1, 3], [1, 0, 4]]);
    assert_eq!(mesh.materials, [0, 1, 0]);
    let twisted = TriangleMesh::from_parts(&positions, &[[0, 1, 2], [0, 1, 4]], &[], vec![]).unwrap();
    assert_eq!((twisted.report.inconsistent_edges, twisted.report.border_edges), (1, 4));
}

#[test]
fn tiny_and_huge_triangles_are_not_degenerate() {
    for scale in [1e-30, 1e-200, 1e30] {
        let positions = [[0.0; 3], [scale, 0.0, 0.0], [0.0, scale, 0.0]];
        assert_eq!(TriangleMesh::from_parts(&positions, &[[0, 1, 2]], &[], vec![]).unwrap().triangles.len(), 1);
    }
}

#[test]
fn parts_that_make_no_mesh_are_refused() {
    let p = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, f64::NAN, 0.0]];
    let make = |p: &[[f64; 3]], t: &[[u32; 3]], m: &[u16]| TriangleMesh::from_parts(p, t, m, vec![]).unwrap_err();
    assert!(matches!(make(&p, &[[0, 1, 2]], &[]), MeshError::Coordinate { vertex: 2, .. }));
    assert!(matches!(make(&p[..2], &[[0, 1, 2]], &[]), MeshError::Index { triangle: 0, index: 2, vertices: 2 }));
    assert!(matches!(make(&p[..2], &[[0, 1, 1]], &[0]), MeshError::Material { triangle: 0 }));
    assert!(matches!(make(&p[..2], &[[0, 1, 1]], &[]), MeshError::Empty { triangles: 1, degenerate: 1 }));
}

#[test]
fn damaged_files_never_panic() {
    let files = Files::new();
    let ply = ascii(FACES, &format!("{CORNERS}3 0 1 2\n4 0 2 3 1\n")).into_bytes();
    let big = binary(true);
    let obj = format!("mtllib a.mtl\nvt 0 1\nvn 0 0 1\n{TETRAHEDRON}usemtl x\nf 1/1/1 2//1 -1/-1 -2\n").into_bytes();
    let mut state = 1u64;
    let mut random = |n: usize| {
        state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (state >> 33) as usize % n
    };
    let (mut read_well, mut refused) = (0, 0);
    for round in 0..1500 {
        let (name, original) = [("a.obj", &obj), ("a.ply", &ply), ("b.ply", &big)][round % 3];
        let mut bytes = original.clone();
        for _ in 0..=random(4) {
            let at = random(bytes.len());
            match random(3) {
                0 => bytes[at] = random(256) as u8,
                1 => bytes[at] = b"0123456789-./ \nvf"[random(17)],
                _ => _ = bytes.remove(at),
            }
        }
        let path = files.write(name, &bytes);
        match read(&path) {
            Ok(mesh) => {
                read_well += 1;
                assert!(!mesh.triangles.is_empty());
            }
            Err(error) => {
                refused += 1;
                assert!(error.to_string().starts_with(path.to_str().unwrap()));
            }
        }
    }
    assert!(read_well > 100 && refused > 100, "{read_well} {refused}");
}
