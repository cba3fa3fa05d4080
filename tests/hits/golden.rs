//! The golden traverser and the reference against themselves, each other, and cases worked out by hand.

use lodray::{
    golden::{Crossings, Exact, ExactHit, Reference, true_bounds},
    mesh::{EdgeCodes, Hierarchy, Placement},
    num::{Cone, Ray, U, VertexForm},
};
use lodray_test_support::models::*;

const HALF: u32 = 1 << 30;

/// Two models in six have vertices of each form.
fn any_form(seed: u64, h: Hierarchy) -> Hierarchy {
    with_vertices(VertexForm::ALL[(seed / 2 % 3) as usize], h)
}

fn length(d: [i64; 3]) -> f64 {
    d.iter().map(|&v| (v as f64).powi(2)).sum::<f64>().sqrt()
}

fn single_triangle() -> Hierarchy {
    Hierarchy {
        levels: 0,
        placement: Placement { offset: [0.0; 3], scale: 1.0 },
        base_vertices: 3,
        triangles: vec![[0, 1, 2]],
        points: vec![[0, 0, 0], [1 << 20, 0, 0], [0, 1 << 20, 0]],
        bounds: EdgeCodes::default(),
        vertices: VertexForm::Exact,
        zeros: 0,
    }
}

#[test]
fn a_single_triangle_by_hand() {
    let h = single_triangle();
    let down = |x, y| ray([x, y, 1 << 28], [0, 0, -(1 << 29)], Cone::default());
    let hit = Exact::new(&h).trace(&down(1 << 18, 1 << 19));
    let bary = [1 << 29, 1 << 29, 1 << 30];
    assert_eq!(hit, Some(ExactHit { t: 1 << 31, tree: 0, level: 0, node: 0, bary, full_node: 0, full_bary: bary, front: true }));
    // Perturbed towards +x, then +y: the edges x = 0 and y = 0 belong to the triangle, the slanted one does not.
    for (x, y, inside) in [(0, 5, true), (5, 0, true), (1 << 19, 1 << 19, false), (0, 0, true), (1 << 20, 0, false), (0, 1 << 20, false)] {
        for exact in [Exact::new(&h), Exact::without_culling(&h)] {
            assert_eq!(exact.trace(&down(x, y)).is_some(), inside, "{x} {y}");
        }
    }
    // From below: seen along the normal; a third of the length is rounded down.
    let up = Exact::new(&h).trace(&ray([1, 1, -(1 << 20)], [0, 0, 3 << 20], Cone::default())).unwrap();
    assert_eq!((up.t, up.front), ((1 << 32) / 3, false));
    // In the plane, and pointing away.
    assert_eq!(Exact::new(&h).trace(&ray([-5, 5, 0], [1 << 29, 0, 0], Cone::default())), None);
    assert_eq!(Exact::new(&h).trace(&ray([5, 5, 5], [0, 0, 1 << 29], Cone::default())), None);
}

/// One split of a right triangle; all inserted vertices lifted by 2^24 units, which code 255 means exactly.
fn lifted() -> (Hierarchy, i64) {
    let lift = 1 << 24;
    let h = model(1, &[[0, 0, 0], [1, 0, 0], [0, 1, 0]], vec![[0, 1, 2]], |p, level| {
        [(p[0] << 27) as f64, (p[1] << 27) as f64, f64::from(lift) * f64::from(level)]
    });
    (h, i64::from(lift))
}

#[test]
fn half_way_between_two_levels_by_hand() {
    let (h, lift) = lifted();
    assert_eq!(true_bounds(&h).edges, vec![lift as u64; 3]);
    assert!(h.bounds.codes.iter().all(|&c| c == 255));
    let exact = Exact::new(&h);
    let down = |tolerated: i64| {
        let cone = Cone { offset: U::new(tolerated as u64), slope: U::ZERO, shift: U::ZERO };
        ray([90_000_000, 90_000_000, lift * 2], [0, 0, -lift], cone)
    };
    let height = |tolerated| (2 << 32) - exact.trace(&down(tolerated)).unwrap().t;
    // s = (h - D) 256 / D: 0 at D = h, 128 at D = 2h / 3 (rounded down), 256 at D = h / 2.
    assert_eq!(height(lift), 0);
    assert_eq!(height(lift / 3 * 2), 1 << 31);
    assert_eq!(height(lift / 2), 1 << 32);
    assert_eq!(height(0), 1 << 32);
    let served = exact.surface(&down(lift / 3 * 2));
    assert_eq!(served.iter().map(|s| (s.level, s.node)).collect::<Vec<_>>(), [(1, 0), (1, 1), (1, 2), (1, 3)]);
    let m = 1 << 27;
    assert_eq!(served[3].corners, [[m, m, lift / 2], [0, m, lift / 2], [m, 0, lift / 2]]);
    assert_eq!(served[1].corners, [[m, 0, lift / 2], [2 * m, 0, 0], [m, m, lift / 2]]);
}

