//! The controller anew, clock by clock and by searching the whole past: its commands must be the model's, none earlier, none later, none in
//! another order.

use super::checker::CommandKind::{self, Act, Pre, Rd, Ref, Wr};
use super::checker::{Event, Rule, banks_per_rank, events, rules};
use super::{Random, Wish, made, odd_device, streams};
use crate::sim::dram::mapping::{Mapping, STREAM_MAPPING};
use crate::sim::dram::trace::{Command, Given};
use crate::sim::dram::{Controller, Device, DramConfig, Scheduler};

#[derive(Clone, Copy)]
struct Waiting {
    age: usize,
    bank: usize,
    row: u32,
}

/// A command that may be given: its priority, and the age of its request.
struct Choice {
    priority: u32,
    age: usize,
    given: Given,
    kind: CommandKind,
    bank: usize,
}

fn access(write: bool, bank: usize, row: u32) -> Given {
    if write { Given::Write { bank, row } } else { Given::Read { bank, row } }
}

struct Reference<'a> {
    device: &'a Device,
    controller: &'a Controller,
    rules: Vec<Rule>,
    trace: Vec<Command>,
    past: Vec<Event>,
    /// Reads and writes, oldest first.
    queues: [Vec<Waiting>; 2],
    writing: bool,
    rows: Vec<Option<u32>>,
    /// The age of the request for which a row was opened, until it is served.
    owed: Vec<Option<usize>>,
    overtaken: Vec<u32>,
    /// Reads and writes of the open row.
    served: Vec<u32>,
    refreshes: Vec<u64>,
}

