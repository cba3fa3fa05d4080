//! Cleaning: every count, and what survives it.

use lodray::mesh::{Attributes, CleanReport, MeshError, TriangleMesh};

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
        turned_triangles: 0,
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
fn corner_normals_survive_cleaning() {
    // Two triangles that share an edge by position only, a flat one, and the first once more.
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [-0.0, 1.0, 0.0]];
    let triangles = [[0, 1, 2], [0, 1, 3], [3, 4, 5], [1, 2, 0]];
    let normals: [[[f32; 3]; 3]; 4] = std::array::from_fn(|t| std::array::from_fn(|k| [t as f32, k as f32, 2.0]));
    let with = |normals: &[[[f32; 3]; 3]]| {
        TriangleMesh::with_attributes(&positions, &triangles, Attributes { normals, ..Attributes::default() }, &[], vec![])
    };
    let mesh = with(&normals).unwrap();
    assert_eq!(mesh.triangles, [[0, 1, 2], [1, 3, 2]]);
    for (kept, from) in mesh.normals.iter().zip([0, 2]) {
        for k in 0..3 {
            let length = normals[from][k].iter().map(|v| v * v).sum::<f32>().sqrt();
            (0..3).for_each(|d| assert!((kept[k][d] - normals[from][k][d] / length).abs() < 1e-6));
        }
    }
    assert_eq!(mesh.normals.len(), 2);
    let bad = [[[0.0, f32::NAN, 0.0], [0.0, 0.0, f32::INFINITY], [0.0; 3]]; 4];
    assert!(with(&bad).unwrap().normals.is_empty());
    let tiny = [[[0.0, f32::MAX, 0.0], [0.0, 0.0, f32::MIN_POSITIVE], [-1e-40, 0.0, 0.0]]; 4];
    let mesh = with(&tiny).unwrap();
    assert_eq!(mesh.normals[0], [[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]]);
    let error = with(&normals[..3]).unwrap_err();
    assert_eq!(error, MeshError::Attributes { what: "normals", found: 3, triangles: 4 });
}

#[test]
fn texture_coordinates_survive_cleaning_and_turning() {
    let positions = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];
    // A flat one, two that run different ways around.
    let triangles = [[0, 1, 1], [0, 1, 2], [1, 2, 3]];
    let texture: [[[f32; 2]; 3]; 3] = std::array::from_fn(|t| std::array::from_fn(|k| [t as f32, k as f32]));
    let with = |texture: &[[[f32; 2]; 3]]| {
        TriangleMesh::with_attributes(&positions, &triangles, Attributes { texture, ..Attributes::default() }, &[], vec![])
    };
    let mut mesh = with(&texture).unwrap();
    assert_eq!(mesh.texture, texture[1..]);
    mesh.orient();
    assert_eq!((mesh.report.turned_triangles, mesh.warnings.len()), (1, 1));
    let place = |v: u32, t: usize| mesh.triangles[t].iter().position(|&w| w == v).unwrap();
    for (t, (corners, own)) in [([0, 1, 2], texture[1]), ([1, 2, 3], texture[2])].into_iter().enumerate() {
        corners.into_iter().zip(own).for_each(|(v, uv)| assert_eq!(mesh.texture[t][place(v, t)], uv));
    }
    assert!(with(&[[[f32::NAN, f32::INFINITY]; 3]; 3]).unwrap().texture.is_empty());
    let error = with(&texture[..2]).unwrap_err();
    assert_eq!(error.to_string(), "there are texture coordinates for 2 triangles, not for 3");
}
