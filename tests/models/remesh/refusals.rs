//! What is refused, and what the refusal advises.

use super::{cube, mesh, remesh_quietly, sphere};
use lodray::mesh::{RemeshError, RemeshOptions, TriangleMesh};
use lodray_test_support::thin;

#[test]
fn wrong_requests_are_refused() {
    let original = cube(2);
    let ask = |levels, base_triangles| {
        remesh_quietly(&original, RemeshOptions { levels: Some(levels), base_triangles, ..RemeshOptions::default() })
            .map(|_| ())
            .unwrap_err()
    };
    assert_eq!(ask(11, None), RemeshError::Levels { levels: 11 });
    assert_eq!(ask(1, Some(0)), RemeshError::NoBase);
    let big = remesh_quietly(&sphere(20), RemeshOptions { levels: Some(10), base_triangles: Some(4000), ..RemeshOptions::default() })
        .map(|_| ())
        .unwrap_err();
    let RemeshError::TooMany { levels: 10, base, works, .. } = big.clone() else { panic!("{big}") };
    assert_eq!((works.levels, works.base, works.error), (Some(7), Some(64), false), "{base} base triangles");
    assert!(base << 14 <= 1 << 26 && base << 16 > 1 << 26, "{base}");
    assert!(
        big.to_string().contains("--levels 7") && big.to_string().contains("--base 64") && !big.to_string().contains("max-error"),
        "{big}"
    );
    let options = RemeshOptions { levels: Some(0), ..RemeshOptions::default() };
    let refuse = |mesh: &TriangleMesh| assert!(matches!(remesh_quietly(mesh, options), Err(RemeshError::BadMesh { .. })));
    refuse(&TriangleMesh::default());
    let mut bad = original.clone();
    bad.triangles[0][0] = 999;
    refuse(&bad);
    bad = original.clone();
    bad.positions[0][0] = f64::NAN;
    refuse(&bad);
    bad = original.clone();
    bad.materials = vec![0];
    refuse(&bad);
}

#[test]
fn levels_that_leave_no_room_for_the_base_are_refused_with_those_that_do() {
    let (_, original) = thin::shapes().into_iter().find(|s| s.0 == "claw").unwrap();
    let ask = |levels| remesh_quietly(&original, RemeshOptions { levels: Some(levels), ..RemeshOptions::default() }).map(|r| r.1);
    let Err(refusal @ RemeshError::NeedsBase { base, levels: 10, works }) = ask(10) else { panic!("no refusal") };
    let levels = works.levels.unwrap();
    assert!(
        (4u64..10).contains(&levels.into()) && base << (2 * levels) <= 1 << 26 && base << (2 * levels + 2) > 1 << 26,
        "{base} {levels}"
    );
    let message = refusal.to_string();
    assert!(message.contains(&format!("--levels {levels}")), "{message}");
}

#[test]
fn a_base_is_advised_only_where_removal_comes_that_far() {
    // Fifty tetrahedra, of which none can go: at ten levels there is room for 64 triangles.
    let corner = |k: usize, c: usize| std::array::from_fn(|a| (3 * k) as f64 + f64::from(u8::from(a + 1 == c)));
    let positions: Vec<[f64; 3]> = (0..50).flat_map(|k| (0..4).map(move |c| corner(k, c))).collect();
    let faces = |k: u32| [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|t| t.map(|v| 4 * k + v));
    let original = mesh(&positions, &(0..50).flat_map(faces).collect::<Vec<_>>());
    for base_triangles in [None, Some(10)] {
        let options = RemeshOptions { levels: Some(10), base_triangles, ..RemeshOptions::default() };
        let refusal = remesh_quietly(&original, options).map(|_| ()).unwrap_err();
        let (RemeshError::TooMany { works, .. } | RemeshError::NeedsBase { works, .. }) = &refusal else { panic!("{refusal}") };
        assert_eq!((works.levels, works.base, works.error), (Some(9), None, false), "{refusal}");
        assert!(refusal.to_string().ends_with("; there is room with --levels 9 at most"), "{refusal}");
    }
}

#[test]
fn what_rounding_to_the_grid_takes_is_refused_and_no_more() {
    let original = cube(2);
    for levels in [0, 3, 8, 10] {
        let ask = |max_error| {
            remesh_quietly(&original, RemeshOptions { levels: Some(levels), max_error, base_triangles: Some(48), ..Default::default() })
        };
        let Err(refusal @ RemeshError::Grid { wanted, least, .. }) = ask(1e-7) else { panic!("no refusal") };
        assert!(wanted < least && least < 1e-4 && refusal.to_string().contains(&format!("--max-error of {least} or more")), "{refusal}");
        assert!(ask(0.99 * least).is_err());
        if levels < 10 {
            // All of its triangles are kept.
            assert_eq!(ask(least).unwrap().1.warning, None, "{levels} levels");
        }
    }
}
