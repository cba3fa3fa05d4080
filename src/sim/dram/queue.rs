//! The requests that wait in a channel: one list per bank for reads and one for writes, oldest first, in slots of fixed number.

use super::standing::Standing;

/// No slot.
pub(super) const NONE: u16 = u16::MAX;

/// Reads.
pub(super) const READ: usize = 0;
/// Writes.
pub(super) const WRITE: usize = 1;

/// What had to be done for a request before its row was open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Opened {
    Already,
    Activated,
    ClosedFirst,
}

/// A request that waits.
#[derive(Clone, Copy, Debug)]
pub(super) struct DramRequest {
    pub id: u64,
    /// First clock in which a command for it may be given.
    pub arrival: u64,
    /// Number of the request in the order of arrival in its channel.
    pub age: u64,
    pub row: u32,
    pub opened: Opened,
    /// When another row was closed for it, from when its bank would have let its row be opened, and when it was; 0 if not.
    pub closed: u64,
    pub ready: u64,
    pub activated: u64,
    before: u16,
    after: u16,
}

/// A bank's list.
#[derive(Clone, Copy, Debug)]
pub(super) struct List {
    /// The oldest, or [`NONE`].
    pub head: u16,
    tail: u16,
}

/// The slots and lists of one kind, reads or writes.
#[derive(Clone, Debug)]
pub(super) struct Queue {
    slots: Vec<DramRequest>,
    free: Vec<u16>,
    lists: Vec<List>,
    /// Banks with a request, one bit each.
    pub banks: u64,
    /// Since their arrivals.
    pub standing: Standing,
}

impl Queue {
    /// Room for `depth` requests (less than 2^16 - 1) to `banks` banks (at most 64).
    pub fn new(depth: u16, banks: u32) -> Self {
        let empty = DramRequest {
            id: 0,
            arrival: 0,
            age: 0,
            row: 0,
            opened: Opened::Already,
            closed: 0,
            ready: 0,
            activated: 0,
            before: NONE,
            after: NONE,
        };
        Self {
            slots: vec![empty; usize::from(depth)],
            free: (0..depth).rev().collect(),
            lists: vec![List { head: NONE, tail: NONE }; banks as usize],
            banks: 0,
            standing: Standing::default(),
        }
    }

    /// How many wait.
    pub fn len(&self) -> usize {
        self.slots.len() - self.free.len()
    }

    /// Whether no more fit.
    pub fn is_full(&self) -> bool {
        self.free.is_empty()
    }

    /// The request in a slot.
    pub fn get(&self, slot: u16) -> &DramRequest {
        &self.slots[usize::from(slot)]
    }

    /// The request in a slot.
    pub fn get_mut(&mut self, slot: u16) -> &mut DramRequest {
        &mut self.slots[usize::from(slot)]
    }

    /// The oldest of a bank, or [`NONE`].
    pub fn head(&self, bank: usize) -> u16 {
        self.lists[bank].head
    }

    /// The one behind the oldest of a bank, which there is, or [`NONE`].
    pub fn second(&self, bank: usize) -> u16 {
        self.get(self.head(bank)).after
    }

    /// Appends to a bank's list; returns the slot.
    ///
    /// # Panics
    /// The queue is full.
    pub fn push(&mut self, bank: usize, id: u64, arrival: u64, age: u64, row: u32) -> u16 {
        let slot = self.free.pop().expect("a request was pushed to a full DRAM queue");
        let list = &mut self.lists[bank];
        let (before, opened) = (list.tail, Opened::Already);
        self.slots[usize::from(slot)] =
            DramRequest { id, arrival, age, row, opened, closed: 0, ready: 0, activated: 0, before, after: NONE };
        match list.tail {
            NONE => list.head = slot,
            tail => self.slots[usize::from(tail)].after = slot,
        }
        list.tail = slot;
        self.banks |= 1 << bank;
        self.standing.comes(arrival);
        slot
    }

    /// Takes a request out of a bank's list.
    pub fn remove(&mut self, bank: usize, slot: u16) -> DramRequest {
        let request = self.slots[usize::from(slot)];
        let list = &mut self.lists[bank];
        match request.before {
            NONE => list.head = request.after,
            before => self.slots[usize::from(before)].after = request.after,
        }
        match request.after {
            NONE => list.tail = request.before,
            after => self.slots[usize::from(after)].before = request.before,
        }
        if list.head == NONE {
            self.banks &= !(1 << bank);
        }
        self.free.push(slot);
        self.standing.goes(request.arrival);
        request
    }

    /// The first request to `row` from `slot` on along its list, or [`NONE`].
    pub fn first_to_row(&self, mut slot: u16, row: u32) -> u16 {
        while slot != NONE && self.get(slot).row != row {
            slot = self.get(slot).after;
        }
        slot
    }

    /// The slot behind a request that was taken out, if nothing changed since.
    pub fn after(request: &DramRequest) -> u16 {
        request.after
    }
}
