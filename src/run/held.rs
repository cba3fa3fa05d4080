//! A frame traced once and kept, for replays one after the other.

use super::simulate::{Demands, replay};
use super::{Frame, Job, Traced};
use crate::sim::replay::{Chunk, ReplayError, Run};
use crate::step::Nodes;

/// The steps of a frame's rays: eight bytes a step, some hundred bytes a ray.
pub struct HeldFrame {
    nodes: Nodes,
    chunks: Vec<Chunk>,
    demands: Demands,
}

impl HeldFrame {
    /// Traces all rays of `frame`; `look` sees them, in order.
    pub fn of(frame: &dyn Frame, look: &mut dyn FnMut(&Traced)) -> Self {
        let (mut chunks, mut has_work) = (Vec::new(), false);
        frame.produce(&mut |traced| {
            look(&traced);
            has_work |= traced.is_before;
            chunks.push(traced.chunk());
            true
        });
        Self { nodes: frame.nodes(), chunks, demands: Demands { has_work, models: frame.models(), lanes: frame.lanes() } }
    }

    /// Runs them on a machine.
    ///
    /// # Errors
    /// The machine is impossible or too large, its units were to do what they cannot ([`ReplayError::ModelsByUnits`], [`ReplayError::PacketsByUnits`]), or nothing happens any more while rays are under way.
    pub fn run(&self, job: &Job) -> Result<Run, ReplayError> {
        self.demands.check(job)?;
        replay(job, self.nodes, self.demands.has_work, self.chunks.iter().cloned(), 1)
    }
}
