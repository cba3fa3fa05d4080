//! The stability lab, reduced: every case without a miss, a double hit, a difference from the golden traverser or a value outside its width (tests
//! check widths), errors within what one rounding allows; and what the hunt came nearest to, shot again.

use lodray::golden::Exact;
use lodray::lab::crack::Closedness;
use lodray::lab::growth::growth;
use lodray::lab::hunt::hunt;
use lodray::lab::{Aim, CASES, Case, FILE_CASES, Found, GOALS, Goal, Judge, Model, Scale, Shot, Tally, suite};
use lodray::mesh::lattice;
use lodray::num::{MAX_LEVELS, VertexForm};
use lodray_test_support::is_nightly;
use lodray_test_support::models::{ball, scene_of, with_vertices};
use std::fs;
use std::path::Path;
use std::process::Output;

/// Rays over all cases; `LODRAY_RAYS` asks for more.
fn total() -> u64 {
    std::env::var("LODRAY_RAYS")
        .map_or(if is_nightly() { 1_500_000 } else { 500_000 }, |text| text.parse().expect("LODRAY_RAYS is a number"))
}

fn sound(name: &str, t: &Tally) {
    assert_eq!((t.misses, t.doubles, t.different, t.overflows, t.saturated), (0, 0, 0, 0, 0), "{name}: first breach {:?}", t.first_breach);
    assert!(t.first_breach.is_none(), "{name}");
    // Each is rounded down once; the first weight takes what two roundings leave.
    assert!(t.t_ulp < 1.0 && t.bary_ulp < 2.0, "{name}: {} {}", t.t_ulp, t.bary_ulp);
    assert!(t.full_bary_ulp < 2.0 * f64::from(1u32 << MAX_LEVELS), "{name}");
}

#[test]
fn every_case_is_sound() {
    let all: Vec<&Case> = CASES.iter().collect();
    let mut rays = 0;
    for (case, share) in all.iter().zip(suite::shares(&all, total())) {
        let row = suite::run(case, Scale::Small, share, 1, &|_| ()).expect("a case");
        println!("{:<14} {:?}", case.name, row.tally);
        sound(case.name, &row.tally);
        // A path has a ray at least.
        let paths = case.aims.iter().any(|aim| matches!(aim, Aim::Leaving(..)));
        assert!(row.tally.rays == share || paths && row.tally.rays > share + share / 2, "{}: {} rays", case.name, row.tally.rays);
        assert!(row.tally.crossing > share / 10, "{}: rays do not reach the surface", case.name);
        assert!(row.tally.compared >= if case.every == 1 { share / 2 } else { share / 1000 }, "{}: too few compared", case.name);
        if case.every > 1 {
            assert!(row.tally.balanced > share / 2, "{}: too few balanced", case.name);
        }
        rays += share;
    }
    println!("{rays} rays");
    let names: std::collections::BTreeSet<_> = CASES.iter().map(|case| case.name).collect();
    assert_eq!(names.len(), CASES.len());
}

#[test]
fn files_run_through_all_families() {
    let models = VertexForm::ALL.map(|form| Model::of_scene("ball", scene_of(&with_vertices(form, ball(3, 0.6, 5)))));
    for case in FILE_CASES {
        let row = suite::shoot(case, &models, 20_000, 2, &|_| ());
        sound(case.name, &row.tally);
        assert!(row.tally.crossing > 1_000, "{}: {:?}", case.name, row.tally);
    }
}

#[test]
fn the_same_on_any_number_of_threads() {
    let case = CASES.iter().find(|case| case.name == "coincident").unwrap();
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let row = pool.install(|| suite::run(case, Scale::Small, 30_000, 3, &|_| ()).unwrap());
        let hunt = pool.install(|| hunt(None, 6_000, 3, &|_| ()).unwrap());
        (row, hunt)
    };
    assert!(run(1) == run(3));
}

#[test]
fn a_hole_and_a_doubled_triangle_are_noticed() {
    // Judged as if they were closed.
    let case = CASES.iter().find(|case| case.name == "edges").unwrap();
    let shoot = |triangles: Vec<[u32; 3]>, points| {
        let h = lodray::mesh::Hierarchy { triangles, points, ..ball(2, 0.3, 1) };
        let mut model = Model::of_hierarchy("changed", h).unwrap();
        assert_eq!(model.closed, Closedness::Open);
        model.closed = Closedness::Oriented;
        suite::shoot(case, &[model], 20_000, 1, &|_| ()).tally
    };
    let h = ball(2, 0.3, 1);
    let (mut triangles, mut points) = (h.triangles.clone(), h.points.clone());
    triangles.pop();
    points.truncate(triangles.len() * lattice::len(2));
    let hole = shoot(triangles, points);
    let (mut triangles, mut points) = (h.triangles.clone(), h.points.clone());
    triangles.push(triangles[0]);
    points.extend_from_slice(h.tree(0));
    let double = shoot(triangles, points);
    for tally in [hole, double] {
        assert!(tally.breaches() > 100 && tally.first_breach.is_some(), "a judge that cannot fail judges nothing: {tally:?}");
    }
}

