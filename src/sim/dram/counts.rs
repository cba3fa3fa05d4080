//! What a channel did.

/// What one channel did; clocks are those of the command clock.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ChannelCounts {
    /// Activates.
    pub activates: u64,
    /// Rows closed, by a precharge of their bank or of all banks.
    pub precharges: u64,
    /// Reads.
    pub reads: u64,
    /// Writes.
    pub writes: u64,
    /// Refreshes of all banks of a rank.
    pub refreshes: u64,
    /// Requests that found their row open.
    pub row_hits: u64,
    /// Requests that found their bank closed.
    pub row_misses: u64,
    /// Requests for which another row had to be closed.
    pub row_conflicts: u64,
    /// Clocks in which the data bus carried data.
    pub bus_clocks: u64,
    /// Clocks with a bank active or in refresh, summed over the ranks.
    pub active_clocks: u64,
    /// Of those, in power-down.
    pub active_down_clocks: u64,
    /// Clocks with all banks precharged, in power-down, summed over the ranks.
    pub precharged_down_clocks: u64,
    /// Clocks from arrival to read or write command, summed over the requests; those that wait count up to now.
    pub queued_clocks: u64,
    /// Most requests that waited at once.
    pub longest_queue: u64,
}

impl ChannelCounts {
    /// Clocks with all banks precharged, but for power-down, summed over `ranks`, of so many clocks; 0 if more are counted than there are.
    pub fn precharged_clocks(&self, ranks: u32, clocks: u64) -> u64 {
        (clocks * u64::from(ranks)).saturating_sub(self.active_clocks + self.precharged_down_clocks)
    }

    /// Adds another channel's; the longest queue is that of either.
    pub fn add(&mut self, other: &Self) {
        self.activates += other.activates;
        self.precharges += other.precharges;
        self.reads += other.reads;
        self.writes += other.writes;
        self.refreshes += other.refreshes;
        self.row_hits += other.row_hits;
        self.row_misses += other.row_misses;
        self.row_conflicts += other.row_conflicts;
        self.bus_clocks += other.bus_clocks;
        self.active_clocks += other.active_clocks;
        self.active_down_clocks += other.active_down_clocks;
        self.precharged_down_clocks += other.precharged_down_clocks;
        self.queued_clocks += other.queued_clocks;
        self.longest_queue = self.longest_queue.max(other.longest_queue);
    }
}
