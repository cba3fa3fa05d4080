//! Cluster level of detail (Benthin and Peters, "Real-Time Ray Tracing of Micro-Poly Geometry with Hierarchical Level of Detail", 2023; meshoptimizer's `clusterlod`, which ships):
//! small clusters of triangles, simplified in groups; those that suffice are chosen before a frame, unpacked, and a BVH is built over them (docs/baselines.md, "Clusters").
//!
//! Two graphs (`shipped.rs`, `paper.rs`) and two measures of what suffices ([`Rule`]); all else is one.

mod before;
mod cut;
mod dense;
mod frame;
mod graph;
mod map;
mod packed;
mod paper;
mod shipped;
mod snapped;
mod surface;
#[cfg(test)]
mod tests;
mod trace;
mod works;

pub use cut::{Cut, Rule};
pub use dense::{pack_dense, unpack_dense};
pub use frame::{FrameBvh, Owned};
pub use graph::{Cluster, Graph, Group, Sphere};
pub use packed::{pack, pairs, unpack, unpaired};
pub use snapped::{Grid, Place, Snapped};

use super::bvh::{FullOptions, LEAF_LAYOUT, LEAF_SIZE, NODE_ORDER, NodeBoxes};
use super::knob::{ErrorKnob, PIXELS, allows_pixels, pixels};
use super::recent::{Recent, apart};
use super::{Before, Knob, Knobs, Method, Over, Registered, Tracer, bvh};
use crate::bvh::BvhError;
use crate::format::Scene;
use crate::rays::{Eye, ModelSpace, Sight};
use crate::step::MemoryMap;
use before::Work;
use dense::dense_sizes;
use packed::{Size, sizes};
use std::sync::{Arc, OnceLock};
use surface::{Corners, surface};
use trace::ClusterTracer;

/// What ships measures by.
pub static ERROR: Knob = Knob {
    name: "error",
    value_name: "PIXELS",
    help: "Clusters: a group is replaced if the simplifier's error of it, which is no bound, is at most so many pixels (default 1 of cluster, unless --pixels is given)",
    default: None,
    words: &[],
    of_frame: false,
    allows: allows_pixels,
};

/// What is outside of all views.
pub static OFF_SCREEN: Knob = Knob {
    name: "off-screen",
    value_name: "FACTOR",
    help: "Clusters: how many times --error and --pixels are allowed to what no view meets, 1 or more",
    default: Some("2"),
    words: &[],
    of_frame: false,
    allows: |value| factor(value).map(drop).ok_or_else(|| format!("'{value}' is not a factor of 1 or more")),
};

fn factor(value: &str) -> Option<f64> {
    value.parse().ok().filter(|factor: &f64| *factor >= 1.0 && factor.is_finite())
}

/// Clusters of a group.
pub static PARTITION: Knob = Knob {
    name: "partition",
    value_name: "CLUSTERS",
    help: "Clusters that are simplified together in the method cluster: about so many, 4 to 64",
    default: Some("16"),
    words: &[],
    of_frame: false,
    allows: |value| partition(value).map(drop).ok_or_else(|| format!("'{value}' is not a number of clusters from 4 to 64")),
};

fn partition(value: &str) -> Option<usize> {
    value.parse().ok().filter(|count| (4..=64).contains(count))
}

/// How clusters lie in memory.
pub static CLUSTER_LAYOUT: Knob = Knob {
    name: "cluster-layout",
    value_name: "CLUSTER_LAYOUT",
    help: "How clusters lie in memory",
    default: Some("indexed"),
    words: &[
        ("indexed", "Vertices of 16 bits a coordinate, pairs of triangles as four indices of 8 bits"),
        ("dgf", "Blocks of 128 bytes of AMD's dense geometry format"),
    ],
    of_frame: false,
    allows: |value| if ["indexed", "dgf"].contains(&value) { Ok(()) } else { Err(format!("'{value}' is not indexed or dgf")) },
};

/// The sweep of errors: octaves from 16 pixels to 1/64.
fn errors() -> Vec<f64> {
    (-6..=4).rev().map(|octave| f64::from(octave).exp2()).collect()
}

/// The sweep of sizes: octaves from 256 pixels to one.
fn diagonals() -> Vec<f64> {
    (0..=8).rev().map(|octave| f64::from(octave).exp2()).collect()
}

