//! What is kept of a shape: shared borders, sharp edges, holes, materials and normals; the same bytes at any size and number of threads.

use super::{cube, cube_point, distance_to_triangle, fit, grids, mesh, remesh_quietly, run, sphere, wave};
use lodray::mesh::{RemeshOptions, RemeshReport, Surface, TriangleMesh, lattice};
use std::collections::HashMap;

#[test]
fn a_sphere_becomes_a_finer_sphere() {
    let original = sphere(24);
    let (surface, report) = run(&original, 4, 100);
    assert!((80..=125).contains(&report.base_triangles), "{report:?}");
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0), "{report:?}");
    assert_eq!((report.on_feature_lines, report.midpoints_kept), (0, 0), "{report:?}");
    let d = report.distance;
    assert!(d.to_original.mean < 0.005 && d.to_original.found < 0.1 && d.from_original.mean < 0.05 && d.from_original.found < 0.3, "{d:?}");
    for (p, n) in surface.positions.iter().zip(&surface.normals) {
        let dot: f64 = (0..3).map(|k| p[k] * f64::from(n[k])).sum();
        assert!(dot > 0.98, "the normal {n:?} at {p:?} leans");
    }
}

#[test]
fn a_cube_keeps_its_corners_and_edges() {
    let (surface, report) = run(&cube(12), 4, 12);
    assert!(report.base_triangles <= 15, "{report:?}");
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0));
    let d = report.distance;
    assert!(d.to_original.found < 1e-9 && d.from_original.found < 1e-9 && d.to_original.max < 0.2 && d.from_original.max < 0.2, "{d:?}");
    // On every face the normals are those of the face, up to its very edge.
    for t in 0..surface.triangles.len() {
        let [a, b, c] = lattice::root(4).map(|p| surface.tree(t)[lattice::index(4, p)]);
        let axis = (0..3).find(|&k| a[k] == b[k] && b[k] == c[k] && a[k].abs() == 1.0).expect("a triangle across an edge");
        let len = lattice::len(4);
        for n in &surface.normals[t * len..][..len] {
            assert!((f64::from(n[axis]) - a[axis]).abs() < 1e-6, "{n:?} on the face {axis} at {}", a[axis]);
        }
    }
}

#[test]
fn a_border_keeps_its_outline() {
    // A square with a round hole.
    let original = grids(4, 16, |face, u, v| {
        let angle = (face as f64 + u) * std::f64::consts::FRAC_PI_2;
        let snap = |x: f64| (x * 1e9).round() / 1e9;
        let (x, y) = (snap(angle.cos()), snap(angle.sin()));
        let outer = 2.0 / x.abs().max(y.abs());
        let r = 1.0 + v * (outer - 1.0);
        [snap(x * r), snap(-y * r), 0.0]
    });
    assert_eq!(original.report.border_edges, 128);
    let (surface, report) = run(&original, 4, 60);
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0), "{report:?}");
    assert!(report.on_feature_lines > 0);
    assert!(report.distance.from_original.max < 0.3, "{report:?}");
    for p in &surface.positions {
        let (r, side) = (p[0].hypot(p[1]), p[0].abs().max(p[1].abs()));
        assert!(r > 0.995 && side < 2.0 + 1e-9 && p[2] == 0.0, "{p:?} is outside the outline");
    }
}

#[test]
fn an_open_surface_is_followed_closely() {
    let (_, report) = run(&wave(32), 3, 64);
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0), "{report:?}");
    assert!(report.distance.to_original.mean < 0.01 && report.distance.from_original.mean < 0.01, "{report:?}");
}

#[test]
fn a_non_manifold_edge_has_one_vertex_for_all_its_triangles() {
    // Five pages of a book, each a grid, on one spine.
    let original = grids(5, 8, |page, u, v| {
        let angle = page as f64;
        [u * angle.cos(), u * angle.sin(), v]
    });
    assert_eq!(original.report.non_manifold_edges, 8);
    let (surface, report) = run(&original, 3, 10);
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0), "{report:?}");
    assert!(report.distance.from_original.found < 1e-6, "{report:?}");
    let mut pages = HashMap::new();
    for t in &surface.triangles {
        (0..3).for_each(|k| *pages.entry((t[k].min(t[(k + 1) % 3]), t[k].max(t[(k + 1) % 3]))).or_insert(0) += 1);
    }
    assert!(pages.values().any(|&n| n == 5));
}

