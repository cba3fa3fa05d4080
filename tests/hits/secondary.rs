//! Rays that leave the surface: equal to the golden traverser in every field, on one surface with the rays before them, and never back on where they start.

use lodray::golden::{Exact, ExactHit, Leg};
use lodray::mesh::Hierarchy;
use lodray::method::bvh::{self, BvhTraverser, NoStore};
use lodray::method::leave;
use lodray::method::lod::{self, LodImage, LodTraverser};
use lodray::method::{ClosestHit, Crossings, Departure, Knobs};
use lodray::num::{Cone, Direction, Point, Ray, VertexForm};
use lodray::rays::{Eye, ModelSpace, Query, Sight};
use lodray::step::{NoSteps, Recorder};
use lodray_test_support::bounces::{leaving, scaled};
use lodray_test_support::models::{Rng, ball, cone, full_bvhs, model, scene_of, terrain, with_vertices};
use lodray_test_support::plain::plain;
use std::cmp::Ordering;

/// What has been seen.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    rays: u64,
    hits: u64,
    balanced: u64,
    crowded: u64,
    deepest: usize,
}

/// Follows paths of up to `depth` rays on one model through the blocks and the golden traverser.
struct Follow<'a> {
    golden: &'a Exact<'a>,
    lod: LodTraverser<'a>,
    levels: u32,
    closed: bool,
    seen: Seen,
}

fn direction(v: [i64; 3]) -> Direction {
    Direction::new(v[0], v[1], v[2])
}

impl Follow<'_> {
    /// The closest hit of a ray from `from`, and all its crossings, the same by blocks and golden.
    fn check(&mut self, ray: &Ray, from: Option<&Departure>, before: &[Leg]) -> Option<(ExactHit, ClosestHit)> {
        let (mut closest, mut counted) = (ClosestHit::new(self.levels), Crossings::default());
        match from {
            Some(from) => {
                self.lod.trace_from(ray, from, &mut NoSteps, &mut closest);
                self.lod.trace_from(ray, from, &mut NoSteps, &mut counted);
            }
            None => {
                self.lod.trace(ray, &mut NoSteps, &mut closest);
                self.lod.trace(ray, &mut NoSteps, &mut counted);
            }
        }
        let golden = self.golden.trace_after(before, ray);
        assert_eq!(closest.record().as_ref().map(plain), golden, "{ray:?} {from:?}");
        let crossings = self.golden.crossings_after(before, ray);
        assert_eq!((counted.front, counted.back), (crossings.front, crossings.back), "{ray:?} {from:?}");
        self.seen.rays += 1;
        golden.map(|hit| (hit, closest))
    }

    /// Front less back hits.
    fn winding(&mut self, ray: &Ray, from: &Departure) -> i64 {
        let mut counted = Crossings::default();
        self.lod.trace_from(ray, from, &mut NoSteps, &mut counted);
        i64::from(counted.front) - i64::from(counted.back)
    }

    /// A path from `ray`, each bounce by a direction and a cone of `next`.
    fn path(&mut self, ray: Ray, depth: usize, mut next: impl FnMut(&Departure) -> (Direction, Cone)) {
        let (mut ray, mut from, mut before) = (ray, None::<Departure>, Vec::new());
        for bounce in 0..depth {
            let Some((hit, closest)) = self.check(&ray, from.as_ref(), &before) else { return };
            self.seen.hits += 1;
            self.seen.deepest = self.seen.deepest.max(bounce + 1);
            let corners = closest.corners().expect("a hit");
            let departure = self.lod.departure(&ray, from.as_ref(), &closest.record().expect("a hit"), &corners);
            let leg = self.golden.leg(&before, &ray, &hit);
            assert_eq!((leg.start(), leg.corners()), (departure.start, corners.map(Point::get)), "{ray:?}");
            if departure.crowded {
                // Two priors are not enough: the golden path has as many as it takes.
                self.seen.crowded += 1;
                return;
            }
            before.push(leg);
            let (direction, cone) = next(&departure);
            ray = Ray { origin: departure.start.point, direction, cone };
            from = Some(departure);
            // The triangle it starts from is among those that serve it, and it meets neither that nor what it passes there.
            if let Some(from) = &from
                && self.closed
                && cone.slope.get() == 0
            {
                self.balance(&ray, from);
            }
        }
    }

    /// Two directions on one side of the start see the same winding number, and on different sides one that differs by one: nothing is met twice or missed at the start.
    fn balance(&mut self, ray: &Ray, from: &Departure) {
        let turned = Ray { direction: direction(ray.direction.get().map(|c| -c)), ..*ray };
        let [x, y, z] = ray.direction.get();
        let aside = Ray { direction: direction([y, z, x]), ..*ray };
        let of = [*ray, turned, aside].map(|ray| (leave::side(&from.corners, ray.direction), self.winding(&ray, from)));
        for &(side, winding) in &of[1..] {
            if of[0].0 != Ordering::Equal && side != Ordering::Equal {
                let apart = match (of[0].0, side) {
                    (Ordering::Greater, Ordering::Less) => 1,
                    (Ordering::Less, Ordering::Greater) => -1,
                    _ => 0,
                };
                assert_eq!(of[0].1 - winding, apart, "{ray:?} {from:?}");
                self.seen.balanced += 1;
            }
        }
    }
}

