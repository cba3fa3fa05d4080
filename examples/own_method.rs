//! A method of your own, with work before a frame: levels by object as `chunked` chooses them for the frame's eyes, but their BVH does not fall from the sky. It is unpacked
//! on the machine: packed triangles are read, nodes and leaves are written, and rays wait for that. `cargo run --release --example own_method`.

use lodray::block::Work;
use lodray::bvh::BvhError;
use lodray::format::Scene;
use lodray::machine::Machine;
use lodray::mesh::procedural::{self, Options};
use lodray::method::{Before, Knobs, Method, Over, Registered, Tracer, bvh::TreeStore, chunked};
use lodray::rays::{Camera, ModelSpace, Sight, View};
use lodray::run::Compute;
use lodray::scene::PassRays;
use lodray::step::{Act, Batch, Fetch, MemoryMap, Recorder, Section, Step, StepSink};
use std::error::Error;

/// Lines that are written from a packed one.
const UNPACKED: u32 = 4;
/// Packed lines of a piece of work, and pieces of a batch.
const PIECE: u32 = 16;
const PIECES: u32 = 64;

/// As the registry has its methods; this one need not be there.
pub static METHOD: Registered = Registered {
    name: "unpacked",
    help: "Levels by object, unpacked before the frame",
    knobs: chunked::METHOD.knobs,
    error: chunked::METHOD.error,
    over: Over::Scene,
    unit: None,
    works: &[Work { name: "unpack_line", products: &[[12, 16, 16]], add_bits: 12 * 32, select_bits: 256, written_bits: 256 }],
    make: |scene, knobs, store| Unpacked::of(scene, knobs, store),
};

struct Unpacked {
    /// Its choice and its rays are another method's.
    chunked: Box<dyn Method>,
}

impl Unpacked {
    fn of(scene: &Scene, knobs: &Knobs, store: &dyn TreeStore) -> Result<Box<dyn Method>, BvhError> {
        Ok(Box::new(Self { chunked: (chunked::METHOD.make)(scene, knobs, store)? }))
    }
}

impl Method for Unpacked {
    /// The other's sections, and behind them what they are unpacked from.
    fn map(&self, sight: &Sight) -> MemoryMap {
        let map = self.chunked.map(sight);
        let packed = Section { name: "packed", lines: map.lines().div_ceil(UNPACKED.into()), base: false };
        let sections: Vec<_> = map.sections().map(|(_, section)| section).chain([packed]).collect();
        MemoryMap::new(&sections, Some((map.section("bvh_node").expect("a BVH has nodes"), map.nodes().lines))).expect("few lines")
    }

    fn tracer(&self, sight: &Sight) -> Box<dyn Tracer + '_> {
        self.chunked.tracer(sight)
    }

    /// All eyes of a path have one cut, so it is unpacked before the first frame alone: what stays costs nothing.
    fn before(&self, sight: &Sight, frame: usize) -> Option<Box<dyn Before + '_>> {
        (frame == 0).then(|| Box::new(Unpacking(self.map(sight))) as Box<dyn Before>)
    }

    fn choices(&self, sight: &Sight) -> Vec<(&'static str, String)> {
        self.chunked.choices(sight)
    }
}

/// The work of a frame, by packed lines.
struct Unpacking(MemoryMap);

impl Unpacking {
    fn packed(&self) -> u32 {
        let lines = |name| self.0.sections().find(|(_, section)| section.name == name).map_or(0, |(_, section)| section.lines);
        lines("packed") as u32 // below 2^32: the map says so
    }
}

impl Before for Unpacking {
    fn batches(&self) -> usize {
        self.packed().div_ceil(PIECE * PIECES) as usize
    }

    fn batch(&self, batch: usize) -> Batch {
        let packed = self.0.section("packed").expect("it is in the map");
        let mut recorder = Recorder::default();
        let first = batch as u32 * PIECE * PIECES;
        for piece in (first..self.packed().min(first + PIECE * PIECES)).step_by(PIECE as usize) {
            for line in piece..self.packed().min(piece + PIECE) {
                recorder.step(Step::on(Fetch::new(packed, self.0.line(packed, line.into()), 1), Act::Fetch));
                recorder.step(Step::of(Act::Work { work: 0, count: UNPACKED }));
                // Whichever section they are of; none lies between the sections.
                let written = (UNPACKED * line..UNPACKED * (line + 1)).filter_map(|line| Some((self.0.locate(line.into())?.0, line)));
                for (section, line) in written.filter(|(section, _)| *section != packed) {
                    recorder.step(Step::on(Fetch::new(section, line, 1).storing(), Act::Fetch));
                }
            }
            recorder.step(Step::end(false, false));
        }
        recorder.work()
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let scene = Scene::generate(&Options { levels: Some(3), ..Options::new(procedural::Scene::Street) })?;
    let camera = Camera::new(&View { distance: Some(4.0), ..View::default() }, &ModelSpace::of(&scene), 512, 512)?;
    let machine = Machine::shipped("haydel2023")?;
    for method in [&chunked::METHOD, &METHOD] {
        let method = scene.method_of(method, &[("chunk", "object")])?;
        let result = method.simulate(PassRays::Camera(camera), &machine, "haydel2023", Compute::Free)?;
        let [time, energy] = [result.milliseconds * 1e3, result.energy.total];
        println!("{}: {time:.1} us, {energy:.1} {}, {} bytes of DRAM", method.registered().name, result.energy.unit, result.dram.bytes);
        if let Some(before) = result.frames[0].before {
            let share = 100.0 * before.cycles as f64 / result.cycles as f64;
            println!("  {share:.0} % of it before the rays: {} lines written, {:.1} {}", before.stores, before.energy, result.energy.unit);
        }
    }
    Ok(())
}