#[test]
fn no_levels_and_all_triangles_give_the_original() {
    let original = sphere(4);
    let (surface, report) = run(&original, 0, usize::MAX);
    assert_eq!(surface.triangles.len(), original.triangles.len());
    let corners = |t: usize| original.triangles[t].map(|v| original.positions[v as usize]);
    for t in 0..surface.triangles.len() {
        assert_eq!(surface.tree(t), [corners(t)[0], corners(t)[1], corners(t)[2]]);
    }
    assert!(report.distance.from_original.found < 1e-9);
    assert_eq!(report.own_base_triangles, original.triangles.len());
}

#[test]
fn ten_levels_of_a_tiny_mesh() {
    let tetrahedron =
        mesh(&[[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], &[[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]);
    let (_, report) = run(&tetrahedron, 6, 4);
    assert_eq!(report.finest_triangles, 4 << 12);
    assert_eq!((report.flipped_triangles, report.degenerate_triangles), (0, 0), "{report:?}");
    assert!(report.distance.to_original.found < 1e-9 && report.distance.from_original.found < 1e-9);
    let (_, report) = run(&mesh(&[[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]], &[[0, 1, 2]]), 10, 1);
    assert_eq!(report.finest_triangles, 1 << 20);
}

#[test]
fn size_and_place_do_not_matter() {
    let original = sphere(12);
    let (unit, report) = run(&original, 2, 100);
    for exponent in [-100, 100] {
        let scale = 2f64.powi(exponent);
        let scaled: Vec<[f64; 3]> = original.positions.iter().map(|p| p.map(|v| v * scale)).collect();
        let (surface, scaled_report) = run(&mesh(&scaled, &original.triangles), 2, 100);
        // But for the place that a warning names.
        assert_eq!(RemeshReport { warning: None, ..scaled_report }, RemeshReport { warning: None, ..report.clone() });
        assert!(surface.positions.iter().zip(&unit.positions).all(|(a, b)| *a == b.map(|v| v * scale)));
    }
}

#[test]
fn any_number_of_threads_gives_the_same_bytes() {
    let original = wave(24);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let (s, r) =
                remesh_quietly(&original, RemeshOptions { levels: Some(3), base_triangles: Some(50), ..RemeshOptions::default() }).unwrap();
            (s.positions, s.normals, s.triangles, r)
        })
    };
    assert!(with(1) == with(4));
}

#[test]
fn materials_follow_their_triangles() {
    let plain = cube(6);
    let materials: Vec<u16> = (0..plain.triangles.len()).map(|t| (t / 72) as u16).collect();
    let colours: Vec<[f32; 3]> = (0..6).map(|k| [k as f32 / 5.0; 3]).collect();
    let original = TriangleMesh::from_parts(&plain.positions, &plain.triangles, &materials, colours.clone()).unwrap();
    let (surface, _) = run(&original, 1, 12);
    assert_eq!((surface.materials.len(), surface.colours.clone()), (surface.triangles.len(), colours));
    for (t, &material) in surface.materials.iter().enumerate() {
        let centre = lattice::root(1).map(|p| surface.tree(t)[lattice::index(1, p)]);
        let face = (0..6).find(|&f| {
            let q = cube_point(f, 0.5, 0.5);
            let axis = q.iter().position(|v| v.abs() == 1.0).unwrap();
            centre.iter().all(|p| p[axis] == q[axis])
        });
        assert_eq!(face, Some(material as usize));
    }
}

