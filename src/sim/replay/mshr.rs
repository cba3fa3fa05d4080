//! The misses under way of a bank, and who waits for each.

use crate::sim::dram::Standing;
use crate::step::SectionId;

/// No waiter.
const NONE: u32 = u32::MAX;

/// The line of a register that nobody joins: it is free, or its line was written.
const CLOSED: u32 = u32::MAX;

/// A miss under way.
#[derive(Clone, Copy, Debug)]
struct Miss {
    line: u32,
    section: SectionId,
    /// First and last waiter; of a free register, the next free one of its bank is `first`.
    first: u32,
    last: u32,
    waiting: u32,
    /// It is a store: nobody joins it.
    stores: bool,
    /// The cycle in which it was entered.
    since: u64,
}

/// Who waits for a line, since when, and what it waited for in front of the bank.
#[derive(Clone, Copy, Debug)]
pub struct Waiter {
    /// Who.
    pub waiter: u32,
    /// Before the bank's full queue, in it for its turn, and while the bank stood still.
    pub before: [u32; 3],
    /// The cycle in which the line was missed.
    pub since: u64,
}

/// A link of a list of waiters.
#[derive(Clone, Copy, Debug)]
struct Link {
    waiter: Waiter,
    next: u32,
}

/// What became of a miss.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Entered {
    /// The first miss of its line: register `slot` of the bank keeps it.
    New {
        /// Which.
        slot: u32,
    },
    /// The line is asked for already.
    Merged,
    /// No register is free, or the line's has no room.
    Full,
}

/// The miss registers of all banks of a level.
#[derive(Clone, Debug)]
pub struct Mshrs {
    misses: Vec<Miss>,
    /// The lines that a miss may join, by register: apart from all else, for every miss is compared with a bank's.
    open: Vec<u32>,
    /// By bank, the first free register.
    free: Vec<u32>,
    per_bank: usize,
    targets: u32,
    links: Vec<Link>,
    /// Links in use no more.
    spare: u32,
    /// Registers in use, by bank, and the most of any.
    in_use: Vec<u32>,
    pub most: u32,
    /// Of all banks.
    pub standing: Standing,
}

impl Mshrs {
    /// `per_bank` registers in each of `banks`, with room for `targets` waiters.
    pub fn new(banks: u32, per_bank: u32, targets: u32) -> Self {
        let count = banks as usize * per_bank as usize;
        let miss = |register: u32| {
            let next = if (register + 1).is_multiple_of(per_bank) { NONE } else { register + 1 };
            Miss { line: CLOSED, section: SectionId::default(), first: next, last: NONE, waiting: 0, stores: false, since: 0 }
        };
        Self {
            misses: (0..count as u32).map(miss).collect(),
            open: vec![CLOSED; count],
            free: (0..banks).map(|bank| bank * per_bank).collect(),
            per_bank: per_bank as usize,
            targets,
            links: Vec::new(),
            spare: NONE,
            in_use: vec![0; banks as usize],
            most: 0,
            standing: Standing::default(),
        }
    }

    /// `waiter` of `bank` misses `line` of `section`.
    #[inline]
    pub fn enter(&mut self, bank: u32, line: u32, section: SectionId, waiter: Waiter) -> Entered {
        let from = bank as usize * self.per_bank;
        if self.in_use[bank as usize] > 0
            && let Some(slot) = position(&self.open[from..from + self.per_bank], line)
        {
            if self.misses[from + slot].waiting == self.targets {
                return Entered::Full;
            }
            let link = self.link(waiter);
            let miss = &mut self.misses[from + slot];
            self.links[miss.last as usize].next = link;
            miss.last = link;
            miss.waiting += 1;
            return Entered::Merged;
        }
        let entered =
            self.enter_alone(bank, Miss { line, section, first: NONE, last: NONE, waiting: 1, stores: false, since: waiter.since }, waiter);
        if let Entered::New { slot } = entered {
            self.open[from + slot as usize] = line;
        }
        entered
    }

    /// `waiter` of `bank` writes `line` of `section`: a register that nobody joins.
    #[inline]
    pub fn enter_store(&mut self, bank: u32, line: u32, section: SectionId, waiter: Waiter) -> Entered {
        self.enter_alone(bank, Miss { line, section, first: NONE, last: NONE, waiting: 1, stores: true, since: waiter.since }, waiter)
    }

    /// Whether `line` is asked for and may be joined.
    pub fn is_open(&self, bank: u32, line: u32) -> bool {
        let from = bank as usize * self.per_bank;
        self.in_use[bank as usize] > 0 && position(&self.open[from..from + self.per_bank], line).is_some()
    }

    /// The next free register of `bank`, for a miss of `waiter`'s.
    #[inline]
    fn enter_alone(&mut self, bank: u32, miss: Miss, waiter: Waiter) -> Entered {
        let register = self.free[bank as usize];
        if register == NONE {
            return Entered::Full;
        }
        let link = self.link(waiter);
        let state = &mut self.misses[register as usize];
        self.free[bank as usize] = state.first;
        *state = Miss { first: link, last: link, ..miss };
        let in_use = &mut self.in_use[bank as usize];
        *in_use += 1;
        self.most = self.most.max(*in_use);
        self.standing.comes(waiter.since);
        Entered::New { slot: register - bank * self.per_bank as u32 }
    }

