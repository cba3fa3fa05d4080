//! `error-time`: figures that follow from one another, runs that go on, and input that is refused.

use lodray_test_support::program::Desk;
use serde_json::Value;

const QUICK: &str = "--size 48x48 --distances 2,6 --samples 1,4 --values delta=0.5,1,4,inf --most-samples 64 --no-host";

fn desk() -> Desk {
    let desk = Desk::new(env!("CARGO_BIN_EXE_lodray"));
    desk.run("generate terrain --levels 4 --base 32 --roughness 0.7 -o a.lod");
    desk
}

fn points<'a>(document: &'a Value, method: &'a str) -> impl Iterator<Item = &'a Value> {
    document["points"].as_array().unwrap().iter().filter(move |point| point["method"] == method)
}

fn number(value: &Value, path: &str) -> f64 {
    value.pointer(path).and_then(Value::as_f64).unwrap_or_else(|| panic!("{path} in {value}"))
}

#[test]
fn errors_fall_along_the_knob_and_what_is_full_resolution_has_none() {
    let desk = desk();
    desk.run(&format!("error-time a.lod -o d {QUICK}"));
    let document: Value = serde_json::from_str(&desk.text("d/error-time.json")).unwrap();
    assert_eq!(document["views"].as_array().unwrap().len(), 2);
    // Two views, two numbers of samples, at four qualities.
    assert_eq!(points(&document, "lod").count(), 2 * 2 * 4);
    // Discrete LOD has all its levels in every view: four splits.
    assert_eq!(points(&document, "discrete").count(), 2 * 2 * 5);
    for errors in ["/geometry/hit", "/geometry/surface", "/geometry/normal_degrees", "/picture/flip", "/viewed/flip"] {
        let all: Vec<&Value> = points(&document, "lod").collect();
        for point in &all {
            let [mean, median, most, maximum] =
                ["mean", "median", "percentile_99", "maximum"].map(|of| number(point, &format!("{errors}/{of}")));
            assert!(median <= most && most <= maximum && mean <= maximum, "{errors} {point}");
        }
        if !errors.starts_with("/viewed") {
            for sweep in all.chunks(4) {
                let means: Vec<_> = sweep.iter().map(|point| number(point, &format!("{errors}/mean"))).collect();
                assert!(means[0] > means[1] && means[1] > means[2] && means[2] > means[3] && means[3] < 1e-3, "{errors}: {means:?}");
            }
        }
    }
    for point in points(&document, "bvh").chain(points(&document, "bvh32")) {
        // The reference is in f64, a BVH in fixed point.
        assert!(number(point, "/geometry/hit/maximum") < 1e-2 && number(point, "/geometry/surface/maximum") < 1e-3, "{point}");
        assert!(
            number(point, "/picture/rmse") < 0.1 && number(point, "/picture/flip/mean") < 1e-3 && number(point, "/picture/ssim") > 0.999
        );
        assert_eq!(number(point, "/geometry/silhouette/pixels"), 0.0);
    }
    // The nearest point is no further than the hit of the same ray, as every ray hits here or misses in both.
    for point in points(&document, "lod").filter(|point| number(point, "/geometry/silhouette/pixels") == 0.0) {
        assert!(number(point, "/geometry/surface/maximum") <= number(point, "/geometry/hit/maximum") + 1e-9);
    }
    // A frame is the one that `simulate` runs.
    let view = &document["views"][0];
    let alone = desk.json("simulate a.lod --size 48x48 --distance 2 --delta 4 --compute units");
    let point = points(&document, "lod").find(|p| p["view"] == 0 && p["samples"] == 1 && p["setting"] == "delta 4").unwrap();
    let costs = point["costs"].as_array().unwrap().iter().find(|costs| costs["compute"] == "units").unwrap();
    assert_eq!((&costs["cycles"], &costs["energy"]["total"]), (&alone["cycles"], &alone["energy"]["total"]), "{view}");
    // Four samples are four rays of each pixel.
    let four = points(&document, "lod").find(|p| p["view"] == 0 && p["samples"] == 4 && p["setting"] == "delta 4").unwrap();
    assert!(number(four, "/costs/0/cycles") > number(point, "/costs/0/cycles"));
    // More samples are nearer to the converged picture, if nothing else is wrong.
    let viewed = |samples: u32| {
        let of = points(&document, "bvh").filter(|point| point["samples"] == samples);
        of.map(|point| number(point, "/viewed/rmse")).sum::<f64>()
    };
    assert!(viewed(4) < viewed(1));
}

