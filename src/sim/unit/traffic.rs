//! What surrounds a unit, as functions of a seed and of the number of a request or cycle alone, so that a model and its RTL meet the same.

use crate::num::random::mix_two;

/// Cycles from the one in which memory takes a request to the one in which it has the answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Latency {
    /// Always the same; at least 1.
    Fixed(u32),
    /// From `min` to `max` by request, `min` at least 1: answers overtake each other.
    Random {
        /// Least.
        min: u32,
        /// Most.
        max: u32,
        /// Seed.
        seed: u64,
    },
}

impl Latency {
    /// Latency of request number `index`.
    pub fn of(&self, index: u64) -> u64 {
        match *self {
            Self::Fixed(cycles) => u64::from(cycles.max(1)),
            Self::Random { min, max, seed } => {
                let (min, max) = (u64::from(min.max(1)), u64::from(max));
                min + mix_two(seed, index) % (max.max(min) - min + 1)
            }
        }
    }

    /// The longest.
    pub fn longest(&self) -> u64 {
        match *self {
            Self::Fixed(cycles) => u64::from(cycles.max(1)),
            Self::Random { min, max, .. } => u64::from(max.max(min).max(1)),
        }
    }
}

/// In which cycles a port does nothing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Stall {
    /// In none.
    #[default]
    Never,
    /// In `eighths` of eight stretches of `stretch` cycles each, on average.
    Random {
        /// 0 to 7.
        eighths: u8,
        /// Cycles of a stretch, at least 1.
        stretch: u32,
        /// Seed.
        seed: u64,
    },
}

impl Stall {
    /// Whether it does nothing in this cycle.
    pub fn at(&self, cycle: u64) -> bool {
        match *self {
            Self::Never => false,
            Self::Random { eighths, stretch, seed } => mix_two(seed, cycle / u64::from(stretch.max(1))) % 8 < u64::from(eighths.min(7)),
        }
    }
}

/// Everything that surrounds a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Traffic {
    /// Memory.
    pub latency: Latency,
    /// Cycles in which memory takes no request.
    pub memory_stall: Stall,
    /// Cycles in which nobody takes a hit.
    pub hit_stall: Stall,
    /// Cycles in which no new ray comes.
    pub ray_gap: Stall,
}

impl Traffic {
    /// Nothing waits but for the memory.
    pub fn smooth(latency: Latency) -> Self {
        Self { latency, memory_stall: Stall::Never, hit_stall: Stall::Never, ray_gap: Stall::Never }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn latencies_cover_their_range_and_stalls_their_share() {
        let latency = Latency::Random { min: 3, max: 9, seed: 5 };
        let mut seen = [0; 10];
        (0..700).for_each(|index| seen[latency.of(index) as usize] += 1);
        assert!(seen[..3] == [0; 3] && seen[3..].iter().all(|&n| n > 50), "{seen:?}");
        assert_eq!([Latency::Fixed(0), Latency::Fixed(7)].map(|l| l.of(3)), [1, 7]);
        let stall = Stall::Random { eighths: 2, stretch: 4, seed: 1 };
        let stalled = (0..32_000).filter(|&cycle| stall.at(cycle)).count();
        assert!((7_000..9_000).contains(&stalled), "{stalled}");
        assert!((0..100).all(|stretch| (1..4).all(|k| stall.at(4 * stretch) == stall.at(4 * stretch + k))));
    }
}