/// How near hunts must come to `goal`, a little more than what theirs do.
fn near(goal: Goal) -> f64 {
    match goal {
        Goal::Edge => 4096.0,
        Goal::Zeros => -5.0,
        Goal::Lod => 0.0,
        Goal::Gap => 1e-6,
        Goal::Remainder => 0.0,
    }
}

/// What the golden traverser says of how near `found` is, and the range that its goal can take at all.
fn measured(found: &Found) -> (f64, std::ops::RangeInclusive<f64>) {
    let model = found.model().expect("a small model");
    let ties = Exact::new(&model.hierarchy).ties(&found.ray().expect("a ray"));
    let finest = f64::from(found.triangles.len() as u32) * f64::from(1u32 << (2 * found.levels));
    match found.goal.expect("a goal") {
        Goal::Edge => (ties.edge.expect("a triangle") as f64, 1.0..=f64::MAX),
        Goal::Zeros => (-f64::from(ties.edge_zeros), -3.0 * finest..=0.0),
        Goal::Lod => (ties.lod.expect("a decision") as f64, 0.0..=f64::MAX),
        Goal::Gap => (ties.t_gap.expect("two hits"), 0.0..=8.0 * f64::from(1u32 << 31)),
        Goal::Remainder => (ties.remainder.expect("a hit"), 0.0..=0.5),
    }
}

#[test]
fn a_hunt_comes_near_every_goal_and_finds_nothing() {
    let mut nearest = GOALS.map(|goal| (goal, f64::INFINITY));
    // Fewer do not reach the limits that are asserted.
    let (steps, mut mixed) = (total().max(1_500_000) / 60, 0);
    for seed in 1..=8 {
        let hunt = hunt(None, steps, seed, &|_| ()).expect("models");
        let tally = &hunt.tally;
        sound("hunt", tally);
        // Nothing that was asked for is left out, and what is judged is rays that meet something.
        assert_eq!((hunt.climbs, tally.rays), (steps.div_ceil(1024), steps));
        for (what, count, least) in [("compared", tally.compared, 80), ("crossing", tally.crossing, 50)] {
            assert!(count <= steps && 100 * count >= least * steps, "seed {seed}: {count} {what} of {steps}");
        }
        mixed += tally.mixed_levels;
        // Errors come to the very limits of one and two roundings, which `sound` says they keep.
        assert!(tally.t_ulp > 0.999 && tally.bary_ulp > 1.95, "{tally:?}");
        // Models of all forms are hunted at, and a found ray's model is made again in its own.
        let compact = hunt.found.iter().filter(|found| found.vertices.is_compact()).count();
        assert!((1..hunt.found.len()).contains(&compact), "seed {seed}: {compact} of {} compact", hunt.found.len());
        for found in &hunt.found {
            let (value, range) = measured(found);
            assert!(value == found.value && range.contains(&value), "{:?}: {} is {value}, in {range:?}", found.goal, found.value);
        }
        for (goal, value) in &mut nearest {
            let of_goal: Vec<f64> = hunt.found.iter().filter(|f| f.goal == Some(*goal)).map(|f| f.value).collect();
            assert!((1..=3).contains(&of_goal.len()) && of_goal.is_sorted(), "seed {seed}, {goal:?}: {of_goal:?}");
            *value = value.min(of_goal[0]);
        }
    }
    println!("{mixed} on mixed levels");
    assert!((steps * 8 / 25..=steps * 8).contains(&mixed), "{mixed} on mixed levels");
    for (goal, value) in nearest {
        println!("{goal:?}: {value:e}");
        assert!(value <= near(goal), "{goal:?}: no nearer than {value:e}");
    }
}

/// What hunts came nearest to (and would have breached), each ray with its model.
#[test]
fn what_was_found_stays_sound() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/stability-found.json");
    let all: Vec<Found> = serde_json::from_str(&fs::read_to_string(path).expect("the found rays")).expect("records");
    assert!(all.len() >= GOALS.len());
    for (k, found) in all.iter().enumerate() {
        let model = found.model().expect("a model");
        assert!(found.ray().is_some(), "found {k}: not a ray");
        let golden = Exact::new(&model.hierarchy);
        let mut judge = Judge::new(&model, &golden, 1);
        // And a unit beside it, in every component.
        for side in 0..=12 {
            let mut near = found.clone();
            if let Some(at) = (side as usize).checked_sub(1) {
                let by = if at % 2 == 0 { 1 } else { -1 };
                if at < 6 { near.origin[at / 2] += by } else { near.direction[at / 2 - 3] += by }
            }
            // Not longer than the blocks are made for.
            let Some(ray) = near.ray().filter(|_| near.direction.iter().map(|c| c * c).sum::<i64>() <= 1 << 60) else { continue };
            sound(&format!("found {k}, side {side}"), &judge.shoot(0, &Shot { ray, view: None, other: None }));
        }
    }
}

