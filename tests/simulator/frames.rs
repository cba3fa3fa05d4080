//! Frames after one another, as typed: a camera that turns, a camera on a path, caches that stay warm.

use lodray_test_support::program::{Desk, FAILS, USAGE};
use serde_json::Value;

fn desk() -> Desk {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate terrain --levels 3 --base 32 --seed 2 -o a.lod");
    desk
}

fn count(value: &Value, key: &str) -> u64 {
    value[key].as_u64().unwrap_or_else(|| panic!("no count {key} in {value}"))
}

fn number(value: &Value, key: &str) -> f64 {
    value[key].as_f64().unwrap_or_else(|| panic!("no number {key} in {value}"))
}

#[test]
fn frames_add_up_and_the_first_is_the_frame_alone() {
    let desk = desk();
    for (method, compute) in [("lod", "free"), ("bvh", "free"), ("lod", "units"), ("discrete", "units")] {
        let shot = format!("simulate a.lod --method {method} --compute {compute} --size 96x64 --distance 2.5");
        let alone = desk.json(&shot);
        let [only] = alone["frames"].as_array().unwrap().as_slice() else { panic!("one frame") };
        assert_eq!((count(only, "cycles"), count(only, "start")), (count(&alone, "cycles"), 0));
        assert!((number(only, "energy") - number(&alone["energy"], "total")).abs() < 1e-9 * number(only, "energy"));
        assert!(alone["warm"].is_null() && alone["setup"]["frames"].is_null());

        let four = desk.json(&format!("{shot} --frames 4 --turn 0"));
        let frames = four["frames"].as_array().unwrap();
        assert_eq!((frames.len(), &frames[0]), (4, only), "{method}, {compute}");
        // The same rays each time: what was read is still there.
        for frame in &frames[1..] {
            assert_eq!(count(frame, "l1_requests"), count(only, "l1_requests"));
            assert_eq!((count(frame, "dram_bytes"), count(frame, "l2_misses")), (0, 0), "{method}, {compute}: all lines fit into the L2");
            assert!(number(frame, "energy") < number(only, "energy"), "{method}, {compute}: {frame} {only}");
            // Units may have more to do than to wait for.
            let most = if compute == "free" { 1.0 } else { 1.02 };
            assert!(number(frame, "cycles") < most * number(only, "cycles"), "{method}, {compute}: {frame} {only}");
        }
        let sum = |key| frames.iter().map(|frame| count(frame, key)).sum::<u64>();
        assert_eq!((sum("rays"), sum("l1_requests")), (count(&four, "rays"), count(&four["l1"], "requests")));
        assert_eq!(sum("dram_bytes"), count(&four["dram"], "bytes"));
        let warm = &four["warm"];
        assert_eq!(warm["frames"], serde_json::json!([3, 4]));
        assert_eq!(number(warm, "cycles"), (count(&frames[2], "cycles") + count(&frames[3], "cycles")) as f64 / 2.0);
        assert!(number(warm, "stragglers") > 0.0 && number(warm, "stragglers") < 1.0);
        let text = desk.run(&format!("{shot} --frames 4 --turn 0"));
        assert!(text.contains("4 frames of 96x64 rays") && text.contains("  3 to 4"), "{text}");
    }
}

#[test]
fn a_path_of_keys_is_the_turn_that_it_describes_and_threads_change_nothing() {
    let desk = desk();
    desk.write("still.toml", "[[key]]\neye = [0, 2, 3]\n[[key]]\neye = [0, 2, 3]\n");
    let shot = "simulate a.lod --size 64x48 --frames 3";
    let still = desk.json(&format!("{shot} --path still.toml"));
    let turned = desk.json(&format!("{shot} --turn 0 --eye 0,2,3"));
    assert_eq!((&still["frames"], &still["warm"]), (&turned["frames"], &turned["warm"]));
    // It moves from one key to the next: the last frame is that of the last key.
    desk.write("move.toml", "[[key]]\neye = [0, 2, 3]\n[[key]]\neye = [1, 2, 3]\ntarget = [0, 0.1, 0]\n");
    let moved = desk.json(&format!("{shot} --path move.toml"));
    let last = desk.json("simulate a.lod --size 64x48 --eye 1,2,3 --target 0,0.1,0");
    assert_eq!(count(&moved["frames"][2], "l1_requests"), count(&last["l1"], "requests"));
    let (code, one, _) = desk.run_on(1, &format!("{shot} --path move.toml --json"));
    assert_eq!((code, one), (0, desk.run(&format!("{shot} --path move.toml --json"))));
}

