//! Which lines a level of cache holds: sets of lines, the most recently used first.

use super::prefetch::prefetch;
use crate::machine::{Cache, Index};

/// No line.
const EMPTY: u32 = u32::MAX;

/// The tags of all banks of a level. Lines go round the banks, then round the sets of a bank; where the index is hashed, the bits above are folded into both.
#[derive(Clone, Debug)]
pub struct Tags {
    /// Lines of set after set.
    lines: Vec<u32>,
    ways: usize,
    set_bits: u32,
    bank_bits: u32,
    hashed: bool,
}

impl Tags {
    /// Empty; `copies` of the cache (one for each group that has its own).
    pub fn new(cache: &Cache, copies: u32) -> Self {
        let lines = vec![EMPTY; cache.lines() as usize * copies as usize];
        // Banks and sets are powers of two: machine descriptions are checked.
        Self {
            lines,
            ways: cache.ways as usize,
            set_bits: cache.sets_per_bank().trailing_zeros(),
            bank_bits: cache.banks.trailing_zeros(),
            hashed: cache.index == Index::Xor,
        }
    }

    /// The set of a line among those of all banks of one copy: the bank in its lowest bits.
    #[inline(always)]
    pub fn set_of_all(&self, line: u32) -> u32 {
        let bits = self.bank_bits + self.set_bits;
        let index = if self.hashed { fold(line, bits) } else { line };
        index & ((1 << bits) - 1) // caches have fewer than 2^31 sets
    }

    /// The bank of a line, among those of one copy.
    #[inline]
    pub fn bank(&self, line: u32) -> u32 {
        self.set_of_all(line) & ((1 << self.bank_bits) - 1)
    }

    /// Where the set of `line` begins.
    #[inline(always)]
    fn from(&self, bank: u32, line: u32) -> usize {
        let set = self.set_of_all(line) >> self.bank_bits;
        (((bank as usize) << self.set_bits) + set as usize) * self.ways
    }

    #[inline]
    fn set(&mut self, bank: u32, line: u32) -> &mut [u32] {
        let from = self.from(bank, line);
        &mut self.lines[from..from + self.ways]
    }

    /// `line` is looked up soon.
    #[inline(always)]
    pub fn prefetch(&self, bank: u32, line: u32) {
        prefetch(&self.lines, self.from(bank, line));
    }

    /// Holds nothing any more.
    pub fn clear(&mut self) {
        self.lines.fill(EMPTY);
    }

    /// Whether `bank`, counted through all copies, holds `line`, which becomes its set's most recently used.
    #[inline]
    pub fn look_up(&mut self, bank: u32, line: u32) -> bool {
        let set = self.set(bank, line);
        // Mostly it is the one used last.
        if set[0] == line {
            return true;
        }
        let Some(way) = set.iter().position(|&held| held == line) else { return false };
        push_front(&mut set[..=way], line);
        true
    }

    /// Writes `line` in place of its set's least recently used, which it gives if there was one.
    #[inline]
    pub fn fill(&mut self, bank: u32, line: u32) -> Option<u32> {
        let set = self.set(bank, line);
        Some(push_front(set, line)).filter(|&gone| gone != EMPTY)
    }
}

/// The exclusive or of the pieces of `bits` bits of a line's number, in its lowest bits.
#[inline]
fn fold(line: u32, bits: u32) -> u32 {
    let mut folded = 0;
    let mut rest = line;
    while rest != 0 && bits != 0 {
        folded ^= rest;
        rest = rest.checked_shr(bits).unwrap_or(0);
    }
    folded
}

/// Puts `line` in front of the others, of which the last goes: that. (Sets are small: a loop beats a copy.)
#[inline(always)]
fn push_front(set: &mut [u32], line: u32) -> u32 {
    let mut moved = line;
    for held in set {
        std::mem::swap(held, &mut moved);
    }
    moved
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::Random;

    fn cache(bytes: u64, ways: u32, banks: u32) -> Cache {
        Cache { bytes, ways, banks, line_bytes: 32, latency_cycles: 1, mshrs: 1, targets: 1, queue: 1, index: Index::Sliced }
    }

    #[test]
    fn the_least_recently_used_line_of_a_set_goes() {
        let mut tags = Tags::new(&cache(4 * 32, 2, 2), 2);
        // Two banks of one set of two ways: even lines in bank 0 of a copy.
        assert_eq!((tags.bank(6), tags.bank(7)), (0, 1));
        for line in [0, 2] {
            assert!(!tags.look_up(2, line));
            tags.fill(2, line);
        }
        assert!(tags.look_up(2, 0));
        tags.fill(2, 4);
        assert!(tags.look_up(2, 0) && !tags.look_up(2, 2) && tags.look_up(2, 4));
        assert!(!tags.look_up(0, 0), "copies do not share");
    }

    #[test]
    fn a_hashed_index_spreads_lines_that_a_power_of_two_parts() {
        let geometry = cache(32 * 32 * 2, 2, 4);
        let sliced = Tags::new(&geometry, 1);
        let hashed = Tags::new(&Cache { index: Index::Xor, ..geometry }, 1);
        let sets =
            |tags: &Tags, lines: &[u32]| lines.iter().map(|&line| tags.set_of_all(line)).collect::<std::collections::HashSet<_>>().len();
        // 32 sets, banks and all.
        let strided: Vec<u32> = (0..32).map(|line| line << 5).collect();
        assert_eq!((sets(&sliced, &strided), sets(&hashed, &strided)), (1, 32));
        // Neighbours stay apart, wherever they begin.
        for from in [0u32, 1 << 5, 0b1_1010_0110 << 5] {
            let neighbours: Vec<u32> = (from..from + 32).collect();
            assert_eq!(sets(&hashed, &neighbours), 32);
        }
        // By hand: 10_10110 and 1 above it are 10110 ^ 00010, in bank 0 and set 5 of it.
        assert_eq!((hashed.set_of_all(0b10_10110), hashed.bank(0b10_10110)), (0b10100, 0));
    }

    #[test]
    fn a_fully_associative_cache_hits_where_the_reuse_distance_is_below_its_lines() {
        let lines = 64;
        let mut tags = Tags::new(&cache(lines * 32, lines as u32, 1), 1);
        let mut random = Random::new(1);
        let mut history: Vec<u32> = Vec::new();
        let mut hits = [0; 2];
        for _ in 0..20_000 {
            let line = if random.below(4) == 0 { random.below(200) } else { random.below(40) } as u32;
            // Distinct lines since the last use: counted from the history, not by a stack.
            let since = history.iter().rev().take_while(|&&past| past != line).collect::<std::collections::HashSet<_>>().len();
            let seen = history.contains(&line);
            hits[0] += usize::from(seen && (since as u64) < lines);
            let hit = tags.look_up(0, line);
            hits[1] += usize::from(hit);
            if !hit {
                tags.fill(0, line);
            }
            history.push(line);
            history.drain(..history.len().saturating_sub(4000));
        }
        assert_eq!(hits[0], hits[1]);
        assert!(hits[0] > 1000, "{hits:?}");
    }
}
