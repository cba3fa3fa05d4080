//! What it costs and brings to decide a level by ray, apart from the structure in which it is decided: frames at full detail, and frames at the error of ours at delta 1. One line of JSON for each.
//!
//! `cargo bench --bench one_delta -- SCENE.lod...`; `scripts/grid` makes a table of it. `LODRAY_GRID_SIZE` is the side of the frame (default 512), `LODRAY_GRID_DISTANCES` has the camera's
//! distances in radii (default 1.5,4,16). At the error of ours stand
//! - grid primitives with the smallest cap that is no worse, with spheres, boxes and prisms;
//! - `discrete` with its coarsest level that is no worse: a BVH;
//! - `trees`: our trees, cut at the coarsest level that is no worse, a scene of its own: no ray decides;
//! - `radius`: our trees with one radius for all rays of the frame, the largest that is no worse: rays decide by how flat the surface is, not by how far;
//! - `lod`: ours, each ray by its cone.

use lodray::bvh::over_trees;
use lodray::format::{Scene, SceneInfo, build};
use lodray::machine::Machine;
use lodray::mesh::{FinestSurface, Surface, lattice};
use lodray::method::knob::DELTA;
use lodray::method::{Departure, Knob, Knobs, Landing, Method, Over, Registered, SurfaceHit, Tracer, lod};
use lodray::picture::{FullResolution, SurfaceError, render};
use lodray::rays::{Camera, ModelSpace, Query, Sight, View};
use lodray::run::Compute;
use lodray::scene::{PassRays, SceneMethod};
use lodray::step::{LineCounter, MemoryMap, Recorder, StepSink};
use serde_json::json;
use std::error::Error;
use std::path::Path;

/// The radius of all rays, in world units.
static RADIUS: Knob = Knob {
    name: "radius",
    value_name: "RADIUS",
    help: "Radius of every ray's cone, from its beginning to its end",
    default: Some("0"),
    words: &[],
    of_frame: false,
    allows: |value| value.parse::<f64>().map(drop).map_err(|error| error.to_string()),
};

/// Ours with one radius for all rays.
static ONE_RADIUS: Registered = Registered {
    name: "radius",
    help: "Ours with one radius for all rays of a frame",
    knobs: &[&DELTA, &RADIUS],
    error: None,
    over: Over::Scene,
    unit: lod::METHOD.unit,
    works: &[],
    make: |scene, knobs, store| {
        let radius = knobs.get(&RADIUS).and_then(|value| value.parse().ok()).unwrap_or(0.0);
        Ok(Box::new(OneRadius { lod: (lod::METHOD.make)(scene, &Knobs::default(), store)?, radius }))
    },
};

struct OneRadius {
    lod: Box<dyn Method>,
    radius: f64,
}

impl Method for OneRadius {
    fn map(&self, sight: &Sight) -> MemoryMap {
        self.lod.map(sight)
    }

    fn tracer(&self, sight: &Sight) -> Box<dyn Tracer + '_> {
        Box::new(Even { tracer: self.lod.tracer(sight), radius: self.radius })
    }
}

/// Traces rays as if they were cylinders.
struct Even<'a> {
    tracer: Box<dyn Tracer + 'a>,
    radius: f64,
}

impl Even<'_> {
    fn of(&self, query: &Query) -> Query {
        query.with_cone(self.radius, 0.0)
    }
}

impl Tracer for Even<'_> {
    fn hit(&mut self, query: &Query) -> Option<SurfaceHit> {
        self.tracer.hit(&self.of(query))
    }
    fn counted(&mut self, query: &Query, counter: &mut LineCounter<'_>) -> Option<SurfaceHit> {
        self.tracer.counted(&self.of(query), counter)
    }
    fn recorded(&mut self, query: &Query, recorder: &mut Recorder) -> Option<SurfaceHit> {
        self.tracer.recorded(&self.of(query), recorder)
    }
    fn heard(&mut self, query: &Query, steps: &mut dyn StepSink) -> Option<SurfaceHit> {
        self.tracer.heard(&self.of(query), steps)
    }
    fn follow(&mut self, query: &Query, from: Option<&Departure>, recorder: Option<&mut Recorder>) -> Option<Landing> {
        self.tracer.follow(&self.of(query), from, recorder)
    }
    fn enter(&mut self, query: &Query, from: Option<&Departure>, steps: &mut dyn StepSink) -> Option<Landing> {
        self.tracer.enter(&self.of(query), from, steps)
    }
    fn all(&mut self, query: &Query, hits: &mut Vec<SurfaceHit>) -> bool {
        self.tracer.all(&self.of(query), hits)
    }
    fn is_mapped(&self) -> bool {
        self.tracer.is_mapped()
    }
}

/// The trees of a scene down to a level, a scene of its own.
fn cut(scene: &Scene, level: u32) -> Result<Scene, Box<dyn Error>> {
    let (h, place) = (scene.decode(), ModelSpace::of(scene).placement);
    let step = h.levels - level;
    let m = 1u32 << level;
    let points: Vec<_> = (0..=m).flat_map(|j| (0..=m - j).map(move |i| (i << step, j << step))).collect();
    let mut surface = Surface { levels: level, base_vertices: h.base_vertices, triangles: h.triangles.clone(), ..Surface::default() };
    for tree in 0..h.triangles.len() {
        let own = h.tree(tree);
        for &at in &points {
            let p = own[lattice::index(h.levels, at)];
            surface.positions.push(std::array::from_fn(|k| place.offset[k] + place.scale * f64::from(p[k])));
            surface.normals.push(scene.normal_at(tree, at));
        }
    }
    let meta = scene.meta();
    let info = SceneInfo { name: meta.name.clone(), bounds: meta.bounds, vertices: meta.vertices, ..SceneInfo::default() };
    Ok(build(&surface, info, over_trees)?)
}

