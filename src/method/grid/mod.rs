//! Grid primitives (von Buelow, "GPU Ray Tracing of Triangular Grid Primitives", 2024): a BVH over coarse triangles, each of which is a grid that follows the 1-to-4 splits of the
//! hierarchy, with a complete 4-ary tree of spheres and vertices that are stored once (docs/baselines.md, "Grid primitives").

mod asked;
mod binary;
mod bounds;
mod caps;
mod children;
mod float;
mod mesh;
mod pattern;
mod sphere;
mod top;
mod trace;
mod tuple;
mod works;

pub use bounds::{Bounding, Bounds};
pub use caps::{Caps, Displacements, open_edges};
pub use float::{FloatGrid, FloatHit};
pub use mesh::{GridMesh, GridOptions, PointForm};
pub use pattern::Preliminary;
pub use top::{Top, Width};
pub use trace::GridTraverser;
pub use tuple::Tuple;

use super::bvh::BvhTraverser;
use super::knob::{DELTA, ErrorKnob};
use super::{AllHits, ClosestHit, Departure, Knob, Knobs, Landing, Method, Over, Registered, SurfaceHit, Trace, Tracer, discrete};
use crate::bvh::BvhError;
use crate::format::Scene;
use crate::rays::{ModelSpace, Query, Sight};
use crate::step::{MemoryMap, NoSteps, StepSink};
use std::sync::{Arc, Mutex, PoisonError};

/// Most splits of a primitive.
const MOST_SPLITS: u32 = 4;

fn number(value: &str, least: u32) -> Option<u32> {
    value.parse().ok().filter(|number| (least..=MOST_SPLITS).contains(number))
}

/// How often a primitive is split.
pub static GRID_LEVELS: Knob = Knob {
    name: "grid-levels",
    value_name: "LEVELS",
    help: "How often the primitives of a grid are split, 1 to 4; the scene's levels if it has fewer",
    default: Some("4"),
    words: &[],
    of_frame: false,
    allows: |value| number(value, 1).map(drop).ok_or_else(|| format!("'{value}' is not a number of splits from 1 to 4")),
};

/// How many of the finest levels have no bounds.
pub static GRID_LEFT_OUT: Knob = Knob {
    name: "grid-left-out",
    value_name: "LEVELS",
    help: "How many of the finest levels of a grid have no bounds, 0 to 4; all triangles there are tested",
    default: Some("2"),
    words: &[],
    of_frame: false,
    allows: |value| number(value, 0).map(drop).ok_or_else(|| format!("'{value}' is not a number of levels from 0 to 4")),
};

/// What bounds nodes below primitives.
pub static GRID_BOUNDS: Knob = Knob {
    name: "grid-bounds",
    value_name: "BOUNDS",
    help: "Bounds of the nodes of a grid's trees",
    default: Some("spheres"),
    words: &[
        ("spheres", "As the paper has them: a radius each, the centre is computed"),
        ("boxes", "As nodes of bvh have them, 32 bytes for four"),
        ("prisms", "Prisms over the triangles, 9 bytes for four"),
    ],
    of_frame: false,
    allows: |value| bounding(value).map(drop).ok_or_else(|| format!("'{value}' is not spheres, boxes or prisms")),
};

fn bounding(value: &str) -> Option<Bounding> {
    match value {
        "spheres" => Some(Bounding::Spheres),
        "boxes" => Some(Bounding::Boxes),
        "prisms" => Some(Bounding::Prisms),
        _ => None,
    }
}

/// Children of nodes over primitives.
pub static GRID_NODES: Knob = Knob {
    name: "grid-nodes",
    value_name: "CHILDREN",
    help: "Children of a node of the BVH over a grid's primitives",
    default: Some("4"),
    words: &[
        ("2", "As the paper has it: a node with its box in a line, depth first, 256 bins"),
        ("4", "As those of bvh: 32 bytes"),
        ("6", "As those of bvh6: 64 bytes"),
    ],
    of_frame: false,
    allows: |value| width(value).map(drop).ok_or_else(|| format!("'{value}' is not 2, 4 or 6")),
};

