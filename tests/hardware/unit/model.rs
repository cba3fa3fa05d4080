//! The cycle model of the traversal unit against the functional traverser (same lines, same counts) and the golden one (same hits).

use lodray::block::EdgesPerCycle;
use lodray::format::Scene;
use lodray::golden::exact::Exact;
use lodray::hardware::Hardware;
use lodray::hardware::ports::MemoryRequest;
use lodray::mesh::Hierarchy;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::method::{ClosestHit, Hit};
use lodray::num::{LineAddress, Ray, U, VertexForm};
use lodray::plan::{Measure, Plan};
use lodray::sim::unit::environment::{RunReport, UnitPort, run};
use lodray::sim::unit::{Inputs, Latency, Outputs, SceneMemory, Stall, Traffic, TraversalUnit, UnitCounts, UnitError};
use lodray::step::{Step, StepCounts, StepSink};
use lodray_test_support::is_nightly;
use lodray_test_support::models::{any_rays, ball, model, octahedron, scene_of, terrain, with_vertices};
use lodray_test_support::plain::plain;
use rayon::prelude::*;

/// Lines in the order of their reading, and counts.
struct Lines<'a> {
    memory: &'a SceneMemory<'a>,
    read: Vec<LineAddress>,
    counts: StepCounts,
}

impl StepSink for Lines<'_> {
    fn step(&mut self, step: Step) {
        let lines = step.fetch.map_or(0..0, |fetch| fetch.line..fetch.line + fetch.lines);
        self.read.extend(lines.map(|line| self.memory.address(line)));
        self.counts.step(step);
    }
}

/// The model, noting the lines that each ray asks for.
struct Noting {
    unit: TraversalUnit,
    lines: Vec<Vec<LineAddress>>,
}

impl UnitPort for Noting {
    fn outputs(&mut self) -> Outputs {
        self.unit.outputs()
    }
    fn tick(&mut self, inputs: &Inputs) {
        if let Some(request) = self.unit.outputs().mem.filter(|_| inputs.mem_ready) {
            // Its context waits for the line, so it still has the ray.
            let ray = self.unit.ray_tag((request.tag.get() >> 2) as usize).expect("a ray");
            self.lines[ray as usize].push(request.address);
        }
        self.unit.tick(inputs);
    }
    fn describe(&mut self) -> String {
        self.unit.describe()
    }
}

fn stall(eighths: u8, stretch: u32, seed: u64) -> Stall {
    Stall::Random { eighths, stretch, seed }
}

/// Everything around the unit, from gentle to rough.
fn traffics() -> [Traffic; 5] {
    let random = |max, seed| Latency::Random { min: 1, max, seed };
    [
        Traffic::smooth(Latency::Fixed(1)),
        Traffic::smooth(Latency::Fixed(40)),
        Traffic::smooth(random(100, 3)),
        Traffic { latency: random(300, 4), memory_stall: stall(4, 1, 5), hit_stall: stall(3, 1, 6), ray_gap: stall(4, 3, 7) },
        Traffic { latency: random(20, 8), memory_stall: stall(6, 30, 9), hit_stall: stall(7, 200, 10), ray_gap: stall(6, 500, 11) },
    ]
}

fn configs() -> Vec<Hardware> {
    use EdgesPerCycle::{One, Three};
    [(1, Three, 3), (1, One, 1), (3, One, 2), (4, Three, 3), (8, One, 2), (8, Three, 1), (64, Three, 3)]
        .map(|(contexts, edges_per_cycle, bits)| Hardware {
            contexts,
            edges_per_cycle,
            lod_edges_per_cycle: if contexts == 3 { Three } else { edges_per_cycle },
            divide_bits: bits,
            setup_bits: 4 - bits,
            setup_copies: bits,
            divide_copies: 1 + contexts as u32 % 4, // at most 64
            ..Hardware::default()
        })
        .into()
}

/// No more of a unit than a scene needs.
fn planned(scene: &Scene) -> Hardware {
    let mut plan = Plan::new(false);
    plan.add("it", &Measure::of(scene).needs());
    plan.hardware(&Hardware::default())
}