#[test]
fn an_origin_on_the_surface_is_told() {
    let (h, lift) = lifted();
    let exact = Exact::new(&h);
    let starts = |origin| exact.starts_on_surface(&ray(origin, [0, 0, 1 << 29], Cone::default()));
    // A corner of one triangle of four, a vertex of three, and beside them.
    assert!(starts([0; 3]) && starts([1 << 27, 0, lift]));
    assert!(!starts([0, 0, 1]) && !starts([1 << 27, 0, lift - 1]) && !starts([-1, 0, 0]));
}

#[test]
fn coarse_hits_are_mapped_and_halves_go_to_the_centre() {
    let (h, lift) = lifted();
    let exact = Exact::new(&h);
    let coarse = Cone { offset: U::new(lift as u64), slope: U::ZERO, shift: U::ZERO };
    let at = |x: i64, y: i64| exact.trace(&ray([x, y, 1 << 29], [0, 0, -(1 << 29)], coarse)).unwrap();
    // b1 = x / 2^28: exactly half, then just above (2^31 / 2^28 = 8 steps).
    let hit = at(1 << 27, 1 << 26);
    assert_eq!((hit.level, hit.bary), (0, [1 << 29, HALF, 1 << 29]));
    assert_eq!((hit.full_node, hit.full_bary), (3, [HALF, 0, HALF]));
    let hit = at((1 << 27) + 1, 1 << 26);
    assert_eq!((hit.full_node, hit.full_bary), (1, [HALF - 16, 16, HALF]));
    let hit = at(0, 1 << 27);
    assert_eq!((hit.bary, hit.full_node, hit.full_bary), ([HALF, 0, HALF], 3, [0, 1 << 31, 0]));
    assert_eq!(at(16, 16).full_node, 0);
}

/// A mixture of rays around a ball: through the middle, through vertices of the base, along axes.
fn ball_ray(h: &Hierarchy, rng: &mut Rng) -> Ray {
    let d = match rng.below(4) {
        0 => {
            let mut d = [0; 3];
            d[rng.below(3) as usize] = if rng.below(2) == 0 { (1 << 30) - 1 } else { 1 - (1 << 30) };
            d
        }
        1 => {
            let mut d = direction(rng);
            d[rng.below(3) as usize] = 0;
            let n = length(d);
            d.map(|v| (v as f64 / n * f64::from((1 << 30) - 1)).round() as i64)
        }
        _ => direction(rng),
    };
    let p = if rng.below(3) == 0 {
        h.points[rng.below(h.points.len() as u64) as usize].map(i64::from)
    } else {
        [(); 3].map(|()| (rng.signed() * f64::from(1 << 28)) as i64)
    };
    // Not quite as far as the limit; a smaller step starts some rays inside.
    let back = if rng.below(4) == 0 { 5 } else { 1 };
    let origin = std::array::from_fn(|k| (p[k] - d[k] / back).clamp(-i64::from(i32::MAX), i64::from(i32::MAX)));
    ray(origin, d, any_cone(rng))
}