/// The graph that ships.
pub static METHOD: Registered = Registered {
    name: "cluster",
    help: "Cluster level of detail as it ships: groups of 128-triangle clusters, chosen by error before a frame and unpacked to a BVH",
    knobs: &[&ERROR, &PIXELS, &OFF_SCREEN, &PARTITION, &CLUSTER_LAYOUT, &NODE_ORDER, &LEAF_LAYOUT, &LEAF_SIZE],
    error: Some(ErrorKnob { knob: &ERROR, values: errors, in_steps: false }),
    over: Over::Either,
    unit: bvh::METHOD_SIX.unit,
    works: works::WORKS,
    make: |scene, knobs, _| Ok(Box::new(Clusters::of(scene, knobs, Kind::Shipped)?)),
};

/// The paper's.
pub static METHOD_PAPER: Registered = Registered {
    name: "cluster-paper",
    help: "Cluster level of detail as in its paper: pairs of 128-quad clusters, chosen by size before a frame and unpacked to a BVH",
    knobs: &[&PIXELS, &ERROR, &OFF_SCREEN, &CLUSTER_LAYOUT, &NODE_ORDER, &LEAF_LAYOUT, &LEAF_SIZE],
    error: Some(ErrorKnob { knob: &PIXELS, values: diagonals, in_steps: false }),
    over: Over::Either,
    unit: METHOD.unit,
    works: works::WORKS,
    make: |scene, knobs, _| Ok(Box::new(Clusters::of(scene, knobs, Kind::Paper)?)),
};

/// Which graph.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// As it ships.
    Shipped,
    /// As in the paper.
    Paper,
}

impl Graph {
    /// The clusters of a scene's finest triangles; those that ship have about `partition` clusters in a group.
    ///
    /// # Errors
    /// No or too many triangles.
    pub fn build(scene: &Scene, kind: Kind, partition: usize) -> Result<Self, BvhError> {
        Ok(Self::over(Snapped::new(scene)?, kind, partition))
    }

    fn over(mesh: Snapped, kind: Kind, partition: usize) -> Self {
        match kind {
            Kind::Shipped => shipped::graph(mesh, partition),
            Kind::Paper => paper::graph(mesh),
        }
    }
}

/// Triangles in all of BVHs that are kept for other sights.
const KEPT: usize = 1 << 25;

/// What does not depend on what is chosen.
struct Shared {
    graph: Graph,
    sizes: Vec<Size>,
    corners: Corners,
    /// The scene over whose finest triangles it is, and the space of its clusters.
    mesh: Scene,
    space: ModelSpace,
    surface: OnceLock<Scene>,
}

/// The method on a scene.
struct Clusters {
    shared: Arc<Shared>,
    kind: Kind,
    rule: Rule,
    options: FullOptions,
    /// The space in which sights are.
    space: ModelSpace,
    made: Recent<FrameBvh>,
}

impl Rule {
    /// What was chosen, or what the method does by default.
    fn chosen(knobs: &Knobs, kind: Kind) -> Self {
        // Checked when they were chosen.
        let of = |knob: &Knob| knobs.get(knob).and_then(pixels);
        let rule = Self { error: of(&ERROR), size: of(&PIXELS), outside: knobs.get(&OFF_SCREEN).and_then(factor).unwrap_or(1.0) };
        match (rule, kind) {
            (Self { error: None, size: None, .. }, Kind::Shipped) => Self { error: Some(1.0), ..rule },
            (Self { error: None, size: None, .. }, Kind::Paper) => Self { size: Some(24.0), ..rule },
            _ => rule,
        }
    }
}

impl Clusters {
    fn of(scene: &Scene, knobs: &Knobs, kind: Kind) -> Result<Self, BvhError> {
        // Boxes have 8 bits in nodes of six, which is what hardware with clusters has.
        let options = FullOptions::chosen(knobs, |_| Some(NodeBoxes::Six))?;
        let mesh = scene.input().unwrap_or(scene).clone();
        let snapped = Snapped::new(&mesh)?;
        let corners = Corners::new(&snapped);
        let partition = knobs.get(&PARTITION).and_then(partition).unwrap_or(16);
        let graph = Graph::over(snapped, kind, partition);
        let places = || graph.places.iter().map(|&place| graph.grid.point(place));
        let corner = |of: fn(i32, i32) -> i32| places().reduce(|a, b| std::array::from_fn(|k| of(a[k], b[k]))).unwrap_or_default();
        let space = ModelSpace { lo: corner(i32::min), hi: corner(i32::max), ..ModelSpace::of(&mesh) };
        let sizes = if knobs.get(&CLUSTER_LAYOUT) == Some("dgf") { dense_sizes(&graph) } else { sizes(&graph) };
        let shared = Shared { sizes, graph, corners, mesh, space, surface: OnceLock::new() };
        let made = Recent::new(|frame: &FrameBvh| frame.triangles.len(), KEPT);
        Ok(Self { shared: Arc::new(shared), kind, rule: Rule::chosen(knobs, kind), options, space: ModelSpace::of(scene), made })
    }

