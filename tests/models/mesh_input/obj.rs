//! Wavefront OBJ.

use super::files::Files;
use lodray::mesh::{CleanReport, TriangleMesh, read_positions};

pub const TETRAHEDRON: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

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

#[test]
fn obj_positions_alone_are_those_of_the_mesh() {
    let files = Files::new();
    let text = "\u{feff}v 2 4 6 2\nv 1 \\\n0 0\nv 0 1 0 1 1 1 # red\nf 1 2 3\n";
    let alone = read_positions(&files.write("a.obj", text)).unwrap();
    assert_eq!((alone.positions, alone.vertices, alone.is_sequence), (files.read("a.obj", text).positions, 3, false));
    let path = files.write("bad.obj", "v 0 0 0\nv 1 2 3 junk\n");
    let message = read_positions(&path).unwrap_err().to_string();
    assert_eq!(message, format!("{}: line 2: v: junk is not a number", path.display()));
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

/// Points on a circle; every other one nearer to its centre, if it is dented.
pub fn ring(corners: u32, dented: bool) -> Vec<[f64; 2]> {
    let radius = |k: u32| if dented && k % 2 == 1 { 0.5 } else { 1.0 };
    let angle = |k: u32| f64::from(k) / f64::from(corners) * std::f64::consts::TAU;
    (0..corners).map(|k| [radius(k) * angle(k).cos(), radius(k) * angle(k).sin()]).collect()
}

#[test]
fn large_polygons_are_cut_without_folding_or_refused() {
    let vertices: String = [false, true].iter().flat_map(|&dented| ring(5000, dented)).map(|[x, y]| format!("v {x} {y} 0\n")).collect();
    let face = |from: usize| (from..from + 5000).map(|v| format!(" {v}")).collect::<String>();
    let good = format!("{vertices}f{}\nf 1 2 5002\n", face(1));
    let files = Files::new();
    let mesh = files.read("round.obj", format!("{vertices}f{}\n", face(1)));
    let (sum, all) = areas(&mesh);
    assert!(mesh.triangles.len() == 4998 && sum == all && (sum - std::f64::consts::TAU).abs() < 1e-4, "{sum} {all}");
    files.refuses("dented.obj", format!("{good}f{}\n", face(5001)), &["line 10003: a face of 5000 corners that is not convex"]);
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
    bad("texture", "f 1/1 2/x 3/1\n", &["line 6", "2/x has no valid texture coordinate index"]);
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
    files.refuses("later.obj", "v 0 0 0\nv 1 0 0\no a\nf 1 2 3\no b\nv 0 1 0\nf 1 2 3\n", &["out of range", "comes later"]);
}

#[test]
fn obj_texture_coordinates_and_polygons_are_kept() {
    let files = Files::new();
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nvt 0 0\nvt 0.5\nvt 1 1 0.5\nvt x 1\n";
    let mesh = files.read("square.obj", format!("{square}f 2 5 3\nf 1/1 2/2 3/-2 4/4\n"));
    assert_eq!((mesh.triangles.len(), &mesh.polygons), (3, &vec![0, 1, 1]));
    assert!(mesh.texture[0].iter().flatten().all(|c| c.is_nan()));
    assert_eq!(mesh.texture[1], [[0.0, 0.0], [0.5, 0.0], [1.0, 1.0]]);
    assert_eq!(mesh.texture[2][..2], [[0.0, 0.0], [1.0, 1.0]]);
    assert!(mesh.texture[2][2].iter().all(|c| c.is_nan()));
    let plain = files.read("plain.obj", format!("{square}f 2 5 3\n"));
    assert!(plain.texture.is_empty() && plain.polygons.is_empty());
}

#[test]
fn obj_texture_indices_need_not_be_there() {
    let files = Files::new();
    for face in ["f 1/7 2/8 3/9", "f 1/-1 2/-2 3/-3", "f 1/0 2/0 3/0", "vt 0 nan\nf 1/1 2/2 3/1", "f 1/9/1 2/9/1 3/9/1"] {
        let mesh = files.read("a.obj", format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\n{face}\n"));
        assert_eq!(mesh.triangles.len(), 1, "{face}");
    }
}

#[test]
fn obj_normals_may_be_named_where_there_are_none() {
    let files = Files::new();
    let largest = ["f 1//9223372036854775807 2 3", "f 1//-9223372036854775808 2 3", "f 1/9223372036854775807 2/-9223372036854775808 3"];
    for face in ["f 1/1/1 2/2/2 3/3/3", "f 1//0 2//-1 3//99"].into_iter().chain(largest) {
        let mesh = files.read("a.obj", format!("v 0 0 0\nv 1 0 0\nv 0 1 0\n{face}\n"));
        assert_eq!((mesh.triangles.len(), mesh.normals.len()), (1, 0), "{face}");
    }
    files.refuses("word.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//x 3//1\n", &["line 4", "2//x has no valid normal index"]);
}

#[test]
fn obj_normals_are_kept_for_each_corner() {
    let square = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";
    let (x, y, z, none) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3]);
    // Of any length; without a direction none; corners without one beside corners with one; counted from both ends.
    let normals = "vn 7 0 0\nvn 0 1e300 0\nvn 0 0 1e-300\nvn 0 0 0\nvn nan 0 1\nvn inf 0 0\n";
    let cases = [
        ("f 1//1 2//2 3//3", vec![[x, y, z]]),
        ("f 1//-6 2//-5 3//-4", vec![[x, y, z]]),
        ("f 1/9/1 2 3//3", vec![[x, none, z]]),
        ("f 1//4 2//5 3//1", vec![[none, none, x]]),
        ("f 1//6 2//2 3//1", vec![[none, y, x]]),
        ("f 1 2 3\nf 1//3 3//1 4//2", vec![[none; 3], [z, x, y]]),
        ("f 1//1 2//2 3//3 4//4", vec![[x, y, z], [x, z, none]]),
        ("o a\nf 1//1 2//2 3//3\no b\nf 1//2 3//2 4//1", vec![[x, y, z], [y, y, x]]),
        ("f 1//4 2//5 3//6", vec![]),
        ("f 1 2 3", vec![]),
    ];
    for (faces, expected) in cases {
        assert_eq!(Files::new().read("a.obj", format!("{square}{normals}{faces}\n")).normals, expected, "{faces}");
    }
    // A normal may come after the face, and the polygon that is cut into ears keeps its corners' normals.
    let dart = "v 0 0 0\nv 2 1 0\nv 0 2 0\nv 1 1 0\nf 1//1 2//2 3//3 4//4\nvn 1 0 0\nvn 0 1 0\nvn 0 0 1\nvn 0 0 -1\n";
    let mesh = Files::new().read("a.obj", dart);
    let expected = [([0.0, 0.0, 0.0], x), ([2.0, 1.0, 0.0], y), ([0.0, 2.0, 0.0], z), ([1.0, 1.0, 0.0], [0.0, 0.0, -1.0])];
    assert_eq!(mesh.normals.len(), 2);
    for (triangle, normals) in mesh.triangles.iter().zip(&mesh.normals) {
        for (&v, &normal) in triangle.iter().zip(normals) {
            assert!(expected.contains(&(mesh.positions[v as usize], normal)), "{:?} {normal:?}", mesh.positions[v as usize]);
        }
    }
}
