//! R-LODs (Yoon, Lauterbach and Manocha, "R-LODs: Fast LOD-based Ray Tracing of Massive Models", 2006): a kd-tree some of whose nodes carry a plane that stands for all below, which serves
//! where the node is small enough on screen (docs/baselines.md, "R-LODs").

mod build;
mod clip;
mod hits;
mod map;
mod moments;
mod planes;
mod surface;
#[cfg(test)]
mod tests;
mod trace;
mod tree;
mod works;

pub use build::{COSTS, Costs};
pub use hits::{Every, Nearest, PlaneHit, PlaneSink};
pub use map::{NODES, RLODS, TRIANGLES, map};
pub use planes::{Errors, Planes, Rlod};
pub use trace::{Metric, RlodTraverser, Width};
pub use tree::{KdOrder, Kind, Node, RlodOptions, Tree};

use super::bvh::BvhTraverser;
use super::knob::{ErrorKnob, PIXELS, pixels};
use super::recent::apart;
use super::{Departure, Knob, Knobs, Landing, Method, MethodUnit, Over, Registered, SurfaceHit, Trace, Tracer};
use crate::block::Operation;
use crate::bvh::BvhError;
use crate::format::Scene;
use crate::num::U;
use crate::rays::{ModelRay, ModelSpace, Query, Sight};
use crate::step::{MemoryMap, NoSteps, StepSink};
use std::sync::{Arc, OnceLock};

/// Which nodes have R-LODs.
pub static EVERY: Knob = Knob {
    name: "rlod-every",
    value_name: "NODES",
    help: "R-LODs: every so many inner nodes of a path have one; 0: none, a plain kd-tree",
    default: Some("3"),
    words: &[],
    of_frame: false,
    allows: |value| every(value).map(drop).ok_or_else(|| format!("'{value}' is not a number of nodes from 0 to 64")),
};

fn every(value: &str) -> Option<u32> {
    value.parse().ok().filter(|every| *every <= 64)
}

/// Weight of the deviation.
pub static WEIGHT: Knob = Knob {
    name: "rlod-weight",
    value_name: "WEIGHT",
    help: "R-LODs: weight of the surface's deviation from a plane beside the size of its node, in the error",
    default: Some("16"),
    words: &[],
    of_frame: false,
    allows: |value| factor(value).map(drop).ok_or_else(|| format!("'{value}' is not a weight: 0 or more")),
};

/// How far planes reach beyond their cells.
pub static REACH: Knob = Knob {
    name: "rlod-reach",
    value_name: "DEVIATIONS",
    help: "R-LODs: how many times its deviation a plane reaches beyond its node, against holes",
    default: Some("3"),
    words: &[],
    of_frame: false,
    allows: |value| factor(value).map(drop).ok_or_else(|| format!("'{value}' is not a number of deviations: 0 or more")),
};

fn factor(value: &str) -> Option<f64> {
    value.parse().ok().filter(|factor: &f64| *factor >= 0.0 && factor.is_finite())
}

/// Where nodes lie.
pub static ORDER: Knob = Knob {
    name: "kd-order",
    value_name: "ORDER",
    help: "Order of the nodes of a kd-tree in memory",
    default: Some("area"),
    words: &[
        ("area", "Pages of what a ray is likely to visit next, by the area of cells"),
        ("depth", "Depth first, siblings side by side"),
    ],
    of_frame: false,
    allows: |value| order(value).map(drop).ok_or_else(|| format!("'{value}' is not area or depth")),
};

fn order(value: &str) -> Option<KdOrder> {
    match value {
        "area" => Some(KdOrder::Area),
        "depth" => Some(KdOrder::Depth),
        _ => None,
    }
}

/// Operations of a unit for its rays; splits and planes are works of its own.
const UNIT: [Operation; 5] = [Operation::RaySetup, Operation::NodeAddress, Operation::TriTest, Operation::HitDivide, Operation::HitSelect];

/// Pixels of error by which it is swept: from planes as large as a quarter of a picture to none.
fn sweep() -> Vec<f64> {
    (-2..=8).rev().map(|k| f64::from(k).exp2()).chain([0.0]).collect()
}

/// The method.
pub static METHOD: Registered = Registered {
    name: "rlod",
    help: "R-LODs: a kd-tree whose nodes carry planes that stand for what is below, chosen by each ray",
    knobs: &[&PIXELS, &EVERY, &WEIGHT, &REACH, &ORDER],
    error: Some(ErrorKnob { knob: &PIXELS, values: sweep, in_steps: false }),
    over: Over::Either,
    unit: Some(MethodUnit { blocks: &UNIT, has_levels: false }),
    works: works::WORKS,
    make: |scene, knobs, _| Ok(Box::new(Rlods::of(scene, knobs)?)),
};

impl RlodOptions {
    /// Those that were chosen.
    pub fn chosen(knobs: &Knobs) -> Self {
        // Checked when they were chosen.
        let default = Self::default();
        Self {
            planes: Planes {
                every: knobs.get(&EVERY).and_then(every).unwrap_or(default.planes.every),
                weight: knobs.get(&WEIGHT).and_then(factor).unwrap_or(default.planes.weight),
            },
            order: knobs.get(&ORDER).and_then(order).unwrap_or(default.order),
            ..default
        }
    }
}