    /// The eyes of a frame, or of all, in units of the clusters.
    fn eyes(&self, sight: &Sight, frame: Option<usize>) -> Vec<Eye> {
        let (from, to) = (self.space.placement, self.shared.space.placement);
        let scale = from.scale / to.scale;
        let place = |p: [f64; 3]| std::array::from_fn(|k| (from.offset[k] - to.offset[k]) / to.scale + scale * p[k]);
        let own = |eye: &Eye| Eye { lo: place(eye.lo), hi: place(eye.hi), radius: scale * eye.radius, ..*eye };
        match frame.and_then(|frame| sight.eyes.get(frame)) {
            Some(eye) => vec![own(eye)],
            None => sight.eyes.iter().map(own).collect(),
        }
    }

    /// What a frame's rays go through, or those of all frames if none is named.
    fn frame(&self, sight: &Sight, frame: Option<usize>) -> Arc<FrameBvh> {
        let eyes = self.eyes(sight, frame);
        let seen = Sight { eyes: eyes.clone(), frame: None, delta: sight.delta, least_radius: sight.least_radius };
        self.made.get(&seen, || {
            let cut = Cut::new(&self.shared.graph, &self.rule, &eyes);
            FrameBvh::new(&self.shared.graph, cut, &self.options).expect("a cut covers the mesh once, which was checked")
        })
    }

    /// Frames that choose for themselves.
    fn frames(sight: &Sight) -> Vec<Option<usize>> {
        if sight.eyes.len() > 1 { (0..sight.eyes.len()).map(Some).collect() } else { vec![None] }
    }
}

impl Method for Clusters {
    fn map(&self, sight: &Sight) -> MemoryMap {
        map::map(&self.shared.graph, &self.shared.sizes, Self::frames(sight).into_iter().map(|frame| self.frame(sight, frame)))
    }

    fn tracer(&self, sight: &Sight) -> Box<dyn Tracer + '_> {
        Box::new(ClusterTracer::new(self.frame(sight, sight.frame), self.map(sight), self.shared.space))
    }

    fn surface<'a>(&'a self, _: &'a Scene) -> &'a Scene {
        let Shared { graph, corners, mesh, surface: made, .. } = &*self.shared;
        // Whoever waits for it must not be needed to build it.
        made.get_or_init(|| apart(|| surface(graph, corners, mesh).expect("no more triangles than a scene holds")))
    }

    fn again(&self, knobs: &Knobs) -> Option<Box<dyn Method>> {
        let made = Recent::new(|frame: &FrameBvh| frame.triangles.len(), KEPT);
        Some(Box::new(Self { shared: Arc::clone(&self.shared), rule: Rule::chosen(knobs, self.kind), made, ..*self }))
    }

    /// A frame whose eye is that of the one before has nothing to do; one whose clusters are the same, only to find that out.
    fn before(&self, sight: &Sight, frame: usize) -> Option<Box<dyn Before + '_>> {
        let own = (sight.eyes.len() > 1).then_some(frame);
        let last = frame.checked_sub(1);
        if let Some(last) = last {
            let is_same = sight.eyes.len() <= 1 || sight.eyes.get(frame) == sight.eyes.get(last);
            if is_same {
                return None;
            }
        }
        let made = self.frame(sight, own);
        let before = last.map(|last| self.frame(sight, Some(last)));
        let is_new = |cluster: &u32| before.as_ref().is_none_or(|before| before.cut.clusters.binary_search(cluster).is_err());
        let changed = (0..).zip(&made.cut.clusters).filter(|(_, cluster)| is_new(cluster)).map(|(at, _)| at).collect();
        let Shared { graph, sizes, .. } = &*self.shared;
        Some(Box::new(Work { graph, sizes, map: self.map(sight), frame: made, changed }))
    }

    fn choices(&self, sight: &Sight) -> Vec<(&'static str, String)> {
        let graph = &self.shared.graph;
        let made = self.frame(sight, Self::frames(sight)[0]);
        let [roots, coarsest] = graph.roots();
        let counts = [
            ("clusters", made.cut.clusters.len()),
            ("of", graph.clusters.len()),
            ("triangles", made.triangles.len()),
            ("groups asked", made.cut.asked.len()),
            ("roots", roots),
            ("their triangles", coarsest),
        ];
        let lost = (graph.collapsed > 0).then_some(("collapsed on the grid", graph.collapsed));
        counts.into_iter().chain(lost).map(|(name, count)| (name, count.to_string())).collect()
    }
}
