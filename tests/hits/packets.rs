//! Packets: hits of the golden traverser on the packet's surface, no miss and no double hit, and what the same rays have alone where they see the same surface.
//!
//! `LODRAY_RAYS` asks for that many rays against the golden traverser, and ten times as many at edges and vertices.

use lodray::golden::exact::Exact;
use lodray::mesh::Hierarchy;
use lodray::method::bvh::NoStore;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::method::packet::{MOST_LANES, PACKET};
use lodray::method::{ClosestHit, Crossings, Knobs, Method, SurfaceHit, find, trace_together};
use lodray::num::{Point, Ray, VertexForm};
use lodray::rays::{Camera, ModelSpace, Query, RaySource, Sight, View};
use lodray::step::{Act, NoSteps, Recorder, Step};
use lodray_test_support::models::{
    Rng, any_cone, any_rays, ball, direction, model, octahedron, ray_through, scene_of, terrain, with_vertices,
};
use lodray_test_support::plain::plain;
use rayon::prelude::*;

fn number(default: u64) -> u64 {
    std::env::var("LODRAY_RAYS").map_or(default, |text| text.parse().expect("LODRAY_RAYS is a number"))
}

/// Closed models, and an open one.
fn models() -> Vec<(&'static str, Hierarchy, bool)> {
    let (base, triangles) = octahedron();
    let ripple = |p: [i64; 3], _| p.map(|v| v as f64 * 40.0 * (1.0 - 0.2 * (p.iter().map(|&v| v * v).sum::<i64>() % 5) as f64 / 5.0));
    vec![
        ("ball", ball(4, 0.4, 1), true),
        ("rough ball", ball(3, 1.5, 2), true),
        ("rippled octahedron", model(3, &base, triangles, ripple), true),
        ("terrain", terrain(6, 4, 0.6, 3), false),
    ]
}

/// Rays that go together: a pencil of nearly the same, or from everywhere.
fn packet(h: &Hierarchy, rng: &mut Rng, lanes: usize) -> Vec<Ray> {
    if rng.below(2) == 0 {
        return any_rays(h, lanes, rng.draw());
    }
    let first = any_rays(h, 1, rng.draw())[0];
    let spread = 2f64.powf(rng.unit() * 16.0);
    let near = |rng: &mut Rng| {
        let at = first.origin.get().map(|v| (v + (rng.signed() * spread) as i64).clamp(1 - (1 << 31), (1 << 31) - 1));
        Ray { origin: Point::new(at[0], at[1], at[2]), ..first }
    };
    (0..lanes).map(|_| near(rng)).collect()
}

#[test]
fn rays_of_packets_hit_what_the_golden_traverser_hits() {
    let rays = number(10_000);
    let models = models();
    for (name, h, _) in &models {
        for form in VertexForm::ALL {
            let scene = scene_of(&with_vertices(form, h.clone()));
            let h = scene.decode();
            let (golden, traverser) = (Exact::new(&h), LodTraverser::new(LodImage::of(&scene)));
            let mut rng = Rng(form as u64 + 17);
            let (mut traced, mut hits, mut apart) = (0, 0, 0);
            while traced < rays / (3 * models.len() as u64) {
                let lanes = 1 + rng.below(MOST_LANES as u64) as usize;
                let packet = packet(&h, &mut rng, lanes);
                let closest = traverser.trace_packet(&packet, &mut NoSteps, packet.iter().map(|_| ClosestHit::new(h.levels)));
                let crossed = traverser.trace_packet(&packet, &mut NoSteps, packet.iter().map(|_| Crossings::default()));
                for ((ray, closest), crossed) in packet.iter().zip(closest).zip(crossed) {
                    let wanted = golden.trace_in_packet(ray, &packet);
                    assert_eq!(closest.record().as_ref().map(plain), wanted, "{name}, {form:?}, {ray:?}");
                    let crossings = golden.crossings_in_packet(ray, &packet);
                    assert_eq!((crossed.front, crossed.back), (crossings.front, crossings.back), "{name}, {form:?}, {ray:?}");
                    hits += u64::from(wanted.is_some());
                    apart += u64::from(wanted != golden.trace(ray));
                }
                traced += lanes as u64;
            }
            println!("{name}, {} vertices: {traced} rays, {hits} hits, {apart} other than alone", form.name());
            assert!(hits > traced / 8 && apart > 0, "{name}: {hits} of {traced} hit, {apart} other than alone");
        }
    }
}

