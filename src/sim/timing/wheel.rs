//! When contexts wake.

/// Cycles ahead that the wheel can tell apart.
const SLOTS: u64 = 64;

/// The numbers of the bits that are set.
#[inline(always)]
pub fn bits(mut set: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let first = (set != 0).then(|| set.trailing_zeros() as usize);
        set &= set.wrapping_sub(1);
        first
    })
}

/// The cycles in which contexts wake, one each: a slot of contexts for each of the next cycles.
#[derive(Clone)]
pub struct Wheel {
    /// Contexts as bits, by cycle modulo `SLOTS`.
    slots: [u64; SLOTS as usize],
    /// Slots with a context.
    occupied: u64,
    /// When each context really wakes, and those for which that is beyond their slot.
    at: [u64; 64],
    far: u64,
}

impl Wheel {
    /// Everybody is awake.
    pub fn new() -> Self {
        Self { slots: [0; SLOTS as usize], occupied: 0, at: [0; 64], far: 0 }
    }

    /// Context `who`, which is awake, sleeps until cycle `at`. It is cycle `now`, and `at` later.
    #[inline]
    pub fn sleep(&mut self, now: u64, at: u64, who: usize) {
        debug_assert!(at > now, "cycle {now}: too late to wake in cycle {at}");
        let mut slot = at;
        if at - now >= SLOTS {
            slot = now + SLOTS - 1;
            self.far |= 1 << who;
        }
        self.at[who] = at;
        self.slots[(slot % SLOTS) as usize] |= 1 << who;
        self.occupied |= 1 << (slot % SLOTS);
    }

    /// The contexts that wake in cycle `now`; cycles before are over.
    #[inline]
    pub fn wake(&mut self, now: u64) -> u64 {
        let mut awake = std::mem::take(&mut self.slots[(now % SLOTS) as usize]);
        self.occupied &= !(1 << (now % SLOTS));
        let far = awake & self.far;
        self.far &= !far;
        for who in bits(far) {
            if self.at[who] > now {
                awake &= !(1 << who);
                self.sleep(now, self.at[who], who);
            }
        }
        awake
    }

    /// The next cycle, `now` or later, in which [`wake`](Self::wake) has something to do.
    #[inline]
    pub fn next(&self, now: u64) -> Option<u64> {
        let ahead = self.occupied.rotate_right((now % SLOTS) as u32); // below 64
        (ahead != 0).then(|| now + u64::from(ahead.trailing_zeros()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn contexts_wake_in_their_cycle_near_and_far() {
        let mut wheel = Wheel::new();
        let times = [101, 163, 164, 165, 290, 1000, 101];
        times.iter().enumerate().for_each(|(who, &at)| wheel.sleep(100, at, who));
        let mut woken = [0; 7];
        let mut now = 101;
        while let Some(next) = wheel.next(now) {
            bits(wheel.wake(next)).for_each(|who| woken[who] = next);
            now = next + 1;
        }
        assert_eq!(woken, times);
    }
}
