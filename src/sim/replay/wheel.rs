//! What happens when: a wheel of cycles, and a heap for what is too far ahead for it.
//!
//! Events of one cycle happen in the order in which they were entered, so a run depends on nothing else.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Cycles that the wheel sees ahead.
const SLOTS: u64 = 4096;

/// Events by cycle; a `u32` each.
pub struct Wheel {
    slots: Vec<Vec<u32>>,
    /// Bit k of word w: slot 64 w + k has events.
    full: [u64; SLOTS as usize / 64],
    now: u64,
    /// Events of this cycle, and how many of them have happened.
    current: Vec<u32>,
    happened: usize,
    /// Beyond the wheel: by cycle, then in order of entry.
    far: BinaryHeap<Reverse<(u64, u64, u32)>>,
    entered: u64,
}

impl Wheel {
    /// Cycle 0, and nothing to happen.
    pub fn new() -> Self {
        let slots = vec![Vec::new(); SLOTS as usize];
        let full = [0; SLOTS as usize / 64];
        Self { slots, full, now: 0, current: Vec::new(), happened: 0, far: BinaryHeap::new(), entered: 0 }
    }

    /// This cycle.
    pub fn now(&self) -> u64 {
        self.now
    }

    /// Enters an event of `cycle`, this one or a later one.
    #[inline]
    pub fn at(&mut self, cycle: u64, event: u32) {
        debug_assert!(cycle >= self.now, "cycle {cycle} was before {}", self.now);
        if cycle == self.now {
            self.current.push(event);
        } else if cycle - self.now < SLOTS {
            self.enter(cycle, event);
        } else {
            self.far.push(Reverse((cycle, self.entered, event)));
            self.entered += 1;
        }
    }

    #[inline]
    fn enter(&mut self, cycle: u64, event: u32) {
        let slot = (cycle % SLOTS) as usize;
        self.slots[slot].push(event);
        self.full[slot / 64] |= 1 << (slot % 64);
    }

    /// The next event of this cycle.
    #[inline]
    pub fn take(&mut self) -> Option<u32> {
        let event = self.current.get(self.happened).copied();
        self.happened += usize::from(event.is_some());
        event
    }

    /// The next cycle with events, after this one.
    pub fn next(&self) -> Option<u64> {
        let near = self.next_near();
        let far = self.far.peek().map(|Reverse((cycle, ..))| *cycle);
        near.into_iter().chain(far).min()
    }

    fn next_near(&self) -> Option<u64> {
        let first = ((self.now + 1) % SLOTS) as usize;
        let words = self.full.len();
        let ahead = |slot: usize| (slot + SLOTS as usize - first) as u64 % SLOTS;
        // The word in which the search begins comes last again, for the slots before the first.
        (0..=words).find_map(|step| {
            let word = (first / 64 + step) % words;
            let mask = match step {
                0 => !0 << (first % 64),
                s if s == words => !(!0 << (first % 64)),
                _ => !0,
            };
            let bits = self.full[word] & mask;
            (bits != 0).then(|| self.now + 1 + ahead(64 * word + bits.trailing_zeros() as usize))
        })
    }

    /// Goes to `cycle`; no event may lie between.
    pub fn go(&mut self, cycle: u64) {
        debug_assert!(self.happened == self.current.len() && self.next().is_none_or(|next| next >= cycle), "events are left behind");
        self.now = cycle;
        self.current.clear();
        self.happened = 0;
        let slot = (cycle % SLOTS) as usize;
        std::mem::swap(&mut self.current, &mut self.slots[slot]);
        self.full[slot / 64] &= !(1 << (slot % 64));
        while let Some(&Reverse((far, _, event))) = self.far.peek()
            && far < cycle + SLOTS
        {
            self.far.pop();
            self.at(far, event);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn events_come_by_cycle_and_in_the_order_of_entry() {
        let mut wheel = Wheel::new();
        let mut expected: Vec<(u64, u32)> = Vec::new();
        for (event, cycle) in [5, 3, 5, 4095, 4096, 100_000, 0, 3, 4100, 100_000, 64, 63].into_iter().enumerate() {
            wheel.at(cycle, event as u32);
            expected.push((cycle, event as u32));
        }
        expected.sort_by_key(|&(cycle, _)| cycle);
        let mut happened = Vec::new();
        loop {
            while let Some(event) = wheel.take() {
                happened.push((wheel.now(), event));
            }
            let Some(next) = wheel.next() else { break };
            wheel.go(next);
        }
        assert_eq!(happened, expected);
    }

    #[test]
    fn an_event_may_enter_another_of_the_same_cycle() {
        let mut wheel = Wheel::new();
        wheel.at(7, 1);
        wheel.go(7);
        assert_eq!(wheel.take(), Some(1));
        wheel.at(7, 2);
        assert_eq!((wheel.take(), wheel.take(), wheel.next()), (Some(2), None, None));
    }
}
