//! The blocks' traversal equals the exact golden traverser in every field of every hit.

use lodray::format::{Scene, scene_prisms};
use lodray::golden::exact::{Exact, ExactHit};
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{BoundKind, Hierarchy};
use lodray::method::bvh::BvhTraverser;
use lodray::method::bvh::NoStore;
use lodray::method::lod::{self, LodImage, LodTraverser};
use lodray::method::{ClosestHit, Crossings, Knobs};
use lodray::num::{Cone, Point, Ray, Vec3, VertexForm};
use lodray::rays::ModelSpace;
use lodray::rays::{Camera, RaySource, Sight, View};
use lodray::step::{NoSteps, Recorder};
use lodray_test_support::models::{
    Rng, ball, build_with, coarsened, cone, full_bvhs, model, octahedron, scene_of, terrain, with_vertices, with_zeros,
};
use lodray_test_support::plain::plain;
use lodray_test_support::surfaces::scene_with;
use lodray_test_support::{cases, is_nightly};
use proptest::prelude::*;
use rayon::prelude::*;

struct Bench<'a> {
    golden: Exact<'a>,
    lod: LodTraverser<'a>,
    /// The same with prisms in place of boxes.
    prisms: LodTraverser<'a>,
    bvhs: Vec<BvhTraverser>,
    levels: u32,
}

impl Bench<'_> {
    /// Compares every way to trace `ray`; gives the golden hit.
    fn check(&mut self, ray: &Ray) -> Option<ExactHit> {
        let golden = self.golden.trace(ray);
        let mut closest = ClosestHit::new(self.levels);
        self.lod.trace(ray, &mut NoSteps, &mut closest);
        assert_eq!(closest.record().as_ref().map(plain), golden, "LOD, {ray:?}");
        let mut by_prisms = ClosestHit::new(self.levels);
        self.prisms.trace(ray, &mut NoSteps, &mut by_prisms);
        assert_eq!(by_prisms.record(), closest.record(), "LOD by prisms, {ray:?}");

        let crossings = self.golden.crossings(ray);
        let mut counted = Crossings::default();
        self.lod.trace(ray, &mut NoSteps, &mut counted);
        assert_eq!((counted.front, counted.back), (crossings.front, crossings.back), "crossings, {ray:?}");
        let mut by_prisms = Crossings::default();
        self.prisms.trace(ray, &mut NoSteps, &mut by_prisms);
        assert_eq!((by_prisms.front, by_prisms.back), (crossings.front, crossings.back), "crossings by prisms, {ray:?}");

        if !self.bvhs.is_empty() {
            let full = self.golden.trace_full(ray);
            for bvh in &mut self.bvhs {
                let mut closest = ClosestHit::new(self.levels);
                bvh.trace(ray, &mut NoSteps, &mut closest);
                assert_eq!(closest.record().as_ref().map(plain), full, "BVH, {ray:?}");
            }
            // A flat node serves even at full detail: the same point on a larger triangle.
            let mut closest = ClosestHit::new(self.levels);
            self.lod.trace(&Ray { cone: Cone::default(), ..*ray }, &mut NoSteps, &mut closest);
            assert_eq!(closest.record().map(|hit| hit.t.get()), full.map(|hit| hit.t), "full detail, {ray:?}");
        }
        golden
    }
}

/// Runs `rays` through everything on one model; gives how many hit.
fn compare(h: &Hierarchy, with_bvhs: bool, rays: impl IntoIterator<Item = Ray>) -> u64 {
    let scene = scene_of(h);
    // Its trees have an order of their own.
    let h = &scene.decode();
    let full = if with_bvhs { full_bvhs(h) } else { Vec::new() };
    let prisms = scene_prisms(&scene);
    let mut bench = Bench {
        golden: Exact::new(h),
        lod: LodTraverser::new(LodImage::of(&scene)),
        prisms: LodTraverser::new(LodImage::of(&scene).bounded_by(&prisms)),
        bvhs: full.iter().map(BvhTraverser::new).collect(),
        levels: h.levels,
    };
    rays.into_iter().filter(|ray| bench.check(ray).is_some()).count() as u64
}

