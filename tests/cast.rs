//! `cast` end to end: what the rays of a file meet, with every method, against the exact golden traverser and against each other.

use lodray::format::Scene;
use lodray::golden::Exact;
use lodray::method::METHODS;
use lodray::method::bvh::NoStore;
use lodray::method::{Knobs, knob, lod};
use lodray::rays::{ModelSpace, Query, RayFile, Sight};
use lodray::run::{HitRow, cast};
use lodray_test_support::models::{Rng, scene_of, terrain};
use lodray_test_support::program::{Desk, FAILS, USAGE, write_rays};

/// Rays at a scene from around it, thin and wide.
fn queries(space: &ModelSpace, count: usize, seed: u64) -> Vec<Query> {
    let mut rng = Rng(seed);
    let (centre, radius) = (space.centre(), space.radius());
    let mut point = |of: f64| -> [f64; 3] { std::array::from_fn(|k| centre[k] + of * radius * rng.signed()) };
    let query = |k: usize| {
        let (from, at) = (point(2.0), point(0.5));
        let direction: [f64; 3] = std::array::from_fn(|k| at[k] - from[k]);
        Query::new(from, direction).with_cone(0.0, [0.0, 1e-3, 1e-2][k % 3])
    };
    (0..count).map(query).collect()
}

fn hits(method: &str, scene: &Scene, queries: Vec<Query>, delta: f64) -> Vec<HitRow> {
    let entry = METHODS.iter().find(|entry| entry.name == method).unwrap();
    let knobs = Knobs::default().with(&knob::DELTA, &delta.to_string()).unwrap();
    let made = (entry.make)(scene, &knobs, &NoStore).unwrap();
    let rays = RayFile::new(queries);
    cast(&*made, scene, &rays, &Sight::new(&rays, &ModelSpace::of(scene), delta), &|_| ())
}

#[test]
fn hits_are_the_golden_traversers_between_any_two_distances() {
    let scene = scene_of(&terrain(4, 4, 0.6, 5));
    let h = scene.decode();
    let (space, golden) = (ModelSpace::of(&scene), Exact::new(&h));
    let all = queries(&space, 3000, 1);
    let whole = hits(lod::METHOD.name, &scene, all.clone(), 1.0);
    let mut met = 0;
    for (query, hit) in all.iter().zip(&whole) {
        let exact = space.enter(query, 1.0).and_then(|ray| golden.trace(&ray.ray).map(|hit| (ray, hit)));
        let Some((ray, exact)) = exact else {
            assert!(hit.tree == -1 && hit.t == f64::INFINITY && hit.point[0].is_nan());
            continue;
        };
        assert_eq!([hit.tree, hit.level, hit.node].map(i32::cast_unsigned), [exact.tree, exact.level, exact.node]);
        assert_eq!(hit.triangle, (i64::from(exact.tree) << 8) + i64::from(exact.full_node));
        assert_eq!((hit.t, hit.front == 1), (ray.distance(exact.t), exact.front));
        met += 1;
    }
    assert!(met > 1000, "{met}");

    // Where nothing nearer counts than a step behind a hit, what is met is behind it: the same as from there on, crossing by crossing.
    let mut behind = 0;
    let met: Vec<_> = all.iter().zip(&whole).filter(|(_, hit)| hit.tree >= 0).collect();
    let beyond = |(query, hit): &(&Query, &HitRow)| {
        let step = space.enter(query, 1.0).unwrap().step;
        query.between(hit.t + 0.5 * step, f64::INFINITY)
    };
    let nearer = |(query, hit): &(&Query, &HitRow)| {
        let step = space.enter(query, 1.0).unwrap().step;
        query.between(0.0, hit.t - 0.5 * step)
    };
    let up_to = |(query, hit): &(&Query, &HitRow)| {
        let step = space.enter(query, 1.0).unwrap().step;
        query.between(hit.t - 0.5 * step, hit.t + 0.5 * step)
    };
    for (later, (query, first)) in hits(lod::METHOD.name, &scene, met.iter().map(beyond).collect(), 1.0).iter().zip(&met) {
        assert!(later.tree == -1 || later.t > first.t);
        let crossings = golden.crossings(&space.enter(query, 1.0).unwrap().ray);
        // Unless two are at one distance.
        assert!(later.tree >= 0 || crossings.front + crossings.back >= 1);
        behind += u32::from(later.tree >= 0);
    }
    assert!(behind > 100, "{behind}");
    assert!(hits(lod::METHOD.name, &scene, met.iter().map(nearer).collect(), 1.0).iter().all(|hit| hit.tree == -1));
    let same = hits(lod::METHOD.name, &scene, met.iter().map(up_to).collect(), 1.0);
    assert!(same.iter().zip(&met).all(|(hit, (_, first))| (hit.tree, hit.node, hit.t) == (first.tree, first.node, first.t)));
}