#[test]
fn culling_changes_nothing() {
    let mut rng = Rng(1);
    let (mut rays, mut hits) = (0, 0);
    for seed in 0..24 {
        let h = match seed % 4 {
            0 => ball(seed as u32 / 4 % 4, 0.3, seed),
            1 => ball(3, 1.5, seed),
            2 => terrain(3, seed as u32 / 4 % 4, 0.5, seed),
            _ => terrain(1, 4, 1.0, seed),
        };
        let h = any_form(seed / 2, h);
        let (fast, slow) = (Exact::new(&h), Exact::without_culling(&h));
        for _ in 0..150 {
            let r = ball_ray(&h, &mut rng).to_small_if_terrain(&h, &mut rng);
            let hit = fast.trace(&r);
            assert_eq!(hit, slow.trace(&r), "model {seed}, {r:?}");
            assert_eq!(fast.trace_full(&r), slow.trace_full(&r), "model {seed}, {r:?}");
            assert_eq!(fast.crossings(&r), slow.crossings(&r), "model {seed}, {r:?}");
            rays += 1;
            hits += u32::from(hit.is_some());
        }
    }
    println!("{rays} rays, {hits} hits");
    assert!(hits > rays / 5);
}

/// Rays that suit a terrain: downwards at a slant from within the space.
trait Suited {
    fn to_small_if_terrain(self, h: &Hierarchy, rng: &mut Rng) -> Self;
}

impl Suited for Ray {
    fn to_small_if_terrain(self, h: &Hierarchy, rng: &mut Rng) -> Self {
        if h.triangles.len() == 8 {
            return self;
        }
        let [x, y] = [(); 2].map(|()| (rng.signed() * 1.9 * f64::from(1 << 30)) as i64);
        let mut d = self.direction.get();
        d[2] = -d[2].abs();
        ray([x, y, 1 << 30], d, self.cone)
    }
}

#[test]
fn rays_from_outside_cross_a_closed_surface_as_often_inwards_as_outwards() {
    let mut rng = Rng(2);
    let (mut rays, mut crossed) = (0, 0);
    for seed in 0..40 {
        let h = any_form(seed, ball(seed as u32 % 5, [0.05, 0.3, 1.0][seed as usize % 3], seed));
        let exact = Exact::new(&h);
        for _ in 0..100 {
            let r = ball_ray(&h, &mut rng);
            let outside = r.origin.get().iter().any(|&v| v.abs() > 1 << 29) || length(r.origin.get()) > 2.0 * f64::from(1 << 29);
            if !outside || seed % 3 == 2 && length(r.origin.get()) < 3.0 * f64::from(1 << 28) {
                continue;
            }
            let Crossings { front, back } = exact.crossings(&r);
            assert_eq!(front, back, "model {seed}, {r:?}");
            rays += 1;
            crossed += u32::from(front > 0);
        }
    }
    println!("{rays} rays, {crossed} cross");
    assert!(crossed > 1000);
}

#[test]
fn rays_through_vertices_edges_and_midpoints_of_the_morphed_surface_cross_it_evenly() {
    let mut rng = Rng(3);
    let (mut rays, mut crossed, mut morphed) = (0, 0, 0);
    for seed in 0..30u64 {
        let h = any_form(seed, ball(1 + seed as u32 % 4, [0.1, 0.5][seed as usize % 2], seed));
        let exact = Exact::new(&h);
        // A cone that does not widen: the surface is the same for all rays.
        let cone = cone(2f64.powf(22.0 + 5.0 * rng.unit()), 0.0);
        let probe = ray_through([0; 3], direction(&mut rng), cone);
        let surface = exact.surface(&probe);
        morphed += u32::from(surface.iter().any(|s| s.level < h.levels) && surface.len() > 8);
        for _ in 0..100 {
            let [a, b, c] = surface[rng.below(surface.len() as u64) as usize].corners;
            let step = 1i64 << rng.below(2);
            let p = match rng.below(3) {
                0 => a,
                1 => std::array::from_fn(|k| (a[k] + b[k]).div_euclid(2)), // on the edge where even
                _ => std::array::from_fn(|k| a[k] + (c[k] - a[k]).div_euclid(2 * step)),
            };
            // Along an axis, within the plane of an edge and an axis, or anywhere.
            let mut d = direction(&mut rng);
            match rng.below(4) {
                0 => {
                    let k = rng.below(3) as usize;
                    d = [0; 3];
                    d[k] = (1 << 30) - 1;
                }
                1 => {
                    // Through two vertices: along the edge itself, scaled up exactly.
                    let e: [i64; 3] = std::array::from_fn(|k| b[k] - a[k]);
                    let largest = e.iter().map(|v| v.abs()).max().unwrap();
                    if largest == 0 {
                        continue;
                    }
                    d = e.map(|v| v * (((1 << 29) + (1 << 28)) / largest));
                    if length(d) > f64::from(1 << 30) {
                        d = d.map(|v| v / 2);
                    }
                }
                _ => {}
            }
            let r = ray_through(p, d, cone);
            if length(r.origin.get()) < 2.0 * f64::from(1 << 28) {
                continue;
            }
            let Crossings { front, back } = exact.crossings(&r);
            assert_eq!(front, back, "model {seed}, {r:?}");
            rays += 1;
            crossed += u32::from(front > 0);
        }
    }
    println!("{rays} rays, {crossed} cross, {morphed} mixed surfaces");
    assert!(crossed > 1000 && morphed > 10);
}

