//! Frames whose every count, cycle, DRAM command and picojoule is written down in `tests/pinned/frames`: nothing of them drifts unseen.
//!
//! `scripts/pin` writes them again; a commit that does so does nothing else, and says why the figures moved.

use lodray::format::Scene;
use lodray::machine::Machine;
use lodray::method::bvh::NoStore;
use lodray::method::{Knobs, METHODS, find};
use lodray::num::VertexForm;
use lodray::rays::{Camera, ModelSpace, Sight, View};
use lodray::report::result::{MachineFacts, MethodFacts, SceneFacts, Setup, SimResult, ViewFacts};
use lodray::report::results_version;
use lodray::run::{Compute, FrameRays, Job, simulate};
use lodray::sim::dram::{ChannelCounts, DramEnergy};
use lodray::sim::replay::Run;
use lodray::sim::unit::UnitCounts;
use lodray_test_support::models::{scene_of, terrain, with_vertices};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use xxhash_rust::xxh3::xxh3_64;

/// Set by `scripts/pin`.
const REWRITE: &str = "LODRAY_REWRITE_PINS";
const SIDE: u32 = 160;

/// A frame of the terrain.
struct Pin {
    name: &'static str,
    method: &'static str,
    /// Knobs that are not as by default.
    knobs: &'static [(&'static str, &'static str)],
    machine: &'static str,
    compute: Compute,
    distance: f64,
    vertices: VertexForm,
}

impl Pin {
    const fn new(name: &'static str, method: &'static str, machine: &'static str, compute: Compute, distance: f64) -> Self {
        Self { name, method, knobs: &[], machine, compute, distance, vertices: VertexForm::Exact }
    }

    const fn with(self, knobs: &'static [(&'static str, &'static str)]) -> Self {
        Self { knobs, ..self }
    }

    const fn compact(self) -> Self {
        Self { vertices: VertexForm::Compact, ..self }
    }
}

const PINS: [Pin; 13] = [
    Pin::new("lod-free", "lod", "haydel2023", Compute::Free, 1.2),
    Pin::new("lod-paper", "lod", "haydel2023", Compute::Free, 1.2).with(&[("line-layout", "paper")]),
    Pin::new("lod-units", "lod", "haydel2023", Compute::Units, 2.0),
    Pin::new("lod-units-gpu", "lod", "turing2018", Compute::Units, 0.7),
    Pin::new("lod-compact-free", "lod", "haydel2023", Compute::Free, 1.2).compact(),
    Pin::new("lod-compact-units", "lod", "haydel2023", Compute::Units, 2.0).compact(),
    Pin::new("lod-packet", "lod", "packet", Compute::Free, 4.0),
    Pin::new("bvh-free", "bvh", "haydel2023-ddr3", Compute::Free, 1.2),
    Pin::new("bvh-units", "bvh", "haydel2023", Compute::Units, 2.0).with(&[
        ("node-boxes", "codes"),
        ("leaf-layout", "packed"),
        ("leaf-size", "2"),
    ]),
    Pin::new("bvh6-units", "bvh6", "haydel2023", Compute::Units, 1.5),
    Pin::new("bvh32-units", "bvh32", "turing2018", Compute::Units, 1.2).with(&[("leaf-layout", "indexed")]),
    Pin::new("discrete-free", "discrete", "haydel2023-public", Compute::Free, 1.2).with(&[("level", "2")]),
    Pin::new("discrete-units", "discrete", "haydel2023", Compute::Units, 4.0),
];

/// A file of this test.
fn pinned(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/pinned").join(name)
}

/// Of all pinned frames.
fn checksum() -> String {
    let frames = PINS.iter().flat_map(|pin| std::fs::read(pin.file()).expect("a pinned frame"));
    format!("{:08x}", xxh3_64(&frames.collect::<Vec<_>>()) >> 32)
}

impl Pin {
    fn file(&self) -> PathBuf {
        pinned("frames").join(format!("{}.json", self.name))
    }

    /// Everything that the frame gives.
    fn figures(&self, scene: &Scene) -> Value {
        let entry = find(self.method).expect("a method");
        let mut knobs = Knobs::default();
        for (name, value) in self.knobs {
            let knob = METHODS.iter().flat_map(|method| method.knobs).find(|knob| knob.name == *name).expect("a knob");
            knobs.set(knob, value).expect("one of its values");
        }
        let method = (entry.make)(scene, &knobs, &NoStore).expect("a method on a scene");
        let space = ModelSpace::of(scene);
        let view = View { distance: Some(self.distance), direction: Some([0.35, -0.5, 0.6]), up: Some([0.0, 0.0, 1.0]), ..View::default() };
        let camera = Camera::new(&view, &space, SIDE, SIDE).expect("a camera");
        let sight = Sight::new(&camera, &space, knobs.delta());
        let frame = FrameRays { method: &*method, rays: &camera, sight: &sight };
        let machine = Machine::shipped(self.machine).expect("a machine");
        let job = Job { machine: machine.clone(), compute: self.compute, window: None };
        let run = simulate(&frame, &[job], &mut |_| ()).pop().expect("a run").expect("a result");
        let setup = Setup {
            scene: SceneFacts::from(scene),
            method: MethodFacts::new(entry, &knobs, &method.choices(&sight), 0),
            view: Some(ViewFacts::new(&camera)),
            frames: None,
            rays: None,
            compute: self.compute,
            machine: MachineFacts { label: self.machine.to_owned(), set: Vec::new(), description: machine },
        };
        let result = SimResult::new(setup, entry, &method.map(&sight), &run).expect("figures");
        let mut figures = serde_json::to_value(&result).expect("JSON");
        // What was run is above.
        figures.as_object_mut().expect("a table").remove("setup");
        json!({ "result": figures, "run": raw(&run) })
    }
}

