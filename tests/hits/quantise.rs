//! Surfaces to integers: any finite extent fits, and what does not fit is refused by name.

use lodray::mesh::{BoundKind, Surface, lattice, quantise};
use lodray::num::{COORD_LIMIT, VertexForm, snap};
use lodray_test_support::surfaces::{bumps, grid, surface};

const QUAD: [[f64; 3]; 4] = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 1.0, 0.0]];

#[test]
fn points_are_snapped_to_their_grid_without_clamping() {
    for (size, origin) in [(1.0, 0.0), (1e-30, 0.0), (1e30, 0.0), (1.0, 1e9), (1e-3, -1e12), (1e308, 0.0), (1e-290, 0.0)] {
        let s = surface(4, &QUAD, &[[0, 1, 2], [3, 2, 1]], |p| bumps(p).map(|c| c * size + origin));
        let h = quantise(&s, BoundKind::Largest, VertexForm::Exact, 0).unwrap();
        let largest = h.points.iter().flatten().map(|c| c.unsigned_abs()).max().unwrap();
        assert!(largest <= COORD_LIMIT as u32 && largest > COORD_LIMIT as u32 / 2, "{size} {origin}: {largest}");
        for (at, (point, position)) in h.points.iter().zip(&s.positions).enumerate() {
            let local = at % lattice::len(4);
            let (j, i) = (0..=16).flat_map(|j| (0..=16 - j).map(move |i| (j, i))).nth(local).unwrap();
            let bits = 4 - lattice::level_of(4, (i, j));
            for k in 0..3 {
                let v = (position[k] - h.placement.offset[k]) / h.placement.scale;
                assert!(v.abs() <= f64::from(COORD_LIMIT));
                assert_eq!(point[k], snap(v, bits));
            }
        }
    }
}

#[test]
fn flat_and_single_point_models_work() {
    let flat = quantise(&surface(3, &QUAD, &[[0, 1, 2], [3, 2, 1]], |p| p), BoundKind::Largest, VertexForm::Exact, 0).unwrap();
    assert!(flat.bounds.codes.iter().all(|&c| c == 0) && flat.bounds.scale.offset.get() == 0);
    let point = quantise(&surface(3, &[[7.0, -2.0, 1e6]; 3], &[[0, 1, 2]], |p| p), BoundKind::Largest, VertexForm::Exact, 0).unwrap();
    assert!(point.points.iter().all(|p| *p == [0; 3]) && point.placement.scale > 0.0);
    assert_eq!(point.to_world([0; 3]), [7.0, -2.0, 1e6]);
}

#[test]
fn what_does_not_fit_is_refused_by_name() {
    let refused = |word: &str, f: &dyn Fn(&mut Surface)| {
        let mut s = grid(3, 2);
        f(&mut s);
        let message = quantise(&s, BoundKind::Largest, VertexForm::Exact, 0).unwrap_err().to_string();
        assert!(message.contains(word), "{message}");
    };
    refused("no triangles", &|s| *s = Surface::default());
    refused("levels", &|s| s.levels = 11);
    refused("positions", &|s| s.positions[50][1] = f64::NAN);
    refused("positions", &|s| s.positions[50][1] = f64::INFINITY);
    refused("extent", &|s| s.positions.iter_mut().for_each(|p| *p = p.map(|c| c * 1e-310)));
    refused("positions: 359 entries, 360", &|s| s.positions.truncate(s.positions.len() - 1));
    refused("normals", &|s| s.normals.truncate(s.normals.len() - 1));
    refused("materials", &|s| s.materials.truncate(s.materials.len() - 1));
    refused("material 7", &|s| s.materials[1] = 7);
    refused("base triangle 2", &|s| s.triangles[2] = [1, 2, 1]);
    refused("base triangle 2", &|s| s.triangles[2] = [1, 2, 9]);
    refused("disagree on point", &|s| s.positions[lattice::index(3, (0, 4))][2] += 0.01);
    refused("base vertex", &|s| s.positions[8][2] += 0.01);
    let mut s = grid(3, 2);
    s.normals[7] = [0.0; 3];
    let message = lodray::format::build(&s, lodray_test_support::surfaces::info("test"), |boxes| {
        Ok::<_, String>(lodray_test_support::surfaces::quad_tree(boxes))
    })
    .unwrap_err()
    .to_string();
    assert!(message.contains("normals: entry 7"), "{message}");
}