fn start_at(h: &Hierarchy, rng: &mut Rng) -> Ray {
    let target = h.points[rng.below(h.points.len() as u64) as usize].map(i64::from);
    let d = scaled([rng.signed(), rng.signed(), rng.signed() + 1e-9]);
    let far = 1 + rng.below(2);
    let x = std::array::from_fn(|k| (target[k] - d[k] * far as i64).clamp(-0x7FFE_0040, 0x7FFE_0040));
    let towards: [f64; 3] = std::array::from_fn(|k: usize| (target[k] - i64::from(x[k] as i32)) as f64);
    let x: [i64; 3] = x;
    Ray { origin: Point::new(x[0], x[1], x[2]), direction: direction(scaled(towards)), cone: any_cone(rng) }
}

fn any_cone(rng: &mut Rng) -> Cone {
    let magnitude = 2f64.powf(rng.unit() * 40.0 - 20.0);
    match rng.below(4) {
        0 => Cone::default(),
        1 => cone(magnitude * 4096.0 * 256.0, 0.0),
        2 => cone(f64::from(1 << 26) * rng.unit(), 0.0),
        _ => cone(if rng.below(2) == 0 { 0.0 } else { magnitude * 4096.0 }, magnitude / 256.0),
    }
}

fn follow(h: &Hierarchy, closed: bool, paths: u64, seed: u64) -> Seen {
    let scene = scene_of(h);
    let h = &scene.decode();
    let golden = Exact::new(h);
    let mut all = Follow { golden: &golden, lod: LodTraverser::new(LodImage::of(&scene)), levels: h.levels, closed, seen: Seen::default() };
    let mut rng = Rng(seed);
    for _ in 0..paths {
        let ray = start_at(h, &mut rng);
        let mut inner = Rng(rng.below(u64::MAX));
        all.path(ray, 8, |from| {
            let at = h.points[inner.below(h.points.len() as u64) as usize].map(i64::from);
            (leaving(&mut inner, &from.corners, from.start.point, at), any_cone(&mut inner))
        });
    }
    all.seen
}

#[test]
fn paths_over_balls_and_terrains_are_the_golden_ones() {
    let (mut rays, mut balanced) = (0, 0);
    for seed in 0..10u64 {
        let levels = seed as u32 % 5;
        let roughness = [0.05, 0.4, 1.5][seed as usize % 3];
        for form in VertexForm::ALL {
            let seen = follow(&with_vertices(form, ball(levels, roughness, seed)), true, 150, seed);
            rays += seen.rays;
            balanced += seen.balanced;
            assert_eq!(seen.crowded, 0);
            let seen = follow(&with_vertices(form, terrain(3, levels, roughness, seed)), false, 150, seed + 100);
            rays += seen.rays;
        }
    }
    println!("{rays} rays, {balanced} balanced");
    assert!(rays > 5_000 && balanced > 2_000);
}

#[test]
fn fans_of_five_triangles_and_pillows_too() {
    let base = [[0, 0, -4], [0, 0, 4], [4, 0, 0], [0, 4, 1], [-4, 0, -1], [0, -4, 0], [3, 3, 3], [0, 0, 0]];
    let triangles = vec![[0, 1, 2], [0, 1, 3], [1, 0, 4], [0, 1, 5], [0, 1, 7], [2, 3, 6], [0, 2, 1], [3, 2, 6]];
    let (mut rays, mut crowded) = (0, 0);
    for levels in 0..=4 {
        let h = model(levels, &base, triangles.clone(), |p, level| {
            let scale = f64::from(1 << 27) / f64::from(1u32 << levels);
            let bump = if level == 0 { 0.0 } else { 2e7 / f64::from(level) };
            std::array::from_fn(|k| p[k] as f64 * scale + bump * (p[(k + 1) % 3] as f64 * 0.7).sin())
        });
        let seen = follow(&h, false, 600, u64::from(levels));
        rays += seen.rays;
        crowded += seen.crowded;
    }
    println!("{rays} rays, {crowded} paths with a third prior ray");
    assert!(rays > 3_000);
}