/// What the result does not say, as counted.
fn raw(run: &Run) -> Value {
    let mut counts = serde_json::to_value(run.counts).expect("JSON");
    // The result has it by name.
    counts.as_object_mut().expect("a table").remove("traffic");
    json!({
        "counts": counts,
        "dram_pj": dram(&run.dram),
        "channels": run.channels.iter().map(channel).collect::<Vec<_>>(),
        "units": run.units.as_ref().map(units),
    })
}

fn dram(energy: &DramEnergy) -> Value {
    let DramEnergy { background_pj, activate_pj, read_pj, write_pj, refresh_pj, io_pj } = *energy;
    json!({ "background": background_pj, "activate": activate_pj, "read": read_pj, "write": write_pj, "refresh": refresh_pj, "io": io_pj })
}

fn channel(counts: &ChannelCounts) -> Value {
    json!({
        "activates": counts.activates,
        "precharges": counts.precharges,
        "reads": counts.reads,
        "writes": counts.writes,
        "refreshes": counts.refreshes,
        "row_hits": counts.row_hits,
        "row_misses": counts.row_misses,
        "row_conflicts": counts.row_conflicts,
        "bus_clocks": counts.bus_clocks,
        "active_clocks": counts.active_clocks,
        "active_down_clocks": counts.active_down_clocks,
        "precharged_down_clocks": counts.precharged_down_clocks,
        "queued_clocks": counts.queued_clocks,
        "longest_queue": counts.longest_queue,
    })
}

fn units(counts: &UnitCounts) -> Value {
    let blocks = counts.blocks.iter().map(|(name, block)| {
        let counts = json!({ "taken": block.taken, "refused": block.refused, "busy": block.busy, "occupancy": block.occupancy });
        ((*name).to_owned(), counts)
    });
    json!({
        "cycles": counts.cycles,
        "states": counts.states,
        "blocks": blocks.collect::<serde_json::Map<_, _>>(),
        "longest_queue": counts.longest_queue,
    })
}

/// Adds where `now` differs from `pinned` to `found`.
fn differences(place: &str, pinned: &Value, now: &Value, found: &mut Vec<String>) {
    match (pinned, now) {
        (Value::Object(a), Value::Object(b)) => {
            let keys = a.keys().chain(b.keys().filter(|key| !a.contains_key(*key)));
            keys.for_each(|key| differences(&format!("{place}/{key}"), &pinned[key], &now[key], found));
        }
        (Value::Array(a), Value::Array(b)) if a.len() == b.len() => {
            a.iter().zip(b).enumerate().for_each(|(k, (a, b))| differences(&format!("{place}/{k}"), a, b, found));
        }
        _ if pinned != now => found.push(format!("{place}: pinned {pinned}, now {now}")),
        _ => (),
    }
}

#[test]
fn frames_are_as_they_were() {
    let [exact, compact] = [VertexForm::Exact, VertexForm::Compact].map(|form| scene_of(&with_vertices(form, terrain(8, 5, 0.6, 11))));
    let rewrite = std::env::var_os(REWRITE).is_some();
    let mut moved = Vec::new();
    for pin in &PINS {
        let now = pin.figures(if pin.vertices.is_compact() { &compact } else { &exact });
        let file = pin.file();
        if rewrite {
            let text = serde_json::to_string_pretty(&now).expect("JSON") + "\n";
            std::fs::write(&file, text).expect("a file that can be written");
            continue;
        }
        let text = std::fs::read_to_string(&file).unwrap_or_else(|why| panic!("{}: {why}", file.display()));
        let mut found = Vec::new();
        differences("", &serde_json::from_str(&text).expect("JSON"), &now, &mut found);
        if !found.is_empty() {
            let first = found.iter().take(8).map(String::as_str).collect::<Vec<_>>().join("\n");
            moved.push(format!("{}: {} figures\n{first}", pin.name, found.len()));
        }
    }
    assert!(moved.is_empty(), "figures moved; scripts/pin writes them again\n{}", moved.join("\n"));
    if rewrite {
        std::fs::write(pinned("checksum"), checksum() + "\n").expect("a file that can be written");
    }
}

/// Results of sweeps are of another version of the program once a pin has moved.
#[test]
fn the_version_of_results_is_that_of_the_pins() {
    let version = results_version();
    assert_eq!(version.rsplit_once('-').expect("a checksum").1, checksum(), "scripts/pin writes the checksum again");
}

#[test]
fn a_figure_that_moved_is_named() {
    let mut found = Vec::new();
    let pinned = json!({ "a": 1, "b": [1.5, { "c": 2 }], "d": 7 });
    differences("", &pinned, &json!({ "a": 1, "b": [1.5, { "c": 3 }], "e": 0 }), &mut found);
    assert_eq!(found, ["/b/1/c: pinned 2, now 3", "/d: pinned 7, now null", "/e: pinned null, now 0"]);
}
