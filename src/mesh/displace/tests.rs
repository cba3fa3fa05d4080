use super::*;
use crate::mesh::{BoundKind, SharedEdges, TriangleMesh, flat_surface, lattice, loop_surface, quantise};
use crate::num::VertexForm;

/// A unit square of two triangles in the plane z = 0, texture coordinates its places.
fn square() -> (TriangleMesh, Vec<[[f32; 2]; 3]>) {
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]];
    let mesh = TriangleMesh::from_parts(&positions, &[[0, 1, 2], [0, 2, 3]], &[], vec![]).unwrap();
    let texture = mesh.triangles.iter().map(|t| t.map(|v| mesh.positions[v as usize]).map(|[x, y, _]| [x as f32, y as f32])).collect();
    (mesh, texture)
}

fn map(width: usize, texels: &[f32]) -> HeightMap {
    HeightMap::new(width, texels.to_vec()).unwrap()
}

#[test]
fn heights_are_bilinear_between_centres_and_repeat() {
    // The upper row first.
    let map = map(2, &[0.0, 1.0, 2.0, 4.0]);
    for (uv, height) in [
        ([0.25, 0.75], 0.0),
        ([0.75, 0.75], 1.0),
        ([0.25, 0.25], 2.0),
        ([0.75, 0.25], 4.0),
        ([0.5, 0.75], 0.5),
        ([0.5, 0.5], 1.75),
        ([1.0, 0.75], 0.5),
        ([0.0, 0.25], 3.0),
        ([-0.75, 2.25], 2.0),
        ([0.25, 0.0], 1.0),
    ] {
        assert_eq!(map.at(uv), height, "{uv:?}");
    }
    assert_eq!((map.texels(), map.size(), map.range()), (4, [2, 2], 4.0));
    assert!(map.at([-1e-18, 1.0 + 1e-17]).is_finite());
    assert_eq!(HeightMap::new(1, vec![3.5]).unwrap().at([0.123, 77.0]), 3.5);
}

#[test]
fn what_is_no_map_is_refused() {
    let said = |made: Result<HeightMap, MapFault>| made.unwrap_err().to_string();
    assert_eq!(said(HeightMap::new(2, vec![0.0; 3])), "3 texels are not whole rows of 2");
    assert_eq!(said(HeightMap::new(0, vec![])), "0 texels are not whole rows of 0");
    assert_eq!(said(HeightMap::new(2, vec![0.0, 0.0, f32::NAN, 0.0])), "its texel (0, 1) is NaN, not a finite number");
    assert!(HeightMap::of_bytes(b"no picture").is_err() && HeightMap::of_bytes(b"").is_err());
    assert!(HeightMap::read(std::path::Path::new("not there.png")).is_err());
}

#[test]
fn a_16_bit_png_keeps_all_its_steps() {
    let own = image::ImageBuffer::<image::Luma<u16>, _>::from_raw(2, 1, vec![1_u16, 65535]).unwrap();
    let mut bytes = std::io::Cursor::new(Vec::new());
    image::DynamicImage::ImageLuma16(own).write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    assert_eq!(HeightMap::of_bytes(bytes.get_ref()).unwrap(), map(2, &[1.0 / 65535.0, 1.0]));
}

#[test]
fn points_move_along_normals_by_what_the_map_says() {
    let (mesh, texture) = square();
    let by = Displacement { map: map(4, &[0.0, 0.25, 1.0, 0.5].repeat(4)), amount: 0.5, middle: 0.25 };
    let mut surface = flat_surface(&mesh, 4, 180.0).unwrap();
    let done = displace(&mut surface, &texture, &by).unwrap();
    for p in &surface.positions {
        let expected = 0.5 * (by.map.at([p[0], p[1]]) - 0.25);
        assert!((p[2] - expected).abs() < 1e-12, "{p:?}, not {expected}");
    }
    assert_eq!((done.least, done.most, done.seam_points), (-0.125, 0.375, 0));
    assert!(done.seam_gap < 1e-12);
    // Normals are those of the waves: they lean along x alone.
    assert!(surface.normals.iter().all(|n| n[1].abs() < 0.2 && n[2] > 0.3) && surface.normals.iter().any(|n| n[0].abs() > 0.5));
    assert!(quantise(&surface, BoundKind::Largest, VertexForm::Exact, 0).is_ok());
}