struct Model {
    name: String,
    h: Hierarchy,
    first_line: u64,
}

fn models() -> Vec<Model> {
    let mut all = Vec::new();
    for levels in 0..=5u32 {
        let roughness = [0.05, 0.4, 1.5][levels as usize % 3];
        let seed = u64::from(levels);
        all.push(Model { name: format!("ball {levels}"), h: ball(levels, roughness, seed), first_line: 0 });
        all.push(Model { name: format!("terrain {levels}"), h: terrain(3, levels, roughness, seed), first_line: (1 << 35) + 77 });
    }
    let (base, triangles) = octahedron();
    let h = model(8, &base, triangles[..2].to_vec(), |p, level| {
        let size = f64::from(1 << 30) / 256.0;
        std::array::from_fn(|k| p[k] as f64 * size + f64::from(level) * size * 3.0 * f64::from((p[k] % 5) as i32))
    });
    all.push(Model { name: "deep".into(), h, first_line: 12_345 });
    let in_form = |form: VertexForm| {
        let each = |of: &Model| Model {
            name: format!("{} {}", form.name(), of.name),
            h: with_vertices(form, of.h.clone()),
            first_line: of.first_line,
        };
        all.iter().map(each).collect::<Vec<_>>()
    };
    VertexForm::ALL.into_iter().flat_map(in_form).collect()
}

/// Runs `rays` through the model and gives every ray's lines with the report.
fn simulate(memory: &SceneMemory<'_>, config: Hardware, traffic: &Traffic, rays: &[Ray]) -> (RunReport, Vec<Vec<LineAddress>>, UnitCounts) {
    let mut unit = Noting { unit: TraversalUnit::new(config, memory.config()), lines: vec![Vec::new(); rays.len()] };
    let report = run(&mut unit, memory, traffic, rays).expect("a run without errors");
    (report, unit.lines, unit.unit.counts())
}

/// Each model by all hardware under two of the traffics in turns: over all models each hardware meets all of them. `scripts/nightly` takes all.
#[test]
fn equals_the_functional_and_the_golden_traverser() {
    let taken_traffics = if is_nightly() { traffics().len() } else { 2 };
    let each = |(number, Model { name, h, first_line }): (usize, &Model)| {
        let (mut traced, mut cycles) = (0u64, 0u64);
        let scene = scene_of(h);
        // With the numbers that its trees have in the scene.
        let h = &scene.decode();
        let image = LodImage::of(&scene);
        let memory = SceneMemory::new(image, *first_line);
        let rays = any_rays(h, if is_nightly() { 50 } else { 20 }, number as u64);

        let golden = Exact::new(h);
        let mut lod = LodTraverser::new(image);
        let mut expected: Vec<(Option<Hit>, Vec<LineAddress>)> = Vec::new();
        let mut counts = StepCounts::default();
        for ray in &rays {
            let mut closest = ClosestHit::new(h.levels);
            let mut lines = Lines { memory: &memory, read: Vec::new(), counts };
            lod.trace(ray, &mut lines, &mut closest);
            counts = lines.counts;
            let hit = closest.record();
            assert_eq!(hit.as_ref().map(plain), golden.trace(ray), "{name}: {ray:?}");
            expected.push((hit, lines.read));
        }

        for config in configs().into_iter().chain([planned(&scene)]) {
            for traffic in traffics().iter().cycle().skip(2 * number).take(taken_traffics) {
                let (report, lines, unit) = simulate(&memory, config, traffic, &rays);
                let what = format!("{name}, {config:?}, {traffic:?}");
                for (k, (hit, read)) in expected.iter().enumerate() {
                    let out = report.rays[k].hit;
                    assert_eq!(out.found.then_some(out.hit), *hit, "{what}: ray {k}");
                    assert_eq!(out.tag.get(), k as u64);
                    assert!(out.found || out.hit == Hit::default());
                    assert_eq!(lines[k], *read, "{what}: lines of ray {k}");
                }
                let taken = |block: &str| unit.blocks.iter().find(|b| b.0 == block).expect("a block").1.taken;
                assert_eq!(taken("child_test"), counts.nodes, "{what}");
                assert_eq!(taken("lod_test"), counts.lod_tests, "{what}");
                assert_eq!(taken("tri_test"), counts.triangles, "{what}");
                assert_eq!([taken("node_address"), report.requests], [counts.lines.iter().sum::<u64>(); 2], "{what}");
                assert!(unit.longest_queue <= 4 * config.contexts, "{what}");
                traced += rays.len() as u64;
                cycles += report.cycles;
            }
        }
        [traced, cycles, expected.iter().filter(|e| e.0.is_some()).count() as u64]
    };
    let models = models();
    let sums = models.par_iter().enumerate().map(each);
    let [traced, cycles, met] = sums.reduce(|| [0; 3], |a, b| std::array::from_fn(|k| a[k] + b[k]));
    println!("{traced} rays in {cycles} cycles; {met} of the different rays met something");
    assert!(met > if is_nightly() { 800 } else { 300 }, "only {met} rays met anything");
}