#[test]
fn costs_are_of_the_whole_frame_and_errors_of_some_of_its_columns_and_rows() {
    let desk = desk();
    let of = |folder: &str, more: &str| -> Value {
        desk.run(&format!("error-time a.lod -o {folder} --size 150x130 --distances 2 --samples 1 --values delta=1,4 --methods lod,bvh,discrete --compute free --most-samples 0 --no-host {more}"));
        serde_json::from_str(&desk.text(&format!("{folder}/error-time.json"))).unwrap()
    };
    let (all, few) = (of("all", ""), of("few", "--error-size 40"));
    for (document, every, pictures) in [(&all, 1, (150, 130)), (&few, 4, (37, 32))] {
        let view = &document["views"][0];
        assert_eq!((&view["size"], &view["every"]), (&serde_json::json!([150, 130]), &serde_json::json!(every)));
        let file = desk.path(if every == 1 { "all" } else { "few" }).join(document["pictures"][0]["file"].as_str().unwrap());
        assert_eq!(image::image_dimensions(file).unwrap(), pictures);
    }
    for (a, b) in points(&all, "lod").zip(points(&few, "lod")).chain(points(&all, "discrete").zip(points(&few, "discrete"))) {
        assert_eq!((&a["setting"], &a["costs"]), (&b["setting"], &b["costs"]));
        // A sixteenth of the rays, with the same cones: not far from the error of all of them.
        let [a, b] = [a, b].map(|point| number(point, "/geometry/surface/mean"));
        assert!((a - b).abs() <= 0.25 * a + 1e-3, "{a} {b}");
    }
    // Other sizes: those below the named one, and itself, which costs what its points say.
    let sizes: Vec<&Value> = few["sizes"].as_array().unwrap().iter().collect();
    let of_lod: Vec<_> = sizes.iter().filter(|size| size["method"] == "lod").map(|size| size["size"].clone()).collect();
    assert_eq!((sizes.len(), of_lod), (6, vec![serde_json::json!([128, 128]), serde_json::json!([150, 130])]));
    for size in sizes.iter().filter(|size| size["size"] == few["views"][0]["size"]) {
        let same = few["points"].as_array().unwrap().iter().find(|p| p["method"] == size["method"] && p["is_default"] == true).unwrap();
        assert_eq!((&same["setting"], number(same, "/costs/0/cycles")), (&size["setting"], number(size, "/costs/0/cycles")));
    }
    let alone = desk.json("simulate a.lod --size 128x128 --distance 2 --method discrete --compute free");
    let discrete = sizes.iter().find(|size| size["method"] == "discrete" && size["size"][0] == 128).unwrap();
    assert_eq!(discrete["costs"][0]["cycles"], alone["cycles"]);
    for cost in ["time", "energy", "dram-lines"] {
        let chart = desk.text(&format!("few/a-size-{cost}.svg"));
        assert!(chart.contains("128x128, 150x130") && chart.contains("over ours"), "{cost}");
    }
    // The size is in the headlines.
    for chart in ["a-surface-p99-time", "a-distance-time", "winners"] {
        assert!(desk.text(&format!("few/{chart}.svg")).contains("150x130"), "{chart}");
    }
}

#[test]
fn the_terminal_ends_with_the_verdict_of_the_files() {
    let desk = desk();
    let said = desk.run(&format!("error-time a.lod -o d {QUICK} --compute free"));
    let verdict = desk.text("d/verdict.txt");
    assert!(said.trim_end().ends_with(verdict.trim_end()) && verdict.starts_with("48x48: the cheapest"), "{said}");
    assert!(verdict.lines().all(|line| line.chars().count() <= 80), "{verdict}");
    // Two views, although each was drawn with one sample a pixel and with four.
    for cost in ["time", "energy", "DRAM lines"] {
        assert!(verdict.contains(&format!("  {cost}, 2 views: ")), "{verdict}");
    }
}

