//! Catmull-Clark subdivision of a mesh's polygons as a source of hierarchies: every vertex is a point of the limit surface.
//!
//! Each quad is two base triangles, halves along a diagonal of its grid of quads; polygons of other sizes are first split into quads. So lattices of trees are points of
//! these grids, and levels hold the points of those above them, as with Loop's rules.

use super::super::{Surface, TriangleMesh, lattice};
use super::quad_net::Net;
use super::{SharedPoints, SubdivideError, check_subdivision, shade};
use std::collections::HashMap;

/// Texture coordinates at the corners of triangles.
pub type CornerTexture = Vec<[[f32; 2]; 3]>;

/// A polygon of the mesh.
struct Ring {
    corners: Vec<u32>,
    texture: Vec<[f32; 2]>,
    /// One of its triangles.
    triangle: usize,
}

/// The Catmull-Clark surface of the polygons of a clean mesh, and the texture coordinates of its base triangles (none if the mesh has none): two triangles for each quad, or for each corner of each polygon if any
/// is no quad, split `levels` times (0 to [`MAX_LEVELS`](crate::num::MAX_LEVELS)). Borders, edges of three faces and more, and normals are as in [`loop_surface`](fn@super::loop_surface).
///
/// # Errors
/// Too many splits, or more than [`MAX_SUBDIVIDED`](super::MAX_SUBDIVIDED) finest triangles.
pub fn catmull_clark_surface(mesh: &TriangleMesh, levels: u32) -> Result<(Surface, CornerTexture), SubdivideError> {
    let mut rings = rings(mesh);
    let are_quads = rings.iter().all(|ring| ring.corners.len() == 4);
    let quads: usize = if are_quads { rings.len() } else { rings.iter().map(|ring| ring.corners.len()).sum() };
    check_subdivision(2 * quads as u64, levels)?;
    let faces: Vec<Vec<u32>> = rings.iter().map(|ring| ring.corners.clone()).collect();
    let mut net = Net::new(mesh.positions.clone(), &faces);
    if !are_quads {
        net = net.split();
        rings = split_texture(rings);
    }
    let base: Vec<[u32; 4]> = net.faces().map(|face| [face[0], face[1], face[2], face[3]]).collect();
    let base_vertices = net.positions.len() as u32; // they are numbered in 32 bits
    for _ in 0..levels {
        net = net.split();
    }
    let limit = net.limit();
    let on_fork = net.is_on_fork();

    let (len, row) = (lattice::len(levels), (1 << levels) + 1);
    let has_materials = !mesh.materials.is_empty();
    let mut surface = Surface { levels, base_vertices, colours: mesh.colours.clone(), ..Surface::default() };
    let mut texture = Vec::new();
    // Points that have a normal of their own: where more than two faces meet.
    let mut alone = Vec::with_capacity(2 * base.len() * len);
    for (quad, (corners, ring)) in base.iter().zip(&rings).enumerate() {
        let grid = net.grid(quad, levels);
        let [c0, c1, c2, c3] = *corners;
        surface.triangles.extend([[c0, c1, c2], [c0, c2, c3]]);
        if let [t0, t1, t2, t3] = ring.texture[..] {
            texture.extend([[t0, t1, t2], [t0, t2, t3]]);
        }
        if has_materials {
            surface.materials.extend([mesh.materials[ring.triangle]; 2]);
        }
        for is_second in [false, true] {
            for j in 0..row {
                for i in 0..row - j {
                    let (x, y) = if is_second { (i, i + j) } else { (i + j, j) };
                    let v = grid[y * row + x] as usize;
                    surface.positions.push(limit[v]);
                    alone.push(on_fork[v]);
                }
            }
        }
    }
    // Of one normal, so that points come together; those on forks have one for each tree.
    surface.normals = alone.iter().enumerate().map(|(at, &alone)| [if alone { (at / len) as f32 } else { 0.0 }, 0.0, 1.0]).collect();
    let together = SharedPoints::new(&surface.triangles, levels).with_one_normal(&surface.normals);
    surface.normals.fill([0.0, 0.0, 1.0]);
    shade(&mut surface, &together);
    Ok((surface, texture))
}

/// The mesh's polygons. Triangles of one that do not make a ring, for instance because cleaning dropped some, are polygons of their own.
fn rings(mesh: &TriangleMesh) -> Vec<Ring> {
    let triangle = |t: usize| Ring {
        corners: mesh.triangles[t].to_vec(),
        texture: mesh.texture.get(t).map_or_else(Vec::new, |uv| uv.to_vec()),
        triangle: t,
    };
    if mesh.polygons.is_empty() {
        return (0..mesh.triangles.len()).map(triangle).collect();
    }
    let mut rings = Vec::new();
    let mut first = 0;
    for of in mesh.polygons.chunk_by(|a, b| a == b) {
        let own = first..first + of.len();
        first = own.end;
        match ring(mesh, own.clone()) {
            Some(ring) => rings.push(ring),
            None => rings.extend(own.map(triangle)),
        }
    }
    rings
}

