//! The stability lab, reduced: every case without a miss, a double hit, a difference from the golden traverser or a value outside its width (tests
//! check widths), errors within what one rounding allows; and what the hunt came nearest to, shot again.

use lodray::golden::Exact;
use lodray::mesh::lattice;
use lodray::num::MAX_LEVELS;
use lodray::report::crack::Closedness;
use lodray::stability::growth::growth;
use lodray::stability::hunt::{GOALS, hunt};
use lodray::stability::{CASES, Case, FILE_CASES, Found, Judge, Model, Scale, Shot, Tally, lab};
use lodray_test_support::models::{ball, scene_of};
use std::fs;
use std::path::Path;
use std::process::Output;

/// Rays over all cases; `LODRAY_RAYS` asks for more.
fn total() -> u64 {
    std::env::var("LODRAY_RAYS").map_or(1_500_000, |text| text.parse().expect("LODRAY_RAYS is a number"))
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
    for (case, share) in all.iter().zip(lab::shares(&all, total())) {
        let row = lab::run(case, Scale::Small, share, 1, &|_| ()).expect("a case");
        println!("{:<14} {:?}", case.name, row.tally);
        sound(case.name, &row.tally);
        assert_eq!(row.tally.rays, share);
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
    let h = ball(3, 0.6, 5);
    let models = [Model::of_scene("ball", scene_of(&h))];
    for case in FILE_CASES {
        let row = lab::shoot(case, &models, 20_000, 2, &|_| ());
        sound(case.name, &row.tally);
        assert!(row.tally.crossing > 1_000, "{}: {:?}", case.name, row.tally);
    }
}

#[test]
fn the_same_on_any_number_of_threads() {
    let case = CASES.iter().find(|case| case.name == "coincident").unwrap();
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let row = pool.install(|| lab::run(case, Scale::Small, 30_000, 3, &|_| ()).unwrap());
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
        lab::shoot(case, &[model], 20_000, 1, &|_| ()).tally
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

#[test]
fn a_hunt_comes_near_every_goal_and_finds_nothing() {
    let found = hunt(None, total() / 30, 7, &|_| ()).expect("models");
    sound("hunt", &found.tally);
    for goal in GOALS {
        let nearest = found.found.iter().find(|f| f.goal == Some(goal)).unwrap_or_else(|| panic!("{goal:?}: no approach"));
        println!("{goal:?}: {:e}", nearest.value);
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
    for point in &growth.by_levels {
        // Base vertices are rounded to 2^N units, others to finer ones, none to finer than 16: half a step in each coordinate.
        let grid = f64::from(1u32 << point.levels.max(4));
        assert!(point.vertex_loss[0] <= 0.5 * grid * 3f64.sqrt() + 1.0, "{point:?}");
        assert!(point.bary_ulp[0] < 2.0 && point.bary_ulp[1] < 2.0 * f64::from(1u32 << point.levels), "{point:?}");
    }
    for pair in growth.by_distance.windows(2) {
        assert!(pair[1].pixels[0] < pair[0].pixels[0], "a pixel grows with distance, and nothing else does: {pair:?}");
    }
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
