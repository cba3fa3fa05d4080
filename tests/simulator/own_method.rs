//! The example of a method with work before its frames.

#[expect(dead_code, reason = "its main")]
#[path = "../../examples/own_method.rs"]
mod example;

use lodray::format::Scene;
use lodray::machine::Machine;
use lodray::mesh::procedural::{self, Options};
use lodray::method::{Registered, chunked};
use lodray::rays::{Camera, CameraPath, ModelSpace, View};
use lodray::report::result::SimResult;
use lodray::run::Compute;
use lodray::scene::{PassRays, SceneMethod};
use lodray_test_support::program::Desk;
use std::path::Path;
use std::process::Command;

fn street() -> (Scene, Camera) {
    let scene = Scene::generate(&Options { levels: Some(2), base: Some(2000), ..Options::new(procedural::Scene::Street) }).unwrap();
    let view = View { distance: Some(3.0), ..View::default() };
    let camera = Camera::new(&view, &ModelSpace::of(&scene), 64, 64).unwrap();
    (scene, camera)
}

fn of(scene: &Scene, method: &'static Registered) -> SceneMethod {
    scene.method_of(method, &[("chunk", "object")]).unwrap()
}

fn run(method: &SceneMethod, rays: PassRays, compute: Compute) -> SimResult {
    method.simulate(rays, &Machine::shipped("haydel2023").unwrap(), "haydel2023", compute).unwrap()
}

#[test]
fn work_before_a_frame_is_charged_apart_and_its_lines_are_found_by_the_rays() {
    let (scene, camera) = street();
    let [free, charged] =
        [&chunked::METHOD, &example::METHOD].map(|method| run(&of(&scene, method), PassRays::Camera(camera), Compute::Free));
    assert!(free.frames[0].before.is_none() && free.l1.stores == 0 && !free.operations.contains_key("unpack_line"));
    let frame = charged.frames[0];
    let before = frame.before.unwrap();
    // Every line of nodes and leaves is written, once.
    let map_bytes = free.setup.method.bytes;
    assert_eq!(before.stores * 32, map_bytes);
    assert_eq!([charged.l1.stores, charged.l2.stores], [before.stores; 2]);
    // The same rays, which find in the L2 what was written there.
    assert_eq!([charged.rays, charged.hits], [free.rays, free.hits]);
    let reads = |r: &SimResult, kind: &str| r.traffic.kinds.iter().find(|k| k.kind == kind).map_or(0, |k| k.dram);
    assert!(reads(&free, "bvh_node") > 0 && reads(&charged, "bvh_node") == 0 && reads(&charged, "packed") > 0);
    // A frame is its work and its rays; energy likewise, and the work's own operations are among it.
    assert_eq!((charged.frames.len(), frame.start, frame.cycles), (1, 0, charged.cycles));
    assert!(before.cycles > 0 && before.cycles < frame.cycles && before.energy > 0.0 && before.energy < frame.energy);
    let compute = charged.energy.compute.operations["unpack_line"];
    assert!(compute > 0.0 && (frame.energy - charged.energy.total).abs() < 1e-9 * frame.energy, "{compute}");
    assert_eq!(charged.operations["unpack_line"] % 4, 0);
    // What is written costs as much as what is filled: by the result's own prices, and by the script that takes them from the tables.
    let (l2, energy) = (charged.l2, &charged.energy);
    assert_eq!(l2.updates, before.stores);
    let fill = (l2.fills + l2.updates) as f64 * energy.prices.l2_fill * 1e-6;
    assert!(energy.unit == "uJ" && (energy.l2.fill - fill).abs() < 1e-9 * fill);
    let desk = Desk::new(env!("CARGO_BIN_EXE_lodray"));
    desk.write("result.json", &serde_json::to_string(&charged).unwrap());
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("scripts/energy.py");
    let out = Command::new("python3").arg(script).arg(desk.path("result.json")).output().unwrap();
    assert!(out.status.success(), "{}{}", String::from_utf8_lossy(&out.stdout), String::from_utf8_lossy(&out.stderr));
}

#[test]
fn what_stays_costs_nothing_in_the_next_frame() {
    let (scene, camera) = street();
    let method = of(&scene, &example::METHOD);
    let result = run(&method, PassRays::Path(CameraPath::turning(&camera, 3, 2.0)), Compute::Free);
    assert_eq!(result.frames.iter().map(|frame| frame.before.is_some()).collect::<Vec<_>>(), [true, false, false]);
    assert_eq!(result.l1.stores, result.frames[0].before.unwrap().stores);
}

#[test]
fn cores_do_the_work_before_units_trace_the_rays() {
    let (scene, camera) = street();
    let method = of(&scene, &example::METHOD);
    let [free, units] = [Compute::Free, Compute::Units].map(|compute| run(&method, PassRays::Camera(camera), compute));
    let [own, of_units] = [&free, &units].map(|result| result.frames[0].before.unwrap());
    assert_eq!(
        (own.cycles, own.l1_requests, own.stores, own.dram_bytes),
        (of_units.cycles, of_units.l1_requests, of_units.stores, of_units.dram_bytes)
    );
    // Blocks and works do the same, whoever does it; the rays take longer, and cost the units' clock besides.
    assert_eq!((free.hits, &free.operations), (units.hits, &units.operations));
    assert!(units.cycles > free.cycles && units.energy.total > free.energy.total, "{} {}", units.cycles, free.cycles);
}