#[test]
fn any_hit_is_found_just_where_the_closest_is() {
    let scene = scene_of(&terrain(4, 4, 0.9, 7));
    let space = ModelSpace::of(&scene);
    let closest = queries(&space, 20_000, 2);
    let any: Vec<_> = closest.iter().map(|query| Query { any: true, ..*query }).collect();
    for method in ["lod", "bvh", "bvh6", "bvh32", "discrete"] {
        let [closest, any] = [&closest, &any].map(|queries| hits(method, &scene, queries.clone(), 1.0));
        let mut farther = 0;
        for (closest, any) in closest.iter().zip(&any) {
            assert_eq!(closest.tree >= 0, any.tree >= 0, "{method}");
            assert!(closest.t <= any.t, "{method}");
            farther += u32::from(closest.t < any.t);
        }
        assert!(farther > 0, "{method}: some ray finds a farther hit first");
    }
}

#[test]
fn methods_agree_at_full_resolution_and_levels_are_as_chosen() {
    let scene = scene_of(&terrain(4, 3, 0.6, 9));
    let space = ModelSpace::of(&scene);
    let all: Vec<_> = queries(&space, 2000, 3);
    let bvh = hits("bvh", &scene, all.clone(), 1.0);
    let finest = [
        hits("lod", &scene, all.clone(), f64::INFINITY),
        hits("bvh6", &scene, all.clone(), 1.0),
        hits("bvh32", &scene, all.clone(), 1.0),
        hits("discrete", &scene, all.clone(), f64::INFINITY),
    ];
    let plain = |hit: &HitRow| (hit.t, hit.triangle, hit.finest_barycentrics.map(f32::to_bits), hit.point.map(f64::to_bits));
    for other in &finest {
        assert!(bvh.iter().zip(other).all(|(a, b)| plain(a) == plain(b)));
    }
    let truth = hits("reference", &scene, all.clone(), 1.0);
    let step = 2.0 * space.radius() / f64::from(1 << 30);
    let near = bvh.iter().zip(&truth).filter(|(a, b)| a.tree >= 0 && (a.t - b.t).abs() < 1e3 * step).count();
    assert!(near as f64 > 0.99 * bvh.iter().filter(|hit| hit.tree >= 0).count() as f64);
    // The base mesh.
    for method in ["lod", "discrete"] {
        assert!(hits(method, &scene, all.clone(), 0.0).iter().all(|hit| hit.tree == -1 || hit.level == 0), "{method}");
    }
}

#[test]
fn files_are_numpys_and_wrong_ones_are_one_clear_error() {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate terrain --levels 3 --base 32 --seed 2 -o a.lod");
    let scene = Scene::open(&desk.path("a.lod")).unwrap();
    let rows: Vec<f64> = queries(&ModelSpace::of(&scene), 300, 4).iter().flat_map(|q| q.origin.into_iter().chain(q.direction)).collect();
    write_rays(&desk.path("rays.npy"), 6, &rows);
    for method in METHODS.iter().map(|method| method.name) {
        let said = desk.run(&format!("cast a.lod rays.npy --method {method} -o {method}.npy"));
        assert!(said.starts_with(&format!("{method}.npy: 300 rays, ")), "{said}");
        let bytes = std::fs::read(desk.path(&format!("{method}.npy"))).unwrap();
        assert_eq!(bytes[..6], *b"\x93NUMPY");
        let file = npyz::NpyFile::new(&bytes[..]).unwrap();
        assert_eq!(file.shape(), [300]);
        let descr = file.dtype().descr();
        for field in ["'t', '<f8'", "'triangle', '<i8'", "'normal', '<f4', (3,)", "'point', '<f8', (3,)"] {
            assert!(descr.contains(field), "no {field} in {descr}");
        }
        desk.run_on(1, &format!("cast a.lod rays.npy --method {method} -o again.npy"));
        assert_eq!(bytes, std::fs::read(desk.path("again.npy")).unwrap(), "{method}: the same with one thread");
    }
    let json = desk.json("cast a.lod rays.npy --method discrete --level 1 -o out.npy");
    assert_eq!((&json["rays"], &json["choices"]["level"]), (&300.into(), &"1".into()));
    assert!(json["hits"].as_u64().unwrap() > 50);

    write_rays(&desk.path("seven.npy"), 7, &rows[..70]);
    desk.write("text.npy", "no array");
    let mut late = vec![0.0; 24];
    (late[3], late[9 + 6], late[11], late[23]) = (1.0, 1.0, -1.0, 5.0);
    late[9] = 1.0;
    late[21] = 1.0;
    write_rays(&desk.path("late.npy"), 12, &late);
    desk.refused("cast a.lod seven.npy -o out.npy", FAILS, &["seven.npy: an array of shape [10, 7]"]);
    desk.refused("cast a.lod text.npy -o out.npy", FAILS, &["text.npy: no array of NumPy's"]);
    desk.refused("cast a.lod late.npy -o out.npy", FAILS, &["late.npy: ray 1: column 11 must be the number of an earlier ray"]);
    desk.refused("cast a.lod none.npy -o out.npy", FAILS, &["none.npy: "]);
    desk.refused("cast a.lod rays.npy -o rays.npy", FAILS, &["rays.npy"]);
}