/// Every kind of BVH: rays that leave a hit meet what golden full resolution has, and start where it says.
#[test]
fn paths_through_bvhs_are_the_golden_ones_of_full_resolution() {
    let (mut rays, mut hits) = (0u64, 0u64);
    for seed in 0..6u64 {
        let levels = 1 + seed as u32 % 4;
        let h = if seed % 2 == 0 { ball(levels, 0.6, seed) } else { terrain(3, levels, 0.7, seed) };
        let h = &scene_of(&h).decode();
        let (golden, bvhs) = (Exact::new(h), full_bvhs(h));
        let mut rng = Rng(seed + 1);
        for _ in 0..100 {
            let mut ray = Ray { cone: Cone::default(), ..start_at(h, &mut rng) };
            let (mut legs, mut from) = (Vec::<Leg>::new(), None::<Departure>);
            for _ in 0..6 {
                let wanted = golden.trace_after(&legs, &ray);
                let mut next = None;
                for bvh in &bvhs {
                    let mut closest = ClosestHit::new(h.levels);
                    let mut traverser = BvhTraverser::new(bvh);
                    match &from {
                        Some(from) => traverser.trace_from(&ray, from, &mut NoSteps, &mut closest),
                        None => traverser.trace(&ray, &mut NoSteps, &mut closest),
                    }
                    assert_eq!(closest.record().as_ref().map(plain), wanted, "{ray:?} {from:?}");
                    next = closest.record().zip(closest.corners()).map(|(hit, corners)| BvhTraverser::departure(&hit, &corners));
                    rays += 1;
                }
                let (Some(hit), Some(departure)) = (wanted, next) else { break };
                hits += 1;
                let leg = golden.leg(&legs, &ray, &hit);
                assert_eq!((leg.start(), leg.corners()), (departure.start, departure.corners.map(Point::get)));
                legs.push(leg);
                let at = h.points[rng.below(h.points.len() as u64) as usize].map(i64::from);
                let direction = leaving(&mut rng, &departure.corners, departure.start.point, at);
                ray = Ray { origin: departure.start.point, direction, cone: Cone::default() };
                from = Some(departure);
            }
        }
    }
    println!("{rays} rays, {hits} hits of paths");
    assert!(rays > 5_000 && hits > 500);
}

/// What pictures and machines are made of: tracers of methods, asked in the world, go on where golden paths do.
#[test]
fn tracers_follow_golden_paths() {
    let mut hits = 0;
    for seed in 0..4u64 {
        let scene = scene_of(&ball(1 + seed as u32, 0.4, seed));
        let (h, space) = (&scene.decode(), ModelSpace::of(&scene));
        let golden = Exact::new(h);
        for (method, delta) in [(&lod::METHOD, 1.0), (&lod::METHOD, f64::INFINITY), (&bvh::METHOD, f64::INFINITY)] {
            let method = (method.make)(&scene, &Knobs::default(), &NoStore).expect("a method on a scene");
            let mut tracer = method.tracer(&Sight { delta, least_radius: 0.0, eyes: vec![Eye::ANYWHERE], frame: None });
            let mut rng = Rng(seed);
            for _ in 0..150 {
                let eye = [0, 1, 2].map(|k| space.centre()[k] + 3.0 * space.radius() * rng.signed());
                let towards = |rng: &mut Rng| [(); 3].map(|()| rng.signed());
                let aside = towards(&mut rng);
                let direction = std::array::from_fn(|k| space.centre()[k] + 0.5 * space.radius() * aside[k] - eye[k]);
                let mut query = Query::new(eye, direction).with_cone(0.0, 0.02);
                let (mut legs, mut from) = (Vec::<Leg>::new(), None::<Departure>);
                for _ in 0..5 {
                    let Some(ray) = space.enter_from(&query, from.as_ref().map(|from| &from.start), delta) else { break };
                    let (landing, wanted) = (tracer.follow(&query, from.as_ref(), None), golden.trace_after(&legs, &ray.ray));
                    let mut recorder = Recorder::default();
                    assert_eq!(tracer.follow(&query, from.as_ref(), Some(&mut recorder)), landing);
                    assert_eq!(recorder.batch().rays(), 1);
                    assert_eq!(landing.is_some(), wanted.is_some(), "{ray:?}");
                    let (Some(landing), Some(wanted)) = (landing, wanted) else { break };
                    hits += 1;
                    assert_eq!((landing.surface.tree, landing.surface.front), (wanted.tree, wanted.front), "{ray:?}");
                    assert_eq!(landing.surface.distance, ray.distance(wanted.t));
                    let leg = golden.leg(&legs, &ray.ray, &wanted);
                    assert_eq!(leg.start(), landing.departure.start);
                    legs.push(leg);
                    query = Query::new([0.0; 3], towards(&mut rng)).with_cone(0.01 * rng.unit(), 0.1 * rng.unit());
                    from = Some(landing.departure);
                }
            }
        }
    }
    println!("{hits} hits");
    assert!(hits > 1_500);
}
