//! Who is told of a traversal's steps.

use super::{Act, MAX_SECTIONS, Step};

/// Is told every step of a ray, in order.
pub trait StepSink {
    /// A step, which is over.
    fn step(&mut self, step: Step);
}

impl<S: StepSink + ?Sized> StepSink for &mut S {
    #[inline(always)]
    fn step(&mut self, step: Step) {
        (**self).step(step);
    }
}

/// Hears nothing.
pub struct NoSteps;

impl StepSink for NoSteps {
    #[inline(always)]
    fn step(&mut self, _: Step) {}
}

/// Counts what rays do.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepCounts {
    /// Groups of child boxes tested: four, of `bvh6` six; by each ray of a packet.
    pub nodes: u64,
    /// LOD tests, by each ray of a packet.
    pub lod_tests: u64,
    /// Triangle tests.
    pub triangles: u64,
    /// Lines read or written, by the place of their section.
    pub lines: [u64; MAX_SECTIONS],
}

impl StepCounts {
    /// Adds the counts of `other`.
    pub fn add(&mut self, other: &Self) {
        self.nodes += other.nodes;
        self.lod_tests += other.lod_tests;
        self.triangles += other.triangles;
        for (a, b) in self.lines.iter_mut().zip(other.lines) {
            *a += b;
        }
    }
}

impl StepSink for StepCounts {
    #[inline(always)]
    fn step(&mut self, step: Step) {
        if let Some(fetch) = step.fetch {
            self.lines[fetch.section.place()] += u64::from(fetch.lines);
        }
        if step.act.met().is_some() {
            self.nodes += u64::from(step.lanes);
        }
        match step.act {
            Act::LodTest { .. } => self.lod_tests += u64::from(step.lanes),
            Act::Triangles { count, .. } => self.triangles += u64::from(count),
            _ => (),
        }
    }
}