#[test]
fn files_of_rays_run_on_machines_and_wait_for_each_other_there() {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate terrain --levels 3 --base 32 --seed 2 -o a.lod");
    let scene = Scene::open(&desk.path("a.lod")).unwrap();
    let row = |after: f64, q: &Query| {
        let tail = [q.radius, q.tan_theta, q.t_min, q.t_max, 0.0, after];
        q.origin.into_iter().chain(q.direction).chain(tail).collect::<Vec<f64>>()
    };
    let all = queries(&ModelSpace::of(&scene), 300, 4);
    let free: Vec<f64> = all.iter().flat_map(|query| row(-1.0, query)).collect();
    let chain: Vec<f64> = all.iter().enumerate().flat_map(|(k, query)| row(k as f64 - 1.0, query)).collect();
    write_rays(&desk.path("free.npy"), 12, &free);
    write_rays(&desk.path("chain.npy"), 12, &chain);
    for method in ["lod", "bvh", "bvh6", "bvh32", "discrete"] {
        let cast = desk.json(&format!("cast a.lod free.npy --method {method} -o hits.npy"));
        for compute in ["free", "units"] {
            let [together, one_by_one] =
                ["free", "chain"].map(|rays| desk.json(&format!("simulate a.lod --rays {rays}.npy --method {method} --compute {compute}")));
            assert_eq!((&together["rays"], &together["hits"]), (&300.into(), &cast["hits"]), "{method}");
            assert_eq!(together["setup"]["rays"], serde_json::json!({ "file": "free.npy", "count": 300 }));
            assert!(together["setup"].get("view").is_none());
            for result in [&together, &one_by_one] {
                let causes = result["stalls"]["cycles"].as_object().unwrap().values();
                let all: u64 = causes.map(|cycles| cycles.as_u64().unwrap()).sum();
                assert_eq!(all, result["stalls"]["context_cycles"].as_u64().unwrap(), "{method} {compute}");
            }
            for same in ["hits", "operations", "traffic"] {
                let (a, b) = (&together[same], &one_by_one[same]);
                // Lines that two rays ask for at once are asked of the L2 once.
                let (a, b) = if same == "traffic" { (&a["bytes_per_ray"]["l1"], &b["bytes_per_ray"]["l1"]) } else { (a, b) };
                assert_eq!(a, b, "{method} {compute} {same}");
            }
            let [together, one_by_one] = [together, one_by_one].map(|result| result["cycles"].as_u64().unwrap());
            assert!(one_by_one > 10 * together, "{method} {compute}: {one_by_one} cycles one by one, {together} together");
        }
    }
    let said = desk.run("simulate a.lod --rays chain.npy -o out");
    assert!(said.contains("300 rays of chain.npy"), "{said}");
    assert!(desk.text("out/run.json").contains("chain.npy"));
    desk.refused("simulate a.lod --rays none.npy", FAILS, &["none.npy: "]);
    for camera in ["--size 8x8", "--distance 2", "--view front", "--fov 20"] {
        desk.refused(&format!("simulate a.lod --rays free.npy {camera}"), USAGE, &["--rays"]);
    }
}