impl Metric {
    /// What was chosen: four pixels by default, as in the paper's pictures.
    pub fn chosen(knobs: &Knobs) -> Self {
        // Checked when they were chosen.
        Self { pixels: knobs.get(&PIXELS).and_then(pixels).unwrap_or(4.0), reach: knobs.get(&REACH).and_then(factor).unwrap_or(3.0) }
    }
}

/// What does not depend on what is chosen.
struct Shared {
    tree: Arc<Tree>,
    /// The scene over whose finest triangles it is.
    mesh: Scene,
    surface: OnceLock<Scene>,
}

/// The method on a scene.
struct Rlods {
    shared: Arc<Shared>,
    metric: Metric,
}

impl Rlods {
    fn of(scene: &Scene, knobs: &Knobs) -> Result<Self, BvhError> {
        let mesh = scene.input().unwrap_or(scene).clone();
        let tree = Arc::new(Tree::new(&mesh, &RlodOptions::chosen(knobs))?);
        Ok(Self { shared: Arc::new(Shared { tree, mesh, surface: OnceLock::new() }), metric: Metric::chosen(knobs) })
    }
}

impl Method for Rlods {
    fn map(&self, _: &Sight) -> MemoryMap {
        map(&self.shared.tree)
    }

    fn tracer(&self, _: &Sight) -> Box<dyn Tracer + '_> {
        let tree = &self.shared.tree;
        Box::new(RlodTracer::new(RlodTraverser::new(Arc::clone(tree), map(tree), self.metric), ModelSpace::of(&self.shared.mesh)))
    }

    fn surface<'a>(&'a self, _: &'a Scene) -> &'a Scene {
        let Shared { tree, mesh, surface: made } = &*self.shared;
        // Whoever waits for it must not be needed to build it.
        made.get_or_init(|| apart(|| surface::surface(tree, mesh).expect("no more triangles than a scene holds")))
    }

    fn again(&self, knobs: &Knobs) -> Option<Box<dyn Method>> {
        Some(Box::new(Self { shared: Arc::clone(&self.shared), metric: Metric::chosen(knobs) }))
    }

    fn choices(&self, _: &Sight) -> Vec<(&'static str, String)> {
        let tree = &*self.shared.tree;
        let triangles = tree.triangles.len() as f64;
        let [nodes, references, lines, planes] = tree.bytes();
        let share = |of: f64| format!("{of:.2}");
        vec![
            ("pixels", self.metric.pixels.to_string()),
            ("kd-nodes", tree.nodes.len().to_string()),
            ("references a triangle", share(tree.references.len() as f64 / triangles)),
            ("R-LODs", tree.rlods.len().to_string()),
            ("step of errors", share(tree.errors.ratio())),
            ("bytes a triangle", share((nodes + references + lines + planes) as f64 / triangles)),
        ]
    }
}

/// Rays through R-LODs.
pub struct RlodTracer {
    traverser: RlodTraverser,
    space: ModelSpace,
}

impl RlodTracer {
    /// Rays of the world through a tree in this space.
    pub fn new(traverser: RlodTraverser, space: ModelSpace) -> Self {
        Self { traverser, space }
    }

    /// A query's ray, and how wide it is along it.
    fn model_ray(&self, query: &Query, from: Option<&Departure>) -> Option<(ModelRay, Width)> {
        let mut ray = self.space.enter_from(query, from.map(|from| &from.start), 1.0)?;
        let scale = self.space.placement.scale;
        let width = Width {
            first: (query.radius.max(0.0) + query.tan_theta.max(0.0) * ray.start) / scale,
            slope: query.tan_theta.max(0.0) * ray.step / scale,
        };
        if let Some(from) = from {
            // World units over world units a step.
            let clear = (f64::from(from.clear) * scale / ray.step).ceil();
            ray.range[0] = ray.range[0].max(U::saturating(clear as u64));
        }
        Some((ray, width))
    }
}

impl Trace for RlodTracer {
    fn trace<S: StepSink>(&mut self, query: &Query, steps: &mut S) -> Option<SurfaceHit> {
        let (ray, width) = self.model_ray(query, None)?;
        let mut hit = Nearest::of(&ray, query.any);
        self.traverser.descend(&ray, None, width, steps, &mut hit);
        hit.surface(self.traverser.tree(), &ray)
    }

    fn follow<S: StepSink>(&mut self, query: &Query, from: Option<&Departure>, steps: &mut S) -> Option<Landing> {
        let (ray, width) = self.model_ray(query, from)?;
        let mut hit = Nearest::of(&ray, query.any);
        self.traverser.descend(&ray, from, width, steps, &mut hit);
        hit.landing(self.traverser.tree(), &ray, from.map(|from| &from.start), BvhTraverser::departure)
    }

    fn all(&mut self, query: &Query, hits: &mut Vec<SurfaceHit>) -> bool {
        if let Some((ray, width)) = self.model_ray(query, None) {
            let mut every = Every::of(&ray);
            self.traverser.descend(&ray, None, width, &mut NoSteps, &mut every);
            every.surfaces(self.traverser.tree(), &ray, hits);
        }
        true
    }

    fn is_mapped(&self) -> bool {
        false
    }
}