#[test]
fn errors_grow_as_they_must() {
    let growth = growth(7, 1, &|_| ()).expect("models");
    assert!(growth.by_levels.iter().map(|point| point.levels).eq(0..=7));
    assert!(growth.by_distance.iter().map(|point| point.distance.log10().round() as i32).eq(-4..=6));
    for point in &growth.by_levels {
        // Base vertices are rounded to 2^N units, others to finer ones, none to finer than 16: half a step in each coordinate.
        let grid = f64::from(1u32 << point.levels.max(4));
        let most = 0.5 * grid * 3f64.sqrt() + 1.0;
        assert!(point.vertex_loss[0] <= most, "{point:?}");
        // Among so many vertices some are nearly that far off, and the mean is that of points in a cube of 16 units.
        assert!(point.vertex_loss[0] >= 0.6 * most && (7.0..9.0).contains(&point.vertex_loss[1]), "{point:?}");
        assert!(point.bary_ulp[0] < 2.0 && point.bary_ulp[1] < 2.0 * f64::from(1u32 << point.levels), "{point:?}");
    }
    for point in growth.by_levels.iter().chain(&growth.by_distance) {
        assert!((5_000..=20_000).contains(&point.hits), "too few of 20,000 rays hit: {point:?}");
        assert!(
            point.bary_ulp[0] > 1.9 && point.bary_ulp[1] >= point.bary_ulp[0],
            "the error of two roundings is nearly reached: {point:?}"
        );
        // Half a unit on a model of 2^31 units, seen from so many radii on 1024 rows: a pixel grows with distance, and nothing else does.
        let [worst, mean] = point.pixels.map(|pixels| pixels * point.distance);
        assert!((4e-6..1.2e-5).contains(&worst) && (2e-6..4e-6).contains(&mean), "{point:?}");
    }
    for pair in growth.by_distance.windows(2) {
        assert!(pair[1].pixels[0] < pair[0].pixels[0], "a pixel grows with distance, and nothing else does: {pair:?}");
    }
    // Far away, hits are on the base mesh: four levels below, each of which doubles the error.
    let far = growth.by_distance[10].bary_ulp;
    assert!(far[1] == 16.0 * far[0], "{far:?}");
}

fn lodray(folder: &Path, args: &str) -> Output {
    assert_cmd::cargo::cargo_bin_cmd!("lodray").current_dir(folder).args(args.split_whitespace()).output().unwrap()
}

#[test]
fn on_the_command_line() {
    let folder = tempfile::tempdir().unwrap();
    let run = |args: &str| {
        let output = lodray(folder.path(), args);
        assert!(output.status.success() && output.stderr.is_empty(), "{args}: {}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let text = run("stability --case flat --case open --rays 20000 --hunt 2000");
    assert!(text.contains("flat") && text.contains("hunt") && !text.contains("needles") && text.contains("0 breaches"), "{text}");
    let json: serde_json::Value = serde_json::from_str(&run("stability --case tiny --rays 5000 --json")).unwrap();
    assert_eq!((json["rows"][0]["case"].as_str(), json["rows"][0]["misses"].as_u64()), (Some("tiny"), Some(0)));
    run("generate terrain --levels 2 --base 8 -o open.lod");
    assert!(run("stability open.lod --rays 20000 --hunt 500 -o out").contains("cameras"));
    for name in ["stability.md", "stability.json", "found.json"] {
        assert!(folder.path().join("out").join(name).is_file(), "{name}");
    }
}

#[test]
fn bad_input() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("text.lod"), "no scene").unwrap();
    for (args, code, says) in [
        ("stability missing.lod", 1, "missing.lod: cannot open"),
        ("stability text.lod", 1, "text.lod: magic"),
        ("stability --case nothing", 1, "--case nothing: there is no such case; there are needles"),
        ("stability --rays 0", 2, "'0' for '--rays"),
        ("stability --rays -5", 2, "'-5' for '--rays"),
        ("stability --rays 5 --long", 2, "'--rays"),
        ("stability --hunt -1", 2, "'-1' for '--hunt"),
        ("stability --case flat --rays 10 -o text.lod", 1, "cannot make folder text.lod"),
    ] {
        let output = lodray(folder.path(), args);
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{args}: {error}");
        assert!(error.starts_with("error: ") && error.contains(says) && output.stdout.is_empty(), "{args}: {error}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
}
