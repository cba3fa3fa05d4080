//! What a plan says is needed is what the scene's points and codes need, looked up another way; no ray of a job goes below the level that it says; and what is one too narrow
//! is refused. Units that are said to be fast enough are, simulated again, and with a context less they are not.

use lodray::format::Scene;
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{BoundKind, Hierarchy, edge_index, lattice};
use lodray::method::ClosestHit;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::num::VertexForm;
use lodray::plan::Measure;
use lodray::rays::{Camera, ModelSpace, RaySource, View};
use lodray::step::{Act, Step, StepSink};
use lodray_test_support::program::{Desk, USAGE};
use lodray_test_support::surfaces::scene_with;

fn made(scene: procedural::Scene, levels: u32, vertices: VertexForm) -> Scene {
    let options = Options { levels: Some(levels), base: Some(32), seed: 5, ..Options::new(scene) };
    scene_with(&procedural::generate(&options).expect("a surface"), BoundKind::Total, vertices)
}

const SCENES: [procedural::Scene; 5] =
    [procedural::Scene::Terrain, procedural::Scene::Cloth, procedural::Scene::Sphere, procedural::Scene::Spikes, procedural::Scene::Room];

/// Coordinates of all points that a ray can read, nodes with a code other than 0 below such nodes by level, and the largest code.
fn read(h: &Hierarchy, tree: usize, level: u32, node: u32, points: &mut Vec<i32>, splits: &mut [u64]) -> u8 {
    let (levels, len) = (h.levels, lattice::len(h.levels));
    let p = lattice::node(levels, level, node);
    let of = &h.points[tree * len..];
    points.extend(p.iter().flat_map(|&at| of[lattice::index(levels, at)]));
    if level == levels {
        return 0;
    }
    let per_tree = h.bounds.codes.len() / h.triangles.len();
    let code = |a, b| h.bounds.codes[tree * per_tree + edge_index(levels, level, a, b)];
    let own = code(p[1], p[2]).max(code(p[2], p[0])).max(code(p[0], p[1]));
    if own == 0 {
        return 0;
    }
    splits[level as usize] += 1;
    (0..4).map(|k| read(h, tree, level + 1, 4 * node + k, points, splits)).fold(own, u8::max)
}

#[test]
fn widths_are_those_of_what_rays_can_read() {
    for (scene, form) in SCENES.into_iter().flat_map(|scene| VertexForm::ALL.map(|form| (scene, form))) {
        let scene = made(scene, 3, form);
        let (h, measure) = (scene.decode(), Measure::of(&scene));
        let (mut points, mut splits) = (Vec::new(), [0; 3]);
        let code = (0..h.triangles.len()).map(|tree| read(&h, tree, 0, 0, &mut points, &mut splits)).fold(0, u8::max);
        let (needs, data) = (measure.needs(), measure.data(&scene.depths()));
        let name = &scene.meta().name;
        // The least width whose ends hold them all.
        let holds = |bits: u32, c: i32| i64::from(c) >= -(1 << (bits - 1)) && i64::from(c) < 1 << (bits - 1);
        assert!(points.iter().all(|&c| holds(needs.coordinate_bits, c)), "{name}");
        assert!(points.iter().any(|&c| !holds(needs.coordinate_bits - 1, c)), "{name}");
        assert!(points.iter().all(|c| c % (1 << needs.vertex_zeros) == 0), "{name}");
        assert!(points.iter().any(|c| c % (2 << needs.vertex_zeros) != 0), "{name}");
        assert_eq!(needs.code_bits, u8::BITS - code.leading_zeros(), "{name}");
        assert_eq!((needs.levels, needs.compact, needs.exact), (3, form.is_compact(), !form.is_compact()));
        // Splits of 32 bytes on levels 0 and 1; vertices of 32 bytes each, or of 16 or 8 on the last level.
        let (record, vertices) = match form {
            VertexForm::Exact => (64, 32 * splits.iter().sum::<u64>()),
            VertexForm::Compact => (32, 16 * splits[2]),
            VertexForm::Short => (32, 8 * splits[2]),
        };
        assert_eq!(data.above_flat, record * h.triangles.len() as u64 + 32 * (splits[0] + splits[1]) + vertices, "{name}");
        assert!(data.above_flat <= data.stored && data.reached == data.stored, "{name}");
        assert_eq!(data.stored as f64, scene.bytes_per_triangle() * scene.finest_triangles() as f64);
    }
}