/// What a view is measured with.
struct Frame<'a> {
    truth: FullResolution<'a>,
    camera: Camera,
    few: Camera,
    machine: &'a Machine,
    distance: &'a str,
}

impl Frame<'_> {
    /// 99 of 100 hits are nearer to the full-resolution surface, in pixels.
    fn error(&self, way: &SceneMethod) -> f64 {
        let pixels = render(way.method(), &ModelSpace::of(way.scene()), &self.few, way.knobs().delta(), &|| ()).0.pixels;
        SurfaceError::of(way.scene(), &pixels, &self.truth, &self.few, 2).surface.map_or(0.0, |error| error.percentile_99)
    }

    /// Tells what a frame takes.
    fn tell(&self, at: &str, name: &str, setting: &str, error: f64, way: &SceneMethod) -> Result<(), Box<dyn Error>> {
        let own = way.simulate(PassRays::Camera(self.camera), self.machine, "haydel2023", Compute::Free)?;
        let done = |name| own.operations.get(name).copied().unwrap_or_default() as f64 / own.rays as f64;
        let groups: f64 = ["child_test", "child_sort", "sphere_sort", "box_pair"].map(done).iter().sum();
        println!(
            "{}",
            json!({
                "scene": self.truth.scene.meta().name, "distance": self.distance, "at": at, "way": name, "setting": setting, "error": error,
                "cycles": own.cycles, "energy": own.energy.total, "dram_bytes": own.dram.bytes, "requests": own.accesses_per_ray,
                "groups": groups, "triangles": done("tri_test"),
            })
        );
        Ok(())
    }

    /// Tells of the first of some settings that is no worse than `limit`, the coarsest first.
    fn tell_first(
        &self,
        name: &str,
        limit: f64,
        ways: impl Iterator<Item = Result<(String, SceneMethod), Box<dyn Error>>>,
    ) -> Result<(), Box<dyn Error>> {
        for way in ways {
            let (setting, way) = way?;
            let error = self.error(&way);
            if error <= limit {
                return self.tell("equal", name, &setting, error, &way);
            }
        }
        Ok(())
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let side = std::env::var("LODRAY_GRID_SIZE").ok().and_then(|value| value.parse().ok()).unwrap_or(512);
    let distances = std::env::var("LODRAY_GRID_DISTANCES").unwrap_or_else(|_| "1.5,4,16".to_owned());
    let machine = Machine::shipped("haydel2023")?;
    for file in std::env::args().skip(1).filter(|word| !word.starts_with('-')) {
        let scene = Scene::open(Path::new(&file))?;
        let (space, levels) = (ModelSpace::of(&scene), scene.levels());
        let surface = FinestSurface::new(&scene.decode());
        let bvh = scene.method("bvh")?;
        let cuts = (0..levels).map(|level| cut(&scene, level)).collect::<Result<Vec<_>, _>>()?;
        let bounds = ["spheres", "boxes", "prisms"];
        for distance in distances.split(',') {
            let view = View { distance: Some(distance.parse()?), ..View::default() };
            let camera = Camera::new(&view, &space, side, side)?;
            let few = camera.every(2);
            let pixels = render(bvh.method(), &space, &few, 1.0, &|| ()).0.pixels;
            let truth = FullResolution { scene: &scene, space: &space, surface: &surface, pixels: &pixels };
            let frame = Frame { truth, camera, few, machine: &machine, distance };

            frame.tell("full", "bvh", "", 0.0, &bvh)?;
            for of in bounds {
                frame.tell("full", of, "cap 4", 0.0, &scene.method_with("grid", &[("grid-bounds", of)])?)?;
            }
            frame.tell("full", "lod", "delta inf", 0.0, &scene.method_with("lod", &[("delta", "inf")])?)?;

            let own = scene.method("lod")?;
            let limit = frame.error(&own).max(1e-9);
            for of in bounds {
                let of_cap =
                    |cap: u32| Ok((format!("cap {cap}"), scene.method_with("grid", &[("grid-bounds", of), ("cap", &cap.to_string())])?));
                frame.tell_first(of, limit, (0..=4).map(of_cap))?;
            }
            let level = |level: u32| Ok((format!("level {level}"), scene.method_with("discrete", &[("level", &level.to_string())])?));
            frame.tell_first("discrete", limit, (0..=levels).map(level))?;
            let whole = |level: u32| {
                let own = cuts.get(level as usize).unwrap_or(&scene);
                Ok((format!("level {level}"), own.method_with("lod", &[("delta", "inf")])?))
            };
            frame.tell_first("trees", limit, (0..=levels).map(whole))?;
            // From the cone behind the model down, by quarters of octaves.
            let farthest = camera.tan_theta * (distance.parse::<f64>()? + 1.0) * space.radius();
            let radius = |step: i32| {
                let radius = farthest * 2f64.powf(-0.25 * f64::from(step));
                Ok((
                    format!("{:.2} pixels at the centre", radius / (camera.tan_theta * distance.parse::<f64>()? * space.radius())),
                    scene.method_of(&ONE_RADIUS, &[("radius", &radius.to_string())])?,
                ))
            };
            frame.tell_first("radius", limit, (0..40).map(radius))?;
            frame.tell("equal", "lod", "delta 1", limit, &own)?;
        }
    }
    Ok(())
}