impl Reference<'_> {
    fn rank(&self, bank: usize) -> usize {
        bank / banks_per_rank(self.device)
    }

    /// Whether a command keeps every rule with respect to all before it.
    fn allowed(&self, clock: u64, kind: CommandKind, bank: usize) -> bool {
        let t = &self.device.timing;
        let pairs = self.past.iter().all(|from| {
            let broken = |&(first, second, scope, least, _): &Rule| {
                (first, second) == (from.kind, kind) && scope.joins(self.device, from.bank, bank) && clock - from.clock < least
            };
            !self.rules.iter().any(broken)
        });
        let recent =
            self.past.iter().filter(|e| e.kind == Act && self.rank(e.bank) == self.rank(bank) && clock - e.clock < t.n_faw).count();
        let start = |kind, clock| clock + if kind == Rd { t.n_cl } else { t.n_cwl };
        let clear = |e: &Event| {
            let gap = if self.rank(e.bank) == self.rank(bank) { 0 } else { t.n_rtrs };
            !matches!(e.kind, Rd | Wr) || start(kind, clock) >= start(e.kind, e.clock) + t.n_bl + gap
        };
        pairs && (kind != Act || recent < 4) && (!matches!(kind, Rd | Wr) || self.past.iter().all(clear))
    }

    fn choose_kind(&mut self) {
        let [reads, writes] = [self.queues[0].len(), self.queues[1].len()];
        let enough = if self.writing { self.controller.write_low + 1 } else { self.controller.write_high };
        self.writing = writes > 0 && (reads == 0 || writes >= usize::from(enough));
    }

    fn arrive(&mut self, waiting: Waiting, write: bool) {
        self.queues[usize::from(write)].push(waiting);
        self.choose_kind();
    }

    /// The read or write that a bank owes, if it does.
    fn owed(&self, bank: usize) -> Option<Choice> {
        let age = self.owed[bank]?;
        let write = self.queues[1].iter().any(|w| w.age == age);
        Some(Choice { priority: 1, age, given: access(write, bank, self.rows[bank]?), kind: if write { Wr } else { Rd }, bank })
    }

    /// What may be given towards a bank's requests, by the scheduler.
    fn next_of(&self, bank: usize) -> Vec<Choice> {
        if let Some(owed) = self.owed(bank) {
            return vec![owed];
        }
        let served = &self.queues[usize::from(self.writing)];
        let Some(oldest) = served.iter().find(|w| w.bank == bank) else { return Vec::new() };
        let choice = |priority, age, given, kind| Choice { priority, age, given, kind, bank };
        let by_age = matches!(self.controller.scheduler, Scheduler::OldestReady | Scheduler::OldestReadyCapped);
        let row_priority = if by_age { 2 } else { 3 };
        let Some(open) = self.rows[bank] else {
            return vec![choice(row_priority, oldest.age, Given::Activate { bank, row: oldest.row }, Act)];
        };
        let close = choice(row_priority, oldest.age, Given::Precharge { bank }, Pre);
        let Some(hit) = served.iter().find(|w| w.bank == bank && w.row == open) else { return vec![close] };
        let column = choice(2, hit.age, access(self.writing, bank, open), if self.writing { Wr } else { Rd });
        let is_oldest = hit.age == oldest.age;
        let cap = self.controller.hit_cap;
        match self.controller.scheduler {
            Scheduler::HitsCapped => vec![if is_oldest || self.overtaken[bank] < cap { column } else { close }],
            Scheduler::Hits => vec![column],
            Scheduler::OldestReady | Scheduler::OldestReadyCapped => {
                let capped = self.controller.scheduler == Scheduler::OldestReadyCapped && self.served[bank] > cap;
                // Of all that are owed nothing.
                let first = served.iter().filter(|w| !self.owed.contains(&Some(w.age))).map(|w| w.age).min();
                let column = (!capped || first == Some(hit.age)).then_some(Choice { priority: if capped { 4 } else { 2 }, ..column });
                column.into_iter().chain((!is_oldest).then_some(close)).collect()
            }
        }
    }

    /// The command of a clock, if any is allowed.
    fn choose(&self, clock: u64) -> Option<(Given, usize)> {
        let mut choices = Vec::new();
        for rank in 0..self.refreshes.len() {
            let banks = rank * banks_per_rank(self.device)..(rank + 1) * banks_per_rank(self.device);
            let open: Vec<_> = banks.clone().filter(|&bank| self.rows[bank].is_some()).collect();
            let owed: Vec<_> = banks.clone().filter_map(|bank| self.owed(bank)).collect();
            let steps: Vec<Choice> = if clock < (self.refreshes[rank] + 1) * self.device.timing.n_refi {
                banks.clone().flat_map(|bank| self.next_of(bank)).collect()
            } else if !owed.is_empty() {
                owed
            } else {
                let (given, kind, whose) = if open.is_empty() {
                    (Given::Refresh { rank }, Ref, banks.clone().collect())
                } else {
                    (Given::PrechargeAll { rank }, Pre, open)
                };
                let ready = whose.iter().all(|&bank| self.allowed(clock, kind, bank));
                choices.extend(ready.then_some((0, rank, given)));
                Vec::new()
            };
            let steps = steps.into_iter().filter(|step| self.allowed(clock, step.kind, step.bank));
            choices.extend(steps.map(|step| (step.priority, step.age, step.given)));
        }
        choices.into_iter().min_by_key(|choice| (choice.0, choice.1)).map(|choice| (choice.2, choice.1))
    }

    fn tick(&mut self, clock: u64) {
        let Some((given, age)) = self.choose(clock) else { return };
        match given {
            Given::Activate { bank, row } => {
                self.rows[bank] = Some(row);
                (self.overtaken[bank], self.served[bank], self.owed[bank]) = (0, 0, Some(age));
            }
            Given::Precharge { bank } => self.rows[bank] = None,
            Given::PrechargeAll { rank } => {
                let banks = banks_per_rank(self.device);
                self.rows[rank * banks..(rank + 1) * banks].fill(None);
            }
            Given::Refresh { rank } => self.refreshes[rank] += 1,
            Given::Read { bank, .. } | Given::Write { bank, .. } => {
                let queue = &mut self.queues[usize::from(matches!(given, Given::Write { .. }))];
                self.served[bank] += 1;
                self.owed[bank] = self.owed[bank].filter(|owed| *owed != age);
                if queue.iter().any(|w| w.bank == bank && w.age < age) {
                    self.overtaken[bank] += 1;
                }
                queue.retain(|w| w.age != age);
                self.choose_kind();
            }
        }
        let command = Command { clock, given };
        self.trace.push(command);
        let furthest = self.device.timing.n_rfc.max(self.device.timing.n_rc);
        self.past.retain(|event| event.clock + furthest > clock);
        self.past.extend(events(self.device, &[command]));
    }
}

