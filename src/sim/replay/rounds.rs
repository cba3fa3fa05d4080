//! How the sides of a replay go on together, on one thread or on several.
//!
//! Groups hear of each other through the shared side and the dispatcher alone, and nothing that happens there reaches an L1 sooner than [`SharedSide::reply`] cycles later, nor
//! anything in an L1 the shared side sooner than the L1's latency. So in rounds of some cycles every partition of the groups goes on for itself, and the shared side, on
//! another thread, does what the round before told it. What they tell each other is handed over between rounds, in the order of cycles and groups: a run depends neither on how
//! long rounds are nor on how many partitions or threads there are.

use super::FrontEnd;
use super::dispatch::{ChunkSource, Dispatcher};
use super::error::ReplayError;
use super::event::Happening;
use super::group_side::GroupSide;
use super::intervals::{Interval, Series, SharedCounts};
use super::messages::{Fill, Granted, Miss, Told};
use super::shared_side::SharedSide;
use super::wave::{Look, Shown, Wave};
use crate::block::Operations;
use crate::machine::Machine;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard};
use std::{hint, thread};

/// Groups that go on together.
pub struct Partition<F> {
    /// Who asks for lines.
    pub front: F,
    /// Their L1s.
    pub side: GroupSide,
    /// What their rays had the blocks do, over time.
    pub operations: Series<Operations>,
    /// The first of them.
    first: u32,
}

impl<F: FrontEnd> Partition<F> {
    /// Groups of `machine`, from `first` on; when the last `ends` of their rays ended is kept.
    pub fn new(front: F, machine: &Machine, first: u32, ends: usize) -> Self {
        let side = GroupSide::new(machine, first, front.slots(), ends);
        Self { front, side, operations: Series::new(), first }
    }

    /// Does all that happens before cycle `end`.
    fn run(&mut self, end: u64) {
        let Self { front, side, operations, .. } = self;
        loop {
            while let Some(happening) = side.take() {
                front.prefetch(happening, side.soon(happening));
                match happening {
                    Happening::Wake(id) => front.wake(id, side),
                    Happening::Comes(waiter, cycle) => front.comes(waiter, cycle, side),
                    Happening::Answer(waiter, from) => front.answer(waiter, from, side),
                    Happening::Granted(group) => front.granted(group, side),
                }
            }
            match side.next() {
                Some(next) if next < end => {
                    if let Some(end) = operations.end_before(next) {
                        operations.note(end, front.operations());
                    }
                    side.go(next);
                }
                _ => break,
            }
        }
    }

    fn grant(&mut self, granted: Granted) {
        let group = granted.group - self.first;
        self.front.grant(group, granted.grant);
        self.side.grants_at(granted.cycle, group);
    }
}

/// Partitions, and those who work on them.
struct Team<'a, F> {
    partitions: &'a [Mutex<Partition<F>>],
    /// The round above 16 bits, and in these the next partition that nobody has taken.
    turn: AtomicU64,
    /// The round's end.
    end: AtomicU64,
    done: AtomicUsize,
    over: AtomicBool,
}

/// Bits of a partition's number in a turn.
const TURN_BITS: u32 = 16;

/// Looks at what another thread changes soon before the thread gives its place to others.
const LOOKS: u32 = 1 << 10;

/// Waits until `done`.
fn wait_for(mut done: impl FnMut() -> bool) {
    let mut looks = 0;
    while !done() {
        looks += 1;
        if looks % LOOKS == 0 { thread::yield_now() } else { hint::spin_loop() }
    }
}

/// Says that the work is over, whatever ends it.
struct Over<'a>(&'a AtomicBool);

impl Drop for Over<'_> {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Release);
    }
}

/// Counts a partition as done, also one that panicked: its lock tells.
struct Done<'a>(&'a AtomicUsize);

impl Drop for Done<'_> {
    fn drop(&mut self) {
        self.0.fetch_add(1, Ordering::Release);
    }
}