#[test]
fn the_vector_area_of_a_closed_morphed_surface_is_zero() {
    let mut rng = Rng(4);
    let mut mixed = 0;
    for seed in 0..200 {
        let h = any_form(seed, ball(seed as u32 % 5, 0.4, seed));
        let surface = Exact::new(&h).surface(&ball_ray(&h, &mut rng));
        let mut area = [0i128; 3];
        for [a, b, c] in surface.iter().map(|s| s.corners) {
            for (k, sum) in area.iter_mut().enumerate() {
                let e = |p: [i64; 3], i: usize| i128::from(p[(k + i) % 3] - a[(k + i) % 3]);
                *sum += e(b, 1) * e(c, 2) - e(b, 2) * e(c, 1);
            }
        }
        assert_eq!(area, [0; 3], "model {seed}");
        let levels: Vec<u32> = surface.iter().map(|s| s.level).collect();
        mixed += u32::from(levels.iter().min() != levels.iter().max());
    }
    println!("{mixed} surfaces of several levels");
    assert!(mixed > 20);
}

#[test]
fn full_detail_is_the_full_resolution_mesh() {
    let mut rng = Rng(5);
    let mut hits = 0;
    for seed in 0..8 {
        let h = any_form(seed, ball(1 + seed as u32 % 4, 0.3, seed));
        let exact = Exact::new(&h);
        for _ in 0..100 {
            let r = Ray { cone: Cone::default(), ..ball_ray(&h, &mut rng) };
            assert_eq!(exact.trace(&r), exact.trace_full(&r));
            if let Some(hit) = exact.trace_full(&r) {
                assert_eq!((hit.level, hit.node, hit.bary), (h.levels, hit.full_node, hit.full_bary));
                hits += 1;
            }
            // And a cone without limits the base mesh.
            let coarse = Ray { cone: cone(1e10, 0.0), ..r };
            assert!(exact.surface(&coarse).iter().all(|s| s.level == 0) && exact.trace(&coarse).is_none_or(|hit| hit.level == 0));
        }
    }
    assert!(hits > 100);
}

#[test]
fn full_resolution_hits_agree_with_the_reference() {
    let mut rng = Rng(6);
    let (mut rays, mut hits, mut apart) = (0, 0, 0.0f64);
    for seed in 0..20 {
        let h = if seed % 2 == 0 { ball(seed as u32 % 5, 0.3, seed) } else { terrain(4, seed as u32 % 4, 0.5, seed) };
        let h = any_form(seed, h);
        let (exact, reference) = (Exact::new(&h), Reference::new(&h));
        for _ in 0..500 {
            // Rounded directions through no vertex in particular: the reference counts a shared edge for both sides.
            let r = ball_ray(&h, &mut rng).to_small_if_terrain(&h, &mut rng);
            let [x, d] = [r.origin.get(), r.direction.get()];
            let found = reference.trace(x.map(|v| v as f64), d.map(|v| v as f64));
            rays += 1;
            match (exact.trace_full(&r), found) {
                (None, None) => {}
                (Some(e), Some(f)) => {
                    hits += 1;
                    let t = e.t as f64 * length(d) / 4_294_967_296.0;
                    if (e.tree, e.full_node) == (f.tree, f.full_node) {
                        apart = apart.max((t - f.t).abs());
                        assert_eq!(e.front, f.front);
                        for (a, b) in e.full_bary.iter().zip(f.bary) {
                            assert!((f64::from(*a) / f64::from(1u32 << 31) - b).abs() < 1e-8);
                        }
                    } else {
                        // Only on an edge, or where both triangles are met within a step of t, may they name different ones.
                        assert!(
                            (t - f.t).abs() < 0.5 || e.full_bary.iter().min() < Some(&2) || f.bary.iter().any(|&b| b < 1e-8),
                            "{e:?} {f:?}"
                        );
                    }
                }
                // Only exactly at a silhouette or border, which the tie rule gives to one side and rounding to either.
                (None, Some(f)) => assert!(f.bary.iter().any(|&b| b < 1e-8), "{r:?} {f:?}"),
                (Some(e), None) => assert!(e.full_bary.iter().min() < Some(&2), "{r:?} {e:?}"),
            }
        }
    }
    println!("{rays} rays, {hits} hits, distances differ by {apart} units at most");
    assert!(hits > 2000 && apart < 1.0);
}

