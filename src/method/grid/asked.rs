//! The lines that a visit of a node asks for.

use super::mesh::GridMesh;
use super::pattern::Preliminary;
use super::tuple::Tuple;
use crate::step::{Act, Fetch, SectionId, Step, StepSink};

/// Whether anybody listens: who keeps nothing has no state.
pub const fn is_heard<S: StepSink>() -> bool {
    size_of::<S>() > 0
}

/// Lines that one visit asks for, each once.
pub struct Lines {
    lines: [(SectionId, u32); 2 * 153 + 1],
    count: usize,
}

impl Lines {
    #[inline(always)]
    pub fn new() -> Self {
        Self { lines: [(SectionId::new(0), 0); 2 * 153 + 1], count: 0 }
    }

    #[inline(always)]
    pub fn add(&mut self, section: SectionId, line: u32) {
        if self.lines[..self.count].iter().all(|of| of.1 != line) {
            self.lines[self.count] = (section, line);
            self.count += 1;
        }
    }

    /// Tells of them: they are asked for together, and with the first the visit begins if it is one.
    pub fn state<S: StepSink>(&self, visits: bool, steps: &mut S) {
        for (place, &(section, line)) in self.lines[..self.count].iter().enumerate() {
            let fetch = Fetch::new(section, line, 1).at(place as u32); // below 2^10
            let is_first = place == 0;
            let fetch = if is_first { fetch } else { fetch.joining() };
            steps.step(Step { visits: visits && is_first, ..Step::on(fetch, Act::Fetch) });
        }
    }
}

/// Adds the lines of a vertex.
#[inline(always)]
pub fn ask(mesh: &GridMesh, primitive: usize, tuple: &Tuple, vertex: Preliminary, lines: &mut Lines) {
    let (section, index) = mesh.place(primitive, tuple, vertex);
    let [first, last] = mesh.vertex_lines(section, index);
    lines.add(section, first);
    if last != first {
        lines.add(section, last);
    }
}
