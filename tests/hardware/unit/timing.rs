//! The timing of the traversal unit against its cycle model: every ray's cycles, every request's cycle, tag and line, and all counts are equal.

use lodray::block::{BoxesPerCycle, EdgesPerCycle};
use lodray::hardware::Hardware;
use lodray::hardware::ports::SecondaryIn;
use lodray::mesh::Hierarchy;
use lodray::method::lod::{LodImage, LodTraverser};
use lodray::num::{Ray, VertexForm};
use lodray::sim::timing::UnitTiming;
use lodray::sim::unit::environment::{RunReport, UnitPort, run, run_secondary};
use lodray::sim::unit::{Inputs, Latency, Outputs, SceneMemory, Stall, Traffic, TraversalUnit};
use lodray::step::{Act, Batch, Fetch, NodeShape, SectionId, Step};
use lodray_test_support::bounces::{Bounce, next, steps_of_bounces};
use lodray_test_support::hardware::{OTHERS, SECONDARIES, form_for, most_levels, ray_for, scene_for};
use lodray_test_support::is_nightly;
use lodray_test_support::models::{Rng, any_rays, ball, coarsened, model, octahedron, scene_of, terrain, with_vertices, with_zeros};
use lodray_test_support::timing::{Smooth, Timed, steps_of};
use rayon::prelude::*;

/// A unit, noting its requests: cycle, tag, address.
struct Noting<U> {
    unit: U,
    cycle: u64,
    requests: Vec<(u64, u64, u64)>,
}

impl<U: UnitPort> Noting<U> {
    fn new(unit: U) -> Self {
        Self { unit, cycle: 0, requests: Vec::new() }
    }

    fn run(&mut self, memory: &SceneMemory<'_>, traffic: &Traffic, rays: &[Ray]) -> RunReport {
        self.run_secondary(memory, traffic, rays, &[])
    }

    fn run_secondary(&mut self, memory: &SceneMemory<'_>, traffic: &Traffic, rays: &[Ray], secondary: &[SecondaryIn]) -> RunReport {
        let mut report = run_secondary(self, memory, traffic, rays, secondary).expect("a run without errors");
        // What is met is the model's alone.
        for ray in &mut report.rays {
            (ray.hit.hit, ray.corners) = Default::default();
        }
        report
    }
}

impl<U: UnitPort> UnitPort for Noting<U> {
    fn outputs(&mut self) -> Outputs {
        self.unit.outputs()
    }
    fn tick(&mut self, inputs: &Inputs) {
        let request = self.unit.outputs().mem.filter(|_| inputs.mem_ready);
        self.requests.extend(request.map(|request| (self.cycle, request.tag.get(), request.address.get())));
        self.unit.tick(inputs);
        self.cycle += 1;
    }
    fn describe(&mut self) -> String {
        self.unit.describe()
    }
}

fn stall(eighths: u8, stretch: u32, seed: u64) -> Stall {
    Stall::Random { eighths, stretch, seed }
}

fn traffics() -> Vec<Traffic> {
    let random = |max, seed| Latency::Random { min: 1, max, seed };
    let smooth = [Latency::Fixed(1), Latency::Fixed(5), Latency::Fixed(40), random(100, 3)].map(Traffic::smooth);
    let rough = [
        Traffic { memory_stall: stall(4, 1, 12), ..Traffic::smooth(Latency::Fixed(1)) },
        Traffic { hit_stall: stall(6, 40, 13), ..Traffic::smooth(Latency::Fixed(5)) },
        Traffic { latency: random(300, 4), memory_stall: stall(4, 1, 5), hit_stall: stall(3, 1, 6), ray_gap: stall(4, 3, 7) },
        Traffic { latency: random(20, 8), memory_stall: stall(6, 30, 9), hit_stall: stall(7, 200, 10), ray_gap: stall(6, 500, 11) },
    ];
    smooth.into_iter().chain(rough).collect()
}