#[test]
fn seams_of_the_map_do_not_tear() {
    let (mesh, mut texture) = square();
    // The second triangle lies elsewhere on the map.
    texture[1] = texture[1].map(|[u, v]| [0.4 - 0.3 * v, 0.1 + 0.7 * u]);
    let by = Displacement { map: map(3, &[0.0, 1.0, 0.3, 0.9, 0.2, 0.6, 0.1, 0.7, 0.5]), amount: -0.3, middle: 0.5 };
    for mut surface in [flat_surface(&mesh, 3, 180.0).unwrap(), loop_surface(&mesh, 3).unwrap()] {
        let done = displace(&mut surface, &texture, &by).unwrap();
        assert!(done.seam_points > 5 && done.seam_gap > 0.01, "{done:?}");
        for group in SharedPoints::new(&surface.triangles, 3).iter() {
            assert!(group.iter().all(|&at| surface.positions[at].map(f64::to_bits) == surface.positions[group[0]].map(f64::to_bits)));
            assert!(group.iter().all(|&at| surface.normals[at] == surface.normals[group[0]]));
        }
        assert!(quantise(&surface, BoundKind::Largest, VertexForm::Exact, 0).is_ok());
    }
}

#[test]
fn creases_stay_creases_and_do_not_tear() {
    // Two walls of a box at a right angle.
    let positions = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, -1.0], [1.0, 1.0, -1.0]];
    let mesh = TriangleMesh::from_parts(&positions, &[[0, 1, 2], [0, 2, 3], [1, 4, 5], [1, 5, 2]], &[], vec![]).unwrap();
    let texture = vec![[[0.1, 0.2], [0.7, 0.3], [0.5, 0.9]]; 4];
    let by = Displacement { map: map(1, &[1.0]), amount: 0.25, middle: 0.0 };
    let mut surface = flat_surface(&mesh, 2, 50.0).unwrap();
    let done = displace(&mut surface, &texture, &by).unwrap();
    assert!(done.seam_points > 0);
    for group in SharedPoints::new(&surface.triangles, 2).iter() {
        assert!(group.iter().all(|&at| surface.positions[at] == surface.positions[group[0]]));
    }
    // The middle of the edge goes to the mean of both walls' ways, and has a normal on each.
    let uses = SharedEdges::new(&mesh.triangles);
    let edge = uses.edges().find(|uses| uses[0].ends == [1, 2]).unwrap();
    let at = |k: usize| edge[k].tree as usize * lattice::len(2) + lattice::index(2, edge[k].point(2, 2));
    assert_eq!(surface.positions[at(0)], [1.125, 0.5, 0.125]);
    assert_ne!(surface.normals[at(0)], surface.normals[at(1)]);
}

#[test]
fn missing_coordinates_are_counted() {
    let (mesh, mut texture) = square();
    let by = Displacement { map: map(1, &[1.0]), amount: 1.0, middle: 0.0 };
    let mut surface = flat_surface(&mesh, 1, 50.0).unwrap();
    assert_eq!(displace(&mut surface, &[], &by), Err(DisplaceError::NoTexture));
    texture[1][2][0] = f32::NAN;
    assert_eq!(displace(&mut surface, &texture, &by), Err(DisplaceError::Missing { first: 1, missing: 1 }));
}

#[test]
fn splits_follow_the_texels() {
    let (_, texture) = square();
    let sized = |side: usize| map(side, &vec![0.0; side * side]);
    // Two triangles over the whole map: a point for each texel takes as many triangles as twice the texels.
    assert_eq!([1, 2, 8, 64, 65].map(|side| levels_for(&texture, &sized(side), 10)), [0, 1, 3, 6, 7]);
    assert_eq!(levels_for(&texture, &sized(64), 4), 4);
}