/// Rays of many kinds at a model: from around and inside, at vertices exactly, axis-parallel, grazing, with all kinds of cones.
fn rays(h: &Hierarchy, count: u64, seed: u64) -> Vec<Ray> {
    let mut rng = Rng(seed);
    let limit = 0x7FFE_0040i64;
    let ray = |_| {
        let near = h.points[rng.below(h.points.len() as u64) as usize].map(i64::from);
        let spread = 1u64 << rng.below(31);
        let mut x: [i64; 3] = near.map(|v| v + (rng.signed() * spread as f64) as i64);
        let target = h.points[rng.below(h.points.len() as u64) as usize].map(i64::from);
        let mut towards: [f64; 3] = std::array::from_fn(|k| (target[k] - x[k]) as f64);
        match rng.below(6) {
            0 => {
                let k = rng.below(3) as usize;
                towards = [0.0; 3];
                towards[k] = if rng.below(2) == 0 { 1.0 } else { -1.0 };
                x = std::array::from_fn(|i| if i == k { x[i] } else { target[i] });
            }
            1 => towards[rng.below(3) as usize] = 0.0,
            2 => towards = std::array::from_fn(|_| rng.signed()),
            _ => {}
        }
        let x = x.map(|v| v.clamp(-limit, limit));
        let length = towards.iter().map(|v| v * v).sum::<f64>().sqrt();
        if length == 0.0 {
            towards = [1.0, 0.0, 0.0];
        }
        let length = towards.iter().map(|v| v * v).sum::<f64>().sqrt();
        let d = towards.map(|v| (v / length * f64::from((1 << 30) - 1)).round() as i64);
        let magnitude = 2f64.powf(rng.unit() * 40.0 - 20.0);
        let cone = match rng.below(8) {
            0 => Cone::default(),
            1 => cone(1e9, 0.0),
            2 => cone(f64::from(1 << 24) * rng.unit(), 0.0),
            _ => cone(if rng.below(2) == 0 { 0.0 } else { magnitude * 4096.0 }, magnitude / 256.0),
        };
        Ray { origin: Point::new(x[0], x[1], x[2]), direction: Vec3::new(d[0], d[1], d[2]), cone }
    };
    (0..count).map(ray).collect()
}

/// Rays of a camera at several distances and qualities.
fn camera_rays(scene: &Scene, side: u32) -> Vec<Ray> {
    let space = ModelSpace::of(scene);
    let mut all = Vec::new();
    for distance in [0.3, 1.2, 4.0, 30.0] {
        for delta in [0.3, 1.0, 8.0] {
            let view = View { distance: Some(distance), ..View::default() };
            let camera = Camera::new(&view, &space, side, side).expect("a view");
            let pixels = (0..side * side).map(|i| camera.ray(i % side, i / side));
            all.extend(pixels.filter_map(|world| Some(space.enter(&world, delta)?.ray)));
        }
    }
    all
}

#[test]
fn random_balls_and_terrains() {
    let (mut hits, count) = (0, if is_nightly() { 750 } else { 300 });
    for seed in 0..12u64 {
        let levels = seed as u32 % 5;
        let roughness = [0.05, 0.4, 1.5][seed as usize % 3];
        for form in VertexForm::ALL {
            let h = with_vertices(form, ball(levels, roughness, seed));
            hits += compare(&h, true, rays(&h, count, seed));
            let h = with_vertices(form, terrain(3, levels, roughness, seed));
            hits += compare(&h, true, rays(&h, count, seed + 100));
        }
    }
    println!("{hits} hits compared");
    assert!(hits > 20 * count, "only {hits} hits");
}

#[test]
fn coarser_grids() {
    let count = if is_nightly() { 2_000 } else { 500 };
    for (zeros, levels, form) in
        [(1, 4, VertexForm::Exact), (4, 3, VertexForm::Compact), (7, 5, VertexForm::Compact), (12, 3, VertexForm::Exact)]
    {
        let h = with_vertices(form, with_zeros(zeros, terrain(3, levels, 0.3, u64::from(zeros))));
        let cut = rays(&h, count, 5).into_iter().map(|ray| coarsened(&ray, [zeros, zeros]));
        assert!(compare(&h, false, cut) > count / 4, "{zeros} zeros");
    }
}

#[test]
fn deep_trees() {
    // The golden traverser takes up to a tenth of a second for a ray here.
    let count = if is_nightly() { 750 } else { 30 };
    let each = |levels: u32, form| {
        let (base, triangles) = octahedron();
        let h = model(levels, &base, triangles[..2].to_vec(), |p, level| {
            let size = f64::from(1 << 30) / f64::from(1u32 << levels);
            std::array::from_fn(|k| p[k] as f64 * size + f64::from(level) * size * 3.0 * f64::from((p[k] % 5) as i32))
        });
        let hits = compare(&with_vertices(form, h.clone()), levels < 10, rays(&h, count, u64::from(levels)));
        assert!(hits > count / 5, "N = {levels}, {form:?}: only {hits} hits");
    };
    // Each depth and each form occurs; `scripts/nightly` takes all pairs.
    [7, 8, 10].into_par_iter().zip(VertexForm::ALL).for_each(|(levels, own)| {
        VertexForm::ALL.into_par_iter().filter(|&form| is_nightly() || form == own).for_each(|form| each(levels, form));
    });
}

