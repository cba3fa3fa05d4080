//! What contexts wait for: every cycle of a wait has one cause.
//!
//! A line's way is a sequence of stretches, each with its cause, without gaps: in the queue of its L1 bank, looked up, over the crossbar, in the queue of its L2 bank, looked up,
//! in memory, and back. Who asks for a line that is on its way already (merges) waits for the rest of that way alone. A context that waits for several lines is charged the way
//! of the one that came last; what it waited before that was asked for is its port's.

/// Causes in the order of a line's way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub enum Cause {
    /// The way of its core or unit to the L1: a line a cycle, others first.
    Port,
    /// The queue of the L1's bank is full.
    L1Queue,
    /// Its turn in that queue.
    L1Turn,
    /// The bank stands still for want of a miss register, or of a target in one.
    L1Mshr,
    /// The L1's latency.
    L1LookUp,
    /// The crossbar's ports, and the time through it.
    CrossbarRequest,
    /// The queue of the L2's bank is full, for it or for what is before it.
    L2Queue,
    /// Its turn in that queue.
    L2Turn,
    /// The bank stands still for want of a miss register, or of a target in one.
    L2Mshr,
    /// The L2's latency.
    L2LookUp,
    /// The queue of the memory channel is full.
    DramQueue,
    /// Others of its bank, the time between activates of a bank, refresh.
    DramBank,
    /// Another row is closed for it.
    DramConflict,
    /// Activates of other banks: nRRD, nFAW.
    DramActivate,
    /// Its row is opened: nRCD.
    DramOpening,
    /// Its row is open: reads and writes before it, the data bus.
    DramBus,
    /// From its read command to its data.
    DramAccess,
    /// The crossbar's ports on the way back, and the time through it.
    CrossbarAnswer,
}

/// How many there are.
pub const CAUSES: usize = Cause::CrossbarAnswer as usize + 1;

impl Cause {
    /// Names in reports, in order.
    pub const NAMES: [&'static str; CAUSES] = [
        "port",
        "l1_queue",
        "l1_turn",
        "l1_mshr",
        "l1_look_up",
        "crossbar_request",
        "l2_queue",
        "l2_turn",
        "l2_mshr",
        "l2_look_up",
        "dram_queue",
        "dram_bank",
        "dram_conflict",
        "dram_activate",
        "dram_opening",
        "dram_bus",
        "dram_access",
        "crossbar_answer",
    ];
}

/// Cycles by cause.
pub type Stalls = [u64; CAUSES];

/// A line's way so far, by cause.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Path {
    cycles: [u32; CAUSES],
    /// The cycle in which it ended.
    end: u64,
    /// Nothing but a look-up of the L1, of this latency.
    plain: Option<u32>,
}

impl Path {
    /// A way that begins.
    pub fn begin(cause: Cause, cycles: u64) -> Self {
        let mut path = Self::default();
        path.add(cause, cycles);
        path
    }

    /// A stretch more.
    #[inline]
    pub fn add(&mut self, cause: Cause, cycles: u64) {
        self.cycles[cause as usize] += cycles as u32; // a run of 2^32 cycles in one wait does not end
    }

    /// The last `left` cycles of `other` follow.
    #[inline]
    pub fn add_rest(&mut self, other: &Self, mut left: u64) {
        for (own, &theirs) in self.cycles.iter_mut().zip(&other.cycles).rev() {
            let taken = u64::from(theirs).min(left);
            *own += taken as u32; // of 32 bits
            left -= taken;
        }
    }

    /// It ends in cycle `end`.
    #[inline]
    pub fn ended(self, end: u64) -> Self {
        Self { end, ..self }
    }

    /// It was nothing but a look-up of the L1, which ends in cycle `end`.
    #[inline(always)]
    pub fn look_up(&mut self, latency: u64, end: u64) {
        (self.end, self.plain) = (end, Some(latency as u32)); // of the machine's 32 bits
    }

    /// Charges a wait from one cycle to another, which this way ended; what came behind it has the cause `behind`, what was before it is the port's.
    #[inline]
    pub fn charge(&self, [since, until]: [u64; 2], behind: Cause, stalls: &mut Stalls) {
        let mut left = until - since;
        let mut take = |cause: usize, cycles: u64| {
            let taken = cycles.min(left);
            stalls[cause] += taken;
            left -= taken;
        };
        take(behind as usize, until - self.end.min(until));
        match self.plain {
            Some(latency) => take(Cause::L1LookUp as usize, latency.into()),
            None => (0..CAUSES).rev().for_each(|cause| take(cause, self.cycles[cause].into())),
        }
        take(Cause::Port as usize, u64::MAX);
    }
}