impl<'a, F: FrontEnd> Team<'a, F> {
    fn new(partitions: &'a [Mutex<Partition<F>>]) -> Self {
        let none_left = AtomicU64::new(partitions.len() as u64);
        Self { partitions, turn: none_left, end: AtomicU64::new(0), done: AtomicUsize::new(0), over: AtomicBool::new(false) }
    }

    fn lock(&self, partition: usize) -> MutexGuard<'a, Partition<F>> {
        self.partitions[partition].lock().expect("a replay's thread has panicked")
    }

    /// The partition of a turn.
    fn partition(turn: u64) -> usize {
        (turn & ((1 << TURN_BITS) - 1)) as usize
    }

    fn is_left(&self, turn: u64) -> bool {
        Self::partition(turn) < self.partitions.len()
    }

    /// Runs partitions that nobody has taken, if there are some.
    fn help(&self) {
        while self.is_left(self.turn.load(Ordering::Acquire)) {
            let turn = self.turn.fetch_add(1, Ordering::AcqRel);
            if self.is_left(turn) {
                let _done = Done(&self.done);
                // The end of the turn's round: it was stored first, and the round is not over before this is done.
                let end = self.end.load(Ordering::Acquire);
                self.lock(Self::partition(turn)).run(end);
            }
        }
    }

    /// What all threads but the first do.
    fn work(&self) {
        while !self.over.load(Ordering::Acquire) {
            self.help();
            wait_for(|| self.over.load(Ordering::Acquire) || self.is_left(self.turn.load(Ordering::Acquire)));
        }
    }

    /// Runs all partitions up to cycle `end`, and `meanwhile`.
    fn run(&self, end: u64, meanwhile: impl FnOnce()) {
        self.end.store(end, Ordering::Release);
        self.done.store(0, Ordering::Release);
        let round = (self.turn.load(Ordering::Acquire) >> TURN_BITS) + 1;
        self.turn.store(round << TURN_BITS, Ordering::Release);
        meanwhile();
        self.help();
        wait_for(|| self.done.load(Ordering::Acquire) == self.partitions.len());
    }
}

/// A frame on a machine, behind others whose lines the caches still hold.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameRun {
    /// The cycle in which it began.
    pub start: u64,
    /// The cycle from which on fewer than half of the contexts have rays.
    pub half: u64,
    /// It is work that the rays of the next wait for, and no frame.
    pub is_before: bool,
    /// What had been counted when its last ray ended, since the start of the run.
    pub end: Interval,
}

/// How long rounds are.
#[derive(Clone, Copy)]
struct Pace {
    l1_latency: u64,
    reply: u64,
}

impl Pace {
    /// A round's end where the shared side does the round's misses behind it; `groups` and `shared` are the next cycles in which something happens.
    fn alone(self, groups: u64, shared: u64) -> u64 {
        shared.min(groups.saturating_add(self.l1_latency)).saturating_add(self.reply)
    }

    /// The same where it does those of the round before meanwhile: half as long, for it is a round behind.
    fn beside(self, groups: u64, shared: u64) -> u64 {
        let half = (self.l1_latency + self.reply) / 2;
        shared.saturating_add(self.reply).min(groups.saturating_add(half.max(1)))
    }
}

/// Runs `partitions` with the shared side and the dispatcher until no ray is left, on so many threads; every cycle alone if there is a wave. Gives the frames that ended.
///
/// `half` is how many contexts are half of them.
#[expect(clippy::too_many_arguments, reason = "the parts of a machine")]
pub fn run<F: FrontEnd + Send>(
    machine: &Machine,
    partitions: &[Mutex<Partition<F>>],
    shared: &mut SharedSide,
    reply: u64,
    dispatcher: &mut Dispatcher<impl ChunkSource>,
    threads: usize,
    half: usize,
    wave: Option<&mut Wave>,
) -> Result<Vec<FrameRun>, ReplayError> {
    let team = Team::new(partitions);
    thread::scope(|scope| {
        let _over = Over(&team.over);
        for _ in 1..threads.min(partitions.len()) {
            scope.spawn(|| team.work());
        }
        let pace = Pace { l1_latency: machine.l1.latency_cycles.into(), reply };
        let firsts: Vec<u32> = (0..partitions.len()).map(|partition| team.lock(partition).first).collect();
        let partition_of = (0..machine.cores.groups).map(|group| firsts.partition_point(|&first| first <= group) - 1).collect();
        let is_alone = threads == 1 || wave.is_some();
        Rounds { machine, team: &team, pace, shared, dispatcher, partition_of, half, is_alone }.run(wave)
    })
}