/// The most splits on the way to a node under visit, and whether any edge was neither open nor closed.
#[derive(Default)]
struct Deepest {
    tests: u32,
    refined: bool,
}

impl StepSink for Deepest {
    fn step(&mut self, step: Step) {
        if let Act::LodTest { refine } = step.act {
            self.tests += 1;
            self.refined |= refine;
        }
    }
}

#[test]
fn no_ray_goes_below_the_deepest_level() {
    let (mut above, mut exact) = (0, 0);
    for scene in SCENES {
        let scene = made(scene, 4, VertexForm::Compact);
        let (measure, space) = (Measure::of(&scene), ModelSpace::of(&scene));
        let mut traverser = LodTraverser::new(LodImage::of(&scene));
        for (distance, delta) in [(0.5, 1.0), (4.0, 1.0), (20.0, 1.0), (60.0, 1.0), (60.0, 4.0), (2.0, 0.0), (2.0, f64::INFINITY)] {
            let camera = Camera::new(&View { distance: Some(distance), ..View::default() }, &space, 48, 48).expect("a camera");
            let needs = measure.rays(&camera, delta);
            let (mut deepest, mut refined) = (0, false);
            for batch in 0..camera.batches() {
                camera.batch(batch, &mut |_, query| {
                    let Some(ray) = space.enter(query, delta) else { return };
                    let (mut steps, mut hit) = (Deepest::default(), ClosestHit::new(4));
                    traverser.trace(&ray.ray, &mut steps, &mut hit);
                    deepest = deepest.max(hit.record().map_or(0, |hit| hit.level.get() as u32));
                    refined |= steps.refined;
                });
            }
            let name = format!("{} from {distance} at {delta}", scene.meta().name);
            assert!(deepest <= needs.deepest_level, "{name}: {deepest} of {}", needs.deepest_level);
            assert!(!refined || needs.deepest_level > 0, "{name}");
            assert_eq!(needs.lod_test, delta > 0.0 && delta.is_finite(), "{name}");
            assert_eq!(needs.deepest_level, if delta == 0.0 { 0 } else { needs.deepest_level }, "{name}");
            assert!(delta.is_finite() || needs.deepest_level == 4, "{name}");
            above += u32::from(needs.deepest_level < 4 && delta > 0.0);
            exact += u32::from(deepest == needs.deepest_level);
        }
    }
    assert!(above > 5 && exact > 15, "{above} below the finest level, {exact} as deep as said");
}