    fn link(&mut self, waiter: Waiter) -> u32 {
        let link = Link { waiter, next: NONE };
        if self.spare == NONE {
            self.links.push(link);
            return self.links.len() as u32 - 1;
        }
        let at = self.spare;
        self.spare = std::mem::replace(&mut self.links[at as usize], link).next;
        at
    }

    /// The line of register `register`, counted through all banks.
    pub fn line(&self, register: u32) -> u32 {
        self.misses[register as usize].line
    }

    /// Whether `register` is a store's.
    pub fn stores(&self, register: u32) -> bool {
        self.misses[register as usize].stores
    }

    /// What that line holds.
    pub fn section(&self, register: u32) -> SectionId {
        self.misses[register as usize].section
    }

    /// The line of `register` was written: gives its waiters to `answer`, first come first. The register stays in use until [`Mshrs::free`], but nobody joins it.
    pub fn land(&mut self, register: u32, mut answer: impl FnMut(Waiter)) {
        let miss = &mut self.misses[register as usize];
        let (mut at, last) = (miss.first, miss.last);
        self.open[register as usize] = CLOSED;
        self.links[last as usize].next = self.spare;
        self.spare = at;
        while at != NONE {
            let link = self.links[at as usize];
            answer(link.waiter);
            at = if at == last { NONE } else { link.next };
        }
    }

    /// Frees a register whose line was written. Since when it was in use.
    pub fn free(&mut self, register: u32) -> u64 {
        let bank = register as usize / self.per_bank;
        self.in_use[bank] -= 1;
        let miss = &mut self.misses[register as usize];
        miss.first = std::mem::replace(&mut self.free[bank], register);
        self.standing.goes(miss.since);
        miss.since
    }

    /// Registers of `bank` in use.
    pub fn in_use_of(&self, bank: u32) -> usize {
        self.in_use[bank as usize] as usize
    }
}

/// Where `line` is among `lines`. (Eight at a time: the compiler compares them at once.)
#[inline]
fn position(lines: &[u32], line: u32) -> Option<usize> {
    let (eights, rest) = lines.as_chunks::<8>();
    let found = |eight: &[u32; 8]| eight.iter().enumerate().fold(0u32, |bits, (k, &held)| bits | u32::from(held == line) << k);
    for (at, eight) in eights.iter().enumerate() {
        let bits = found(eight);
        if bits != 0 {
            return Some(8 * at + bits.trailing_zeros() as usize);
        }
    }
    rest.iter().position(|&held| held == line).map(|at| 8 * eights.len() + at)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn enter(mshrs: &mut Mshrs, bank: u32, line: u32, waiter: u32) -> Entered {
        mshrs.enter(bank, line, SectionId::new(line as usize % 8), Waiter { waiter, before: [0; 3], since: 7 })
    }

    #[test]
    fn misses_merge_up_to_the_targets_and_are_answered_in_order() {
        let mut mshrs = Mshrs::new(2, 2, 3);
        assert_eq!(enter(&mut mshrs, 1, 9, 10), Entered::New { slot: 0 });
        assert_eq!(enter(&mut mshrs, 1, 8, 20), Entered::New { slot: 1 });
        assert_eq!(enter(&mut mshrs, 1, 9, 11), Entered::Merged);
        assert_eq!(enter(&mut mshrs, 1, 9, 12), Entered::Merged);
        assert_eq!(enter(&mut mshrs, 1, 9, 13), Entered::Full, "no target");
        assert_eq!(enter(&mut mshrs, 1, 7, 30), Entered::Full, "no register");
        assert_eq!(enter(&mut mshrs, 0, 9, 40), Entered::New { slot: 0 }, "banks do not share");
        let mut answered = Vec::new();
        mshrs.land(2, |waiter| answered.push(waiter.waiter));
        assert_eq!(enter(&mut mshrs, 1, 9, 13), Entered::Full, "nobody joins a line that was written, and its register is not free yet");
        assert_eq!(mshrs.free(2), 7);
        assert_eq!((answered, mshrs.in_use_of(0), mshrs.in_use_of(1)), (vec![10, 11, 12], 1, 1));
        assert_eq!(enter(&mut mshrs, 1, 7, 30), Entered::New { slot: 0 });
        assert_eq!((mshrs.line(2), mshrs.section(2)), (7, SectionId::new(7)));
        let links = mshrs.links.len();
        for round in 0..100 {
            assert_eq!(enter(&mut mshrs, 1, 7, round), Entered::Merged);
            mshrs.land(2, |_| ());
            mshrs.free(2);
            assert_eq!(enter(&mut mshrs, 1, 7, round), Entered::New { slot: 0 });
        }
        assert_eq!(mshrs.links.len(), links, "links are used again");
    }
}