#[test]
fn packets_at_edges_and_vertices_neither_miss_nor_hit_twice() {
    let rays = 10 * number(24_000);
    let models: Vec<_> = models().into_iter().filter(|(_, _, is_closed)| *is_closed).collect();
    let each = rays / (models.len() as u64 * MOST_LANES as u64);
    for (name, h, _) in &models {
        let scene = scene_of(h);
        let h = scene.decode();
        let crossing = (0..each).into_par_iter().map_init(
            || LodTraverser::new(LodImage::of(&scene)),
            |traverser, number| {
                let mut rng = Rng(number.wrapping_mul(0x9E37_79B9_7F4A_7C15) + 5);
                let packet: Vec<Ray> = (0..MOST_LANES)
                    .map(|_| {
                        // At a vertex of some triangle, or between two of them: on an edge of some level.
                        let tree = h.tree(rng.below(h.triangles.len() as u64) as usize);
                        let [a, b] = [(); 2].map(|()| tree[rng.below(tree.len() as u64) as usize].map(i64::from));
                        let at = if rng.below(2) == 0 { a } else { std::array::from_fn(|k| (a[k] + b[k]) / 2) };
                        let towards = direction(&mut rng);
                        ray_through(at, towards, any_cone(&mut rng))
                    })
                    .collect();
                let seen = traverser.trace_packet(&packet, &mut NoSteps, packet.iter().map(|_| Crossings::default()));
                for (ray, seen) in packet.iter().zip(&seen) {
                    assert_eq!(seen.front, seen.back, "{name}, {ray:?} in {packet:?}");
                }
                seen.iter().filter(|seen| seen.front > 0).count()
            },
        );
        let crossing: usize = crossing.sum();
        assert!(crossing as u64 > each * MOST_LANES as u64 / 4, "{name}: {crossing} cross the model");
    }
}

/// Settings of every kind of node, and whether their rays see one surface whatever goes with them.
const SETTINGS: [(&str, &[(&str, &str)]); 10] = [
    ("lod", &[]),
    ("lod", &[("delta", "inf")]),
    ("lod", &[("node-bounds", "prisms"), ("delta", "inf")]),
    ("bvh", &[]),
    ("bvh", &[("node-boxes", "codes"), ("leaf-layout", "indexed"), ("leaf-size", "4")]),
    ("bvh32", &[("leaf-layout", "line"), ("leaf-size", "4")]),
    ("bvh6", &[]),
    ("bvh6", &[("node-boxes", "oriented")]),
    ("discrete", &[("level", "2")]),
    ("stochastic", &[("mean-level", "2.5"), ("transition", "1")]),
];

/// A method with packets of so many rays, and its quality.
fn made(scene: &lodray::format::Scene, lanes: usize, (name, chosen): (&str, &[(&str, &str)])) -> (Box<dyn Method>, f64, String) {
    let registered = find(name).expect("a method");
    let mut knobs = Knobs::default().with(&PACKET, &lanes.to_string()).expect("a packet");
    for (knob, value) in chosen {
        let knob = registered.knobs.iter().find(|own| own.name == *knob).expect("its knob");
        knobs.set(knob, value).expect("its value");
    }
    ((registered.make)(scene, &knobs, &NoStore).expect("a method"), knobs.delta(), format!("{name} {chosen:?}"))
}

fn methods(scene: &lodray::format::Scene, lanes: usize) -> Vec<(Box<dyn Method>, f64, String)> {
    SETTINGS.iter().map(|&setting| made(scene, lanes, setting)).collect()
}

fn queries(camera: &Camera, number: usize) -> Vec<Query> {
    let mut queries = Vec::new();
    camera.batch(number, &mut |_, query| queries.push(*query));
    queries
}

#[test]
fn a_packet_of_one_ray_takes_its_steps_and_others_have_the_hits_of_their_rays() {
    let scene = scene_of(&terrain(6, 4, 0.6, 5));
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View { distance: Some(1.1), ..View::default() }, &space, 61, 43).expect("a camera");
    for ((alone, delta, name), (together, ..)) in methods(&scene, 1).into_iter().zip(methods(&scene, 32)) {
        let sight = Sight::new(&camera, &space, delta);
        let (mut alone, mut together) = (alone.tracer(&sight), together.tracer(&sight));
        assert_eq!((alone.lanes(), together.lanes()), (1, 32));
        let (mut same, mut hits) = (0, 0);
        for batch in 0..camera.batches() {
            let queries = queries(&camera, batch);
            for query in &queries {
                let (mut own, mut packed) = (Recorder::default(), Recorder::default());
                let wanted = alone.recorded(query, &mut own);
                assert_eq!(trace_together(&mut *alone, &[*query], &mut packed), [wanted], "{name}, {query:?}");
                assert!(own.batch().words() == packed.batch().words(), "{name}, {query:?}: other steps");
            }
            for any in [false, true] {
                let queries: Vec<_> = queries.iter().map(|query| Query { any, ..*query }).collect();
                let wanted: Vec<Option<SurfaceHit>> = queries.iter().map(|query| alone.hit(query)).collect();
                let found = trace_together(&mut *together, &queries, &mut NoSteps);
                let is_hit = |hit: &Option<SurfaceHit>| hit.is_some();
                match delta.is_finite() && name.starts_with("lod") {
                    // At least as fine: nearly all of them hit.
                    true => same += wanted.iter().zip(&found).filter(|(a, b)| a == b).count(),
                    false if any => assert!(wanted.iter().map(is_hit).eq(found.iter().map(is_hit)), "{name}"),
                    false => assert_eq!(wanted, found, "{name}"),
                }
                hits += found.iter().flatten().count();
            }
        }
        println!("{name}: {hits} hits, {same} counted as the same");
        assert!(hits > 1000, "{name}: {hits} hits");
    }
}

