//! From outside a body the first hit is a front face, by every traverser: rays at vertices, edges and bodies a millionth as thin as they are wide.
//! `LODRAY_RAYS` asks for that many rays (default 60,000).

use lodray::block::hit_divide::{self, HitDivide};
use lodray::block::start_test::Below;
use lodray::block::tri_test;
use lodray::golden::Exact;
use lodray::mesh::Hierarchy;
use lodray::method::bvh::BvhTraverser;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::method::{ClosestHit, HitSink, TriangleId};
use lodray::num::{Cone, Point, Ray, RayT};
use lodray::step::NoSteps;
use lodray_test_support::models::{Rng, any_cone, ball, direction, full_bvhs, model, octahedron, ray_through, scene_of};
use lodray_test_support::plain::plain;

fn total() -> u64 {
    std::env::var("LODRAY_RAYS").map_or(60_000, |text| text.parse().expect("LODRAY_RAYS is a number"))
}

/// Every hit: its t, its side and its number.
#[derive(Default)]
struct All(Vec<(u64, bool, [u32; 2])>);

impl HitSink for All {
    fn t_max(&self) -> RayT {
        RayT::MAX
    }
    fn offer(&mut self, id: TriangleId, _: &[Point; 3], test: &tri_test::Out, below: &Below) {
        let t = HitDivide::with(&hit_divide::In { numerator: test.t_num, denominator: test.det }, below.t).quotient;
        self.0.push((t.get(), test.front, [id.tree, id.node]));
    }
    fn found(&self) -> bool {
        !self.0.is_empty()
    }
}

/// A tetrahedron.
fn tetrahedron(levels: u32) -> Hierarchy {
    let base = [[1, 1, 1], [-1, -1, 1], [-1, 1, -1], [1, -1, -1]];
    let triangles = vec![[0, 1, 3], [0, 3, 2], [0, 2, 1], [1, 2, 3]];
    let scale = f64::from((1 << 28) >> levels);
    model(levels, &base, triangles, |p, _| p.map(|v| v as f64 * scale))
}

/// A double pyramid of half this height, in half widths.
fn lens(levels: u32, height: f64) -> Hierarchy {
    let (base, triangles) = octahedron();
    let scale = f64::from((1 << 28) >> levels);
    model(levels, &base, triangles, |[x, y, z], _| [x as f64 * scale, y as f64 * scale, z as f64 * scale * height])
}

/// A ray from outside at a vertex of the full resolution, at a point between two or just beside one.
fn aimed(h: &Hierarchy, rng: &mut Rng) -> Ray {
    let mut vertex = || h.points[rng.below(h.points.len() as u64) as usize].map(i64::from);
    let (a, b) = (vertex(), vertex());
    let at = match rng.below(3) {
        0 => a,
        1 => std::array::from_fn(|k| (a[k] + b[k]).div_euclid(2)),
        _ => a.map(|v| v + rng.below(3) as i64 - 1),
    };
    let mut d = direction(rng);
    // Along a thin body too, from beyond its rim.
    if rng.below(3) == 0 && (d[0] as f64).hypot(d[1] as f64) > 0.9 * f64::from(1 << 30) {
        d[2] >>= 8 + rng.below(22);
    }
    ray_through(at, d, if rng.below(2) == 0 { Cone::default() } else { any_cone(rng) })
}

#[test]
fn the_first_hit_from_outside_is_a_front_face() {
    // The last is no convex body: it may be folded where rays see it coarsely.
    let models = [
        ("tetrahedron", tetrahedron(0), true),
        ("tetrahedron of three levels", tetrahedron(3), true),
        ("a millionth as thin", lens(0, 1e-6), true),
        ("a millionth as thin, of three levels", lens(3, 1e-6), true),
        ("two units thick", lens(0, 4e-9), true),
        ("spikes", ball(3, 1.5, 1), false),
    ];
    let each = total().div_ceil(models.len() as u64);
    let (mut rays, mut ties) = (0, 0);
    for (seed, (name, h, is_body)) in models.into_iter().enumerate() {
        let scene = scene_of(&h);
        let h = &scene.decode();
        let (golden, bvhs) = (Exact::new(h), full_bvhs(h));
        let mut lod = LodTraverser::new(LodImage::of(&scene));
        let mut rng = Rng(seed as u64 + 1);
        let (mut met, mut turned) = (0, 0);
        for number in 0..each {
            let ray = aimed(h, &mut rng);
            let (mut all, mut closest) = (All::default(), ClosestHit::new(h.levels));
            lod.trace(&ray, &mut NoSteps, &mut all);
            lod.trace(&ray, &mut NoSteps, &mut closest);
            let hit = closest.record();
            assert_eq!(hit.is_some(), all.found());
            let Some(hit) = hit else { continue };
            met += 1;
            let first = all.0.iter().map(|hit| hit.0).min();
            assert_eq!(Some(hit.t.get()), first, "{name}: {ray:?}");
            let at_first = || all.0.iter().filter(|hit| Some(hit.0) == first);
            assert_eq!(hit.front, at_first().any(|hit| hit.1), "{name}: {ray:?}");
            assert!(hit.front || !is_body, "{name}: a back face first: {ray:?}");
            // What would have been a back face by number alone.
            turned += u64::from(hit.front && at_first().min_by_key(|hit| hit.2).is_some_and(|hit| !hit.1));
            if number % 16 == 0 {
                assert_eq!(Some(plain(&hit)), golden.trace(&ray), "{name}: {ray:?}");
            }
            // Full resolution, whatever the cone.
            let bvh = &bvhs[number as usize % bvhs.len()];
            let mut closest = ClosestHit::new(h.levels);
            BvhTraverser::new(bvh).trace(&ray, &mut NoSteps, &mut closest);
            let full = closest.record().map(|hit| hit.front);
            assert!(full != Some(false) || !is_body, "{name}, {:?}: a back face first: {ray:?}", bvh.leaves.layout());
            if number % 16 == 0 {
                assert_eq!(full, golden.trace_full(&ray).map(|hit| hit.front), "{name}: {ray:?}");
            }
        }
        println!("{name}: {each} rays, {met} hits, {turned} of them back faces if numbers decided");
        assert!(met > each / 4, "{name}: {met} hits");
        rays += each;
        ties += turned;
    }
    println!("{rays} rays, {ties} ties of a front and a back face that numbers would have decided otherwise");
    assert!(ties > rays / 1000, "a test without ties shows nothing: {ties}");
}
