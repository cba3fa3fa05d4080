//! What a file loses is said, what can be mended is mended, and files that a mesh names never hang a run.

use super::files::Files;
use super::glb::{SQUARE, UP, square};
use super::obj::TETRAHEDRON;
use lodray::mesh::TriangleMesh;
use serde_json::json;

/// The one line on what was lost.
fn line(mesh: &TriangleMesh) -> &str {
    let [line] = mesh.warnings.as_slice() else { panic!("{:?}", mesh.warnings) };
    line
}

#[test]
fn material_libraries_that_cannot_be_read_are_named() {
    let files = Files::new();
    std::fs::create_dir(files.folder().join("sub")).unwrap();
    files.write("sub/red.mtl", "newmtl red\nKd 1 0 0\n");
    let read = |name: &str| files.read("a.obj", format!("mtllib {name}\nusemtl red\n{TETRAHEDRON}"));
    for name in ["sub/red.mtl", "sub\\red.mtl", ".\\sub\\red.mtl"] {
        let mesh = read(name);
        assert!(mesh.warnings.is_empty() && mesh.colours[usize::from(mesh.materials[0])] == [1.0, 0.0, 0.0], "{name}");
    }
    for name in ["none.mtl", "sub", "sub\\none.mtl", "/dev/zero", "/dev/null"] {
        let mesh = read(name);
        assert!(line(&mesh).starts_with("mtllib ") && line(&mesh).contains("its colours are missing"), "{name}");
        assert!(mesh.colours.is_empty());
    }
    let large = std::fs::File::create(files.folder().join("large.mtl")).unwrap();
    large.set_len((1 << 26) + 1).unwrap();
    assert!(line(&read("large.mtl")).contains("larger than 64 MiB"));
}

