//! A frame on machines: one functional pass, and a replay on each machine beside it.

use super::{Frame, Traced};
use crate::machine::Machine;
use crate::sim::energy::EnergyModel;
use crate::sim::replay::{self, Chunk, ChunkSource, ReplayError, Run, Running, Window};
use crate::step::Nodes;
use serde::{Deserialize, Serialize};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::thread;

/// Chunks that wait for a replay: one, while the next is being traced.
const AHEAD: usize = 1;

/// How compute is simulated.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Compute {
    /// It takes no time, as in the paper.
    Free,
    /// Traversal units, cycle by cycle.
    Units,
}

impl Compute {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Free, Self::Units];

    /// Its name in options and reports.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Free => "free",
            Self::Units => "units",
        }
    }
}

/// A machine, and whether compute takes time on it.
#[derive(Clone, Debug)]
pub struct Job {
    /// The machine.
    pub machine: Machine,
    /// What compute takes.
    pub compute: Compute,
    /// The cycles of which a waveform is wanted.
    pub window: Option<Window>,
}

/// Refuses a machine that no frame can run on: its energy tables or its memory cannot be read or be, the tables have no energies for its caches, or it is too large.
///
/// # Errors
/// The first of these.
pub fn check(machine: &Machine, compute: Compute) -> Result<(), ReplayError> {
    EnergyModel::new(machine)?;
    replay::check(machine, compute == Compute::Units)
}

/// What a frame asks of whoever runs it.
#[derive(Clone, Copy)]
pub(super) struct Demands {
    /// Work before its rays.
    pub has_work: bool,
    /// Models that its rays go through.
    pub models: usize,
    /// Rays that are traced together.
    pub lanes: usize,
}

impl Demands {
    /// Refuses traversal units what they cannot do: rays through several models, and packets.
    pub fn check(&self, job: &Job) -> Result<(), ReplayError> {
        match job.compute {
            Compute::Units if self.models > 1 => Err(ReplayError::ModelsByUnits(self.models)),
            Compute::Units if self.lanes > 1 => Err(ReplayError::PacketsByUnits(self.lanes)),
            _ => Ok(()),
        }
    }
}

/// Runs steps for a job on so many threads; their rays begin with `nodes`, behind work if there is some.
pub(super) fn replay(job: &Job, nodes: Nodes, has_work: bool, source: impl ChunkSource, threads: usize) -> Result<Run, ReplayError> {
    let how = Running { window: job.window, threads };
    match job.compute {
        Compute::Free => replay::run_free(&job.machine, nodes, source, how),
        Compute::Units if has_work => replay::run_work_then_units(&job.machine, nodes, source, how),
        Compute::Units => replay::run_units(&job.machine, source, how),
    }
}

/// More threads than this make no replay faster.
const MOST_THREADS: usize = 8;

/// Threads of each of so many replays beside each other.
fn threads_of_replay(replays: usize) -> usize {
    (rayon::current_num_threads() / replays.max(1)).clamp(1, MOST_THREADS)
}

/// Runs the rays of `frame` for each of `jobs`. Rays are traced once; every replay has a thread of its own.
/// `look` sees the rays, in order, before they go to the machines.
pub fn simulate(frame: &dyn Frame, jobs: &[Job], look: &mut dyn FnMut(&Traced)) -> Vec<Result<Run, ReplayError>> {
    thread::scope(|scope| {
        let nodes = frame.nodes();
        let threads = threads_of_replay(jobs.len());
        let frames = 0..=frame.frame_starts().len();
        let mut works = frames.filter_map(|of| frame.before(of)).map(|work| work.batches() > 0);
        let has_work = jobs.iter().any(|job| job.compute == Compute::Units) && works.any(|is| is);
        let demands = Demands { has_work, models: frame.models(), lanes: frame.lanes() };
        let (senders, runs): (Vec<SyncSender<Chunk>>, Vec<_>) = jobs
            .iter()
            .map(|job| {
                let (sender, receiver): (_, Receiver<Chunk>) = sync_channel(AHEAD);
                (
                    sender,
                    scope.spawn(move || {
                        demands.check(job)?;
                        replay(job, nodes, demands.has_work, receiver.into_iter(), threads)
                    }),
                )
            })
            .unzip();
        frame.produce(&mut |traced| {
            look(&traced);
            let chunk = traced.chunk();
            // A replay that failed takes no more; the others go on.
            senders.iter().filter(|sender| sender.send(Chunk::clone(&chunk)).is_ok()).count() > 0
        });
        drop(senders);
        let join = |run: thread::ScopedJoinHandle<'_, _>| run.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic));
        runs.into_iter().map(join).collect()
    })
}
