//! Loop surfaces against closed forms, against cases by hand and against a direct subdivision that shares nothing with the one that is tested.

use super::*;
use crate::mesh::{BoundKind, Hierarchy, quantise};
use crate::num::random::Random;
use crate::num::{MAX_LEVELS, VertexForm};
use std::collections::BTreeMap;

type Point = [f64; 3];

fn mesh(positions: &[Point], triangles: &[[u32; 3]]) -> TriangleMesh {
    TriangleMesh::from_parts(positions, triangles, &[], Vec::new()).unwrap()
}

fn octahedron() -> TriangleMesh {
    let positions = [[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, -1.0]];
    mesh(&positions, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1], [5, 2, 1], [5, 3, 2], [5, 4, 3], [5, 1, 4]])
}

fn tetrahedron() -> TriangleMesh {
    let positions = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
    mesh(&positions, &[[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
}

fn cube() -> TriangleMesh {
    let positions: Vec<Point> = (0..8).map(|v| [0, 1, 2].map(|k| f64::from((v >> k) & 1))).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<_> = faces.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    mesh(&positions, &triangles)
}

/// A bumpy sheet of 2 n^2 triangles with an open border.
fn sheet(n: u32, seed: u64) -> TriangleMesh {
    let mut random = Random::new(seed);
    let positions: Vec<Point> = (0..=n)
        .flat_map(|y| (0..=n).map(move |x| (x, y)))
        .map(|(x, y)| [x, y, 0].map(f64::from).map(|c| c + 0.3 * random.signed()))
        .collect();
    let triangles: Vec<_> = (0..n)
        .flat_map(|y| (0..n).map(move |x| y * (n + 1) + x))
        .flat_map(|a| [[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]])
        .collect();
    mesh(&positions, &triangles)
}

/// A sheet with fins on two of its inner edges, and two tetrahedra that touch it and each other in one vertex.
fn forked() -> TriangleMesh {
    let TriangleMesh { mut positions, mut triangles, .. } = sheet(4, 5);
    let first = positions.len() as u32;
    positions.extend([
        [1.5, 1.5, 2.0],
        [0.0, 0.0, 3.0],
        [1.0, 0.0, 4.0],
        [0.0, 1.0, 4.0],
        [5.0, 0.0, 3.0],
        [6.0, 1.0, 4.0],
        [2.5, 1.5, 2.0],
    ]);
    let [fin, a, b, c, d, e, other] = [0, 1, 2, 3, 4, 5, 6].map(|k| first + k);
    triangles.extend([[6, 7, fin], [7, 8, other]]);
    triangles.extend([[12, a, b], [12, b, c], [12, c, a], [a, c, b]]);
    triangles.extend([[a, d, e], [a, e, 0], [a, 0, d], [d, 0, e]]);
    mesh(&positions, &triangles)
}

fn near(a: Point, b: Point) -> bool {
    (0..3).all(|k| (a[k] - b[k]).abs() < 1e-12)
}

fn add_up(points: impl IntoIterator<Item = Point>) -> Point {
    points.into_iter().fold([0.0; 3], |sum, p| std::array::from_fn(|k| sum[k] + p[k]))
}

fn mix<const N: usize>(of: [(f64, Point); N]) -> Point {
    add_up(of.map(|(weight, p)| p.map(|c| weight * c)))
}

/// A mesh by lists of neighbours, subdivided once for all: every rule looks up what it needs.
#[derive(Clone)]
struct Direct {
    positions: Vec<Point>,
    triangles: Vec<[usize; 3]>,
}

impl Direct {
    fn new(mesh: &TriangleMesh) -> Self {
        Self { positions: mesh.positions.clone(), triangles: mesh.triangles.iter().map(|t| t.map(|v| v as usize)).collect() }
    }

    /// Of each edge the corners opposite to it.
    fn edges(&self) -> BTreeMap<[usize; 2], Vec<usize>> {
        let mut edges: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
        for &[a, b, c] in &self.triangles {
            for (a, b, c) in [(a, b, c), (b, c, a), (c, a, b)] {
                edges.entry([a.min(b), a.max(b)]).or_default().push(c);
            }
        }
        edges
    }

    /// All vertices moved: with `limit` to the limit, else as a split moves them.
    fn moved(&self, limit: bool) -> Vec<Point> {
        let mut neighbours: Vec<Vec<usize>> = vec![Vec::new(); self.positions.len()];
        let mut on_curves = neighbours.clone();
        for ([a, b], opposite) in self.edges() {
            for (v, w) in [(a, b), (b, a)] {
                neighbours[v].push(w);
                if opposite.len() != 2 {
                    on_curves[v].push(w);
                }
            }
        }
        let each = neighbours.iter().zip(&on_curves).enumerate().map(|(v, (around, along))| {
            let at = self.positions[v];
            let sum = |of: &[usize]| add_up(of.iter().map(|&w| self.positions[w]));
            match along.len() {
                0 if self.pieces_around(v) == 1 => {
                    let n = around.len() as f64;
                    let inside = 0.375 + 0.25 * (std::f64::consts::TAU / n).cos();
                    let beta = (0.625 - inside * inside) / n;
                    let weight = if limit { 1.0 / (n + 0.375 / beta) } else { beta };
                    mix([(1.0 - n * weight, at), (weight, sum(around))])
                }
                2 if limit => mix([(2.0 / 3.0, at), (1.0 / 6.0, sum(along))]),
                2 => mix([(0.75, at), (0.125, sum(along))]),
                _ => at,
            }
        });
        each.collect()
    }

    /// Into how many pieces the triangles around a vertex fall, joined across edges.
    fn pieces_around(&self, v: usize) -> usize {
        let own: Vec<[usize; 3]> = self.triangles.iter().copied().filter(|t| t.contains(&v)).collect();
        let mut piece: Vec<usize> = (0..own.len()).collect();
        for i in 0..own.len() {
            for j in 0..i {
                if own[i].iter().filter(|&&w| own[j].contains(&w)).count() == 2 {
                    let [from, to] = [piece[i], piece[j]];
                    piece.iter_mut().filter(|p| **p == from).for_each(|p| *p = to);
                }
            }
        }
        piece.sort_unstable();
        piece.dedup();
        piece.len()
    }

    fn split(&self) -> Self {
        let mut positions = self.moved(false);
        let mut middles = BTreeMap::new();
        for (ends, opposite) in self.edges() {
            let [a, b] = ends.map(|v| self.positions[v]);
            let middle = match opposite[..] {
                [c, d] => mix([(0.375, a), (0.375, b), (0.125, self.positions[c]), (0.125, self.positions[d])]),
                _ => mix([(0.5, a), (0.5, b)]),
            };
            middles.insert(ends, positions.len());
            positions.push(middle);
        }
        let middle = |a: usize, b: usize| middles[&[a.min(b), a.max(b)]];
        let mut triangles = Vec::new();
        for &[a, b, c] in &self.triangles {
            let [p, q, r] = [middle(b, c), middle(c, a), middle(a, b)];
            triangles.extend([[a, r, q], [r, b, p], [q, p, c], [p, q, r]]);
        }
        Self { positions, triangles }
    }
}

/// Where the surface of a mesh has the corners of finest triangle `node` of a tree.
fn finest(surface: &Surface, tree: usize, node: u32) -> [Point; 3] {
    let levels = surface.levels;
    lattice::node(levels, levels, node).map(|place| surface.tree(tree)[lattice::index(levels, place)])
}

#[test]
fn a_direct_subdivision_gives_the_same_points() {
    for (name, mesh) in
        [("octahedron", octahedron()), ("tetrahedron", tetrahedron()), ("cube", cube()), ("sheet", sheet(4, 1)), ("forked", forked())]
    {
        let mut direct = Direct::new(&mesh);
        for levels in 0..=3 {
            let surface = loop_surface(&mesh, levels).unwrap();
            let limit = direct.moved(true);
            for (number, triangle) in direct.triangles.iter().enumerate() {
                let (tree, node) = (number >> (2 * levels), number as u32 % (1 << (2 * levels)));
                let found = finest(&surface, tree, node);
                assert!((0..3).all(|k| near(found[k], limit[triangle[k]])), "{name}, level {levels}, triangle {number}: {found:?}");
            }
            direct = direct.split();
        }
    }
}

#[test]
fn limits_by_hand() {
    // Four neighbours in a plane around each vertex: chi = 31 / 220, so 1 - 4 chi = 24 / 55 of its place is left. Three, whose sum is the opposite of the vertex: chi = 1 / 5, so 1 / 5 is left.
    for (mesh, left) in [(octahedron(), 24.0 / 55.0), (tetrahedron(), 0.2)] {
        let surface = loop_surface(&mesh, 0).unwrap();
        for (tree, triangle) in mesh.triangles.iter().enumerate() {
            let wanted = triangle.map(|v| mesh.positions[v as usize].map(|c| left * c));
            assert!((0..3).all(|k| near(surface.tree(tree)[k], wanted[k])), "{:?}", surface.tree(tree));
            // Facets around a vertex are alike: their normals add up to one along it.
            let along = |k: usize| (0..3).all(|d| (f64::from(surface.normals[3 * tree + k][d]) - unit(wanted[k])[d] as f64).abs() < 1e-6);
            assert!((0..3).all(along), "{:?}", &surface.normals[3 * tree..][..3]);
        }
    }
}

/// Quartic box splines over a triangle of a regular net at barycentrics (a, b, c), times 12 (Stam, "Evaluation of Loop subdivision surfaces", 1998): of its own vertex at a;
fn own(a: f64, b: f64, c: f64) -> f64 {
    let terms = [
        (6.0, [4, 0, 0]),
        (24.0, [3, 1, 0]),
        (24.0, [3, 0, 1]),
        (24.0, [2, 2, 0]),
        (60.0, [2, 1, 1]),
        (24.0, [2, 0, 2]),
        (8.0, [1, 3, 0]),
        (36.0, [1, 2, 1]),
        (36.0, [1, 1, 2]),
        (8.0, [1, 0, 3]),
        (1.0, [0, 4, 0]),
        (6.0, [0, 3, 1]),
        (12.0, [0, 2, 2]),
        (6.0, [0, 1, 3]),
        (1.0, [0, 0, 4]),
    ];
    powers(&terms, [a, b, c])
}

/// of the vertex beyond its edge from a to b;
fn beyond(a: f64, b: f64, c: f64) -> f64 {
    let terms = [
        (1.0, [4, 0, 0]),
        (2.0, [3, 0, 1]),
        (6.0, [3, 1, 0]),
        (6.0, [2, 1, 1]),
        (12.0, [2, 2, 0]),
        (6.0, [1, 2, 1]),
        (6.0, [1, 3, 0]),
        (2.0, [0, 3, 1]),
        (1.0, [0, 4, 0]),
    ];
    powers(&terms, [a, b, c])
}

/// and of the vertex that is c mirrored at a.
fn mirrored(a: f64, b: f64) -> f64 {
    a.powi(4) + 2.0 * a.powi(3) * b
}

fn powers(terms: &[(f64, [i32; 3])], at: [f64; 3]) -> f64 {
    terms.iter().map(|&(by, powers)| by * (0..3).map(|k| at[k].powi(powers[k])).product::<f64>()).sum()
}

#[test]
fn a_regular_patch_is_the_box_spline() {
    let n = 5;
    let mesh = sheet(n, 2);
    let levels = 4;
    let surface = loop_surface(&mesh, levels).unwrap();
    // In the middle of the sheet.
    let corners = [[2, 2], [3, 2], [3, 3]];
    let vertex = |[x, y]: [i32; 2]| (y * (n as i32 + 1) + x) as usize;
    let tree = mesh.triangles.iter().position(|&t| t.map(|v| v as usize) == corners.map(vertex)).unwrap();
    let steps = 1 << levels;
    for (i, j) in (0..=steps).flat_map(|j| (0..=steps - j).map(move |i| (i, j))) {
        let at = [steps - i - j, i, j].map(|part| f64::from(part) / f64::from(steps));
        let (mut wanted, mut total) = ([0.0; 3], 0.0);
        let mut add = |weight: f64, place: [i32; 2]| {
            total += weight / 12.0;
            wanted = add_up([wanted, mesh.positions[vertex(place)].map(|c| weight / 12.0 * c)]);
        };
        for k in 0..3 {
            let [p, q, r] = [0, 1, 2].map(|d| corners[(k + d) % 3]);
            let [a, b, c] = [0, 1, 2].map(|d| at[(k + d) % 3]);
            let mirror = |of: [i32; 2]| [2 * p[0] - of[0], 2 * p[1] - of[1]];
            add(own(a, b, c), p);
            add(beyond(a, b, c), [p[0] + q[0] - r[0], p[1] + q[1] - r[1]]);
            add(mirrored(a, b), mirror(r));
            add(mirrored(a, c), mirror(q));
        }
        assert!((total - 1.0).abs() < 1e-12);
        let found = surface.tree(tree)[lattice::index(levels, (i, j))];
        assert!(near(found, wanted), "({i}, {j}): {found:?}, not {wanted:?}");
    }
}

#[test]
fn a_border_is_the_spline_of_its_own_vertices() {
    let (n, levels) = (4, 3);
    let mesh = sheet(n, 3);
    let mut other = sheet(n, 4);
    // The same border around another inside.
    let is_inside = |v: usize| (1..n).contains(&(v as u32 % (n + 1))) && (1..n).contains(&(v as u32 / (n + 1)));
    (0..mesh.positions.len()).filter(|&v| !is_inside(v)).for_each(|v| other.positions[v] = mesh.positions[v]);
    let surfaces = [&mesh, &other].map(|mesh| loop_surface(mesh, levels).unwrap());
    let mut differ = false;
    for (tree, triangle) in mesh.triangles.iter().enumerate() {
        for k in 0..=1 << levels {
            // Along the lower border trees run from p0 to p1.
            let [found, again] = [0, 1].map(|of| surfaces[of].tree(tree)[lattice::index(levels, (k, 0))]);
            if triangle[..2].iter().all(|&v| v <= n) {
                assert_eq!(found, again, "tree {tree}, place {k}");
            } else {
                differ |= found != again;
            }
            if triangle[0] == 1 && triangle[1] == 2 {
                let control = [0, 1, 2, 3].map(|v| mesh.positions[v]);
                let t = f64::from(k) / 8.0;
                let s = 1.0 - t;
                let basis = [s * s * s, 3.0 * t * t * t - 6.0 * t * t + 4.0, 3.0 * s * s * s - 6.0 * s * s + 4.0, t * t * t];
                let wanted = mix([0, 1, 2, 3].map(|v| (basis[v] / 6.0, control[v])));
                assert!(near(found, wanted), "place {k}: {found:?}, not {wanted:?}");
            }
        }
    }
    assert!(differ, "the insides are the same");
}

#[test]
fn levels_are_samples_of_one_surface() {
    for mesh in [cube(), sheet(3, 6), forked()] {
        let [coarse, fine] = [2, 4].map(|levels| loop_surface(&mesh, levels).unwrap());
        for tree in 0..mesh.triangles.len() {
            for (i, j) in (0..=4).flat_map(|j| (0..=4 - j).map(move |i| (i, j))) {
                let (a, b) = (coarse.tree(tree)[lattice::index(2, (i, j))], fine.tree(tree)[lattice::index(4, (4 * i, 4 * j))]);
                assert!(near(a, b), "tree {tree}, ({i}, {j}): {a:?} and {b:?}");
            }
        }
    }
}

#[test]
fn finer_nets_of_a_sphere_come_nearer_to_it() {
    let unit_length = |p: Point| p.map(|c| c / p.iter().map(|c| c * c).sum::<f64>().sqrt());
    let mut net = Direct::new(&octahedron());
    let mut furthest = Vec::new();
    for _ in 0..4 {
        net = net.split();
        net.positions = net.positions.iter().map(|&p| unit_length(p)).collect();
        let triangles: Vec<_> = net.triangles.iter().map(|t| t.map(|v| v as u32)).collect();
        let surface = loop_surface(&mesh(&net.positions, &triangles), 2).unwrap();
        furthest.push(surface.positions.iter().map(|p| (p.iter().map(|c| c * c).sum::<f64>().sqrt() - 1.0).abs()).fold(0.0, f64::max));
        // Normals point outwards, along the positions.
        let turned =
            surface.positions.iter().zip(&surface.normals).map(|(p, n)| (0..3).map(|k| unit_length(*p)[k] * f64::from(n[k])).sum::<f64>());
        assert!(turned.fold(1.0, f64::min) > 0.95);
    }
    // Splines that use points as weights fall short by the square of the edges.
    assert!(furthest.windows(2).all(|two| (3.0..5.0).contains(&(two[0] / two[1]))), "{furthest:?}");
}

#[test]
fn the_same_at_any_number_of_threads_and_fit_to_be_stored() {
    let mesh = forked();
    let make = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let surface = loop_surface(&mesh, 3).unwrap();
            let hierarchy = quantise(&surface, BoundKind::Total, VertexForm::Exact, 0).unwrap();
            (surface.positions, surface.normals, hierarchy.points, hierarchy.bounds)
        })
    };
    let first = make(1);
    assert!(first.2.len() == lattice::len(3) * mesh.triangles.len());
    for threads in [2, 3] {
        let again = make(threads);
        assert!((&again.0, &again.1, &again.2) == (&first.0, &first.1, &first.2) && again.3.codes == first.3.codes, "{threads} threads");
    }
}

