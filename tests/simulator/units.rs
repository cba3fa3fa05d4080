//! How full the blocks of units are over time, what they cost, and rays of several tiles in turn.

use lodray_test_support::program::{Desk, FAILS, USAGE, write_rays};
use serde_json::Value;

/// A frame whose units have much to do: one group has all of it.
const SHOT: &str = "simulate a.lod --size 64x64 --distance 2 --compute units --set cores.groups=1 --set units.contexts=32";

fn with_scene() -> Desk {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate terrain --levels 3 --base 32 --seed 2 -o a.lod");
    desk
}

fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("no number {pointer}"))
}

#[test]
fn loads_are_what_was_done_over_what_the_block_can_do() {
    let desk = with_scene();
    for way in ["", " --method bvh6", " --method discrete --set units.boxes_per_cycle=4", " --set cores.groups=8 --set units.per_group=2"] {
        let r = desk.json(&format!("{SHOT}{way}"));
        let (phases, units) = (&r["units"]["phases"], number(&r, "/units/units"));
        assert_eq!(number(phases, "/stretch_cycles"), 1024.0);
        let mut full = number(phases, "/none_full");
        for (name, block) in phases["blocks"].as_object().unwrap() {
            let shares: Vec<f64> = block["by_load"].as_array().unwrap().iter().map(|share| share.as_f64().unwrap()).collect();
            assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-9, "{way} {name}: {shares:?}");
            assert_eq!(number(block, "/full"), shares[9]);
            let [least, most] = [0, 1].map(|k| number(block, &format!("/full_of_units/{k}")));
            assert!((0.0..=1.0).contains(&least) && least <= shares[9] + 1e-9 && shares[9] <= most + 1e-9 && most <= 1.0);
            assert!(number(block, "/fullest") <= shares[9] + 1e-9);
            full += number(block, "/fullest");
            // The mean lies between the loads that the steps begin and end with.
            let load = number(block, "/load");
            let least: f64 = shares.iter().zip(0..).map(|(share, step)| share * f64::from(step) / 10.0).sum();
            assert!(least <= load + 1e-9 && load <= least + 0.1 + 1e-9, "{way} {name}: {load}, {shares:?}");
            // The same as what the block alone would need.
            if let Some(bound) = r["roofline"]["limits"].get(name) {
                let share = number(bound, "/share");
                assert!((load - share).abs() <= 0.02 * share + 16.0 / number(&r, "/cycles"), "{way} {name}: {load}, alone {share}");
            }
        }
        assert!((full - 1.0).abs() < 1e-9, "{way}: {full}");
        assert_eq!(units, if way.contains("groups") { 16.0 } else { 1.0 });
        assert!(number(&r, "/units/gate_equivalents") > 5e5);
        // Over a hundred rays for each context: some block is full at times.
        assert!(units > 1.0 || phases["blocks"].as_object().unwrap().values().any(|block| number(block, "/full") > 0.0), "{way}: {phases}");
    }
}

#[test]
fn a_block_that_keeps_nobody_waiting_makes_the_frame_shorter_by_what_it_cost() {
    let desk = with_scene();
    let r = desk.json(&format!("{SHOT} --ease"));
    let plain = desk.json(SHOT);
    let cycles = number(&plain, "/cycles");
    assert_eq!((number(&r, "/cycles"), &r["units"]["blocks"]), (cycles, &plain["units"]["blocks"]));
    assert!(plain["units"].get("eased").is_none());
    let eased = r["units"]["eased"].as_object().unwrap();
    let names: Vec<&str> = eased.keys().map(String::as_str).collect();
    let blocks = ["bary_map", "child_test", "hit_divide", "lod_test", "node_address", "ray_setup", "tessellate", "tri_test"];
    let mut all = [&blocks[..], &["all", "latency", "split_lines"]].concat();
    all.sort_unstable();
    assert_eq!(names, all);
    // What a machine description says gives the same.
    for (name, with) in eased {
        let alone = desk.json(&format!("{SHOT} --set units.eased={name}"));
        assert_eq!(number(&alone, "/cycles"), with.as_f64().unwrap(), "{name}");
        for what in ["/hits", "/l1/requests"] {
            assert_eq!(number(&alone, what), number(&plain, what), "{name}");
        }
        if blocks.contains(&name.as_str()) {
            assert_eq!(number(&alone, &format!("/units/phases/blocks/{name}/load")), 0.0, "{name}");
        }
    }
    // The block that is full the longest costs the most of all.
    let fullest = |name: &&str| number(&plain, &format!("/units/phases/blocks/{name}/fullest"));
    let most = blocks.iter().copied().max_by(|a, b| fullest(a).total_cmp(&fullest(b))).unwrap();
    let least = eased.iter().filter(|(name, _)| blocks.contains(&name.as_str())).min_by_key(|(_, with)| with.as_u64()).unwrap();
    assert_eq!(most, least.0, "{eased:?}");
    assert!(least.1.as_f64().unwrap() < 0.97 * cycles && eased["all"].as_f64().unwrap() < least.1.as_f64().unwrap(), "{eased:?}");
    // So do blocks that are as seldom free but done at once, and lines that are there when the LOD test is.
    for name in ["latency", "split_lines"] {
        assert!(eased[name].as_f64().unwrap() < cycles, "{name}: {eased:?}");
    }
    assert!(eased["latency"].as_f64().unwrap() < 0.97 * cycles, "{eased:?}");
    let late = |r: &Value| number(r, "/units/states/FETCH");
    let early = desk.json(&format!("{SHOT} --set units.eased=split_lines"));
    assert!(late(&early) < 0.7 * late(&plain), "{} of {}", late(&early), late(&plain));
    let none = desk.json(&format!("{SHOT} --method bvh6 --ease"));
    assert!(none["units"]["eased"].get("split_lines").is_none() && none["units"]["eased"].get("latency").is_some());
    // Two at once.
    let two = desk.json(&format!("{SHOT} --set units.eased=ray_setup+lod_test"));
    assert_eq!(two["setup"]["machine"]["description"]["units"]["eased"], "ray_setup+lod_test");
    let text = desk.run(&format!("{SHOT} --ease"));
    for word in ["load", "90 % full", "the fullest", "cycles, eased", "none, all", "  latency", "  split_lines"] {
        assert!(text.contains(word), "no {word} in\n{text}");
    }
}

