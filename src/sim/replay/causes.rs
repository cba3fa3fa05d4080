//! Why a cache misses: lines that nobody had read before, too few lines, or too few places for lines that fall on each other.

use serde::{Deserialize, Serialize};

/// Misses of a cache by what would have helped.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MissCauses {
    /// Of lines read for the first time, which no store brought.
    pub cold: u64,
    /// That a fully associative cache of as many lines, the least recently used of which goes, would have too.
    pub capacity: u64,
    /// That it would not have.
    pub conflict: u64,
}

/// A fully associative cache beside a real one.
#[derive(Clone, Debug)]
pub struct Shadow {
    /// Of each line: never seen, gone, or its slot from [`FIRST`] on.
    lines: Vec<u32>,
    /// Slots in a ring in the order of their use; slot 0 is before the first and behind the last.
    slots: Vec<Slot>,
    /// Slots that lines may have.
    room: usize,
    /// Lines read or written, by set.
    sets: Vec<u32>,
    causes: MissCauses,
}

const UNSEEN: u32 = 0;
const GONE: u32 = 1;
/// Slot 1.
const FIRST: u32 = 2;

#[derive(Clone, Copy, Debug, Default)]
struct Slot {
    line: u32,
    before: u32,
    behind: u32,
}

impl Shadow {
    /// Of a cache of so many lines and sets (a power of two).
    pub fn new(lines: u64, sets: u64) -> Self {
        Self {
            lines: Vec::new(),
            slots: vec![Slot::default()],
            room: lines as usize,
            sets: vec![0; sets as usize],
            causes: MissCauses::default(),
        }
    }

    /// The real cache looked up `line`, which belongs to `set`, and asked the next level for it if it `missed`.
    #[inline]
    pub fn look_up(&mut self, line: u32, set: u32, missed: bool) {
        let at = line as usize;
        if at >= self.lines.len() {
            self.lines.resize((at + 1).next_power_of_two(), UNSEEN);
        }
        let known = self.lines[at];
        let cause = match known {
            UNSEEN => &mut self.causes.cold,
            GONE => &mut self.causes.capacity,
            _ => &mut self.causes.conflict,
        };
        *cause += u64::from(missed);
        if known == UNSEEN {
            self.sets[set as usize] += 1;
        }
        let slot = match known {
            UNSEEN | GONE => self.take(line),
            slot => slot - FIRST + 1,
        };
        self.use_now(slot, known >= FIRST);
    }

    /// A slot for a line: a new one, or that of the least recently used line.
    fn take(&mut self, line: u32) -> u32 {
        let slot = if self.slots.len() <= self.room {
            self.slots.push(Slot::default());
            self.slots.len() as u32 - 1 // caches have at most 2^30 lines
        } else {
            let last = self.slots[0].before;
            self.unlink(last);
            self.lines[self.slots[last as usize].line as usize] = GONE;
            last
        };
        self.slots[slot as usize].line = line;
        self.lines[line as usize] = slot - 1 + FIRST;
        slot
    }

    fn unlink(&mut self, slot: u32) {
        let Slot { before, behind, .. } = self.slots[slot as usize];
        self.slots[before as usize].behind = behind;
        self.slots[behind as usize].before = before;
    }

    /// Puts a slot first, which is in the ring already or not.
    #[inline]
    fn use_now(&mut self, slot: u32, linked: bool) {
        let first = self.slots[0].behind;
        if first == slot {
            return;
        }
        if linked {
            self.unlink(slot);
        }
        let first = self.slots[0].behind;
        (self.slots[slot as usize].before, self.slots[slot as usize].behind) = (0, first);
        self.slots[first as usize].before = slot;
        self.slots[0].behind = slot;
    }

    /// What misses were.
    pub fn causes(&self) -> MissCauses {
        self.causes
    }

    /// Different lines read that fall into the busiest set, and into all.
    pub fn busiest_set(&self) -> (u64, u64) {
        (self.sets.iter().max().copied().unwrap_or(0).into(), self.sets.iter().map(|&lines| u64::from(lines)).sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::{Cache, Index};
    use crate::num::Random;
    use crate::sim::replay::tags::Tags;

    #[test]
    fn causes_are_those_by_counting() {
        let (lines, ways) = (64, 2);
        let cache = Cache {
            bytes: lines * 32,
            ways,
            banks: 1,
            line_bytes: 32,
            latency_cycles: 1,
            mshrs: 1,
            targets: 1,
            queue: 1,
            index: Index::Sliced,
        };
        let mut tags = Tags::new(&cache, 1);
        let mut shadow = Shadow::new(lines, lines / u64::from(ways));
        let mut random = Random::new(1);
        let mut history: Vec<u32> = Vec::new();
        let mut counted = MissCauses::default();
        for _ in 0..5_000 {
            let line = if random.below(4) == 0 { random.below(400) } else { random.below(48) } as u32;
            let hit = tags.look_up(0, line);
            if !hit {
                tags.fill(0, line);
                let since = history.iter().rev().take_while(|&&past| past != line).collect::<std::collections::HashSet<_>>().len();
                match (history.contains(&line), (since as u64) < lines) {
                    (false, _) => counted.cold += 1,
                    (true, false) => counted.capacity += 1,
                    (true, true) => counted.conflict += 1,
                }
            }
            shadow.look_up(line, tags.set_of_all(line), !hit);
            history.push(line);
        }
        assert_eq!(shadow.causes(), counted);
        assert!(counted.cold > 100 && counted.capacity > 100 && counted.conflict > 100, "{counted:?}");
        let of_set = |set: u32| history.iter().filter(|&&line| line % 32 == set).collect::<std::collections::HashSet<_>>().len() as u64;
        let sets: Vec<u64> = (0..32).map(of_set).collect();
        assert_eq!(shadow.busiest_set(), (*sets.iter().max().unwrap(), sets.iter().sum()));
    }
}
