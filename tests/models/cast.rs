//! `cast` end to end: what the rays of a file meet, with every method, against the exact golden traverser and against each other.

use lodray::format::Scene;
use lodray::golden::{Exact, Leg};
use lodray::method::bvh::NoStore;
use lodray::method::leave::side;
use lodray::method::{Departure, METHODS};
use lodray::method::{Knobs, knob, lod};
use lodray::rays::{ModelSpace, Query, RayFile, Sight};
use lodray::run::{HitRow, cast};
use lodray_test_support::models::{Rng, scene_of, terrain};
use lodray_test_support::program::{Desk, FAILS, USAGE, write_rays};
use npyz::WriterBuilder;
use std::cmp::Ordering;
use std::path::Path;

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
    for method in METHODS.iter().filter(|method| !method.of_input()).map(|method| method.name) {
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

/// Numbers that float32 has.
fn single(v: [f64; 3]) -> [f64; 3] {
    v.map(|v| f64::from(v as f32))
}

fn row(query: &Query) -> [f64; 12] {
    let ([x, y, z], [dx, dy, dz]) = (query.origin, query.direction);
    let after = query.after.map_or(-1.0, |after| after as f64);
    [x, y, z, dx, dy, dz, query.radius, query.tan_theta, query.t_min, query.t_max, f64::from(u8::from(query.any)), after]
}

/// The same file, of float32.
fn write_single(path: &Path, queries: &[Query]) {
    let file = std::fs::File::create(path).unwrap();
    let mut writer = npyz::WriteOptions::new().default_dtype().shape(&[queries.len() as u64, 12]).writer(file).begin_nd().unwrap();
    writer.extend(queries.iter().flat_map(row).map(|v| v as f32)).unwrap();
    writer.finish().unwrap();
}

fn write(desk: &Desk, name: &str, queries: &[Query]) {
    write_rays(&desk.path(name), 12, &queries.iter().flat_map(row).collect::<Vec<_>>());
}

fn read(desk: &Desk, name: &str) -> Vec<HitRow> {
    npyz::NpyFile::new(&desk.bytes(name)[..]).unwrap().into_vec().unwrap()
}

/// Follows the rays one by one, by the library and, for the first `golden`, by the exact traverser: the hits are theirs. A ray that leaves a closed body to the outside meets a front face or
/// nothing, one that goes inside a back face; none meets what it leaves. How many there are, and how many meet something near.
fn check_followed(scene: &Scene, method: &str, delta: f64, queries: &[Query], hits: &[HitRow], golden: usize) -> [u64; 2] {
    let entry = METHODS.iter().find(|entry| entry.name == method).unwrap();
    let made = (entry.make)(scene, &Knobs::default().with(&knob::DELTA, &delta.to_string()).unwrap(), &NoStore).unwrap();
    let rays = RayFile::new(queries.to_vec());
    let (h, space) = (scene.decode(), ModelSpace::of(scene));
    let mut tracer = made.tracer(&Sight::new(&rays, &space, delta));
    let exact = Exact::new(&h);
    let (mut ends, mut legs): (Vec<Option<Departure>>, Vec<Vec<Leg>>) = (Vec::new(), Vec::new());
    let (mut followed, mut near) = (0, 0);
    for (number, (query, row)) in queries.iter().zip(hits).enumerate() {
        let what = format!("{method}, ray {number}: {query:?} {row:?}");
        let from = query.after.map(|after| ends[after as usize].expect("a hit"));
        let landing = tracer.follow(query, from.as_ref(), None);
        assert_eq!(landing.map_or(-1, |landing| landing.surface.tree.cast_signed()), row.tree, "{what}");
        if let Some(landing) = &landing {
            let surface = &landing.surface;
            let (wanted, own) = ((surface.distance, surface.node, surface.front), (row.t, row.node.cast_unsigned(), row.front == 1));
            assert_eq!((wanted, i32::from(surface.level)), (own, row.level), "{what}");
        }
        if let (Some(from), Some(after)) = (&from, query.after) {
            let before = &hits[after as usize];
            assert!((row.tree, row.level, row.node) != (before.tree, before.level, before.node), "it meets what it leaves: {what}");
            let met = (row.tree >= 0).then_some(row.front == 1);
            match side(&from.corners, space.direction(query.direction).unwrap()) {
                Ordering::Greater => assert_ne!(met, Some(false), "outside, and a back face: {what}"),
                Ordering::Less => assert_eq!(met, Some(false), "inside, and no back face: {what}"),
                Ordering::Equal => {}
            }
            followed += 1;
            near += u64::from(row.t < 1e-5 * space.radius());
        }
        if number < golden {
            let before = query.after.map_or(Vec::new(), |after| legs[after as usize].clone());
            let ray = space.enter_from(query, from.as_ref().map(|from| &from.start), delta);
            let wanted = ray.as_ref().and_then(|ray| exact.trace_after(&before, &ray.ray));
            assert_eq!(wanted.is_some(), row.tree >= 0, "{what}");
            let mut path = before;
            if let (Some(ray), Some(wanted)) = (ray, wanted) {
                assert_eq!([row.tree, row.level, row.node].map(i32::cast_unsigned), [wanted.tree, wanted.level, wanted.node], "{what}");
                assert_eq!((row.t, row.front == 1), (ray.distance(wanted.t), wanted.front), "{what}");
                path.push(exact.leg(&path, &ray.ray, &wanted));
            }
            legs.push(path);
        }
        ends.push(landing.map(|landing| landing.departure));
    }
    [followed, near]
}

/// Rays that `cast` met something with, and rays from the very points that it wrote, three times over, on closed scenes. `LODRAY_RAYS` asks for that many of the latter over all scenes and methods.
#[test]
fn rays_that_follow_hits_neither_leak_nor_meet_what_they_leave() {
    let total: usize = std::env::var("LODRAY_RAYS").map_or(12_000, |text| text.parse().expect("LODRAY_RAYS is a number"));
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    let (mut all, mut close) = (0, 0);
    for (seed, kind) in [(1, "sphere"), (2, "spikes")] {
        desk.run(&format!("generate {kind} --levels 4 --base 128 --seed {seed} -o {kind}.lod"));
        let scene = Scene::open(&desk.path(&format!("{kind}.lod"))).unwrap();
        let space = ModelSpace::of(&scene);
        // A BVH has full resolution for every cone.
        for (method, delta) in [("lod", 1.0), ("bvh6", f64::INFINITY)] {
            let mut rng = Rng(seed);
            let mut paths: Vec<Query> = queries(&space, (total / 12).max(100), seed)
                .into_iter()
                .map(|query| Query {
                    origin: single(query.origin),
                    direction: single(query.direction),
                    tan_theta: f64::from(query.tan_theta as f32),
                    ..query
                })
                .collect();
            let mut newest = 0;
            // To the second hits twice, so that rays share a start.
            for bounce in 0..3 {
                write(&desk, "rays.npy", &paths);
                desk.run(&format!("cast {kind}.lod rays.npy --method {method} -o hits.npy"));
                let hits = read(&desk, "hits.npy");
                let starts: Vec<_> = hits.iter().enumerate().skip(newest).filter(|(_, hit)| hit.tree >= 0).collect();
                newest = paths.len();
                for (after, hit) in starts {
                    for _ in 0..[2, 2, 1][bounce] {
                        let cone = [0.0, 1e-3 * space.radius(), 1e-3][rng.below(3) as usize];
                        let next = Query::new(hit.point, single([(); 3].map(|()| rng.signed()))).with_cone(0.0, f64::from(cone as f32));
                        paths.push(Query { after: Some(after as u64), ..next });
                    }
                }
            }
            write(&desk, "rays.npy", &paths);
            let json = desk.json(&format!("cast {kind}.lod rays.npy --method {method} -o hits.npy"));
            let hits = read(&desk, "hits.npy");
            let [followed, near] = check_followed(&scene, method, delta, &paths, &hits, 2500);
            assert_eq!((&json["followed"], &json["crowded"]), (&followed.into(), &0.into()));
            println!("{kind}, {method}: {followed} rays from hits, {near} of which meet something within 1e-5 radii");
            // Starts are those of the hits, whatever the roundings of the file, and whatever the number of threads.
            write_single(&desk.path("single.npy"), &paths);
            desk.run_on(1, &format!("cast {kind}.lod single.npy --method {method} -o single-hits.npy"));
            assert_eq!(desk.bytes("hits.npy"), desk.bytes("single-hits.npy"), "{kind}, {method}");
            all += followed;
            close += near;
        }
    }
    println!("{all} rays from hits, {close} of which meet something within 1e-5 radii; no leak");
    assert!(all as usize > total / 2, "{all}");
}

#[test]
fn rays_that_cannot_follow_are_one_clear_error() {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate sphere --levels 3 --base 32 --seed 2 -o a.lod");
    let space = ModelSpace::of(&Scene::open(&desk.path("a.lod")).unwrap());
    let (centre, radius) = (space.centre(), space.radius());
    let eye = [centre[0], centre[1], centre[2] + 4.0 * radius];
    let first = Query::new(eye, [0.0, 0.0, -1.0]);
    write(&desk, "first.npy", &[first]);
    desk.run("cast a.lod first.npy -o hits.npy");
    let point = read(&desk, "hits.npy")[0].point;
    let next = |origin| Query { after: Some(0), ..Query::new(origin, [0.1, 0.2, 1.0]) };
    let beside = [point[0] + 1e-3 * radius, point[1], point[2]];
    write(&desk, "good.npy", &[first, next(point)]);
    write(&desk, "beside.npy", &[first, next(point), next(beside)]);
    write(&desk, "missed.npy", &[first, Query::new(eye, [0.0, 0.0, 1.0]), next(point), Query { after: Some(1), ..next(eye) }]);
    let said = desk.run("cast a.lod good.npy -o out.npy");
    assert_eq!(said.trim_end(), "out.npy: 2 rays, 1 hit, 1 start at an earlier hit");
    let away = format!("beside.npy: ray 2: its origin is {:.2e}", 1e-3 * radius);
    desk.refused("cast a.lod beside.npy -o out.npy", FAILS, &[&away[..away.len() - 4], "away from the hit of ray 0"]);
    desk.refused("cast a.lod missed.npy -o out.npy", FAILS, &["missed.npy: ray 3: it starts at the hit of ray 1, which meets nothing"]);
    desk.refused("cast a.lod good.npy --method reference -o out.npy", FAILS, &["--method reference: its hits are not exact"]);
    for name in ["good", "beside", "missed"] {
        for method in ["lod", "reference"] {
            desk.run(&format!("cast a.lod {name}.npy --method {method} --follow false -o out.npy"));
        }
    }
}