#[test]
fn a_border_between_materials_stays_where_it_is() {
    // A ball of two colours, which meet in a wave.
    let plain = sphere(24);
    let upper = |t: &[u32; 3]| {
        let middle: [f64; 3] = std::array::from_fn(|k| t.iter().map(|&v| plain.positions[v as usize][k]).sum());
        middle[2] > 0.6 * (3.0 * middle[1].atan2(middle[0])).sin()
    };
    let materials: Vec<u16> = plain.triangles.iter().map(|t| upper(t).into()).collect();
    let original =
        TriangleMesh::from_parts(&plain.positions, &plain.triangles, &materials, vec![[1.0, 0.0, 0.0], [0.0, 0.0, 1.0]]).unwrap();
    let (surface, report) = fit(&original, RemeshOptions { levels: Some(4), ..RemeshOptions::default() });
    assert!(report.base_triangles < original.triangles.len() / 4, "{report:?}");
    // Every finest triangle lies where the original has its colour.
    let at = |t: &[u32; 3]| t.map(|v| original.positions[v as usize]);
    for t in 0..surface.triangles.len() {
        for n in (0..256).step_by(37) {
            let c = lattice::node(4, 4, n).map(|p| surface.tree(t)[lattice::index(4, p)]);
            let middle = std::array::from_fn(|k| (c[0][k] + c[1][k] + c[2][k]) / 3.0);
            let near = |m: u16| {
                let all = original.triangles.iter().zip(&original.materials).filter(|x| *x.1 == m);
                all.map(|(tri, _)| distance_to_triangle(middle, &at(tri))).fold(f64::INFINITY, f64::min)
            };
            assert!(near(surface.materials[t]) < 0.01, "tree {t}: its colour is {} away", near(surface.materials[t]));
        }
    }
}

#[test]
fn normals_are_those_of_the_points_that_vertices_stand_for() {
    // Eight sides bend by 45 degrees: round below that angle, faceted above.
    let drum = grids(8, 4, |face, u, v| {
        let [(s0, c0), (s1, c1)] = [face, face + 1].map(|f| (std::f64::consts::FRAC_PI_4 * f as f64).sin_cos());
        let snap = |x: f64| (x * 1e9).round() / 1e9;
        [snap(c0 + (c1 - c0) * u), snap(s0 + (s1 - s0) * u), v]
    });
    let off_axis = |s: &Surface| {
        let far = s.positions.iter().zip(&s.normals).map(|(p, n)| {
            let r = p[0].hypot(p[1]);
            1.0 - (p[0] * f64::from(n[0]) + p[1] * f64::from(n[1])) / r
        });
        far.fold(0.0f64, f64::max)
    };
    let options = |crease_angle| RemeshOptions { levels: Some(3), crease_angle, ..RemeshOptions::default() };
    let (round, _) = fit(&drum, options(50.0));
    let (faceted, _) = fit(&drum, options(40.0));
    // The vertices of the original inside a side have that side's normal, a quarter of 45 degrees from round.
    assert!(off_axis(&round) < 0.021, "{}", off_axis(&round));
    assert!((off_axis(&faceted) - (1.0 - (std::f64::consts::PI / 8.0).cos())).abs() < 0.003, "{}", off_axis(&faceted));
    // A mesh's own normals win, whatever they say.
    let mut own = drum;
    own.normals = vec![[[0.0, 0.6, 0.8]; 3]; own.triangles.len()];
    let (surface, _) = fit(&own, options(40.0));
    assert!(surface.normals.iter().all(|n| (n[1] - 0.6).abs() < 1e-6 && (n[2] - 0.8).abs() < 1e-6));
}

#[test]
fn ugly_meshes_do_no_harm() {
    // Slivers, points that touch, spikes, and a triangle on both sides.
    let mut positions = vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.5, 1e-14, 0.0], [0.5, 1.0, 0.0], [0.5, 0.5, 1e6], [0.5, 0.5, -1e-9]];
    positions.extend((0..40).map(|i| [f64::from(i * i % 17), f64::from(i * 7 % 13), f64::from(i * 5 % 11)]));
    let mut triangles = vec![[0, 1, 2], [0, 2, 3], [2, 1, 3], [0, 3, 4], [3, 1, 4], [0, 1, 5], [0, 5, 3]];
    triangles.extend((6..44u32).map(|i| [i, i + 1, i + 2]));
    triangles.extend((6..30u32).map(|i| [i, i + 7, i + 15]));
    let original = mesh(&positions, &triangles);
    for base in [1, 10, 30, 1000] {
        for levels in [0, 1, 4] {
            run(&original, levels, base);
        }
    }
}