fn width(value: &str) -> Option<Width> {
    match value {
        "2" => Some(Width::Two),
        "4" => Some(Width::Four),
        "6" => Some(Width::Six),
        _ => None,
    }
}

/// How vertices are stored.
pub static GRID_POINTS: Knob = Knob {
    name: "grid-points",
    value_name: "FORM",
    help: "Vertices of a grid",
    default: Some("packed"),
    words: &[
        ("packed", "Three coordinates of 28 bits, 84 bits in all: nothing is lost"),
        ("float", "Three 32-bit floats, as the paper has them: coordinates are rounded to 24 bits"),
    ],
    of_frame: false,
    allows: |value| points(value).map(drop).ok_or_else(|| format!("'{value}' is not float or packed")),
};

fn points(value: &str) -> Option<PointForm> {
    match value {
        "float" => Some(PointForm::Float),
        "packed" => Some(PointForm::Packed),
        _ => None,
    }
}

/// How deep the trees of primitives are gone through.
pub static CAP: Knob = Knob {
    name: "cap",
    value_name: "CAP",
    help: "Splits below the primitives of a grid: 0 to 4, for all rays; or distance, for each primitive as few as --delta tolerates at its distance, with seams to its neighbours",
    default: Some("4"),
    words: &[],
    of_frame: false,
    allows: |value| cap(value).map(drop).ok_or_else(|| format!("'{value}' is not distance, or a number of splits from 0 to 4")),
};

/// A chosen cap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Cap {
    Frame(u32),
    Distance,
}

fn cap(value: &str) -> Option<Cap> {
    if value == "distance" { Some(Cap::Distance) } else { number(value, 0).map(Cap::Frame) }
}

impl Cap {
    fn chosen(knobs: &Knobs) -> Self {
        // Checked when it was chosen.
        knobs.get(&CAP).and_then(cap).unwrap_or(Self::Frame(MOST_SPLITS))
    }
}

/// The method.
pub static METHOD: Registered = Registered {
    name: "grid",
    help: "Grid primitives: coarse triangles that are split alike, vertices shared, each with a tree of spheres",
    knobs: &[&DELTA, &CAP, &GRID_LEVELS, &GRID_LEFT_OUT, &GRID_BOUNDS, &GRID_NODES, &GRID_POINTS],
    error: Some(ErrorKnob { knob: &CAP, values: || (0..=MOST_SPLITS).map(f64::from).collect(), in_steps: true }),
    over: Over::Scene,
    // Nodes of four, and hits on coarse triangles are mapped. Spheres and indices are works of its own, which take a unit no time.
    unit: discrete::METHOD.unit,
    works: works::WORKS,
    make: |scene, knobs, _| Ok(Box::new(Grid::of(scene, knobs)?)),
};

impl GridOptions {
    /// Those that were chosen.
    pub fn chosen(knobs: &Knobs) -> Self {
        // Checked when they were chosen.
        let default = Self::default();
        Self {
            splits: knobs.get(&GRID_LEVELS).and_then(|value| number(value, 1)).unwrap_or(default.splits),
            left_out: knobs.get(&GRID_LEFT_OUT).and_then(|value| number(value, 0)).unwrap_or(default.left_out),
            bounding: knobs.get(&GRID_BOUNDS).and_then(bounding).unwrap_or(default.bounding),
            width: knobs.get(&GRID_NODES).and_then(width).unwrap_or(default.width),
            points: knobs.get(&GRID_POINTS).and_then(points).unwrap_or(default.points),
        }
    }
}

/// Sights whose caps are kept for other frames.
const KEPT: usize = 4;

/// The method on a scene.
struct Grid {
    mesh: Arc<GridMesh>,
    cap: Cap,
    /// If caps follow the distance.
    displacements: Option<Displacements>,
    space: ModelSpace,
    /// Caps by what was seen last, the latest at the end.
    seen: Mutex<Vec<(Sight, Caps)>>,
}