/// The one ring around some triangles.
fn ring(mesh: &TriangleMesh, of: std::ops::Range<usize>) -> Option<Ring> {
    let sides =
        of.clone().flat_map(|t| [0, 1, 2].map(|k| (t, k))).map(|(t, k)| (mesh.triangles[t][k], mesh.triangles[t][(k + 1) % 3], t, k));
    let sides: Vec<_> = sides.collect();
    let outer = sides.iter().filter(|side| !sides.iter().any(|other| (other.0, other.1) == (side.1, side.0)));
    let mut next = HashMap::new();
    let mut start = None;
    for &(from, to, t, k) in outer {
        start.get_or_insert(from);
        if next.insert(from, (to, t, k)).is_some() {
            return None;
        }
    }
    let (start, triangle) = (start?, of.start);
    let mut ring = Ring { corners: Vec::new(), texture: Vec::new(), triangle };
    let mut at = start;
    loop {
        let &(to, t, k) = next.get(&at)?;
        ring.corners.push(at);
        ring.texture.extend(mesh.texture.get(t).map(|uv| uv[k]));
        at = to;
        if at == start || ring.corners.len() > next.len() {
            break;
        }
    }
    (ring.corners.len() == next.len()).then_some(ring)
}

/// Texture coordinates of the quads that the first split makes of polygons, as [`Net::split`] orders them.
fn split_texture(rings: Vec<Ring>) -> Vec<Ring> {
    let mean = |of: &[[f32; 2]]| std::array::from_fn(|k| of.iter().map(|uv| uv[k]).sum::<f32>() / of.len() as f32);
    let quads = |ring: &Ring| {
        let count = ring.corners.len();
        let own: Vec<Ring> = (0..count)
            .map(|k| {
                let mut texture = Vec::new();
                if !ring.texture.is_empty() {
                    let uv = |k: usize| ring.texture[k % count];
                    let (side, last) = (mean(&[uv(k), uv(k + 1)]), mean(&[uv(k + count - 1), uv(k)]));
                    texture = vec![uv(k), side, mean(&ring.texture), last];
                    if count == 4 {
                        texture.rotate_right(k);
                    }
                }
                Ring { corners: Vec::new(), texture, triangle: ring.triangle }
            })
            .collect();
        own
    };
    rings.iter().flat_map(quads).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::{Attributes, BoundKind, quantise};
    use crate::num::VertexForm;

    type Point = [f64; 3];

    fn of(positions: &[Point], faces: &[&[u32]]) -> TriangleMesh {
        let (mut triangles, mut polygons, mut texture) = (Vec::new(), Vec::new(), Vec::new());
        for (face, number) in faces.iter().zip(0..) {
            for k in 1..face.len() - 1 {
                let triangle = [face[0], face[k], face[k + 1]];
                triangles.push(triangle);
                polygons.push(number);
                texture.push(triangle.map(|v| [v as f32, number as f32]));
            }
        }
        let attributes = Attributes { texture: &texture, polygons: &polygons, ..Attributes::default() };
        TriangleMesh::with_attributes(positions, &triangles, attributes, &[], vec![]).unwrap()
    }

    /// A cube of six quads.
    fn cube() -> TriangleMesh {
        let corner = |k: u32| std::array::from_fn(|axis| if k >> axis & 1 == 1 { 1.0 } else { -1.0 });
        let positions: Vec<Point> = (0..8).map(corner).collect();
        of(&positions, &[&[0, 4, 6, 2], &[1, 3, 7, 5], &[0, 1, 5, 4], &[2, 6, 7, 3], &[0, 2, 3, 1], &[4, 5, 7, 6]])
    }

    fn near(a: Point, b: Point) -> bool {
        (0..3).all(|k| (a[k] - b[k]).abs() < 1e-12)
    }

    #[test]
    fn corners_of_a_cube_go_to_their_limit() {
        let (surface, texture) = catmull_clark_surface(&cube(), 0).unwrap();
        assert_eq!((surface.triangles.len(), surface.base_vertices, texture.len()), (12, 8, 12));
        // n = 3: (9 v + 4 (sum of 3 neighbours) + (sum of 3 diagonals)) / 24, which is (9 + 4 - 3 ... ) of each coordinate: neighbours sum to 1, diagonals to -1.
        let limit = (9.0 + 4.0 - 1.0) / 24.0;
        assert!(surface.positions.iter().all(|p| near(p.map(f64::abs), [limit; 3])));
    }

    #[test]
    fn levels_hold_the_points_of_those_above() {
        let (coarse, _) = catmull_clark_surface(&cube(), 1).unwrap();
        let (fine, _) = catmull_clark_surface(&cube(), 3).unwrap();
        for tree in 0..coarse.triangles.len() {
            for j in 0..=2 {
                for i in 0..=2 - j {
                    let [a, b] = [coarse.tree(tree)[lattice::index(1, (i, j))], fine.tree(tree)[lattice::index(3, (4 * i, 4 * j))]];
                    assert!(near(a, b), "{a:?} {b:?}");
                }
            }
        }
        assert!(quantise(&fine, BoundKind::Largest, VertexForm::Exact, 0).is_ok());
        // Round on all sides, and turned outwards.
        for (p, n) in fine.positions.iter().zip(&fine.normals) {
            let [p, n] = [glam::DVec3::from_array(*p), glam::DVec3::from_array(n.map(f64::from))];
            assert!(p.normalize().dot(n) > 0.9 && p.length() > 0.8 && p.length() < 1.0, "{p} {n}");
        }
    }

    #[test]
    fn a_regular_net_is_a_bicubic_spline() {
        // Heights that are x^2: a uniform cubic B-spline with these controls is x^2 + 1/3 inside.
        let side = 7_u32;
        let positions: Vec<Point> =
            (0..side * side).map(|k| [f64::from(k % side), f64::from(k / side), f64::from(k % side).powi(2)]).collect();
        let quads: Vec<[u32; 4]> =
            (0..side - 1).flat_map(|y| (0..side - 1).map(move |x| y * side + x)).map(|v| [v, v + 1, v + side + 1, v + side]).collect();
        let faces: Vec<&[u32]> = quads.iter().map(<[u32; 4]>::as_slice).collect();
        let (surface, texture) = catmull_clark_surface(&of(&positions, &faces), 2).unwrap();
        let inside = |c: f64| (2.0..=4.0).contains(&c);
        let mut seen = 0;
        for p in surface.positions.iter().filter(|p| inside(p[0]) && inside(p[1])) {
            assert!((p[2] - p[0] * p[0] - 1.0 / 3.0).abs() < 1e-12, "{p:?}");
            seen += 1;
        }
        assert!(seen > 50);
        assert_eq!((texture.len(), texture[1]), (72, [[0.0, 0.0], [8.0, 0.0], [7.0, 0.0]]));
    }

    #[test]
    fn other_polygons_become_quads_first() {
        // A pyramid: a quad and four triangles.
        let positions = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
        let mesh = of(&positions, &[&[3, 2, 1, 0], &[0, 1, 4], &[1, 2, 4], &[2, 3, 4], &[3, 0, 4]]);
        let (surface, texture) = catmull_clark_surface(&mesh, 2).unwrap();
        assert_eq!((surface.triangles.len(), texture.len()), (32, 32));
        assert_eq!(surface.base_vertices, 5 + 8 + 5);
        assert!(quantise(&surface, BoundKind::Largest, VertexForm::Exact, 0).is_ok());
        for group in SharedPoints::new(&surface.triangles, 2).iter() {
            assert!(
                group
                    .iter()
                    .all(|&at| surface.positions[at] == surface.positions[group[0]] && surface.normals[at] == surface.normals[group[0]])
            );
        }
        // The first triangle's quads: its corner, halves, and the middle.
        assert_eq!(texture[8][0], [0.0, 1.0]);
        assert_eq!(texture[8][2], [5.0 / 3.0, 1.0]);
        assert_eq!(catmull_clark_surface(&mesh, 11).unwrap_err(), SubdivideError::Levels(11));
    }

    #[test]
    fn forks_and_borders_stay_curves() {
        // Three walls at one edge.
        let positions = [
            [0.0, 0.0, 0.0],
            [0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0],
            [1.0, 0.0, 1.0],
            [-1.0, 1.0, 0.0],
            [-1.0, 1.0, 1.0],
            [-1.0, -1.0, 0.0],
            [-1.0, -1.0, 1.0],
        ];
        let (surface, _) = catmull_clark_surface(&of(&positions, &[&[0, 2, 3, 1], &[0, 4, 5, 1], &[0, 6, 7, 1]]), 2).unwrap();
        assert!(quantise(&surface, BoundKind::Largest, VertexForm::Exact, 0).is_ok());
        let on = |p: &&Point| p[0].abs() < 1e-12 && p[1].abs() < 1e-12;
        // The edge is straight, and its normals differ from wall to wall.
        assert!(surface.positions.iter().filter(on).count() >= 15);
        let normals: Vec<_> =
            surface.positions.iter().zip(&surface.normals).filter(|(p, _)| on(p) && p[2] == 0.5).map(|(_, n)| *n).collect();
        assert!(normals.iter().any(|n| *n != normals[0]), "{normals:?}");
    }
}