#[test]
fn non_manifold_fans_and_loose_triangles() {
    // Five triangles around one edge, one of them turned, one degenerate in space, and a loose one.
    let base = [[0, 0, -4], [0, 0, 4], [4, 0, 0], [0, 4, 1], [-4, 0, -1], [0, -4, 0], [3, 3, 3], [0, 0, 0]];
    let triangles = vec![[0, 1, 2], [0, 1, 3], [1, 0, 4], [0, 1, 5], [0, 1, 7], [2, 3, 6]];
    let mut hits = 0;
    for levels in 0..=4 {
        let h = model(levels, &base, triangles.clone(), |p, level| {
            let scale = f64::from(1 << 27) / f64::from(1u32 << levels);
            let bump = if level == 0 { 0.0 } else { 2e7 / f64::from(level) };
            std::array::from_fn(|k| p[k] as f64 * scale + bump * (p[(k + 1) % 3] as f64 * 0.7).sin())
        });
        for form in VertexForm::ALL {
            let h = with_vertices(form, h.clone());
            hits += compare(&h, true, rays(&h, 2000, u64::from(levels)));
        }
    }
    assert!(hits > 3000, "only {hits} hits");
}

#[test]
fn procedural_scenes() {
    use procedural::Scene::{Cloth, Drape, Pot, Room, Sphere, Spikes, Terrain};
    let kinds = [(Terrain, 32, 4), (Cloth, 32, 3), (Sphere, 32, 4), (Spikes, 32, 3), (Room, 64, 2), (Pot, 64, 3), (Drape, 32, 3)];
    for (number, (kind, base, levels)) in kinds.into_iter().enumerate() {
        let options = Options { levels: Some(levels), base: Some(base), ..Options::new(kind) };
        let surface = procedural::generate(&options).expect("options");
        // Of the forms one in turn.
        let forms = if is_nightly() { &VertexForm::ALL[..] } else { &VertexForm::ALL[number % 3..][..1] };
        for &form in forms {
            let scene = build_with(&surface, form);
            let h = scene.decode();
            let mut all = camera_rays(&scene, 17);
            all.extend(rays(&h, 1500, 5));
            let tried = all.len();
            let hits = compare(&h, true, all);
            println!("{kind:?}, {form:?}: {hits} hits of {tried} rays");
            assert!(hits > 1000, "{kind:?}, {form:?}: only {hits} hits");
        }
    }
}

proptest! {
    #![proptest_config(cases(if is_nightly() { 200 } else { 60 }))]

    #[test]
    fn any_ball(levels in 0u32..=4, roughness in 0.0f64..4.0, seed: u64, form in prop::sample::select(&VertexForm::ALL[..])) {
        let h = with_vertices(form, ball(levels, roughness, seed));
        compare(&h, true, rays(&h, 100, seed));
    }
}

#[test]
fn a_tracer_of_full_detail_takes_the_same_steps() {
    let options = |scene| Options { levels: Some(4), base: Some(32), seed: 5, ..Options::new(scene) };
    for (scene, form) in [procedural::Scene::Terrain, procedural::Scene::Spikes, procedural::Scene::Wall]
        .into_iter()
        .flat_map(|scene| VertexForm::ALL.map(|form| (scene, form)))
    {
        let scene = scene_with(&procedural::generate(&options(scene)).expect("a surface"), BoundKind::Total, form);
        let (space, image) = (ModelSpace::of(&scene), LodImage::of(&scene));
        let method = (lod::METHOD.make)(&scene, &Knobs::default(), &NoStore).expect("the method");
        for (distance, delta) in [(0.4, f64::INFINITY), (2.0, f64::INFINITY), (2.0, 1.0)] {
            let camera = Camera::new(&View { distance: Some(distance), ..View::default() }, &space, 64, 64).expect("a camera");
            let sight = Sight::new(&camera, &space, delta);
            let (mut tracer, mut traverser, mut hits) = (method.tracer(&sight), LodTraverser::new(image), 0);
            for batch in 0..camera.batches() {
                camera.batch(batch, &mut |_, query| {
                    let Some(ray) = space.enter(query, delta) else { return };
                    let (mut wanted, mut steps) = (Recorder::default(), Recorder::default());
                    let mut closest = ClosestHit::of(image.levels, &ray, false);
                    traverser.trace(&ray.ray, &mut wanted, &mut closest);
                    let hit = tracer.recorded(query, &mut steps);
                    assert_eq!(hit, closest.surface(&ray), "{query:?}");
                    let (steps, wanted) = (steps.batch(), wanted.batch());
                    assert!(steps.words() == wanted.words(), "{query:?}");
                    hits += u64::from(hit.is_some());
                });
            }
            assert!(hits > 500, "{hits}");
        }
    }
}