fn configs() -> Vec<Hardware> {
    use EdgesPerCycle::{One, Three};
    let each =
        |contexts| {
            [(Three, BoxesPerCycle::Four), (One, BoxesPerCycle::One), (Three, BoxesPerCycle::Two)].map(|(edges, boxes_per_cycle)| {
                Hardware { contexts, edges_per_cycle: edges, lod_edges_per_cycle: edges, boxes_per_cycle, ..Hardware::default() }
            })
        };
    let dividing = |contexts, divide_bits, setup_bits| Hardware { contexts, divide_bits, setup_bits, ..Hardware::default() };
    let slower = [dividing(1, 1, 2), dividing(4, 2, 1), dividing(16, 1, 1)];
    let in_turns = |contexts, setup_copies, divide_copies| Hardware { contexts, setup_copies, divide_copies, ..Hardware::default() };
    let faster = [in_turns(2, 4, 4), in_turns(16, 3, 2), in_turns(64, 2, 3)];
    [1, 2, 4, 16, 64].into_iter().flat_map(each).chain(slower).chain(faster).collect()
}

fn models() -> Vec<(String, Hierarchy)> {
    let mut all = Vec::new();
    for levels in 0..=5u32 {
        let roughness = [0.05, 0.4, 1.5][levels as usize % 3];
        all.push((format!("ball {levels}"), ball(levels, roughness, u64::from(levels))));
        all.push((format!("terrain {levels}"), terrain(3, levels, roughness, u64::from(levels))));
    }
    let (base, triangles) = octahedron();
    let size = f64::from(1 << 22);
    let deep = model(8, &base, triangles[..2].to_vec(), |p, level| {
        std::array::from_fn(|k| p[k] as f64 * size + f64::from(level) * size * 3.0 * f64::from((p[k] % 5) as i32))
    });
    all.push(("deep octahedron".into(), deep));
    let in_form = |form: VertexForm| all.iter().map(move |(name, h)| (format!("{} {name}", form.name()), with_vertices(form, h.clone())));
    VertexForm::ALL.into_iter().flat_map(in_form).collect()
}

/// What a comparison has seen: rays, requests, cycles and ticks of runs that skip, hits, and hits that were refused.
#[derive(Default)]
struct Seen {
    rays: u64,
    requests: u64,
    cycles: u64,
    ticks: u64,
    found: u64,
    refused: u64,
}

impl Seen {
    fn and(self, other: Self) -> Self {
        Self {
            rays: self.rays + other.rays,
            requests: self.requests + other.requests,
            cycles: self.cycles + other.cycles,
            ticks: self.ticks + other.ticks,
            found: self.found + other.found,
            refused: self.refused + other.refused,
        }
    }
}

/// One model by all hardware that is for it, each under two of the traffics in turns: over all models each hardware meets all of them. `scripts/nightly` takes all.
fn every_cycle_of(number: usize, name: &str, h: &Hierarchy) -> Seen {
    let mut seen = Seen::default();
    let any = any_rays(h, if is_nightly() { 40 } else { 15 }, number as u64);
    let fits = |config: &Hardware| h.levels <= most_levels(config) && form_for(config, h.vertices) == h.vertices;
    for config in configs().into_iter().chain(OTHERS).filter(fits) {
        // Of as many zeros as the hardware leaves out.
        let zeros = [config.coordinate_zeros, config.direction_zeros];
        let scene = match config.coordinate_zeros {
            0 => scene_for(&config, h),
            zeros => scene_for(&config, &with_vertices(h.vertices, with_zeros(zeros, h.clone()))),
        };
        let image = LodImage::of(&scene);
        let memory = SceneMemory::new(image, 1000);
        let rays: Vec<Ray> = any.iter().enumerate().map(|(k, ray)| ray_for(&config, &coarsened(ray, zeros), k)).collect();
        let batch = steps_of(image, &rays);
        let (each, taken) = (traffics(), if is_nightly() { traffics().len() } else { 2 });
        for traffic in each.iter().cycle().skip(2 * number).take(taken) {
            let what = format!("{name}, {config:?}, {traffic:?}");
            let mut model = Noting::new(TraversalUnit::new(config, memory.config()));
            let expected = model.run(&memory, traffic, &rays);
            for skip in [false, true] {
                let mut timed = Noting::new(Timed::new(config, &memory, &batch, skip));
                let report = timed.run(&memory, traffic, &rays);
                for (k, (ray, expected)) in report.rays.iter().zip(&expected.rays).enumerate() {
                    assert_eq!((ray.taken, ray.done), (expected.taken, expected.done), "{what}, skip {skip}: ray {k}");
                }
                assert_eq!(report, expected, "{what}, skip {skip}");
                assert_eq!(timed.requests, model.requests, "{what}, skip {skip}");
                assert_eq!(timed.unit.unit.counts(report.cycles), model.unit.counts(), "{what}, skip {skip}");
                seen.rays += report.rays.len() as u64;
                seen.requests += report.requests;
                if skip {
                    seen.cycles += report.cycles;
                    seen.ticks += timed.unit.ticks;
                }
            }
            seen.found += expected.rays.iter().filter(|ray| ray.hit.found).count() as u64;
            seen.refused += expected.waited.iter().sum::<u64>();
        }
    }
    seen
}

