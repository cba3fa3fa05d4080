//! JEDEC's rules as a table, checked on every pair of commands of a trace. Shares nothing with the model but the description.

use crate::sim::dram::Device;
use crate::sim::dram::trace::{Command, Given};

/// A command without its operands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CommandKind {
    Act,
    Pre,
    Rd,
    Wr,
    Ref,
}
use CommandKind::{Act, Pre, Rd, Ref, Wr};

/// Between which banks a rule holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scope {
    Bank,
    Group,
    Rank,
}

impl Scope {
    /// Whether two banks are within it.
    pub fn joins(self, device: &Device, from: usize, to: usize) -> bool {
        let banks = match self {
            Scope::Bank => 1,
            Scope::Group => device.organisation.banks_per_group as usize,
            Scope::Rank => banks_per_rank(device),
        };
        from / banks == to / banks
    }
}

/// A command to one bank; a precharge of all and a refresh are one to each bank of the rank.
#[derive(Clone, Copy, Debug)]
pub struct Event {
    pub clock: u64,
    pub kind: CommandKind,
    pub bank: usize,
    pub row: u32,
    /// Place of its command in the trace.
    pub command: usize,
}

/// From, to, scope, least clocks, the keys that make it.
pub type Rule = (CommandKind, CommandKind, Scope, u64, &'static str);

pub fn rules(device: &Device) -> Vec<Rule> {
    let t = &device.timing;
    let written = t.n_cwl + t.n_bl;
    vec![
        (Act, Rd, Scope::Bank, t.n_rcd_rd, "nRCDRD"),
        (Act, Wr, Scope::Bank, t.n_rcd_wr, "nRCDWR"),
        (Act, Pre, Scope::Bank, t.n_ras, "nRAS"),
        (Act, Act, Scope::Bank, t.n_rc, "nRC"),
        (Pre, Act, Scope::Bank, t.n_rp, "nRP"),
        (Rd, Pre, Scope::Bank, t.n_rtp, "nRTP"),
        (Wr, Pre, Scope::Bank, written + t.n_wr, "nWR"),
        (Act, Act, Scope::Group, t.n_rrd_l, "nRRD_L"),
        (Act, Act, Scope::Rank, t.n_rrd_s, "nRRD_S"),
        (Rd, Rd, Scope::Group, t.n_ccd_l, "nCCD_L"),
        (Wr, Wr, Scope::Group, t.n_ccd_l, "nCCD_L of writes"),
        (Rd, Rd, Scope::Rank, t.n_ccd_s, "nCCD_S"),
        (Wr, Wr, Scope::Rank, t.n_ccd_s, "nCCD_S of writes"),
        (Rd, Wr, Scope::Rank, t.n_rtw, "nRTW"),
        (Wr, Rd, Scope::Group, written + t.n_wtr_l, "nWTR_L"),
        (Wr, Rd, Scope::Rank, written + t.n_wtr_s, "nWTR_S"),
        (Pre, Pre, Scope::Rank, t.n_ppd, "nPPD"),
        (Pre, Ref, Scope::Bank, t.n_rp, "nRP before a refresh"),
        (Act, Ref, Scope::Bank, t.n_rc, "nRC before a refresh"),
        (Ref, Act, Scope::Bank, t.n_rfc, "nRFC"),
        (Ref, Ref, Scope::Bank, t.n_rfc, "nRFC between refreshes"),
    ]
}

/// Every breach of a rule, and the names of the rules that some pair meets to the clock.
#[derive(Debug, Default)]
pub struct Findings {
    pub breaches: Vec<String>,
    pub tight: Vec<&'static str>,
}

impl Findings {
    fn distance(&mut self, name: &'static str, clocks: u64, least: u64, place: impl Fn() -> String) {
        if clocks < least {
            self.breaches.push(format!("{name}: {clocks} clocks, not {least}: {}", place()));
        } else if clocks == least && !self.tight.contains(&name) {
            self.tight.push(name);
        }
    }
}

/// Checks the trace of one channel.
pub fn check(device: &Device, trace: &[Command]) -> Findings {
    let mut findings = Findings::default();
    for pair in trace.windows(2) {
        findings.distance("one command per clock", pair[1].clock.saturating_sub(pair[0].clock), 1, || format!("{pair:?}"));
    }
    let events = events(device, trace);
    check_rows(&events, &mut findings);
    check_pairs(device, &events, &mut findings);
    check_window(device, &events, &mut findings);
    check_bus(device, &events, &mut findings);
    check_refreshes(device, trace, &mut findings);
    findings
}

pub fn banks_per_rank(device: &Device) -> usize {
    (device.organisation.bank_groups * device.organisation.banks_per_group) as usize
}

pub fn events(device: &Device, trace: &[Command]) -> Vec<Event> {
    let per_rank = banks_per_rank(device);
    let mut events = Vec::new();
    for (command, &Command { clock, given }) in trace.iter().enumerate() {
        let event = |kind, bank, row| Event { clock, kind, bank, row, command };
        match given {
            Given::Activate { bank, row } => events.push(event(Act, bank, row)),
            Given::Precharge { bank } => events.push(event(Pre, bank, 0)),
            Given::Read { bank, row } => events.push(event(Rd, bank, row)),
            Given::Write { bank, row } => events.push(event(Wr, bank, row)),
            Given::PrechargeAll { rank } => events.extend((0..per_rank).map(|bank| event(Pre, rank * per_rank + bank, 0))),
            Given::Refresh { rank } => events.extend((0..per_rank).map(|bank| event(Ref, rank * per_rank + bank, 0))),
        }
    }
    events
}

/// Reads and writes find their row open; activates and refreshes find the bank closed.
fn check_rows(events: &[Event], findings: &mut Findings) {
    let mut open = [None; 64];
    for event in events {
        let row = &mut open[event.bank];
        let good = match event.kind {
            Rd | Wr => *row == Some(event.row),
            Act | Ref => row.is_none(),
            Pre => true,
        };
        if !good {
            findings.breaches.push(format!("bank has row {row:?} open: {event:?}"));
        }
        match event.kind {
            Act => *row = Some(event.row),
            Pre => *row = None,
            _ => {}
        }
    }
}

fn check_pairs(device: &Device, events: &[Event], findings: &mut Findings) {
    let rules = rules(device);
    let furthest = rules.iter().map(|rule| rule.3).max().unwrap();
    for (later, to) in events.iter().enumerate() {
        for from in events[..later].iter().rev().take_while(|from| from.clock + furthest >= to.clock) {
            let of_pair = rules.iter().filter(|rule| (rule.0, rule.1) == (from.kind, to.kind) && from.command != to.command);
            for &(_, _, scope, least, name) in of_pair {
                if scope.joins(device, from.bank, to.bank) {
                    findings.distance(name, to.clock - from.clock, least, || format!("{from:?} {to:?}"));
                }
            }
        }
    }
}

/// A fifth activate of a rank comes nFAW after the first.
fn check_window(device: &Device, events: &[Event], findings: &mut Findings) {
    for rank in 0..device.organisation.ranks as usize {
        let activates: Vec<_> = events.iter().filter(|e| e.kind == Act && e.bank / banks_per_rank(device) == rank).collect();
        for five in activates.windows(5) {
            findings.distance("nFAW", five[4].clock - five[0].clock, device.timing.n_faw, || format!("{five:?}"));
        }
    }
}

/// Bursts do not overlap, and nRTRS lies between those of different ranks.
fn check_bus(device: &Device, events: &[Event], findings: &mut Findings) {
    let t = &device.timing;
    let latency = |kind| if kind == Rd { t.n_cl } else { t.n_cwl };
    let mut bursts: Vec<_> =
        events.iter().filter(|e| matches!(e.kind, Rd | Wr)).map(|e| (e.clock + latency(e.kind), e.bank / banks_per_rank(device))).collect();
    bursts.sort_unstable();
    for pair in bursts.windows(2) {
        let ((first, rank), (second, other)) = (pair[0], pair[1]);
        if rank == other {
            findings.distance("the bus", second - first, t.n_bl, || format!("{pair:?}"));
        } else {
            findings.distance("nRTRS", second - first, t.n_bl + t.n_rtrs, || format!("{pair:?}"));
        }
    }
}

/// The k-th refresh of a rank comes at k nREFI or as soon after as the reads and writes for which rows were opened are given and the rows can be closed.
fn check_refreshes(device: &Device, trace: &[Command], findings: &mut Findings) {
    let t = &device.timing;
    let owed = t.n_rcd_rd.max(t.n_rcd_wr) + u64::from(device.banks()) * t.n_ccd_l + t.n_rtw + t.n_cwl + t.n_bl + t.n_wtr_l;
    let latest = owed + t.n_ras.max(t.n_cwl + t.n_bl + t.n_wr) + t.n_ppd + t.n_rc + 2 * u64::from(device.organisation.ranks);
    for wanted in 0..device.organisation.ranks as usize {
        let refreshes = trace.iter().filter(|command| command.given == Given::Refresh { rank: wanted });
        for (k, command) in refreshes.enumerate() {
            let due = (k as u64 + 1) * t.n_refi;
            if command.clock > due + latest {
                findings.breaches.push(format!("refresh {k} due at {due} is late: {command:?}"));
            }
            findings.distance("nREFI", command.clock, due, || format!("refresh {k}: {command:?}"));
        }
    }
}