#[test]
fn a_plan_takes_its_scenes_and_refuses_others() {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate terrain --levels 3 --base 32 -o rough.lod");
    desk.run("generate sphere --levels 2 --base 32 -o round.lod");
    desk.run("generate sphere --levels 4 --base 32 -o deep.lod");
    let shown = desk.run("plan rough.lod round.lod -o both.toml");
    for word in ["structure", "levels", "quad-BVH depth", "bits of a context", "numbers", "plan in both.toml"] {
        assert!(shown.contains(word), "{word} in {shown}");
    }
    let plan = desk.text("both.toml");
    assert!(plan.contains("levels = 3\n") && plan.contains("scenes = [\"rough.lod\", \"round.lod\"]"), "{plan}");
    assert!(desk.run("plan rough.lod round.lod --check both.toml").contains("2 scenes fit the plan"));
    desk.refused("plan deep.lod --check both.toml", 1, &["deep.lod", "levels is 4, and the plan has 3"]);
    // Each number one less than there is.
    for (at, line) in plan.lines().enumerate().skip_while(|(_, line)| *line != "[scene]").skip(1) {
        let (name, value) = line.split_once(" = ").expect("a number");
        let less = match (name, value.parse::<u32>()) {
            (_, Ok(value)) if name.ends_with("-zeros") => (value + 1).to_string(),
            (_, Ok(0)) | (_, Err(_)) if value != "true" => continue,
            (_, Ok(value)) => (value - 1).to_string(),
            _ => "false".to_owned(),
        };
        let narrow: Vec<_> =
            plan.lines().enumerate().map(|(k, l)| if k == at { format!("{name} = {less}") } else { l.to_owned() }).collect();
        desk.write("narrow.toml", &narrow.join("\n"));
        desk.refused("plan rough.lod round.lod --check narrow.toml", 1, &["does not fit the plan", name]);
    }
    // A plan that was made before gives the same sizes.
    desk.run("plan rough.lod round.lod --package made.sv");
    desk.run("plan --plan both.toml --package again.sv");
    assert_eq!(desk.text("made.sv"), desk.text("again.sv"));
    assert!(desk.text("made.sv").contains("localparam int unsigned MAX_LEVELS = 3;"));
    desk.write("bad.toml", "program = 1");
    desk.refused("plan rough.lod --check bad.toml", 1, &["bad.toml"]);
    desk.write(
        "jobs.toml",
        "size = \"32x32\"\nmethods = [\"lod\"]\ndeltas = [\"inf\"]\ndistances = [2]\n[[scene]]\nfile = \"rough.lod\"\n[[machine]]\nname = \"haydel2023\"\n",
    );
    let document = desk.json("plan --job jobs.toml");
    assert_eq!(document["plan"]["rays"]["lod-test"], false);
    assert_eq!(document["plan"]["rays"]["deepest-level"], 3);
    desk.run("plan --job jobs.toml -o full.toml");
    // Without a job the plan's own views are looked at, and it is said which.
    let shown = desk.run("plan rough.lod --check full.toml");
    assert!(shown.contains("rough.lod: the rays of 1 view of the plan fit; others are not promised"), "{shown}");
    let shown = desk.run("plan round.lod --check full.toml");
    assert!(shown.contains("round.lod: the plan has no views of a scene named sphere; no rays were checked"), "{shown}");
    desk.write("shallow.toml", &desk.text("full.toml").replace("deepest-level = 3", "deepest-level = 2"));
    desk.refused(
        "plan rough.lod --check shallow.toml",
        1,
        &["the plan's own job, on scene rough.lod,", "deepest-level is 3, and the plan has 2"],
    );
    for (from, to, wanted) in [
        ("delta = \"inf\"", "delta = \"nan\"", "wrong.toml: views.terrain[0].delta must be a number from 0 on, or inf"),
        ("levels = 3", "levels = 99", "wrong.toml: scene.levels must be 0 to 10, but is 99"),
        ("program = \"", "program = \"9", "wrong.toml: program must be a version up to "),
    ] {
        let text = desk.text("full.toml");
        assert!(text.contains(from), "{from} in {text}");
        desk.write("wrong.toml", &text.replacen(from, to, 1));
        for command in
            ["plan rough.lod --check wrong.toml", "prune rough.lod --plan wrong.toml -o out.lod", "simulate rough.lod --plan wrong.toml"]
        {
            desk.refused(command, 1, &[wanted]);
        }
    }
    desk.write(
        "jobs.toml",
        "size = \"32x32\"\nmethods = [\"lod\"]\ndistances = [2]\n[[scene]]\nfile = \"rough.lod\"\n[[machine]]\nname = \"haydel2023\"\n",
    );
    desk.refused("plan --job jobs.toml --check full.toml", 1, &["job of scene", "does not fit the plan"]);
}

/// Cycles of both views, and what their rays hit, on `machine` with `compute`.
fn frames(desk: &Desk, machine: &str, compute: &str) -> [(f64, u64); 2] {
    [1, 2].map(|distance| {
        let shot = format!("simulate rough.lod --size 64x64 --distance {distance} --delta inf --compute {compute} {machine}");
        let frame = desk.json(&shot);
        (frame["cycles"].as_f64().expect("cycles"), frame["hits"].as_u64().expect("hits"))
    })
}