#[test]
fn equals_the_cycle_model_in_every_cycle() {
    let models = models();
    let each = models.par_iter().enumerate().map(|(number, (name, h))| every_cycle_of(number, name, h));
    let Seen { rays, requests, cycles, ticks, found, refused } = each.reduce(Seen::default, Seen::and);
    println!("{rays} rays and {requests} requests are equal; {found} hits; {ticks} ticks in {cycles} cycles; {refused} refused");
    let part = if is_nightly() { 1 } else { 4 };
    assert!(rays > 100_000 / part && requests > 1_000_000 / part && found > 10_000 / part && refused > 100_000 / part && ticks < cycles);
}

#[test]
fn rays_from_a_surface_take_the_cycles_of_the_model() {
    let (mut compared, mut decided) = (0u64, 0u64);
    for (number, (name, h)) in models().iter().enumerate() {
        let fits = |config: &&Hardware| h.levels <= most_levels(config) && form_for(config, h.vertices) == h.vertices;
        for config in SECONDARIES.iter().filter(fits) {
            let scene = scene_for(config, h);
            let (image, decoded) = (LodImage::of(&scene), scene.decode());
            let (memory, mut traverser) = (SceneMemory::new(image, 1000), LodTraverser::new(image));
            let mut rng = Rng(number as u64);
            let first = any_rays(h, 20, number as u64);
            let mut bounces: Vec<Bounce> = first.iter().enumerate().map(|(k, ray)| Bounce::primary(ray_for(config, ray, k))).collect();
            for _ in 0..3 {
                let (rays, secondary): (Vec<_>, Vec<_>) = bounces.iter().map(|bounce| (bounce.ray, bounce.secondary())).unzip();
                let batch = steps_of_bounces(image, &bounces);
                let taken = if is_nightly() { traffics().len() } else { 2 };
                for traffic in traffics().into_iter().cycle().skip(2 * number).take(taken) {
                    let what = format!("{name}, {config:?}, {traffic:?}");
                    let mut model = Noting::new(TraversalUnit::new(*config, memory.config()));
                    let expected = model.run_secondary(&memory, &traffic, &rays, &secondary);
                    let mut timed = Noting::new(Timed::new(*config, &memory, &batch, true));
                    assert_eq!(timed.run(&memory, &traffic, &rays), expected, "{what}");
                    assert_eq!(timed.requests, model.requests, "{what}");
                    assert_eq!(timed.unit.unit.counts(expected.cycles), model.unit.counts(), "{what}");
                    compared += rays.len() as u64;
                }
                decided += secondary.iter().filter(|of| of.prior).count() as u64;
                bounces = next(config, &decoded, &mut traverser, &bounces, &mut rng);
            }
        }
    }
    println!("{compared} rays are equal; {decided} with rays before them");
    assert!(compared > 5_000 && decided > 500);
}

