//! Ways to find hits, each in a folder of its own: its structure and sections, knobs, trace, and the unit that its rays need.
//!
//! Whatever runs a method knows it by the traits here and by its entry in [`METHODS`]; adding one touches its folder and that line. What methods share lies
//! beside the folders: children of a node tested and sorted, hits kept, the stack.

mod all_hits;
pub mod binary16;
pub mod bvh;
mod children;
pub mod chunked;
pub mod cluster;
pub mod discrete;
pub mod floats;
pub mod grid;
mod hit;
pub mod knob;
pub mod leave;
pub mod lod;
mod mesh_bvh;
mod normal;
pub mod packet;
mod prior;
mod recent;
pub mod reference;
mod registry;
pub mod rlod;
mod stack;
pub mod stochastic;
mod tracer;

pub use all_hits::AllHits;
pub(crate) use children::{bvh_boxes, bvh_children};
pub use hit::{ClosestHit, Crossings, Departure, Hit, HitSink, Landing, SurfaceHit, TriangleId, is_beyond};
pub use knob::{ErrorKnob, Knob, KnobError, Knobs};
pub use prior::{Deciders, Prior};
pub use registry::{METHODS, find};
pub use stack::{Entry, Op, STACK_ENTRIES, TraversalStack};
pub use tracer::{Trace, Tracer, trace_together};

use crate::block::{Operation, Work};
use crate::bvh::BvhError;
use crate::format::Scene;
use crate::rays::Sight;
use crate::step::{Batch, MemoryMap};
use mesh_bvh::TreeStore;
use std::fmt;

/// What a traversal unit for a method's rays is made of.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MethodUnit {
    /// Its blocks, each as often as there is one.
    pub blocks: &'static [Operation],
    /// A context keeps split triangles, and its stack levels and bound codes.
    pub has_levels: bool,
}

/// What computes for a method's rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Computing {
    /// Their units; none where compute takes no time.
    pub unit: Option<MethodUnit>,
    /// Operations of its own.
    pub works: &'static [Work],
}

/// Whose triangles a method is over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Over {
    /// The scene's own.
    Scene,
    /// Those of the mesh that the scene was made from, which must be at hand ([`Scene::input`]).
    Input,
    /// Those of that mesh if it is at hand, otherwise the scene's finest.
    Either,
}

/// A method in the registry.
pub struct Registered {
    /// Its name in options and reports.
    pub name: &'static str,
    /// One line about it.
    pub help: &'static str,
    /// What may be chosen.
    pub knobs: &'static [&'static Knob],
    /// The knob by which error is traded for cost; none if there is no error to trade.
    pub error: Option<ErrorKnob>,
    /// Whose triangles it is over.
    pub over: Over,
    /// A unit for its rays; none if it is no hardware.
    pub unit: Option<MethodUnit>,
    /// Operations of its own that no block does, by the number that steps name them by; few methods have any.
    pub works: &'static [Work],
    /// Builds what it needs for a scene.
    pub make: Make,
}

/// Builds what a method needs for a scene.
pub type Make = fn(&Scene, &Knobs, &dyn TreeStore) -> Result<Box<dyn Method>, BvhError>;

/// A method with what it needs for one scene: it may be kept, sent to other threads, and outlive whatever it was made from.
pub trait Method: Send + Sync {
    /// Its memory, for rays that see `sight`; empty if it has none in hardware.
    fn map(&self, sight: &Sight) -> MemoryMap;

    /// Traces one ray after the other; one for each thread.
    fn tracer(&self, sight: &Sight) -> Box<dyn Tracer + '_>;

    /// The scene whose triangles its hits name, with their normals and materials: `scene`, for which it was made, where they are that one's.
    fn surface<'a>(&'a self, scene: &'a Scene) -> &'a Scene {
        scene
    }

    /// Rays may start on the surface that it finds, exactly where others met it ([`Tracer::follow`]).
    fn leaves(&self) -> bool {
        true
    }

    /// The same structures with other choices of its error knob, where that is not the quality, which rays bring along.
    fn again(&self, _knobs: &Knobs) -> Option<Box<dyn Method>> {
        None
    }

    /// What is to be done before the rays of a frame, the first being 0, as pieces of work whose steps read, write, and do operations of its own: all rays wait until all is done.
    /// None where there is nothing to do, as for a frame of which all is still there.
    fn before(&self, _sight: &Sight, _frame: usize) -> Option<Box<dyn Before + '_>> {
        None
    }

    /// Sights for which it gives the same number are seen alike: rays with either find the same, in the same memory. None where each sight may be seen in its own way.
    fn alike(&self, _sight: &Sight) -> Option<u64> {
        None
    }

    /// What it chose for these rays, beyond its knobs: name and value.
    fn choices(&self, _sight: &Sight) -> Vec<(&'static str, String)> {
        Vec::new()
    }
}

/// Work before a frame, in batches that do not wait for each other.
pub trait Before: Sync {
    /// How many.
    fn batches(&self) -> usize;

    /// The steps of a batch ([`Recorder::work`](crate::step::Recorder::work)).
    fn batch(&self, batch: usize) -> Batch;
}

impl Registered {
    /// It is over the mesh that a scene was made from, which must be at hand.
    pub fn of_input(&self) -> bool {
        self.over == Over::Input
    }

    /// It has a knob of this name.
    pub fn has(&self, knob: &str) -> bool {
        self.knobs.iter().any(|own| own.name == knob)
    }
}

impl fmt::Debug for Registered {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name)
    }
}

/// Names are told apart by the registry's test.
impl PartialEq for Registered {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}