/// The first thread's part.
struct Rounds<'a, 'b, F, S> {
    machine: &'a Machine,
    team: &'a Team<'b, F>,
    pace: Pace,
    shared: &'a mut SharedSide,
    dispatcher: &'a mut Dispatcher<S>,
    /// By group.
    partition_of: Vec<usize>,
    half: usize,
    is_alone: bool,
}

/// What is known between rounds.
struct Between {
    /// The next cycle in which something happens in a group, and on the shared side; `u64::MAX` if in none.
    groups: u64,
    shared: u64,
    /// Rays are under way or about to be.
    is_busy: bool,
}

impl<F: FrontEnd, S: ChunkSource> Rounds<'_, '_, F, S> {
    fn run(mut self, mut wave: Option<&mut Wave>) -> Result<Vec<FrameRun>, ReplayError> {
        let mut frames: Vec<FrameRun> = Vec::new();
        let mut start = 0;
        let (mut misses, mut told): (Vec<Miss>, Vec<Told>) = (Vec::new(), Vec::new());
        let mut fills: Vec<Vec<Fill>> = vec![Vec::new(); self.team.partitions.len()];
        self.dispatcher.start();
        let mut between = self.deliver(&mut fills);
        // Cycle 0 has begun, and the grants of it are events of it.
        between.groups = 0;
        let mut done = 0;
        loop {
            if !between.is_busy {
                let frame = self.frame(start);
                let end = frame.end.end;
                if frame.is_before {
                    // L1s do not hear of what others write: they begin anew, as between programs of a GPU.
                    (0..self.team.partitions.len()).for_each(|partition| self.team.lock(partition).side.empty());
                }
                frames.push(frame);
                // Not before `done`: a round ends no later than the way back of what happened last.
                let Some(next) = self.dispatcher.go_to_next_frame(end) else { return Ok(frames) };
                start = next;
                between = self.deliver(&mut fills);
                continue;
            }
            let next = between.groups.min(between.shared);
            if next == u64::MAX {
                return Err(self.deadlock());
            }
            let end = match (&wave, self.is_alone) {
                (Some(_), _) => next + 1,
                (None, true) => self.pace.alone(between.groups, between.shared),
                (None, false) => self.pace.beside(between.groups, between.shared).max(done),
            };
            let (shared, behind) = (&mut *self.shared, done + self.pace.l1_latency);
            self.team.run(end, || {
                if !self.is_alone {
                    shared.run(behind)
                }
            });
            self.collect(&mut misses, &mut told);
            misses.drain(..).for_each(|miss| self.shared.comes(&miss));
            self.dispatcher.hear(&told);
            told.clear();
            if self.is_alone {
                self.shared.run(if wave.is_some() { end } else { end + self.pace.l1_latency });
            }
            between = self.deliver(&mut fills);
            if let Some(wave) = &mut wave {
                let next = between.groups.min(between.shared);
                self.look(wave, end - 1, between.is_busy.then_some(next).filter(|&next| next < u64::MAX))?;
            }
            done = end;
        }
    }