#[test]
fn a_packet_asks_for_fewer_lines_and_does_the_tests_of_all_its_rays() {
    let scene = scene_of(&terrain(6, 4, 0.6, 5));
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View { distance: Some(1.1), ..View::default() }, &space, 64, 64).expect("a camera");
    for ((alone, delta, name), (together, ..)) in methods(&scene, 1).into_iter().zip(methods(&scene, 32)) {
        let sight = Sight::new(&camera, &space, delta);
        let steps = |method: &dyn Method| {
            let (mut tracer, mut recorder) = (method.tracer(&sight), Recorder::default());
            for batch in 0..camera.batches() {
                trace_together(&mut *tracer, &queries(&camera, batch), &mut recorder);
            }
            recorder.batch()
        };
        let [alone, together] = [steps(&*alone), steps(&*together)];
        assert_eq!((alone.rays(), together.rays()), (64 * 64, 64 * 64 / 32), "{name}");
        let sum =
            |batch: &lodray::step::Batch, of: fn(Step) -> u32| batch.words().iter().map(|word| u64::from(of(word.step()))).sum::<u64>();
        let lines = |step: Step| step.fetch.map_or(0, |fetch| fetch.lines);
        let ended = |step: Step| if let Act::End { .. } = step.act { step.lanes } else { 0 };
        let found = |step: Step| if let Act::End { found, .. } = step.act { found } else { 0 };
        let tests = |step: Step| if step.act.met().is_some() { step.lanes } else { 0 };
        assert_eq!((sum(&alone, ended), sum(&together, ended)), (64 * 64, 64 * 64), "{name}");
        if name != "lod []" {
            assert_eq!(sum(&alone, found), sum(&together, found), "{name}");
        }
        let ratio = sum(&together, lines) as f64 / sum(&alone, lines) as f64;
        println!("{name}: {ratio:.3} of the lines, {:.3} of the tests of nodes", sum(&together, tests) as f64 / sum(&alone, tests) as f64);
        assert!(ratio < 0.25 && sum(&together, tests) >= sum(&alone, tests) * 9 / 10, "{name}: {ratio}");
    }
}

#[test]
fn stochastic_levels_are_discrete_ones_of_which_each_ray_has_its_own() {
    let scene = scene_of(&terrain(6, 4, 0.6, 5));
    let space = ModelSpace::of(&scene);
    let camera = Camera::new(&View { distance: Some(1.1), ..View::default() }, &space, 61, 43).expect("a camera");
    let queries: Vec<Query> = (0..camera.batches()).flat_map(|batch| queries(&camera, batch)).collect();
    let hits = |name, chosen: &[(&str, &str)]| {
        let (method, delta, _) = made(&scene, 1, (name, chosen));
        let mut tracer = method.tracer(&Sight::new(&camera, &space, delta));
        queries.iter().map(|query| tracer.hit(query)).collect::<Vec<_>>()
    };
    let levels: Vec<_> = (0..=4).map(|level| hits("discrete", &[("level", &level.to_string())])).collect();
    for (mean, level) in [("0", 0), ("1.2", 1), ("1.8", 2), ("4", 4), ("9.5", 4)] {
        assert!(hits("stochastic", &[("mean-level", mean)]) == levels[level], "{mean}");
    }
    let [one, other] = ["0", "1"].map(|seed| hits("stochastic", &[("mean-level", "2.25"), ("transition", "1"), ("draw-seed", seed)]));
    for drawn in [&one, &other] {
        let both = drawn.iter().zip(&levels[2]).zip(&levels[3]);
        assert!(both.clone().all(|((hit, coarse), fine)| hit == coarse || hit == fine));
        let apart: Vec<_> = both.filter(|((_, coarse), fine)| coarse != fine).collect();
        let finer = apart.iter().filter(|((hit, _), fine)| hit == fine).count() as f64 / apart.len() as f64;
        assert!(apart.len() > 1000 && (0.2..0.3).contains(&finer), "{finer} of {}", apart.len());
    }
    assert!(one != other);
    // By its own rule: finer from nearer, and where the quality is higher.
    let mean = |distance, delta: &str| {
        let camera = Camera::new(&View { distance: Some(distance), ..View::default() }, &space, 64, 64).expect("a camera");
        let (method, delta, _) = made(&scene, 1, ("stochastic", &[("delta", delta)]));
        let choices = method.choices(&Sight::new(&camera, &space, delta));
        choices[0].1.parse::<f64>().expect("a level")
    };
    let [near, far, better] = [mean(1.5, "1"), mean(4.0, "1"), mean(4.0, "4")];
    assert!(near > far && better > far && far < 4.0, "{near}, {far}, {better}");
}