#[test]
fn tiles_in_turn_change_when_rays_come_and_nothing_that_they_find() {
    let desk = with_scene();
    for way in ["", " --method bvh6", " --compute free"] {
        let shot = SHOT.replace(" --compute units", if way.contains("free") { "" } else { " --compute units" });
        let [tiles, turns] = ["", " --tiles-in-turn 4"].map(|order| desk.json(&format!("{shot}{way}{order}")));
        for what in ["/rays", "/hits", "/l1/requests"] {
            assert_eq!(number(&tiles, what), number(&turns, what), "{way} {what}");
        }
        assert_eq!(tiles["operations"], turns["operations"], "{way}");
        assert_ne!(tiles["cycles"], turns["cycles"], "{way}");
        assert!(tiles["setup"]["view"].get("tiles_in_turn").is_none());
        assert_eq!(turns["setup"]["view"]["tiles_in_turn"], 4);
    }
    // Frames after one another, and the words of a result.
    let frames = desk.json(&format!("{SHOT} --tiles-in-turn 16 --frames 2"));
    assert_eq!((frames["frames"].as_array().unwrap().len(), number(&frames, "/rays")), (2, 2.0 * 64.0 * 64.0));
    assert!(desk.run(&format!("{SHOT} --tiles-in-turn 4")).contains("64x64 rays from 2 bounding radii, of 4 tiles in turn"));
    // A sweep does the same.
    let list = "size = \"64x64\"\ntiles_in_turn = 4\nmethods = [\"lod\"]\ncompute = [\"units\"]\n[[scene]]\nfile = \"a.lod\"\ndistances = [2]\n[[machine]]\nname = \"haydel2023\"\nset = { \"cores.groups\" = 1, \"units.contexts\" = 32 }\n";
    desk.write("jobs.toml", list);
    desk.run("sweep jobs.toml -o swept");
    let row: Value = serde_json::from_str(desk.text("swept/results.jsonl").lines().next().unwrap()).unwrap();
    assert_eq!(number(&row, "/result/cycles"), number(&desk.json(&format!("{SHOT} --tiles-in-turn 4")), "/cycles"));
    // What cannot be.
    write_rays(&desk.path("rays.npy"), 6, &[0.0, 0.0, 9.0, 0.0, 0.0, -1.0]);
    desk.refused(&format!("{SHOT} --tiles-in-turn 3"), USAGE, &["--tiles-in-turn", "must be a power of two from 1 to 64"]);
    desk.refused(&format!("{SHOT} --tiles-in-turn 128"), USAGE, &["must be a power of two from 1 to 64"]);
    desk.refused("simulate a.lod --rays rays.npy --tiles-in-turn 4", USAGE, &["--tiles-in-turn"]);
    desk.refused("simulate a.lod --packet 32 --tiles-in-turn 4", FAILS, &["--tiles-in-turn: packets take the rays of one tile"]);
    desk.refused("simulate a.lod --ease", FAILS, &["--ease: eases parts of traversal units, which --compute units has"]);
    desk.refused(&format!("{SHOT} --ease --set units.eased=all"), FAILS, &["--ease: haydel2023 has eased parts already"]);
    let wrong = format!("{SHOT} --set units.eased=cache");
    desk.refused(&wrong, FAILS, &["--set units.eased = cache: `cache` is no part of a unit that can be eased: there are ray_setup,"]);
    desk.write("jobs.toml", &list.replace("= 4", "= 5"));
    desk.refused("sweep jobs.toml -o none", FAILS, &["jobs.toml: line 2: tiles_in_turn: must be a power of two from 1 to 64"]);
    desk.write("jobs.toml", &list.replace("compute = [\"units\"]", "knobs = { packet = 32 }"));
    desk.refused("sweep jobs.toml -o none", FAILS, &["jobs.toml: line 5: tiles_in_turn: packets take the rays of one tile"]);
}