    /// The frame that began in cycle `start`, all of whose rays have ended.
    fn frame(&mut self, start: u64) -> FrameRun {
        let partitions: Vec<_> = (0..self.team.partitions.len()).map(|partition| self.team.lock(partition)).collect();
        let mut ends: Vec<u64> =
            partitions.iter().flat_map(|partition| partition.side.last_ends()).copied().filter(|&end| end >= start).collect();
        ends.sort_unstable();
        let end = self.shared.drain(ends.last().copied().unwrap_or(start));
        let half = ends.len().checked_sub(self.half).map_or(start, |at| ends[at]);
        self.shared.end(end);
        let SharedCounts { mut counts, channels, dram } = self.shared.counts();
        let mut operations = Operations::default();
        for partition in partitions {
            let side = &partition.side;
            counts.add(&side.counts_at(end.max(side.now())));
            operations.join(&partition.front.operations());
        }
        FrameRun { start, half, is_before: self.dispatcher.is_before, end: Interval { end, counts, channels, dram, operations } }
    }

    /// What the groups told, in the order of cycles and groups.
    fn collect(&self, misses: &mut Vec<Miss>, told: &mut Vec<Told>) {
        for partition in 0..self.team.partitions.len() {
            let mut partition = self.team.lock(partition);
            misses.append(&mut partition.side.misses);
            told.append(&mut partition.front.feed().told);
        }
        misses.sort_by_key(|miss| (miss.cycle, miss.group));
        told.sort_by_key(|told| (told.cycle, told.group));
    }

    /// Gives the groups what is theirs.
    fn deliver(&mut self, fills: &mut [Vec<Fill>]) -> Between {
        let mut lines = std::mem::take(&mut self.shared.fills);
        for fill in lines.drain(..) {
            fills[self.partition_of[self.shared.group(fill.register) as usize]].push(fill);
        }
        self.shared.fills = lines;
        for granted in self.dispatcher.granted.drain(..) {
            self.team.lock(self.partition_of[granted.group as usize]).grant(granted);
        }
        let mut between = Between { groups: u64::MAX, shared: self.shared.next().unwrap_or(u64::MAX), is_busy: false };
        for (partition, fills) in fills.iter_mut().enumerate() {
            let mut partition = self.team.lock(partition);
            fills.drain(..).for_each(|fill| partition.side.comes(&fill));
            between.groups = between.groups.min(partition.side.next().unwrap_or(u64::MAX));
            between.is_busy |= partition.front.under_way() > 0 || !partition.front.feed().is_empty();
        }
        between
    }

    fn look(&self, wave: &mut Wave, now: u64, next: Option<u64>) -> Result<(), ReplayError> {
        let partitions: Vec<_> = (0..self.team.partitions.len()).map(|partition| self.team.lock(partition)).collect();
        let mut counts = self.shared.counts().counts;
        partitions.iter().for_each(|partition| counts.add(&partition.side.counts()));
        let groups = self.machine.cores.groups;
        let show = |show: &mut Shown<'_>| {
            for (at, partition) in partitions.iter().enumerate() {
                let last = partitions.get(at + 1).map_or(groups, |next| next.first);
                for group in partition.first..last {
                    let (queued, misses) = partition.side.occupancy(group - partition.first);
                    let scope = format!("group_{group}");
                    for (name, value) in
                        [("l1_queued", queued), ("l1_misses_under_way", misses), ("crossbar_queued", self.shared.queued(group))]
                    {
                        show(&scope, name, value as u64);
                    }
                }
            }
            self.shared.show(show);
        };
        Ok(wave.sample(&Look { now, counts, show: &show }, &self.machine.cores, next)?)
    }

    fn deadlock(&self) -> ReplayError {
        let partitions: Vec<_> = (0..self.team.partitions.len()).map(|partition| self.team.lock(partition)).collect();
        let cycle = partitions.iter().map(|partition| partition.side.now()).max().unwrap_or(0);
        let of = |partition: &MutexGuard<'_, Partition<F>>| format!("{}\n{}\n", partition.front.describe(), partition.side.describe());
        ReplayError::Deadlock { cycle, state: partitions.iter().map(of).collect::<String>() + &self.shared.describe() }
    }
}
