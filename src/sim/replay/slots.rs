//! A port that passes so many items a cycle: who comes when it is full goes in the next cycle with room.

/// A port's next place.
#[derive(Clone, Copy, Debug, Default)]
pub struct Slots {
    cycle: u64,
    used: u32,
}

impl Slots {
    /// The cycle, `at` or later, in which one more item passes; `per_cycle` do.
    #[inline]
    pub fn take(&mut self, at: u64, per_cycle: u32) -> u64 {
        if at > self.cycle {
            *self = Self { cycle: at, used: 1 };
        } else if self.used < per_cycle {
            self.used += 1;
        } else {
            *self = Self { cycle: self.cycle + 1, used: 1 };
        }
        self.cycle
    }

    /// Whether no item passes any more in cycle `at`.
    pub fn is_full(&self, at: u64, per_cycle: u32) -> bool {
        self.cycle > at || (self.cycle == at && self.used >= per_cycle)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn items_pass_in_order_so_many_a_cycle() {
        let mut port = Slots::default();
        let at = [3, 3, 3, 4, 4, 9].map(|at| port.take(at, 2));
        assert_eq!(at, [3, 3, 4, 4, 5, 9]);
    }
}
