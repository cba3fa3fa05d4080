//! STL, ASCII and binary.

use super::files::Files;

pub const ASCII: &str = "solid a name\n\
    facet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1 0\n endloop\nendfacet\n\
    facet normal 0 0 1\n outer loop\n  vertex 1 0 0\n  vertex 1 1 0.5\n  vertex 0 1 0\n endloop\nendfacet\n\
    endsolid a name\n";

/// A binary file with these 80 bytes first and a facet normal of NaN.
pub fn binary(header: &str, triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
    let mut bytes = header.as_bytes().to_vec();
    bytes.resize(80, b' ');
    bytes.extend((triangles.len() as u32).to_le_bytes());
    for triangle in triangles {
        bytes.extend([f32::NAN; 3].iter().chain(triangle.iter().flatten()).flat_map(|v| v.to_le_bytes()));
        bytes.extend([7, 0]);
    }
    bytes
}

pub const TRIANGLES: [[[f32; 3]; 3]; 2] =
    [[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], [[1.0, 0.0, 0.0], [1.0, 1.0, 0.5], [0.0, 1.0, 0.0]]];

#[test]
fn ascii_facets_are_welded_and_their_normals_left() {
    let mesh = Files::new().read("a.stl", ASCII);
    assert_eq!(mesh.positions, [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.5]]);
    assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
    assert_eq!((mesh.report.vertices_read, mesh.report.welded_vertices), (6, 2));
    assert!(mesh.normals.is_empty() && mesh.materials.is_empty());
}

#[test]
fn ascii_of_many_writers() {
    let plain = Files::new().read("a.stl", ASCII);
    let second = ASCII.replace("a name", "another");
    let cases: [(&str, Vec<u8>, usize); 6] = [
        ("upper case", ASCII.to_uppercase().into(), 2),
        ("windows", ASCII.replace('\n', "\r\n").into(), 2),
        ("nameless", ASCII.replace(" a name", "").into(), 2),
        ("a name that is not UTF-8", ASCII.replace("a name", "a\u{fffd}").into_bytes().into_iter().filter(|&b| b != 0xbf).collect(), 2),
        ("normals that are no numbers", ASCII.replace("normal 0 0 1", "normal -nan nan nan").into(), 2),
        ("blank lines, more digits", format!("\n\n{}\n\n", ASCII.replace("1 1 0.5", "+1.0e0\t1.E+00   5.0000000000000000E-1")).into(), 2),
    ];
    for (what, bytes, triangles) in cases {
        let mesh = Files::new().read("a.stl", bytes);
        assert_eq!((mesh.triangles.len(), &mesh.positions), (triangles, &plain.positions), "{what}");
    }
    // All solids of a file.
    let mesh = Files::new().read("a.stl", format!("{ASCII}{}", second.replace("0.5", "0.75")));
    assert_eq!(mesh.report.triangles_read, 4);
    // In double precision.
    let mesh = Files::new().read("a.stl", ASCII.replace("0.5", "0.1"));
    assert_eq!(mesh.positions[3][2], 0.1);
}

#[test]
fn binary_files_may_begin_like_text() {
    let text = Files::new().read("a.stl", ASCII);
    for header in ["", "made by hand", "solid", "solid a name", "solid\nfacet normal 0 0 1\n", "solid \0\0\n"] {
        let bytes = binary(header, &TRIANGLES);
        let mesh = Files::new().read("a.stl", &bytes);
        assert_eq!((mesh.positions, mesh.triangles), (text.positions.clone(), text.triangles.clone()), "{header}");
        // Cut short it is still not taken for text, as there are zero bytes.
        Files::new().refuses("a.stl", &bytes[..bytes.len() - 1], &["header", "counts 2 triangles (100 bytes)", "99 bytes"]);
        Files::new().refuses("a.stl", [&bytes[..], b"more"].concat(), &["header", "counts 2", "104 bytes"]);
    }
}

#[test]
fn bad_stl_files_are_named_with_line_or_triangle() {
    let files = Files::new();
    let bad = |old: &str, new: &str, parts: &[&str]| files.refuses("a.stl", ASCII.replacen(old, new, 1), parts);
    bad("vertex 1 0 0", "vertex 1 0", &["line 5", "3 coordinates, found 2"]);
    bad("vertex 1 0 0", "vertex 1 0 0 0", &["line 5", "found 4"]);
    bad("vertex 1 0 0", "vertex 1 zero 0", &["line 5", "'zero' is not a number"]);
    bad("vertex 1 0 0", "vertex 1 nan 0", &["line 5", "nan is not finite"]);
    bad("vertex 1 0 0", "vertex 1 -1e999 0", &["line 5", "-1e999 is not finite"]);
    bad("vertex 1 0 0", "vertex 1 1e200 0", &["line 5", "vertex: 1e200 is too large"]);
    bad("  vertex 1 0 0\n", "", &["line 6", "expected 'vertex', found 'endloop'"]);
    bad(" endloop\n", "vertex 3 3 3\n", &["line 7", "expected 'endloop', found 'vertex 3 3 3'"]);
    bad("outer loop", "inner loop", &["line 3", "expected 'outer loop'"]);
    bad("facet normal", "triangle", &["line 2", "expected 'facet normal' or 'endsolid', found 'triangle 0 0 1'"]);
    bad("endsolid a name\n", "", &["line 15", "ends without 'endsolid'"]);
    bad(" endloop\nendfacet\nendsolid a name\n", "", &["line 13", "in the middle of a facet"]);
    bad("endsolid a name\n", "endsolid\nfacet normal 0 0 1\n", &["line 17", "expected 'solid'"]);
    files.refuses("empty.stl", "", &["empty"]);
    files.refuses("none.stl", "solid\nendsolid\n", &["there are no triangles"]);
    files.refuses("none.stl", binary("", &[]), &["there are no triangles"]);
    files.refuses("other.stl", "v 0 0 0\n", &["no STL file"]);
    files.refuses("flat.stl", binary("", &[[[0.0; 3]; 3]]), &["no triangle is left"]);
    let mut nan = TRIANGLES;
    nan[1][2][1] = f32::NAN;
    files.refuses("nan.stl", binary("", &nan), &["triangle 1", "NaN"]);
    let mut endless = binary("", &TRIANGLES);
    endless[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    files.refuses("endless.stl", endless, &["header", "counts 4294967295 triangles"]);
    // Any cut gives an error and no panic.
    let bytes = binary("solid", &TRIANGLES);
    (1..bytes.len()).for_each(|n| files.refuses("cut.stl", &bytes[..n], &[]));
    (1..ASCII.len() - 8).for_each(|n| files.refuses("cut.stl", &ASCII[..n], &[]));
}