#[test]
fn equals_the_cycle_model_from_event_to_event() {
    let h = with_vertices(VertexForm::Compact, terrain(4, 5, 0.4, 7));
    let scene = scene_of(&h);
    let image = LodImage::of(&scene);
    let memory = SceneMemory::new(image, 0);
    let rays = any_rays(&h, 2000, 9);
    let batch = steps_of(image, &rays);
    let mut compared = 0;
    for (contexts, latency) in [(1, 1), (4, 10), (16, 10), (16, 200), (64, 25)] {
        let config = Hardware { contexts, ..Hardware::default() };
        let mut model = TraversalUnit::new(config, memory.config());
        let expected = run(&mut model, &memory, &Traffic::smooth(Latency::Fixed(latency)), &rays).expect("a run without errors");
        let mut unit = UnitTiming::new(config);
        let mut around = Smooth::new(&batch, u64::from(latency));
        let cycles = around.run(&mut unit);
        assert_eq!(around.rays, expected.rays.iter().map(|ray| (ray.taken, ray.done)).collect::<Vec<_>>());
        assert_eq!([cycles, around.requests], [expected.cycles, expected.requests]);
        assert_eq!(unit.counts(cycles), model.counts());
        println!("{contexts} contexts, latency {latency}: {} ticks in {cycles} cycles", around.ticks);
        compared += around.rays.len();
    }
    assert_eq!(compared, 10_000);
}

const NODES: SectionId = SectionId::new(0);
const LEAVES: SectionId = SectionId::new(1);

/// How a node stores its boxes: steps, codes of 16 bits, coordinates of 32, or finer steps of six children.
#[derive(Clone, Copy)]
enum Boxes {
    Local,
    Plain,
    Wide,
    Six,
}

impl Boxes {
    fn lines(self) -> u32 {
        match self {
            Self::Local => 1,
            Self::Plain | Self::Six => 2,
            Self::Wide => 4,
        }
    }
}

/// A visit of a node.
fn node(line: u32, met: u32, boxes: Boxes) -> Step {
    let act = match boxes {
        Boxes::Local => Act::Children { shape: NodeShape::Local, met },
        Boxes::Plain => Act::Children { shape: NodeShape::Plain, met },
        Boxes::Wide => Act::Children { shape: NodeShape::Wide, met },
        Boxes::Six => Act::Children { shape: NodeShape::Six, met },
    };
    Step::on(Fetch::new(NODES, line, boxes.lines()), act).visiting()
}

/// The lines of a leaf.
fn leaf(lines: impl IntoIterator<Item = u32>) -> impl Iterator<Item = Step> {
    (0..).zip(lines).map(|(place, line)| {
        let fetch = Fetch::new(LEAVES, line, 1).at(place);
        if place == 0 { Step::on(fetch, Act::Fetch).visiting() } else { Step::on(fetch.joining(), Act::Fetch) }
    })
}

fn triangles(count: u32, hits: u32) -> Step {
    Step::of(Act::Triangles { count, hits })
}

fn pop(dropped: bool) -> Step {
    Step::of(Act::Pop { dropped })
}

/// The end of a ray whose hit is on the full resolution.
fn end(found: bool) -> Step {
    Step::end(found, false)
}

/// The cycles of one ray alone.
fn alone(steps: Vec<Step>, latency: u64) -> u64 {
    let batch = Batch::new(&[steps]);
    let mut unit = UnitTiming::new(Hardware::one_context());
    let mut around = Smooth::new(&batch, latency);
    around.run(&mut unit);
    around.rays[0].1 - around.rays[0].0
}