#[test]
fn the_reference_finds_what_brute_force_finds() {
    let mut rng = Rng(7);
    let (mut rays, mut hits) = (0, 0);
    for seed in 0..12 {
        let h = if seed % 2 == 0 { ball(seed as u32 % 5, 0.5, seed) } else { terrain(3, seed as u32 % 5, 1.0, seed) };
        let h = any_form(seed, h);
        let reference = Reference::new(&h);
        for _ in 0..400 {
            let target: [f64; 3] = match rng.below(2) {
                0 => h.points[rng.below(h.points.len() as u64) as usize].map(f64::from),
                _ => [rng.signed() * 3e8, rng.signed() * 3e8, rng.signed() * 2e8],
            };
            // From inside to a million radii away, along axes and almost along axes.
            let far = 2f64.powf(26.0 + 26.0 * rng.unit());
            let mut d = direction(&mut rng).map(|v| v as f64 * 1e-9);
            let k = rng.below(3) as usize;
            match rng.below(4) {
                0 => d[k] = 0.0,
                1 => d[k] *= 1e-8,
                2 => {
                    d = [0.0; 3];
                    d[k] = -3.0;
                }
                _ => {}
            }
            let origin = std::array::from_fn(|i| target[i] - d[i] * far);
            let found = reference.trace(origin, d);
            assert_eq!(found, reference.trace_brute_force(origin, d), "model {seed}, {origin:?} {d:?}");
            rays += 1;
            hits += u32::from(found.is_some());
        }
        assert_eq!(reference.trace([0.0; 3], [0.0; 3]), None);
        assert_eq!(reference.trace([f64::NAN; 3], [0.0, 0.0, 1.0]), None);
    }
    println!("{rays} rays, {hits} hits");
    assert!(hits > rays / 4);
}

#[test]
fn ten_splits_work() {
    let h = terrain(1, 10, 0.3, 10);
    let (exact, reference) = (Exact::new(&h), Reference::new(&h));
    let mut rng = Rng(11);
    let (mut hits, mut levels) = (0, [0; 11]);
    for _ in 0..500 {
        let r = ball_ray(&h, &mut rng).to_small_if_terrain(&h, &mut rng);
        if let Some(hit) = exact.trace(&r) {
            levels[hit.level as usize] += 1;
            assert!(hit.full_node < 1 << 20 && hit.full_node >> (2 * (10 - hit.level)) == hit.node);
        }
        let (full, found) = (exact.trace_full(&r), reference.trace(r.origin.get().map(|v| v as f64), r.direction.get().map(|v| v as f64)));
        if let (Some(e), Some(f)) = (full, found) {
            hits += 1;
            assert!((e.t as f64 * length(r.direction.get()) / 4_294_967_296.0 - f.t).abs() < 1.0);
        } else {
            assert!(full.is_none() && found.is_none(), "{r:?} {full:?} {found:?}");
        }
    }
    println!("{hits} hits; by level {levels:?}");
    assert!(hits > 100 && levels.iter().filter(|&&n| n > 0).count() > 5);
}

#[test]
fn a_model_without_triangles_is_missed() {
    let h = Hierarchy { triangles: vec![], points: vec![], base_vertices: 0, ..single_triangle() };
    let r = ray([0, 0, 5], [0, 0, -5], Cone::default());
    assert_eq!(Exact::new(&h).trace(&r), None);
    assert_eq!(Reference::new(&h).trace([0.0; 3], [0.0, 0.0, 1.0]), None);
}

#[test]
fn traversers_serve_many_threads() {
    fn shared<T: Send + Sync>() {}
    shared::<Exact<'_>>();
    shared::<Reference>();
}