#[test]
fn costs_at_equal_error_lie_between_the_settings_around_it() {
    let desk = desk();
    desk.run(&format!("error-time a.lod -o d {QUICK} --compute free"));
    let document: Value = serde_json::from_str(&desk.text("d/error-time.json")).unwrap();
    let mut inside = 0;
    for equal in document["equal_error"].as_array().unwrap().iter().filter(|e| e["error"] == "surface-p99" && e["cost"] == "time") {
        let level = number(equal, "/level");
        let sweep = points(&document, "lod").filter(|p| p["view"] == equal["view"] && p["samples"] == equal["samples"]);
        let sweep: Vec<[f64; 2]> =
            sweep.map(|p| [number(p, "/geometry/surface/percentile_99"), number(p, "/costs/0/milliseconds")]).collect();
        let Some(ours) = equal["ours"].as_f64() else {
            assert!(sweep.iter().all(|pair| pair[0] > level));
            continue;
        };
        let below = sweep.iter().filter(|pair| pair[0] <= level).map(|pair| pair[1]).fold(f64::INFINITY, f64::min);
        let above = sweep.iter().filter(|pair| pair[0] > level).map(|pair| pair[1]).fold(0.0, f64::max);
        assert!(ours <= below && (above == 0.0 || ours >= above.min(below)), "{equal}: {sweep:?}");
        inside += u32::from(above > 0.0 && ours < below);
        let bvh = equal["methods"].as_array().unwrap().iter().find(|m| m["method"] == "bvh").unwrap();
        assert!((number(bvh, "/ratio") - number(bvh, "/cost") / ours).abs() < 1e-12);
    }
    assert!(inside > 0, "nothing was interpolated");
    // Of levels only those that exist: the cheapest that is near enough, and the one that the method chooses by itself.
    let mut exist = 0;
    for equal in document["equal_error"].as_array().unwrap().iter().filter(|e| e["error"] == "surface-p99" && e["cost"] == "energy") {
        let levels = || points(&document, "discrete").filter(|p| p["view"] == equal["view"] && p["samples"] == equal["samples"]);
        let near = |p: &&Value| number(p, "/geometry/surface/percentile_99") <= number(equal, "/level");
        let least = levels().filter(near).map(|p| number(p, "/costs/0/energy/total")).reduce(f64::min);
        let of = |list: &str| equal[list].as_array().unwrap().iter().find(|m| m["method"] == "discrete").unwrap().clone();
        assert_eq!(of("methods")["cost"].as_f64(), least, "{equal}");
        if let Some(setting) = of("methods")["setting"].as_str() {
            exist += 1;
            let level = levels().find(|p| p["setting"] == setting).unwrap();
            assert_eq!((Some(number(level, "/costs/0/energy/total")), near(&level)), (least, true));
        }
        let own = levels().find(|p| p["is_default"] == true).unwrap();
        assert_eq!(
            (&of("own_rule")["setting"], of("own_rule")["cost"].as_f64()),
            (&own["setting"], own.pointer("/costs/0/energy/total").unwrap().as_f64())
        );
        assert_eq!(of("own_rule")["why"].is_null(), near(&own), "{equal}");
    }
    assert!(exist > 4, "{exist}");
}

