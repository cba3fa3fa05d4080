//! Stanford PLY.

use super::files::Files;
use super::obj::ring;

const PLY_VERTICES: &str = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\n";

pub fn ascii(rest: &str, data: &str) -> String {
    format!("ply\nformat ascii 1.0\ncomment a comment\n{PLY_VERTICES}{rest}end_header\n{data}")
}

pub const FACES: &str = "element face 2\nproperty list uchar int vertex_indices\n";
pub const CORNERS: &str = "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0.5 9\n";

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

pub fn binary(big: bool) -> Vec<u8> {
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
    bad("range", &format!("{CORNERS}3 0 1 2\n3 0 1 4\n"), &["line 17, element face 1: ", "index 4"]);
    bad("negative", &format!("{CORNERS}3 0 1 -2\n3 0 1 2\n"), &["line 16, element face 0: ", "-2"]);
    bad("two", &format!("{CORNERS}3 0 1 2\n2 0 1\n"), &["line 17, element face 1: ", "3 vertices or more"]);
    bad("missing", &format!("{CORNERS}3 0 1 2\n3 0 1\n"), &["line 17", "element face 1"]);
    bad("truncated", &format!("{CORNERS}3 0 1 2\n"), &["line 16, element face 1: ", "counts 2"]);
    bad("truncated_vertices", "0 0 0 9\n1 0 0 9\n", &["line 13, element vertex 2: ", "counts 4"]);
    bad("more", &format!("{CORNERS}3 0 1 2\n3 0 2 3\n3 1 2 3\n"), &["after line 17: ", "follow the last element"]);
    bad("nan", "0 0 0 9\n1 nan 0 9\n1 1 0 9\n0 1 0 9\n3 0 1 2\n3 0 2 3\n", &["line 13, element vertex 1: "]);
    bad("infinite", "0 0 0 9\n1 1e999 0 9\n1 1 0 9\n0 1 0 9\n3 0 1 2\n3 0 2 3\n", &["line 13, element vertex 1: ", "y", "inf"]);
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
        &["header: element face", "vertex_indices must be whole numbers"],
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
fn large_ply_polygons_are_cut_or_refused() {
    let file = |dented: bool| {
        let head = "ply\nformat ascii 1.0\nelement vertex 5000\nproperty double x\nproperty double y\nproperty double z\nelement face 1\nproperty list uint uint vertex_indices\nend_header\n";
        let vertices: String = ring(5000, dented).iter().map(|[x, y]| format!("{x} {y} 0\n")).collect();
        let face: String = (0..5000).map(|v| format!(" {v}")).collect();
        format!("{head}{vertices}5000{face}\n")
    };
    let files = Files::new();
    assert_eq!(files.read("round.ply", file(false)).triangles.len(), 4998);
    files.refuses("dented.ply", file(true), &["line 5010, element face 0: a face of 5000 corners that is not convex"]);
}

/// The header of a file with these lines in place of its second to last, numbered from 2.
fn refuses_header(lines: &[&str], parts: &[&str]) {
    Files::new().refuses("a.ply", format!("ply\n{}\nend_header\n", lines.join("\n")), parts);
}

#[test]
fn malformed_header_lines_are_named_in_plain_words() {
    let ascii = "format ascii 1.0";
    refuses_header(&["format ascii"], &["header, line 2: 'format' needs a kind and a version"]);
    refuses_header(&["format text 1.0"], &["header, line 2: format 'text' is not known"]);
    refuses_header(&["format ascii 2.0"], &["header, line 2: version '2.0' is not known"]);
    refuses_header(&[ascii, "", ascii], &["header, line 4: there is a second line 'format'"]);
    refuses_header(&["element vertex 3"], &["header, line 3: the header ends without a line 'format'"]);
    refuses_header(&[ascii, "element vertex"], &["header, line 3: 'element' needs a name and a count"]);
    refuses_header(&[ascii, "element vertex -3"], &["header, line 3: element vertex: its count '-3' is not a whole number"]);
    refuses_header(&[ascii, "element vertex 1e3"], &["'1e3' is not a whole number"]);
    refuses_header(&[ascii, "element vertex 99999999999999999999"], &["line 3", "is not a whole number"]);
    refuses_header(&[ascii, "element a 1", "element a 2"], &["header, line 4: there is a second element a"]);
    refuses_header(&[ascii, "property float x"], &["header, line 3: property x comes before any element"]);
    refuses_header(&[ascii, "element vertex 1", "property x"], &["header, line 4: 'property' needs a type and a name"]);
    refuses_header(&[ascii, "element vertex 1", "property real x"], &["header, line 4: property x: type 'real' is not known"]);
    refuses_header(&[ascii, "element vertex 1", "property float x", "property int x"], &["header, line 5: there is a second property x"]);
    refuses_header(&[ascii, "element face 1", "property list uchar int"], &["header, line 4: 'property list' needs a type for its length"]);
    refuses_header(&[ascii, "element face 1", "property list float int a"], &["line 4", "property a: its length cannot be of type float"]);
    refuses_header(&[ascii, "comment fine", "obj_info fine", "elements 3"], &["header, line 5: 'elements' is not a word"]);
    refuses_header(&[ascii, "element 3d 1"], &["header: a line or a name in it has a form that is not known"]);
    Files::new().refuses("a.ply", "PLY\n", &["header, line 1: this is not a PLY file"]);
    Files::new().refuses("a.ply", "ply\nformat ascii 1.0\n", &["header, line 3: the file ends here, before end_header"]);
}

#[test]
fn malformed_lines_of_elements_are_named_in_plain_words() {
    let files = Files::new();
    let bad = |data: &str, what: &str| files.refuses("a.ply", ascii(FACES, data), &[what]);
    bad("0 0\n", "line 12, element vertex 0: z: the line ends before it");
    bad("0 0 0 9\n0 up 0 9\n", "line 13, element vertex 1: y: 'up' is not a number");
    bad("0 0 0 9 9\n", "line 12, element vertex 0: the line goes on after the element's last value: 1 more");
    bad(&format!("{CORNERS}3 0 1\n"), "line 16, element face 0: vertex_indices: its length is 3, but the line has 2");
    bad(&format!("{CORNERS}-3 0 1 2\n"), "line 16, element face 0: vertex_indices: its length '-3' is not a whole number");
    bad(&format!("{CORNERS}99999999999 0 1 2\n"), "element face 0: vertex_indices: its length is 99999999999, but the line has 3");
    bad(&format!("{CORNERS}3 0 1 2.5\n"), "line 16, element face 0: vertex_indices: '2.5' is not a whole number");
    files.refuses(
        "a.ply",
        [ascii(FACES, "0 0 0 9\n").as_bytes(), b"\xff\xfe\n"].concat(),
        &["line 13, element vertex 1: this is not text"],
    );
    // A binary list of a negative length.
    let head = "ply\nformat binary_little_endian 1.0\nelement face 1\nproperty list char int vertex_indices\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
    files.refuses("a.ply", [head.as_bytes(), &[0xff; 40]].concat(), &["element face 0: the length of a list is negative"]);
}

#[test]
fn ply_texture_coordinates_are_those_of_the_vertices() {
    for [u, v] in [["s", "t"], ["u", "v"], ["texture_u", "texture_v"]] {
        let pair = format!("property float {u}\nproperty double {v}\n");
        let rows = "0 0 0 9 0 0\n1 0 0 9 1 0\n1 1 0 9 0.5 2\n0 1 0 9 nan 1\n";
        let mesh = Files::new().read("a.ply", ascii(&format!("{pair}{FACES}"), &format!("{rows}3 0 1 2\n3 0 2 3\n")));
        assert_eq!(mesh.texture[0], [[0.0, 0.0], [1.0, 0.0], [0.5, 2.0]]);
        assert!(mesh.texture[1][2][0].is_nan() && mesh.polygons.is_empty());
    }
    let quad = Files::new().read("a.ply", ascii(FACES, "0 0 0 9\n1 0 0 9\n1 1 0 9\n0 1 0 9\n4 0 1 2 3\n3 0 2 1\n"));
    assert!(quad.texture.is_empty() && quad.polygons[..2] == [0, 0]);
}

#[test]
fn ply_normals_are_those_of_the_vertices() {
    let normals = "property float nx\nproperty float ny\nproperty double nz\n";
    let rows = "0 0 0 9 2 0 0\n1 0 0 9 0 0 1e300\n1 1 0 9 nan 0 0\n0 1 0.5 9 0 -.5 0\n";
    let mesh = Files::new().read("a.ply", ascii(&format!("{normals}{FACES}"), &format!("{rows}3 0 1 2\n4 0 2 3 1\n")));
    let vertex = [[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0; 3], [0.0, -1.0, 0.0]];
    let expected: Vec<[[f32; 3]; 3]> = mesh.triangles.iter().map(|t| t.map(|v| vertex[v as usize])).collect();
    assert_eq!((mesh.triangles.len(), mesh.normals), (3, expected));
    // Two of three are none.
    let mesh = Files::new().read(
        "a.ply",
        ascii(
            &format!("property float nx\nproperty float ny\n{FACES}"),
            "0 0 0 9 1 0\n1 0 0 9 1 0\n1 1 0 9 1 0\n0 1 0 9 1 0\n3 0 1 2\n3 0 2 3\n",
        ),
    );
    assert!(mesh.normals.is_empty());
    // Binary: normals of whole numbers.
    let head = "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty char x\nproperty char y\nproperty char z\nproperty char nx\nproperty char ny\nproperty char nz\nelement face 1\nproperty list uchar uchar vertex_indices\nend_header\n";
    let mesh =
        Files::new().read("a.ply", [head.as_bytes(), &[0, 0, 0, 0, 0, 127, 1, 0, 0, 0, 0, 127, 0, 1, 0, 0, 0x81, 0, 3, 0, 1, 2]].concat());
    assert_eq!(mesh.normals, [[[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]]]);
}