#[test]
fn every_vertex_but_fixed_ones_moves_and_the_finest_level_is_displaced() {
    let surface = loop_surface(&cube(), 3).unwrap();
    let hierarchy: Hierarchy = quantise(&surface, BoundKind::Largest, VertexForm::Exact, 0).unwrap();
    assert!((0..surface.triangles.len()).all(|tree| hierarchy.depth(tree) == 3));
    // Where fans touch, and where fins meet, vertices stay.
    let mesh = forked();
    let surface = loop_surface(&mesh, 0).unwrap();
    for (tree, triangle) in mesh.triangles.iter().enumerate() {
        for (k, &v) in triangle.iter().enumerate() {
            let stays = [7, 12, 26].contains(&v);
            assert_eq!(surface.tree(tree)[k] == mesh.positions[v as usize], stays, "vertex {v}");
        }
    }
}

#[test]
fn colours_are_kept_and_what_is_too_large_is_refused() {
    let octahedron = octahedron();
    let materials = [0, 1, 0, 1, 0, 1, 0, 1];
    let mesh = TriangleMesh::from_parts(&octahedron.positions, &octahedron.triangles, &materials, vec![[1.0; 3], [0.5; 3]]).unwrap();
    let surface = loop_surface(&mesh, 1).unwrap();
    assert!(surface.materials == materials && surface.colours.len() == 2 && surface.triangles == mesh.triangles);
    assert_eq!(loop_surface(&mesh, MAX_LEVELS + 1).unwrap_err(), SubdivideError::Levels(MAX_LEVELS + 1));
    assert_eq!(check_subdivision(1 << 11, 10), Err(SubdivideError::Triangles { triangles: 1 << 11, levels: 10 }));
    assert_eq!(check_subdivision(1 << 10, 10), Ok(()));
}
