//! The RTL of the traversal unit beside its cycle model in one environment: every port compared in every cycle, every hit against the golden
//! traverser's. `LODRAY_CYCLES` asks for that many cycles (default 1 million), `LODRAY_SEED` for another seed.

mod early;
mod limits;
mod port;
mod secondary;
mod watch;
mod wave;

use lodray::block::EdgesPerCycle;
use lodray::format::{Job, Scene};
use lodray::golden::exact::Exact;
use lodray::hardware::Hardware;
use lodray::hardware::ports::{HitOut, SceneConfig};
use lodray::mesh::most_zeros;
use lodray::mesh::procedural::{self, Options};
use lodray::method::lod::LodImage;
use lodray::num::{Ray, VertexForm};
use lodray::plan::{Measure, Plan, Reach};
use lodray::rays::{Camera, ModelSpace, View};
use lodray::sim::unit::environment::{RunReport, UnitPort, run};
use lodray::sim::unit::{Inputs, Latency, Outputs, SceneMemory, Stall, Traffic, TraversalUnit};
use lodray_test_support::hardware::{
    FLAT, FULL_DETAIL, MIDDLE, NARROW, OTHERS, SECONDARY_AT_ONCE, SHALLOW, SMALL, form_for, most_levels, ray_for, scene_for,
};
use lodray_test_support::is_nightly;
use lodray_test_support::models::{Rng, any_rays, ball, build_with, coarsened, terrain, with_vertices, with_zeros};
use lodray_test_support::plain::plain;
use port::{Rtl, Watched};

/// Model and RTL with the same inputs.
struct SideBySide {
    model: TraversalUnit,
    rtl: Rtl,
    cycle: u64,
    what: String,
    /// Answers may come that no memory gives, so the rules of the ports need not hold.
    any_answer: bool,
    /// Memories write wrong parities.
    parity_broken: bool,
    /// Cycles in which one was used.
    faults: u64,
}

impl SideBySide {
    fn new(config: Hardware, scene: &SceneConfig, seed: u64, what: String) -> Self {
        Self {
            model: TraversalUnit::new(config, *scene),
            rtl: Rtl::new(config, scene, seed),
            cycle: 0,
            what,
            any_answer: false,
            parity_broken: false,
            faults: 0,
        }
    }
}

impl UnitPort for SideBySide {
    fn outputs(&mut self) -> Outputs {
        let (model, rtl) = (self.model.outputs(), self.rtl.outputs());
        if model != rtl {
            let port = match () {
                () if model.ready != rtl.ready => "ready_o",
                () if model.hit != rtl.hit => "valid_o, out_o",
                () if model.corners != rtl.corners => "corners_o",
                () if model.busy != rtl.busy => "busy_o",
                () => "mem_valid_o, mem_o",
            };
            let (what, cycle, contexts) = (&self.what, self.cycle, self.model.describe());
            panic!("{what}: cycle {cycle}: port {port} differs\nmodel {model:?}\nRTL   {rtl:?}\n{contexts}");
        }
        // Each context in turn, and a number that none has.
        let context = self.cycle as usize % (self.model.contexts() + 1);
        if let Some(rtl) = self.rtl.watched(context) {
            let model = Watched { view: self.model.view(context), counters: self.model.counters() };
            assert_eq!(
                rtl, model,
                "{}: cycle {}, context {context}: view_o or counters_o differs, right is the model's",
                self.what, self.cycle
            );
        }
        model
    }

    fn tick(&mut self, inputs: &Inputs) {
        self.model.tick(inputs);
        self.rtl.tick(inputs);
        self.faults += u64::from(self.rtl.memory_fault());
        assert!(self.parity_broken || self.faults == 0, "{}: cycle {}: a memory changed a word", self.what, self.cycle);
        self.cycle += 1;
    }

    fn describe(&mut self) -> String {
        self.model.describe()
    }
}

/// What a comparison has seen.
struct Compared {
    report: RunReport,
    hits: u64,
    longest_queue: usize,
}

