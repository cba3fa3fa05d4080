//! What a frame costs on a machine if every vertex has moved before it: the images of `lod`, or the BVH of `bvh`, are refitted there. `cargo run --release --example refitted [LEVELS]`.
//!
//! Positions are three floats of 32 bits. They are read once for a BVH: its leaves and, from them, its boxes follow. For `lod` they are read twice: codes of bounds have one scale for
//! all trees, so all bounds come before any split. Every line of the structure is written once. What is computed on the way takes no time here, and stays on the chip.

use lodray::block::Work;
use lodray::bvh::BvhError;
use lodray::format::Scene;
use lodray::machine::Machine;
use lodray::mesh::procedural::{self, Options};
use lodray::method::{Before, Knobs, Method, Over, Registered, Tracer, bvh, bvh::TreeStore, lod};
use lodray::num::LINE_BYTES;
use lodray::rays::{Camera, ModelSpace, Sight, View};
use lodray::run::Compute;
use lodray::scene::PassRays;
use lodray::step::{Act, Batch, Fetch, MemoryMap, Recorder, Section, Step, StepSink};
use std::error::Error;

/// Lines of a piece of work, and pieces of a batch.
const PIECE: u64 = 16;
const PIECES: u64 = 64;
/// Bytes of a position.
const POSITION: u64 = 12;

/// A vertex that inserts: its middle, its distance from that, its bound, its code, its steps; boxes that grow around it.
const FIT: Work = Work {
    name: "fit_vertex",
    products: &[[3, 32, 32]],
    add_bits: 3 * 3 * 32 + 6 * 32,
    select_bits: 6 * 32,
    written_bits: 3 * 13 + 8 + 6 * 2,
};
/// A triangle that is stored, and boxes that grow around it.
const STORE: Work = Work { name: "fit_triangle", products: &[], add_bits: 2 * 6 * 32, select_bits: 6 * 32, written_bits: 256 };

static LOD: Registered = Registered {
    name: "lod_refitted",
    help: "Level of detail, refitted before the frame",
    knobs: lod::METHOD.knobs,
    error: lod::METHOD.error,
    over: Over::Scene,
    unit: None,
    works: &[FIT],
    make: |scene, knobs, store| Refitted::of(&lod::METHOD, 2, scene, knobs, store),
};

static BVH: Registered = Registered {
    name: "bvh_refitted",
    help: "BVH, refitted before the frame",
    knobs: bvh::METHOD.knobs,
    error: bvh::METHOD.error,
    over: Over::Scene,
    unit: None,
    works: &[STORE],
    make: |scene, knobs, store| Refitted::of(&bvh::METHOD, 1, scene, knobs, store),
};

struct Refitted {
    method: Box<dyn Method>,
    /// How often positions are read.
    passes: u64,
    vertices: u64,
}

impl Refitted {
    fn of(method: &Registered, passes: u64, scene: &Scene, knobs: &Knobs, store: &dyn TreeStore) -> Result<Box<dyn Method>, BvhError> {
        let vertices = scene.refitting().map_or(0, |refit| refit.vertices() as u64);
        Ok(Box::new(Self { method: (method.make)(scene, knobs, store)?, passes, vertices }))
    }
}

impl Method for Refitted {
    /// The method's sections, and positions behind them.
    fn map(&self, sight: &Sight) -> MemoryMap {
        let map = self.method.map(sight);
        let positions = Section { name: "position", lines: (POSITION * self.vertices).div_ceil(LINE_BYTES), base: false };
        let sections: Vec<_> = map.sections().map(|(_, section)| section).chain([positions]).collect();
        let nodes = map.sections().find(|(_, section)| section.name.ends_with("node")).map(|(id, _)| id);
        MemoryMap::new(&sections, nodes.map(|nodes| (nodes, map.nodes().lines))).expect("few lines")
    }

    fn tracer(&self, sight: &Sight) -> Box<dyn Tracer + '_> {
        self.method.tracer(sight)
    }

    fn before(&self, sight: &Sight, _frame: usize) -> Option<Box<dyn Before + '_>> {
        let map = self.map(sight);
        let written = self.method.map(sight).lines();
        Some(Box::new(Refitting { map, written, passes: self.passes, vertices: self.vertices }))
    }
}

/// The work before a frame: passes over positions, and all lines written, spread evenly over the last.
struct Refitting {
    map: MemoryMap,
    written: u64,
    passes: u64,
    vertices: u64,
}

impl Refitting {
    fn positions(&self) -> u64 {
        (POSITION * self.vertices).div_ceil(LINE_BYTES)
    }

    fn pieces(&self) -> u64 {
        self.passes * self.positions().div_ceil(PIECE)
    }
}

impl Before for Refitting {
    fn batches(&self) -> usize {
        self.pieces().div_ceil(PIECES) as usize
    }

    fn batch(&self, batch: usize) -> Batch {
        let positions = self.map.section("position").expect("it is in the map");
        let mut recorder = Recorder::default();
        let per_pass = self.positions().div_ceil(PIECE);
        for piece in (batch as u64 * PIECES..self.pieces()).take(PIECES as usize) {
            let (pass, part) = (piece / per_pass, piece % per_pass);
            for line in PIECE * part..self.positions().min(PIECE * (part + 1)) {
                recorder.step(Step::on(Fetch::new(positions, self.map.line(positions, line), 1), Act::Fetch));
            }
            if pass + 1 == self.passes {
                recorder.step(Step::of(Act::Work { work: 0, count: (PIECE * LINE_BYTES / POSITION) as u32 }));
                for line in self.written * part / per_pass..self.written * (part + 1) / per_pass {
                    if let Some((section, _)) = self.map.locate(line) {
                        recorder.step(Step::on(Fetch::new(section, line as u32, 1).storing(), Act::Fetch));
                    }
                }
            }
            recorder.step(Step::end(false, false));
        }
        recorder.work()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let levels = std::env::args().nth(1).map_or(Ok(5), |levels| levels.parse())?;
    let scene = Scene::generate(&Options { levels: Some(levels), ..Options::new(procedural::Scene::Terrain) })?;
    let camera = Camera::new(&View { distance: Some(4.0), ..View::default() }, &ModelSpace::of(&scene), 1024, 1024)?;
    let machine = Machine::shipped("haydel2023")?;
    println!("{} triangles", scene.finest_triangles());
    for method in [&LOD, &BVH] {
        let method = scene.method_of(method, &[])?;
        let result = method.simulate(PassRays::Camera(camera), &machine, "haydel2023", Compute::Free)?;
        let before = result.frames[0].before.as_ref().ok_or("there is work before the frame")?;
        let (time, cycles) = (result.milliseconds * 1e3, result.cycles as f64);
        let refit = time * before.cycles as f64 / cycles;
        println!("{}: {time:.1} us, {:.1} {}", method.registered().name, result.energy.total, result.energy.unit);
        println!(
            "  refit: {refit:.1} us, {:.1} {}, {} bytes of DRAM, {} lines written",
            before.energy, result.energy.unit, before.dram_bytes, before.stores
        );
    }
    Ok(())
}