/// Latencies, from 0 on by steps of a quarter of an octave.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Histogram {
    counts: Vec<u64>,
}

impl Histogram {
    /// One more of so many cycles.
    #[inline]
    pub fn add(&mut self, cycles: u64) {
        let at = Self::step(cycles);
        if at >= self.counts.len() {
            self.counts.resize(at + 1, 0);
        }
        self.counts[at] += 1;
    }

    /// Adds another's.
    pub fn join(&mut self, other: &Self) {
        if other.counts.len() > self.counts.len() {
            self.counts.resize(other.counts.len(), 0);
        }
        self.counts.iter_mut().zip(&other.counts).for_each(|(sum, count)| *sum += count);
    }

    /// 0 to 3 alone, then four steps an octave.
    fn step(cycles: u64) -> usize {
        match cycles {
            0..4 => cycles as usize,
            _ => {
                let octave = cycles.ilog2() as usize;
                4 * (octave - 1) + (cycles >> (octave - 2) & 3) as usize // two bits
            }
        }
    }

    /// The least cycles of a step.
    fn least(step: usize) -> u64 {
        if step < 4 { step as u64 } else { (4 + step as u64 % 4) << (step / 4 - 1) }
    }

    /// For each step that has some, its least cycles and how many there are.
    pub fn steps(&self) -> impl Iterator<Item = (u64, u64)> {
        self.counts.iter().enumerate().filter(|(_, count)| **count > 0).map(|(step, &count)| (Self::least(step), count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cycle_has_one_cause() {
        let mut first = Path::begin(Cause::L1LookUp, 1);
        first.add(Cause::CrossbarRequest, 5);
        let mut memory = Path::begin(Cause::L2LookUp, 4);
        memory.add(Cause::DramBank, 10);
        memory.add(Cause::DramAccess, 20);
        // Merged with it 28 cycles before its end.
        first.add_rest(&memory, 28);
        first.add(Cause::CrossbarAnswer, 2);
        let mut stalls = [0; CAUSES];
        // Of 40 cycles, 36 are of the way.
        first.ended(100).charge([60, 100], Cause::Port, &mut stalls);
        let of = |cause: Cause| stalls[cause as usize];
        assert_eq!([of(Cause::L2LookUp), of(Cause::DramBank), of(Cause::DramAccess), of(Cause::CrossbarAnswer)], [0, 8, 20, 2]);
        assert_eq!([of(Cause::L1LookUp), of(Cause::CrossbarRequest), of(Cause::Port)], [1, 5, 4]);
        assert_eq!(stalls.iter().sum::<u64>(), 40);
        // A shorter wait has the end of the way, and what came behind it.
        let mut short = [0; CAUSES];
        first.ended(100).charge([93, 103], Cause::L1LookUp, &mut short);
        assert_eq!([short[Cause::L1LookUp as usize], short[Cause::CrossbarAnswer as usize], short[Cause::DramAccess as usize]], [3, 2, 5]);
        first.look_up(3, 50);
        let mut plain = [0; CAUSES];
        first.charge([46, 50], Cause::Port, &mut plain);
        assert_eq!([plain[Cause::L1LookUp as usize], plain[Cause::Port as usize], plain.iter().sum()], [3, 1, 4]);
    }

    #[test]
    fn steps_are_quarters_of_octaves() {
        let mut all = Histogram::default();
        for cycles in 0..10_000u64 {
            let step = Histogram::step(cycles);
            assert!(Histogram::least(step) <= cycles && Histogram::least(step + 1) > cycles, "{cycles}");
            all.add(cycles);
        }
        assert_eq!(all.steps().map(|(_, count)| count).sum::<u64>(), 10_000);
        assert_eq!(all.steps().take(6).collect::<Vec<_>>(), [(0, 1), (1, 1), (2, 1), (3, 1), (4, 1), (5, 1)]);
        assert_eq!(all.steps().find(|step| step.0 == 16), Some((16, 4)));
    }
}