#[test]
fn columns_that_nobody_reads_refuse_nothing() {
    let files = Files::new();
    for extra in ["vt nan(ind) 0", "vt -nan(ind) inf", "vt 1.#QNAN 0", "vt x", "vt", "vt 0 0 0 0"] {
        assert!(files.read("a.obj", format!("{extra}\n{TETRAHEDRON}")).warnings.is_empty(), "{extra}");
    }
    files.read("b.obj", "v 0 0 0 nan 0 0\nv 1 0 0 1 1 1\nv 0 1 0 1 1 -nan(ind)\nf 1 2 3\n");
    for normal in ["nan 0 1", "nan(ind) 0 0", "-1.#IND 0 0", "inf 0 0"] {
        let mesh = files.read("c.obj", format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 0 0 1\nvn {normal}\nf 1//1 2//1 3//2\n"));
        assert!(line(&mesh).starts_with("1 of its normals"), "{normal}");
        assert_eq!(mesh.normals, [[[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0; 3]]]);
    }
}

#[test]
fn what_is_no_triangle_has_a_line() {
    let files = Files::new();
    let read = |text: &str| files.read("a.obj", format!("{TETRAHEDRON}{text}"));
    for (text, count) in [("l 1 2\n", 1), ("p 1\ncurv 0 1 1 2\nsurf 0 1 0 1 1 2 3 4\n", 3)] {
        assert!(line(&read(text)).starts_with(&format!("{count} of its lines begin with p, l, curv, curv2, surf")), "{text}");
    }
    assert_eq!(line(&read("f 1 1 2\n")), "1 of its 5 triangles have no area, and are dropped");
    let all = read("f 1 1 2\nf 2 2 3\nf 2 1 3\n");
    let said = ["2 of its 7 triangles have no area, and are dropped", "1 of its 7 triangles have the corners of another, and are dropped"];
    assert_eq!(all.warnings, said);
    assert_eq!(all.triangles.len(), 4);
    let header = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
    let rest = "element face 1\nproperty list uchar int vertex_indices\nelement edge 1\nproperty int a\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n7\n";
    assert_eq!(line(&files.read("a.ply", format!("{header}{rest}"))), "its element edge is not kept");
    let mut glb = square();
    let mut points = glb.json["meshes"][0]["primitives"][0].clone();
    points["mode"] = json!(0);
    glb.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(points);
    assert_eq!(line(&glb.mesh()), "1 of its primitives are points or lines: only triangles are kept");
}

#[test]
fn a_comment_ends_with_its_line() {
    let files = Files::new();
    let with = |comment: &str| files.read("a.obj", format!("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\n{comment}\nf 2 4 3\n"));
    for comment in ["# a", "# exported from C:\\models\\", "  #\\"] {
        assert_eq!(with(comment).triangles.len(), 2, "{comment}");
    }
    // Other lines go on.
    assert_eq!(files.read("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 \\\n3\n").triangles.len(), 1);
}

#[test]
fn morph_targets_are_applied_with_their_default_weights() {
    let mut glb = square();
    glb.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": 0}]);
    let corner = |glb: &super::glb::Glb| glb.mesh().positions[2];
    let at = |scale: f64| SQUARE[2].map(|v| scale * f64::from(v));
    assert_eq!(corner(&glb), at(1.0));
    let whole = glb.set("/meshes/0/weights", json!([1.0]));
    assert_eq!(corner(&whole), at(2.0));
    assert_eq!(corner(&whole.set("/nodes/0/weights", json!([0.5]))), at(1.5));
    assert_eq!(corner(&whole.set("/nodes/0/weights", json!([0.0]))), at(1.0));
    assert!(line(&glb.set("/meshes/0/weights", json!([1.0, 1.0])).mesh()).contains("2 weights for 1 morph targets"));
    let skinned = glb.set("/nodes/0/skin", json!(0)).mesh();
    assert!(line(&skinned).contains("joints"));
    assert_eq!(UP.len(), SQUARE.len());
}

#[test]
fn mixed_winding_is_brought_to_one_way() {
    let files = Files::new();
    let faces = ["1 3 2", "1 2 4", "2 3 4", "3 1 4"];
    let corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
    let reversed = |face: &str| face.split(' ').rev().collect::<Vec<_>>().join(" ");
    // Every choice of triangles that run the other way.
    for mask in 0..16u32 {
        let text: String =
            (0..4).map(|k| format!("f {}\n", if mask >> k & 1 == 1 { reversed(faces[k]) } else { faces[k].into() })).collect();
        let mesh = files.read("a.obj", format!("{corners}{text}"));
        let wrong = mask.count_ones();
        let turned = if wrong == 4 { 0 } else { wrong.min(4 - wrong) } as usize;
        assert_eq!(
            (mesh.report.inconsistent_edges, mesh.report.turned_triangles, mesh.warnings.len()),
            (0, turned, usize::from(turned > 0))
        );
        let [a, b, c] = mesh.triangles[1].map(|v| mesh.positions[v as usize]);
        // The second triangle lies in y = 0: outside is -y.
        let y = (b[2] - a[2]) * (c[0] - a[0]) - (b[0] - a[0]) * (c[2] - a[2]);
        assert_eq!(y < 0.0, wrong <= 2, "{mask:04b}");
    }
    let strip = "v 0 0 0\nv 0 0 1\nv 1 0 0\nv 1 0 1\nv 0 1 0\nv 0 1 1\nf 1 3 4 2\nf 3 5 6 4\nf 5 2 1 6\n";
    let mesh = files.read("moebius.obj", strip);
    assert!(mesh.report.turned_triangles == 0 && line(&mesh).contains("Moebius"), "{:?}", mesh.report);
}

#[test]
fn seams_are_found_and_welded() {
    let files = Files::new();
    for (gap, found) in [(1e-7, true), (1e-6, true), (1e-5, true), (1e-2, false)] {
        let x = 1.0 + gap;
        let text = format!("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv {x} 0 0\nv 2 0 0\nv 2 1 0\nv {x} 1 0\nf 1 2 3 4\nf 5 6 7 8\n");
        let mesh = files.read("a.obj", text);
        assert_eq!(mesh.report.border_edges, 8);
        let seams = mesh.seams();
        assert_eq!(seams.map(|s| (s.closed, s.open)), found.then_some((2, 8)), "{gap}");
        if let Some(seams) = seams {
            let welded = mesh.welded(seams.distance).unwrap();
            assert_eq!((welded.report.border_edges, welded.triangles.len(), welded.seams()), (6, 4, None));
        }
    }
}