#[test]
fn less_in_scene_and_unit_costs_no_more_error_than_was_allowed() {
    let desk = desk();
    desk.run("error-time a.lod -o d --size 48x48 --distances 2,6 --samples 1 --methods lod --values delta=4 --most-samples 0 --no-host --within 0.5,0.0001");
    let document: Value = serde_json::from_str(&desk.text("d/error-time.json")).unwrap();
    let all = document["left_out"].as_array().unwrap();
    let (gates, bytes) = ("/point/costs/0/unit_gates", "/point/bytes_per_triangle");
    let error = "/point/geometry/surface/maximum";
    assert_eq!(all.len(), 2 * 4);
    for (view, of) in all.chunks(4).enumerate() {
        let names: Vec<&str> = of.iter().map(|left| left["what"].as_str().unwrap()).collect();
        assert_eq!(names, ["whole", "lossless", "within 0.0001", "within 0.5"]);
        assert!(of.iter().all(|left| left["point"]["view"] == view && left["point"]["setting"] == "delta 1"));
        let [whole, lossless, little, much] = of else { panic!("four") };
        // What rays do not read changes nothing.
        for same in ["geometry", "picture"] {
            assert_eq!(whole["point"][same], lossless["point"][same]);
        }
        assert!(number(lossless, gates) < number(whole, gates) && number(lossless, bytes) <= number(whole, bytes));
        assert!(number(much, gates) < number(little, gates) && number(little, gates) <= number(lossless, gates));
        assert!(number(whole, "/coordinate_zeros") == 0.0 && number(much, "/coordinate_zeros") > number(little, "/coordinate_zeros"));
        // Delta's promise, and the pixels that things may move by.
        for left in [little, much] {
            assert!(number(left, error) <= number(whole, error) + number(left, "/pixels"), "{left}");
        }
        assert!(number(much, error) != number(whole, error));
        // Units are smaller, not slower; lines of smaller trees lie in other rows of the DRAM, for better or worse.
        let time = |left: &Value| {
            let costs = left["point"]["costs"].as_array().unwrap().iter().find(|costs| costs["compute"] == "units").unwrap();
            number(costs, "/cycles")
        };
        assert!(time(lossless) <= 1.01 * time(whole), "{} {}", time(lossless), time(whole));
    }
    let table = desk.text("d/left-out.csv");
    assert_eq!(table.lines().count(), 1 + 8 * 2);
    assert!(table.starts_with("scene,distance,setting,left_out,coordinate_zeros,direction_zeros,machine,compute,energy_unit,surface_"));
    for chart in ["gates", "bytes"] {
        assert!(desk.text(&format!("d/a-left-out-{chart}-haydel2023-units.svg")).contains("from 6 radii"));
    }
    // Figures of other values of the knob are none of the points.
    assert_eq!(points(&document, "lod").count(), 2);
}

#[test]
fn the_same_bytes_at_any_number_of_threads_and_after_an_interruption() {
    let desk = desk();
    let whole = |threads, folder: &str| {
        let (code, _, said) = desk.run_on(threads, &format!("error-time a.lod -o {folder} {QUICK} --compute free --methods lod,discrete"));
        assert_eq!(code, 0, "{said}");
        let mut files = desk.files(folder);
        // What the run was called with, and the lines it went on from.
        files.remove("run.json");
        files.remove("views.jsonl");
        files.remove("views.bad.jsonl");
        files
    };
    let first = whole(1, "a");
    assert!(first.contains_key("error-time.json") && first.contains_key("error-time.csv"));
    assert!(first == whole(3, "b"), "threads");
    // One view lost, and half of another line: both are done again.
    let lines = desk.text("a/views.jsonl");
    let second = lines.lines().nth(1).unwrap();
    desk.write("a/views.jsonl", &second[..second.len() / 2]);
    assert!(first == whole(2, "a"), "after an interruption");
}

#[test]
fn a_list_of_jobs_says_what_options_say() {
    let desk = desk();
    desk.write(
        "list.toml",
        "size = \"32x32\"\ndistances = [3]\nmethods = [\"lod\", \"bvh\"]\ndeltas = [1, 2]\n[[scene]]\nfile = \"a.lod\"\n[[machine]]\nname = \"haydel2023\"\n",
    );
    let more = "--samples 1 --most-samples 0 --no-host";
    desk.run(&format!("error-time --jobs list.toml -o a {more}"));
    desk.run(&format!("error-time a.lod --size 32x32 --distances 3 --methods lod,bvh --values delta=1,2 --compute free -o b {more}"));
    assert!(desk.bytes("a/error-time.json") == desk.bytes("b/error-time.json"));
    let document: Value = serde_json::from_str(&desk.text("a/error-time.json")).unwrap();
    assert!(points(&document, "lod").all(|point| point["viewed"].is_null()) && document["views"][0]["converged"].is_null());
}