#[test]
fn baseline_rays_take_the_cycles_of_their_blocks() {
    use lodray::block::Block;
    use lodray::block::{
        box_decode::BoxDecode, box_decode8::BoxDecode8, box_test::BoxTest, box_test32::BoxTest32, child_sort::ChildSort,
        child_sort6::ChildSort6, hit_divide::HitDivide, hit_select::HitSelect, node_address::NodeAddress, ray_setup::RaySetup,
        tri_test::TriTest,
    };
    let cycles = |timing: lodray::block::Timing| u64::from(timing.latency);
    let latency = 30;
    // Each state that asks takes the cycle of its grant; a result shows in the cycle behind.
    let setup = 1 + 1 + cycles(RaySetup::TIMING);
    // VISIT; one grant for each line; address, memory; and the cycle in which all is seen to be there.
    let fetch = |lines: u64| 1 + lines + cycles(NodeAddress::TIMING) + latency + 1;
    let node_cycles = |boxes: Boxes| {
        let test = match boxes {
            Boxes::Local => cycles(BoxDecode::TIMING) + cycles(BoxTest::TIMING),
            Boxes::Plain => cycles(BoxTest::TIMING),
            Boxes::Wide => cycles(BoxTest32::TIMING),
            Boxes::Six => cycles(BoxDecode8::TIMING) + cycles(BoxTest::TIMING),
        };
        let sort = if matches!(boxes, Boxes::Six) { cycles(ChildSort6::TIMING) } else { cycles(ChildSort::TIMING) };
        // Each turn but the first takes a cycle more.
        let children = if matches!(boxes, Boxes::Six) { 6 } else { 4 };
        let turns = u64::from(Hardware::DEFAULT.boxes_per_cycle.passes(children));
        fetch(boxes.lines().into()) + 1 + test + turns - 1 + sort
    };
    // SETUP and its wait, a node and one PUSH, POP, DONE and the hit's register.
    for boxes in [Boxes::Local, Boxes::Plain, Boxes::Wide, Boxes::Six] {
        assert_eq!(alone(vec![node(0, 0, boxes), end(false)], latency), setup + node_cycles(boxes) + 1 + 1 + 1 + 1 - 1);
    }

    let of_leaf = |hits| {
        let mut steps = vec![node(0, 1, Boxes::Wide)];
        steps.extend(leaf([40, 41, 57]));
        steps.extend([triangles(5, hits), end(hits != 0)]);
        alone(steps, latency)
    };
    let interval = u64::from(TriTest::TIMING.interval);
    let tests = 1 + 4 * interval + cycles(TriTest::TIMING);
    let to_leaf = setup + node_cycles(Boxes::Wide) + 1 + fetch(3);
    // PUSH and its leaf; five tests, the cycle in which all are seen through; POP, DONE, the register.
    assert_eq!(of_leaf(0), to_leaf + tests + 1 + 1 + 1 + 1 - 1);
    // The last test's hit: the queue, the division, the comparison; then v, w and SUM, and no map.
    let hit = 1 + cycles(HitDivide::TIMING) + cycles(HitSelect::TIMING);
    let divide = 2 * cycles(HitDivide::TIMING) + 1 + 1;
    assert_eq!(of_leaf(1 << 4), to_leaf + tests + hit + 1 + 1 + divide + 1 + 1 - 1);
    // Two hits one behind the other in the division.
    assert_eq!(of_leaf(0b11000), of_leaf(1 << 4) + cycles(HitDivide::TIMING) - interval);
}

#[test]
fn baseline_rays_share_a_unit() {
    let mut rng = Rng(5);
    let mut lines = 0;
    let mut ray = |_| {
        let mut steps = vec![node(4, 1, Boxes::Wide)];
        for _ in 0..20 {
            lines += 4;
            let leaves = rng.below(16) + 1;
            lines += leaves;
            steps.extend(leaf(0..leaves as u32));
            steps.push(triangles(rng.below(32) as u32 + 1, (rng.draw() & rng.draw()) as u32));
            steps.extend([pop(true); 90]);
            steps.extend([pop(false), node(8, 1, Boxes::Wide)]);
        }
        lines += 4 + 1;
        steps.extend(leaf([3]));
        steps.extend([triangles(1, 1), end(true)]);
        steps
    };
    let rays: Vec<_> = (0..300).map(&mut ray).collect();
    let batch = Batch::new(&rays);
    for (contexts, edges_per_cycle) in [(1, EdgesPerCycle::One), (16, EdgesPerCycle::Three), (64, EdgesPerCycle::One)] {
        let mut unit = UnitTiming::new(Hardware { contexts, edges_per_cycle, ..Hardware::default() });
        let mut around = Smooth::new(&batch, 17);
        let cycles = around.run(&mut unit);
        let counts = unit.counts(cycles);
        assert_eq!([around.done as u64, around.requests], [300, lines]);
        assert_eq!(counts.states.iter().sum::<u64>(), cycles * contexts as u64);
        println!("{contexts} contexts: {cycles} cycles, {} ticks, longest queue {}", around.ticks, counts.longest_queue);
    }
}