/// Runs `rays` through both and compares every hit with the golden traverser's.
fn compare(scene: &Scene, config: Hardware, traffic: &Traffic, rays: &[Ray], seed: u64) -> Compared {
    let memory = SceneMemory::new(LodImage::of(scene), seed % (1 << 35));
    let what = format!("seed {seed}, {config:?}, {traffic:?}");
    let mut both = SideBySide::new(config, &memory.config(), seed, what.clone());
    let report = run(&mut both, &memory, traffic, rays).unwrap_or_else(|error| panic!("{what}: {error}"));
    assert!(!both.rtl.sim.failed(), "{what}: an assertion of the RTL failed");
    let h = scene.decode();
    let golden = Exact::new(&h);
    for (ray, traced) in rays.iter().zip(&report.rays) {
        let HitOut { found, hit, .. } = traced.hit;
        assert_eq!(found.then(|| plain(&hit)), golden.trace(ray), "{what}: {ray:?}");
    }
    let hits = report.rays.iter().filter(|ray| ray.hit.found).count() as u64;
    Compared { report, hits, longest_queue: both.model.counts().longest_queue }
}

/// Cycles to compare: `LODRAY_CYCLES`, or as many.
fn cycles_or(many: u64) -> u64 {
    let parse = |text: String| text.replace('_', "").parse().unwrap_or_else(|_| panic!("LODRAY_CYCLES={text}: not a number"));
    std::env::var("LODRAY_CYCLES").map_or(many, parse)
}

/// The same, or a quarter of a million; `scripts/nightly` has a million.
fn cycles_wanted() -> u64 {
    cycles_or(250_000)
}

/// The others of these tests: each unit takes the C++ compiler half a minute, so `scripts/nightly` alone has all.
fn others() -> &'static [Hardware] {
    const SOME: [Hardware; 7] = [SMALL, MIDDLE, NARROW, FULL_DETAIL, SHALLOW, FLAT, SECONDARY_AT_ONCE];
    if is_nightly() { &OTHERS } else { &SOME }
}

/// Tests so fast, and divisions so slow, that hits wait for them.
const QUEUED: Hardware = Hardware { contexts: 4, edges_per_cycle: EdgesPerCycle::Three, divide_bits: 1, ..Hardware::DEFAULT };

fn configs() -> [Hardware; 3] {
    let eight = Hardware { contexts: 8, ..Hardware::default() };
    [Hardware::one_context(), QUEUED, eight]
}

/// Any traffic: fixed and random latency, ports that stall never, in single cycles, or for long.
fn any_traffic(rng: &mut Rng) -> Traffic {
    let mut stall = || match rng.below(3) {
        0 => Stall::Never,
        _ => Stall::Random { eighths: rng.below(7) as u8, stretch: 1 << rng.below(6), seed: rng.draw() },
    };
    let (memory_stall, hit_stall, ray_gap) = (stall(), stall(), stall());
    let latency = match rng.below(3) {
        0 => Latency::Fixed(1 + rng.below(60) as u32),
        _ => Latency::Random { min: 1 + rng.below(8) as u32, max: 1 << rng.below(8), seed: rng.draw() },
    };
    Traffic { latency, memory_stall, hit_stall, ray_gap }
}

#[test]
fn random_rays_under_random_traffic() {
    random_rays(&configs(), cycles_wanted());
}

#[test]
fn other_hardware_under_random_traffic() {
    random_rays(others(), cycles_wanted() / 8);
}

/// Random models, of any number of levels that the hardware is for, for so many cycles; the hardware by turns.
fn random_rays(hardware: &[Hardware], wanted: u64) {
    let seed = tb::seed(1).unwrap_or_else(|error| panic!("{error}"));
    let (mut cycles, mut traced, mut hits) = (0, 0, 0);
    for round in 0.. {
        let seed = seed + round;
        let mut rng = Rng(seed);
        let config = hardware[round as usize % hardware.len()];
        let roughness = [0.05, 0.4, 1.5][rng.below(3) as usize];
        let levels = rng.below(u64::from(most_levels(&config).min(6) + 1)) as u32;
        let h = if rng.below(2) == 0 { ball(levels, roughness, seed) } else { terrain(2, levels, roughness, seed) };
        // As many zeros as the hardware leaves out, or some more.
        let zeros = (config.coordinate_zeros + rng.below(3) as u32 * rng.below(3) as u32).min(most_zeros(levels));
        let h = with_vertices(form_for(&config, VertexForm::ALL[rng.below(3) as usize]), with_zeros(zeros, h));
        let rays = any_rays(&h, 20 * config.contexts, seed);
        let rays: Vec<Ray> =
            rays.iter().enumerate().map(|(k, ray)| ray_for(&config, &coarsened(ray, [zeros, config.direction_zeros]), k)).collect();
        let Compared { report, hits: met, .. } = compare(&scene_for(&config, &h), config, &any_traffic(&mut rng), &rays, seed);
        cycles += report.cycles;
        traced += rays.len();
        hits += met;
        if cycles >= wanted {
            break;
        }
    }
    println!("seed {seed}: {cycles} cycles compared, {traced} rays, {hits} hits");
    assert!(hits > 0);
}