/// The commands for requests that come at whole clocks, until none waits.
fn reference(device: &Device, controller: &Controller, wishes: &[Wish]) -> Vec<Command> {
    let mapping = Mapping::new(STREAM_MAPPING, 1, &device.organisation).unwrap();
    let banks = device.banks() as usize;
    let mut reference = Reference {
        device,
        controller,
        rules: rules(device),
        trace: Vec::new(),
        past: Vec::new(),
        queues: [Vec::new(), Vec::new()],
        writing: false,
        rows: vec![None; banks],
        owed: vec![None; banks],
        overtaken: vec![0; banks],
        served: vec![0; banks],
        refreshes: vec![0; device.organisation.ranks as usize],
    };
    let mut wishes = wishes.iter().enumerate().peekable();
    let mut clock = 0;
    while wishes.peek().is_some() || reference.queues.iter().any(|queue| !queue.is_empty()) {
        while let Some((age, &(_, line, write))) = wishes.next_if(|(_, wish)| wish.0 == clock * device.clock_ps) {
            let place = mapping.place(line);
            let organisation = &device.organisation;
            let bank = (place.rank * organisation.bank_groups + place.group) * organisation.banks_per_group + place.bank;
            reference.arrive(Waiting { age, bank: bank as usize, row: place.row }, write);
        }
        reference.tick(clock);
        clock += 1;
    }
    reference.trace
}

#[test]
fn commands_are_those_of_a_search_clock_by_clock() {
    let mut device = odd_device();
    device.timing.n_refi = 700;
    let mut compared = 0;
    for ranks in [1, 2] {
        device.organisation.ranks = ranks;
        for seed in 0..12 {
            let mut random = Random::new(seed);
            let (gap, writes, runs) = (random.below(16), random.below(3), random.below(4));
            // The queues hold all: no request waits outside.
            let hit_cap = random.below(5) as u32;
            let scheduler =
                [Scheduler::HitsCapped, Scheduler::Hits, Scheduler::OldestReady, Scheduler::OldestReadyCapped][seed as usize % 4];
            let all = Controller { read_queue: 400, write_queue: 400, ..Controller::default() };
            let controller = Controller { write_high: 9, write_low: 3, scheduler, hit_cap, ..all };
            let (mut clock, mut line) = (0, 0);
            let mut wish = || {
                clock += random.below(2 * gap + 1);
                line = if random.below(4) < runs { line + 1 } else { random.below(1 << 11) };
                (clock * device.clock_ps, line, random.below(4) < writes)
            };
            let wishes: Vec<Wish> = (0..400).map(|_| wish()).collect();
            let mut dram = made(&DramConfig { controller: controller.clone(), ..streams(device.clone(), 1) });
            for (id, &(time, line, write)) in wishes.iter().enumerate() {
                dram.advance(time.saturating_sub(1), &mut |_, _| {}); // the command of this very clock knows the request
                dram.push(time, line, id as u64, write);
            }
            while let Some(next) = dram.next_event() {
                dram.advance(next, &mut |_, _| {});
            }
            let expected = reference(&device, &controller, &wishes);
            for (command, expected) in dram.trace(0).iter().zip(&expected) {
                assert_eq!(command, expected, "{ranks} ranks, seed {seed}");
                compared += 1;
            }
            assert_eq!(dram.trace(0).len(), expected.len(), "{ranks} ranks, seed {seed}");
        }
    }
    assert!(compared > 12000, "{compared}");
}