impl Grid {
    fn of(scene: &Scene, knobs: &Knobs) -> Result<Self, BvhError> {
        let hierarchy = scene.decode();
        let (mesh, cap) = (GridMesh::build(&hierarchy, &GridOptions::chosen(knobs))?, Cap::chosen(knobs));
        let displacements = (cap == Cap::Distance).then(|| Displacements::new(&hierarchy, &mesh));
        Ok(Self { mesh: Arc::new(mesh), cap, displacements, space: ModelSpace::of(scene), seen: Mutex::default() })
    }

    /// The caps of a frame.
    fn caps(&self, sight: &Sight) -> Caps {
        let splits = self.mesh.pattern.splits;
        let displacements = match (self.cap, &self.displacements) {
            (Cap::Frame(cap), _) => return Caps::Frame(cap.min(splits)),
            (Cap::Distance, None) => return Caps::Frame(splits),
            (Cap::Distance, Some(displacements)) => displacements,
        };
        let sight = &sight.whole();
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, caps)) = seen.iter().find(|(of, _)| of == sight) {
            return caps.clone();
        }
        let caps = Caps::Each(Arc::new(displacements.caps(&self.mesh, sight)));
        if seen.len() == KEPT {
            seen.remove(0);
        }
        seen.push((sight.clone(), caps.clone()));
        caps
    }
}

impl Method for Grid {
    fn map(&self, _: &Sight) -> MemoryMap {
        *self.mesh.map()
    }

    fn tracer(&self, sight: &Sight) -> Box<dyn Tracer + '_> {
        let traverser = GridTraverser::new(Arc::clone(&self.mesh), self.caps(sight));
        Box::new(GridTracer { traverser, space: self.space, levels: self.mesh.levels })
    }

    fn again(&self, knobs: &Knobs) -> Option<Box<dyn Method>> {
        let cap = Cap::chosen(knobs);
        let again = || Self { mesh: Arc::clone(&self.mesh), cap, displacements: None, space: self.space, seen: Mutex::default() };
        (cap != Cap::Distance).then(|| Box::new(again()) as Box<dyn Method>)
    }

    fn choices(&self, sight: &Sight) -> Vec<(&'static str, String)> {
        let caps = self.caps(sight);
        let triangles: u64 = (0..self.mesh.ids.len()).map(|primitive| 1 << (2 * caps.of(primitive))).sum();
        let counts =
            [("primitives", self.mesh.ids.len() as u64), ("triangles", triangles), ("open edges", open_edges(&self.mesh, &caps) as u64)];
        counts.map(|(name, count)| (name, count.to_string())).to_vec()
    }
}

/// Rays through grid primitives.
struct GridTracer {
    traverser: GridTraverser,
    space: ModelSpace,
    /// Number of splits N of the scene.
    levels: u32,
}

impl Trace for GridTracer {
    fn trace<S: StepSink>(&mut self, query: &Query, steps: &mut S) -> Option<SurfaceHit> {
        // Its triangles are what they are, whatever the ray's cone.
        let ray = self.space.enter(query, 1.0)?;
        let mut hit = ClosestHit::of(self.levels, &ray, query.any);
        self.traverser.descend(&ray.ray, None, steps, &mut hit);
        hit.surface(&ray)
    }

    fn follow<S: StepSink>(&mut self, query: &Query, from: Option<&Departure>, steps: &mut S) -> Option<Landing> {
        let ray = self.space.enter_from(query, from.map(|from| &from.start), 1.0)?;
        let mut hit = ClosestHit::of(self.levels, &ray, query.any);
        self.traverser.descend(&ray.ray, from, steps, &mut hit);
        // All rays see one surface: none of them decides anything.
        hit.landing(&ray, BvhTraverser::departure)
    }

    fn all(&mut self, query: &Query, hits: &mut Vec<SurfaceHit>) -> bool {
        if let Some(ray) = self.space.enter(query, 1.0) {
            let mut all = AllHits::of(self.levels, &ray);
            self.traverser.descend(&ray.ray, None, &mut NoSteps, &mut all);
            all.surfaces(&ray, hits);
        }
        true
    }

    fn is_mapped(&self) -> bool {
        self.traverser.is_mapped()
    }
}