#[test]
fn error_time_has_what_a_warm_frame_costs() {
    let desk = desk();
    let options = "--quick --size 64x64 --distances 3 --compute free --methods lod,discrete --most-samples 0 --no-host";
    let measured = |out: &str, words: &str| -> Value {
        let (code, said) = desk.hear(&format!("error-time a.lod -o {out} {options} {words}"));
        assert_eq!(code, 0, "{said}");
        serde_json::from_str(&desk.text(&format!("{out}/error-time.json"))).unwrap()
    };
    let costs =
        |document: &Value| -> Vec<Value> { document["points"].as_array().unwrap().iter().map(|point| point["costs"][0].clone()).collect() };
    let document = measured("warm", "--frames 4 --turn 5");
    let own = document["points"].as_array().unwrap().iter().find(|point| point["method"] == "lod" && point["is_default"] == true).unwrap();
    let simulated = desk.json("simulate a.lod --size 64x64 --distance 3 --frames 4 --turn 5");
    let warm = &own["costs"][0]["warm"];
    assert_eq!(
        (number(warm, "energy"), 32.0 * number(warm, "dram_lines")),
        (number(&simulated["warm"], "energy"), number(&simulated["warm"], "dram_bytes"))
    );
    assert!(
        (number(warm, "milliseconds") * 2e6 - number(&simulated["warm"], "cycles")).abs() < 1e-6 * number(&simulated["warm"], "cycles")
    );
    let header = desk.text("warm/error-time.csv").lines().next().unwrap().to_owned();
    assert!(["warm_time", "warm_energy", "warm_dram_lines"].iter().all(|name| header.contains(name)), "{header}");
    // Without frames nothing else changes.
    let strip = |costs: Vec<Value>| -> Vec<Value> {
        let without = |mut cost: Value| {
            cost.as_object_mut().unwrap().remove("warm");
            cost
        };
        costs.into_iter().map(without).collect()
    };
    let cold = costs(&measured("cold", ""));
    assert!(cold.iter().all(|cost| cost["warm"].is_null()) && strip(costs(&document)) == cold);
}

#[test]
fn frames_that_cannot_be_are_refused() {
    let desk = desk();
    let shot = "simulate a.lod --size 16x12";
    desk.refused(&format!("{shot} --frames 0"), USAGE, &["--frames"]);
    desk.refused(&format!("{shot} --frames 2 --turn nan"), USAGE, &["--turn"]);
    desk.refused(&format!("{shot} --frames 2 --vcd a.vcd --window 0:9"), USAGE, &["--frames", "--vcd"]);
    desk.refused(&format!("{shot} --frames 2 --path none.toml"), FAILS, &["none.toml"]);
    for (text, words) in [
        ("[[key]]\neye = [0, 2, 3]\n", ["bad.toml", "two [[key]] tables"]),
        ("[[key]]\neye = [0, 2]\n", ["bad.toml", "length 3"]),
        ("[[key]]\neye = [0, 2, 3]\nlens = 3\n", ["bad.toml", "lens"]),
        ("[[key]]\neye = [0, 2, nan]\n[[key]]\neye = [0, 2, 3]\n", ["bad.toml", "three finite numbers"]),
    ] {
        desk.write("bad.toml", text);
        desk.refused(&format!("{shot} --frames 2 --path bad.toml"), FAILS, &words);
    }
    desk.write("good.toml", "[[key]]\neye = [0, 2, 3]\n[[key]]\neye = [1, 2, 3]\n");
    desk.refused(&format!("{shot} --path good.toml"), USAGE, &["--frames"]);
    desk.refused(&format!("{shot} --frames 1 --path good.toml"), FAILS, &["--frames of 2 or more"]);
}