/// A frame of a procedural scene on model and RTL.
fn frame(kind: procedural::Scene, form: VertexForm, config: Hardware, latency: Latency) {
    frame_of(kind, form, config, latency, false);
}

/// No more of `hardware` than the rays of a view need on a scene.
fn planned(scene: &Scene, camera: &Camera, hardware: Hardware) -> Hardware {
    let (measure, mut plan) = (Measure::of(scene), Plan::new(true));
    plan.add("it", &measure.needs());
    plan.add_rays(&measure.rays(camera, 1.0));
    plan.hardware(&hardware)
}

/// The same; if `pruned`, on a scene that is pruned for it, by the unit of its plan.
fn frame_of(kind: procedural::Scene, form: VertexForm, config: Hardware, latency: Latency, pruned: bool) {
    const SIDE: u32 = 96;
    let options = Options { levels: Some(3), base: Some(32), ..Options::new(kind) };
    let scene = build_with(&procedural::generate(&options).expect("options"), form);
    let space = ModelSpace::of(&scene);
    let camera =
        Camera::new(&View { distance: Some(if pruned { 3.5 } else { 2.5 }), ..View::default() }, &space, SIDE, SIDE).expect("a view");
    let pixels = (0..SIDE * SIDE).map(|i| camera.ray(i % SIDE, i / SIDE));
    // Where a ray misses the model's box there is nothing to trace.
    let rays: Vec<Ray> = pixels.filter_map(|world| Some(space.enter(&world, 1.0)?.ray)).collect();
    let scene = if pruned {
        let reach = Reach::of(&scene);
        reach.add(&camera, 1.0);
        scene.pruned(&reach.depths(), Job { views: vec![camera.job_view(1.0)], ..Job::default() }).expect("memory")
    } else {
        scene
    };
    let depths = scene.trees_by_depth().iter().filter(|trees| **trees > 0).count();
    assert!(!pruned || depths > 1, "{:?}", scene.trees_by_depth());
    let config = if pruned { planned(&scene, &camera, config) } else { config };
    let Compared { report, hits, .. } = compare(&scene, config, &Traffic::smooth(latency), &rays, 1);
    println!("{kind:?}, {form:?}: {SIDE}x{SIDE} pixels, {} rays, {hits} hits, {} cycles; {config:?}", rays.len(), report.cycles);
    assert!(hits > 1000, "only {hits} hits");
}

#[test]
fn a_frame_of_a_terrain() {
    frame(procedural::Scene::Terrain, VertexForm::Short, configs()[2], Latency::Random { min: 5, max: 60, seed: 1 });
}

/// Two of them; `scripts/nightly` has four.
#[test]
fn frames_of_pruned_scenes_by_their_own_units() {
    use procedural::Scene::{Cloth, Room, Sphere, Terrain};
    let scenes = [(Sphere, VertexForm::Compact), (Terrain, VertexForm::Exact), (Room, VertexForm::Exact), (Cloth, VertexForm::Short)];
    for &(kind, form) in &scenes[..if is_nightly() { 4 } else { 2 }] {
        frame_of(kind, form, configs()[1], Latency::Random { min: 2, max: 80, seed: 2 }, true);
    }
}

/// By the unit as it is: `scripts/synth --check traversal_unit` lets its netlist render this.
#[test]
fn a_frame_of_a_sphere() {
    frame(procedural::Scene::Sphere, VertexForm::Exact, Hardware::default(), Latency::Fixed(20));
}
