//! What a plan says is needed is what the scene's points and codes need, looked up another way; no ray of a job goes below the level that it says; and what is one too narrow
//! is refused.

use lodray::format::Scene;
use lodray::mesh::procedural::{self, Options};
use lodray::mesh::{BoundKind, Hierarchy, edge_index, lattice};
use lodray::method::ClosestHit;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::num::VertexForm;
use lodray::plan::Measure;
use lodray::rays::{Camera, ModelSpace, RaySource, View};
use lodray::step::{Act, Step, StepSink};
use lodray_test_support::program::Desk;
use lodray_test_support::surfaces::scene_with;

fn made(scene: procedural::Scene, levels: u32, vertices: VertexForm) -> Scene {
    let options = Options { scene, levels: Some(levels), base: Some(32), seed: 5, roughness: None };
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
        assert!(points.iter().all(|c| c % (1 << needs.coordinate_zeros) == 0), "{name}");
        assert!(points.iter().any(|c| c % (2 << needs.coordinate_zeros) != 0), "{name}");
        assert_eq!(needs.code_bits, u8::BITS - code.leading_zeros(), "{name}");
        assert_eq!((needs.levels, needs.compact, needs.exact), (3, form.is_compact(), !form.is_compact()));
        // Sibling groups of 32 bytes below levels 0 and 1; vertices of 32 bytes each, or of 16 below the root, whose own are in the record.
        let vertices = if form.is_compact() { 16 * (splits[1] + splits[2]) } else { 32 * splits.iter().sum::<u64>() };
        assert_eq!(data.above_flat, 64 * h.triangles.len() as u64 + 32 * (splits[0] + splits[1]) + vertices, "{name}");
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
            ("coordinate-zeros", Ok(value)) => (value + 1).to_string(),
            (_, Ok(0)) | (_, Err(_)) if value != "true" => continue,
            (_, Ok(value)) => (value - 1).to_string(),
            _ => "false".to_owned(),
        };
        let narrow: Vec<_> =
            plan.lines().enumerate().map(|(k, l)| if k == at { format!("{name} = {less}") } else { l.to_owned() }).collect();
        desk.write("narrow.toml", &narrow.join("\n"));
        desk.refused("plan rough.lod round.lod --check narrow.toml", 1, &["does not fit the plan", name]);
    }
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
    desk.write(
        "jobs.toml",
        "size = \"32x32\"\nmethods = [\"lod\"]\ndistances = [2]\n[[scene]]\nfile = \"rough.lod\"\n[[machine]]\nname = \"haydel2023\"\n",
    );
    desk.refused("plan --job jobs.toml --check full.toml", 1, &["job of scene", "does not fit the plan"]);
}