#[test]
fn one_context_takes_each_ray_the_same_cycles_whatever_came_before() {
    let h = ball(3, 0.4, 1);
    let scene = scene_of(&h);
    let memory = SceneMemory::new(LodImage::of(&scene), 0);
    let rays = any_rays(&h, 50, 2);
    let traffic = Traffic::smooth(Latency::Fixed(20));
    let config = Hardware { contexts: 1, ..Hardware::default() };
    let (together, ..) = simulate(&memory, config, &traffic, &rays);
    for (k, ray) in rays.iter().enumerate() {
        let (alone, ..) = simulate(&memory, config, &traffic, &[*ray]);
        assert_eq!(alone.rays[0].cycles(), together.rays[k].cycles(), "ray {k}");
    }
}

#[test]
fn contexts_hide_latency() {
    let h = terrain(3, 4, 0.4, 1);
    let scene = scene_of(&h);
    let memory = SceneMemory::new(LodImage::of(&scene), 0);
    let rays = any_rays(&h, 400, 3);
    let traffic = Traffic::smooth(Latency::Fixed(100));
    let cycles = [1, 4, 16, 64].map(|contexts| simulate(&memory, Hardware { contexts, ..Hardware::default() }, &traffic, &rays).0.cycles);
    println!("{} rays on 1, 4, 16, 64 contexts: {cycles:?} cycles", rays.len());
    assert!(cycles[1] * 3 < cycles[0] && cycles[2] * 2 < cycles[1] && cycles[3] <= cycles[2]);
}

/// A unit that never answers, or asks for what is not there.
struct Broken(Outputs);

impl UnitPort for Broken {
    fn outputs(&mut self) -> Outputs {
        self.0
    }
    fn tick(&mut self, _: &Inputs) {}
    fn describe(&mut self) -> String {
        "context 0: asleep".into()
    }
}

#[test]
fn misbehaviour_is_an_error() {
    let h = ball(1, 0.4, 1);
    let scene = scene_of(&h);
    let memory = SceneMemory::new(LodImage::of(&scene), 100);
    let rays = any_rays(&h, 1, 2);
    let try_out = |outputs| run(&mut Broken(outputs), &memory, &Traffic::smooth(Latency::Fixed(3)), &rays).expect_err("an error");
    let asleep = try_out(Outputs::default());
    assert!(matches!(&asleep, UnitError::Deadlock { contexts, .. } if contexts.contains("asleep")), "{asleep}");
    let request = |address: u64| {
        let mem = MemoryRequest { tag: U::new(6), address: LineAddress::new(address), ..MemoryRequest::default() };
        Outputs { mem: Some(mem), ..Outputs::default() }
    };
    assert_eq!(try_out(request(99)), UnitError::Address { cycle: 0, address: 99, tag: 6 });
    assert_eq!(try_out(request(100)), UnitError::TagInUse { cycle: 1, tag: 6 });
    let hit = Outputs { hit: Some(Default::default()), ..Outputs::default() };
    assert_eq!(try_out(hit), UnitError::StrayHit { cycle: 0, tag: 0 });
}
