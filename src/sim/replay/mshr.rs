//! The misses under way of a bank, and who waits for each.

use crate::step::SectionId;

/// No waiter.
const NONE: u32 = u32::MAX;

/// A miss under way.
#[derive(Clone, Copy, Debug)]
struct Miss {
    line: u32,
    section: SectionId,
    /// First and last waiter; [`NONE`] if the register is free.
    first: u32,
    last: u32,
    waiting: u32,
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
    per_bank: usize,
    targets: u32,
    links: Vec<Link>,
    /// Links in use no more.
    spare: u32,
    /// Registers in use, by bank, and the most of any.
    in_use: Vec<u32>,
    pub most: u32,
}

impl Mshrs {
    /// `per_bank` registers in each of `banks`, with room for `targets` waiters.
    pub fn new(banks: u32, per_bank: u32, targets: u32) -> Self {
        let misses = vec![
            Miss { line: 0, section: SectionId::default(), first: NONE, last: NONE, waiting: 0, since: 0 };
            banks as usize * per_bank as usize
        ];
        Self { misses, per_bank: per_bank as usize, targets, links: Vec::new(), spare: NONE, in_use: vec![0; banks as usize], most: 0 }
    }

    /// `waiter` of `bank` misses `line` of `section`.
    #[inline]
    pub fn enter(&mut self, bank: u32, line: u32, section: SectionId, waiter: Waiter) -> Entered {
        let from = bank as usize * self.per_bank;
        let misses = &self.misses[from..from + self.per_bank];
        if let Some(slot) = misses.iter().position(|miss| miss.first != NONE && miss.line == line) {
            if misses[slot].waiting == self.targets {
                return Entered::Full;
            }
            let link = self.link(waiter);
            let miss = &mut self.misses[from + slot];
            self.links[miss.last as usize].next = link;
            miss.last = link;
            miss.waiting += 1;
            return Entered::Merged;
        }
        let Some(slot) = misses.iter().position(|miss| miss.first == NONE) else { return Entered::Full };
        let link = self.link(waiter);
        self.misses[from + slot] = Miss { line, section, first: link, last: link, waiting: 1, since: waiter.since };
        let in_use = &mut self.in_use[bank as usize];
        *in_use += 1;
        self.most = self.most.max(*in_use);
        Entered::New { slot: slot as u32 }
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

    /// What that line holds.
    pub fn section(&self, register: u32) -> SectionId {
        self.misses[register as usize].section
    }

    /// The line has come: frees the register and gives its waiters to `answer`, first come first. Since when it was in use.
    pub fn free(&mut self, register: u32, mut answer: impl FnMut(Waiter)) -> u64 {
        self.in_use[register as usize / self.per_bank] -= 1;
        let miss = &mut self.misses[register as usize];
        let (mut at, last, since) = (miss.first, miss.last, miss.since);
        miss.first = NONE;
        self.links[last as usize].next = self.spare;
        self.spare = at;
        while at != NONE {
            let link = self.links[at as usize];
            answer(link.waiter);
            at = if at == last { NONE } else { link.next };
        }
        since
    }

    /// Registers of `bank` in use.
    pub fn in_use_of(&self, bank: u32) -> usize {
        self.in_use[bank as usize] as usize
    }
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
        assert_eq!(mshrs.free(2, |waiter| answered.push(waiter.waiter)), 7);
        assert_eq!((answered, mshrs.in_use_of(0), mshrs.in_use_of(1)), (vec![10, 11, 12], 1, 1));
        assert_eq!(enter(&mut mshrs, 1, 7, 30), Entered::New { slot: 0 });
        assert_eq!((mshrs.line(2), mshrs.section(2)), (7, SectionId::new(7)));
        let links = mshrs.links.len();
        for round in 0..100 {
            assert_eq!(enter(&mut mshrs, 1, 7, round), Entered::Merged);
            mshrs.free(2, |_| ());
            assert_eq!(enter(&mut mshrs, 1, 7, round), Entered::New { slot: 0 });
        }
        assert_eq!(mshrs.links.len(), links, "links are used again");
    }
}