#[test]
fn what_is_given_in_parts_is_all_measured_and_no_file_replaces_another() {
    let desk = desk();
    for name in ["a_b.lod", "a-b.lod"] {
        std::fs::copy(desk.path("a.lod"), desk.path(name)).unwrap();
    }
    let base = "--size 24x24 --distances 3 --methods lod --samples 1 --most-samples 0 --no-host";
    desk.run(&format!("error-time a_b.lod a-b.lod -o d --values delta=1,2 --values delta=4 --compute free {base}"));
    let document: Value = serde_json::from_str(&desk.text("d/error-time.json")).unwrap();
    assert_eq!(points(&document, "lod").count(), 2 * 3);
    let files: Vec<&str> = document["pictures"].as_array().unwrap().iter().map(|picture| picture["file"].as_str().unwrap()).collect();
    let names: std::collections::BTreeSet<_> = files.iter().collect();
    assert!(names.len() == files.len() && files.iter().all(|file| desk.path("d").join(file).is_file()), "{files:?}");
    let diagrams = desk.files("d").keys().filter(|name| name.ends_with(".svg")).count();
    desk.run(&format!("error-time a_b.lod -o e --values delta=1,2,4 --compute free {base}"));
    assert_eq!(diagrams, 2 * desk.files("e").keys().filter(|name| name.ends_with(".svg")).count());
}

#[test]
fn rays_of_several_tiles_in_turn_cost_what_they_cost_in_simulate() {
    let desk = desk();
    desk.write(
        "list.toml",
        "size = \"64x64\"\ncompute = [\"units\"]\ndistances = [3]\ntiles_in_turn = 4\nmethods = [\"lod\"]\ndeltas = [1]\n[[scene]]\nfile = \"a.lod\"\n[[machine]]\nname = \"haydel2023\"\n",
    );
    desk.run("error-time --jobs list.toml -o a --samples 1 --most-samples 0 --no-host");
    let document: Value = serde_json::from_str(&desk.text("a/error-time.json")).unwrap();
    let cycles =
        |words: &str| desk.json(&format!("simulate a.lod --size 64x64 --distance 3 --compute units {words}"))["cycles"].as_f64().unwrap();
    let point = points(&document, "lod").next().unwrap();
    assert_eq!(number(point, "/costs/0/cycles"), cycles("--tiles-in-turn 4"));
    assert_ne!(number(point, "/costs/0/cycles"), cycles(""));
}

#[test]
fn what_is_wrong_is_refused_before_anything_is_traced() {
    let desk = desk();
    for (args, words) in [
        ("", &["SCENE"][..]),
        ("a.lod --samples 3", &["--samples", "square"]),
        ("a.lod --values roughness=1", &["no method trades error by 'roughness'", "delta"]),
        ("a.lod --values delta=-1", &["delta", "not a quality"]),
        ("a.lod --methods lod,quick", &["'quick' is none of", "discrete"]),
        ("a.lod --pixels-per-degree 0", &["1 to 1000"]),
        ("a.lod --size 8192x8192 --samples 4", &["--samples 4", "too many"]),
        ("a.lod --distances 0", &["distances"]),
        ("a.lod --distances 2,4,2", &["--distances: 2 is given twice"]),
        ("a.lod --machine haydel2023,haydel2023", &["--machine: haydel2023 is given twice"]),
        ("a.lod --compute free,free", &["--compute: free is given twice"]),
        ("a.lod --samples 1,16 --most-samples 16", &["--most-samples 16: a converged picture has at least 64 here"]),
        ("a.lod --error-size 0", &["--error-size", "0 is not in 1.."]),
        ("a.lod --within 0", &["--within", "no number of pixels above 0"]),
        ("a.lod --within -1", &["--within", "'-1' is no number of pixels above 0"]),
        ("a.lod --within 0.1 --methods bvh", &["--within", "lod is none of the methods"]),
        ("a.lod --jobs a.lod", &["--jobs"]),
        ("a.lod a.lod", &["a.lod", "another scene of the name a"]),
        ("none.lod", &["none.lod"]),
    ] {
        desk.refused(
            &format!("error-time {args} -o d"),
            if words[0] == "a.lod"
                || words[0] == "none.lod"
                || words[0] == "--samples 4"
                || words[0].contains(": ")
                || args.ends_with("bvh")
            {
                1
            } else {
                2
            },
            words,
        );
    }
    assert!(!desk.path("d").exists());
}