#[test]
fn units_are_the_least_that_keep_the_share() {
    let desk = Desk::new(assert_cmd::cargo::cargo_bin!("lodray"));
    desk.run("generate terrain --levels 5 --base 32 --seed 5 --roughness 0.6 -o rough.lod");
    desk.write(
        "jobs.toml",
        "size = \"64x64\"\nmethods = [\"lod\"]\ndeltas = [\"inf\"]\ndistances = [1, 2]\n[[scene]]\nfile = \"rough.lod\"\n[[machine]]\nname = \"packet\"\n",
    );
    // Compute is the limit, both are, the memory is.
    let plans =
        [("", 95.0), ("--set dram.channels=1 --set units.per_group=4", 95.0), ("--set dram.channels=1 --set units.per_group=4", 60.0)];
    let mut contexts = Vec::new();
    for (machine, percent) in plans {
        let document = desk.json(&format!("plan --job jobs.toml --speed --share {percent} {machine}"));
        let speed = &document["plan"]["speed"];
        let number = |value: &serde_json::Value| value.as_f64().expect("a number");
        let (share, units) = (percent / 100.0, |key: &str| speed["units"][key].as_u64().expect("a number"));
        assert_eq!([number(&speed["share"]), number(&speed["frames"])], [share, 2.0]);
        let of = |contexts: u64| {
            let keys = [
                "per_group",
                "edges_per_cycle",
                "lod_edges_per_cycle",
                "boxes_per_cycle",
                "divide_bits",
                "setup_bits",
                "setup_copies",
                "divide_copies",
            ];
            let set = keys.map(|key| format!(" --set units.{key}={}", units(key))).concat();
            format!("{machine} --set units.contexts={contexts}{set}")
        };
        let (free, full) = (frames(&desk, machine, "free"), frames(&desk, machine, "units"));
        let measure: Vec<f64> = free.iter().zip(full).map(|(free, full)| if free.0 / full.0 < share { full.0 } else { free.0 }).collect();
        assert_eq!(
            number(&speed["frames-of-units"]),
            measure.iter().zip(full).filter(|(measure, full)| **measure == full.0).count() as f64
        );
        let least = |of: [(f64, u64); 2]| measure.iter().zip(of).map(|(measure, of)| measure / of.0).fold(f64::INFINITY, f64::min);
        let chosen = frames(&desk, &of(units("contexts")), "units");
        assert_eq!(number(&speed["kept"]), least(chosen));
        assert!(least(chosen) >= share, "{speed}");
        assert_eq!(chosen.map(|frame| frame.1), free.map(|frame| frame.1), "hits");
        assert!(least(frames(&desk, &of(units("contexts") - 1), "units")) < share, "{speed}");
        // What it saves is in the table.
        let savings = document["savings"].as_array().expect("lines");
        assert!(savings.iter().any(|line| line["part"] == "speed" && line["what"] == "million gate equivalents"), "{savings:?}");
        contexts.push(units("contexts") * units("per_group"));
    }
    assert_eq!(desk.json("plan --job jobs.toml")["plan"]["speed"], serde_json::Value::Null);
    let [alone, both, memory] = contexts[..] else { panic!("three plans") };
    assert!(memory < both && memory < alone, "{contexts:?}");

    // The unit is as many contexts and edge functions wide, and a plan with a speed is none the narrower.
    let shown = desk.run("plan --job jobs.toml --speed -o fast.toml --package lod_pkg.sv");
    assert!(shown.contains("speed: on haydel2023, 2 frames: in 2 the machine's own units"), "{shown}");
    assert!(desk.text("lod_pkg.sv").contains(&format!(" CONTEXTS = {alone};")) && desk.text("fast.toml").contains("[speed.units]"));
    desk.run("plan --job jobs.toml --check fast.toml");
    desk.refused("plan rough.lod --speed", 1, &["--speed: give the views, with --distance or as a list with --job"]);
    desk.refused("plan --job jobs.toml --speed --share 0", USAGE, &["'0' is not above 0 and at most 100"]);
    desk.refused("plan --job jobs.toml --speed --machine none", 1, &["--machine none"]);
}
