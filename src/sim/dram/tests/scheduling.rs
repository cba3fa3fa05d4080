//! Who goes first, who must wait, and when rows are closed.

use super::{Wish, drive, line, made, odd_device, single, streams};
use crate::sim::dram::trace::Given;
use crate::sim::dram::{Controller, Device, DramConfig, PagePolicy, Scheduler};

fn gddr5() -> Device {
    Device::preset("gddr5").unwrap()
}

fn with(controller: Controller) -> DramConfig {
    DramConfig { controller, ..streams(gddr5(), 1) }
}

/// Ids by the time of their data.
fn order(times: &[(u64, u64)]) -> Vec<usize> {
    let mut ids: Vec<_> = (0..times.len()).collect();
    ids.sort_by_key(|&id| times[id].1);
    ids
}

#[test]
fn row_hits_overtake_and_otherwise_the_oldest_goes_first() {
    let device = gddr5();
    let at = |bank, row, column| (0, line(&device, 0, 0, bank, row, column), false);
    let mut dram = single(&device);
    // 1 wants another row of the bank, 2 and 3 the first one's.
    let times = drive(&mut dram, &[at(0, 0, 0), at(0, 1, 0), at(0, 0, 1), at(0, 0, 2)]);
    assert_eq!(order(&times), [0, 2, 3, 1]);
    let counts = dram.counts()[0];
    assert_eq!((counts.row_misses, counts.row_hits, counts.row_conflicts), (1, 2, 1));
    // Without a common row the order is that of arrival, over all banks.
    let times = drive(&mut single(&device), &[at(0, 0, 0), at(0, 1, 0), at(1, 0, 0), at(0, 2, 0)]);
    assert_eq!(order(&times), [0, 2, 1, 3]);
}

#[test]
fn a_hit_that_comes_later_overtakes_only_before_the_row_is_closed() {
    let device = gddr5();
    let t = &device.timing;
    let conflict = |at| {
        let wishes = [
            (0, line(&device, 0, 0, 0, 0, 0), false),
            (0, line(&device, 0, 0, 0, 1, 0), false),
            (at * 800, line(&device, 0, 0, 0, 0, 1), false),
        ];
        order(&drive(&mut single(&device), &wishes))
    };
    // The row is closed at nRAS, later than nRCDRD + nRTP; a request of that very clock still counts.
    assert!(t.n_ras > t.n_rcd_rd + t.n_rtp);
    assert_eq!(conflict(t.n_ras - 1), [0, 2, 1]);
    assert_eq!(conflict(t.n_ras + 1), [0, 1, 2]);
}

#[test]
fn no_request_is_overtaken_more_often_than_the_cap() {
    let device = gddr5();
    for cap in [0, 1, 5, 16, 1000] {
        let mut wishes: Vec<Wish> = vec![(0, line(&device, 0, 0, 0, 0, 0), false), (0, line(&device, 0, 0, 0, 1, 0), false)];
        // Hits come faster than they can be served.
        wishes.extend((0..600).map(|k| (k * 1600, line(&device, 0, 0, 0, 0, k as u32 % 64), false)));
        let times = drive(&mut made(&with(Controller { hit_cap: cap, ..Controller::default() })), &wishes);
        let position = order(&times).iter().position(|&id| id == 1).unwrap();
        let expected = 1 + (cap as usize).min(600);
        assert_eq!(position, expected, "cap {cap}");
    }
}

#[test]
fn an_older_request_closes_a_row_if_age_is_what_counts() {
    let device = gddr5();
    let at = |row, column| (0, line(&device, 0, 0, 0, row, column), false);
    // 1 wants another row of the bank; the others the first one's, for longer than it must stay open.
    let hits = 40;
    let wishes: Vec<Wish> = [at(0, 0), at(1, 0)].into_iter().chain((1..=hits).map(|k| at(0, k))).collect();
    let place = |scheduler, hit_cap| {
        let times = drive(&mut made(&with(Controller { scheduler, hit_cap, ..Controller::default() })), &wishes);
        order(&times).iter().position(|&id| id == 1).unwrap()
    };
    let t = &device.timing;
    // Reads from nRCD on, until nRAS allows the row to be closed.
    let until_closed = (t.n_ras - t.n_rcd_rd).div_ceil(t.n_ccd_l) as usize;
    assert_eq!(place(Scheduler::OldestReady, 0), until_closed);
    assert_eq!(place(Scheduler::OldestReadyCapped, 100), until_closed);
    assert_eq!(place(Scheduler::OldestReadyCapped, 1), 2, "the first read, and one more");
    assert_eq!(place(Scheduler::HitsCapped, 16), 17);
    assert_eq!(place(Scheduler::Hits, 0), 1 + hits as usize);
}

#[test]
fn reads_go_before_writes() {
    let device = gddr5();
    let at = |bank, row, write| (0, line(&device, 0, 0, bank, row, 0), write);
    assert_eq!(order(&drive(&mut single(&device), &[at(1, 0, false), at(0, 0, true), at(0, 1, false)])), [0, 2, 1]);
    // But a row that was opened for a write is written before it is closed.
    let wishes = [at(0, 0, true), at(0, 1, false)];
    let mut dram = single(&device);
    assert_eq!(order(&drive(&mut dram, &wishes)), [0, 1]);
    assert_eq!(dram.counts()[0].activates, 2);
    // Alone it does not wait for others.
    let times = drive(&mut single(&device), &wishes[..1]);
    assert_eq!(times[0].1, (device.timing.n_rcd_wr + device.timing.n_cwl + device.timing.n_bl) * 800);
}

#[test]
fn writes_wait_for_the_high_watermark_and_are_drained_to_the_low_one() {
    let device = gddr5();
    let controller = Controller { write_queue: 8, write_high: 6, write_low: 2, ..Controller::default() };
    let reads = |count: u64| (0..count).map(|k| (0, line(&device, 0, (k % 4) as u32, 0, 0, (k / 4) as u32), false));
    let write = |k: u32| (0, line(&device, 0, k % 4, 1, 0, k / 4), true);
    // The fifth of the six is the one for which a row was open when the fourth was written.
    for (writes, early) in [(5, 0), (6, 5)] {
        let mut dram = made(&with(controller.clone()));
        let wishes: Vec<Wish> = reads(40).chain((0..writes).map(write)).collect();
        drive(&mut dram, &wishes);
        let kinds = dram.trace(0).iter().filter_map(|command| match command.given {
            Given::Read { .. } => Some(false),
            Given::Write { .. } => Some(true),
            _ => None,
        });
        let kinds: Vec<_> = kinds.collect();
        let last_read = kinds.iter().rposition(|&write| !write).unwrap();
        let before = kinds[..last_read].iter().filter(|&&write| write).count();
        assert_eq!(before, early, "{writes} writes");
        // Those go in one piece.
        let changes = kinds.windows(2).filter(|pair| pair[0] != pair[1]).count();
        assert!(changes <= 3, "{kinds:?}");
    }
}

#[test]
fn a_full_queue_accepts_again_when_a_command_was_given() {
    let device = gddr5();
    let config = DramConfig { channels: 2, ..with(Controller { read_queue: 3, ..Controller::default() }) };
    let mut dram = made(&config);
    for id in 0..3 {
        assert!(dram.accepts(2 * id, false));
        dram.push(0, 2 * id, id, false);
    }
    assert!(!dram.accepts(100, false), "channel 0 is full");
    assert!(dram.accepts(101, false), "channel 1 is not");
    assert!(dram.accepts(100, true), "nor are its writes");
    let read = device.timing.n_rcd_rd * device.clock_ps;
    dram.advance(read - 1, &mut |_, _| panic!("too early"));
    assert!(!dram.accepts(100, false));
    dram.advance(read, &mut |id, _| assert_eq!(id, 0));
    assert!(dram.accepts(100, false));
    assert_eq!(dram.counts()[0].longest_queue, 3);
}

#[test]
#[should_panic(expected = "pushed to a full DRAM queue")]
fn pushing_to_a_full_queue_panics() {
    let mut dram = made(&with(Controller { read_queue: 1, ..Controller::default() }));
    dram.push(0, 0, 0, false);
    dram.push(0, 64, 1, false);
}

#[test]
fn queued_clocks_run_from_arrival_to_command() {
    let device = gddr5();
    let t = &device.timing;
    let mut dram = single(&device);
    drive(&mut dram, &[(0, line(&device, 0, 0, 0, 0, 0), false), (0, line(&device, 0, 1, 0, 0, 0), false)]);
    // The second activate waits nRRD_S, which is more than nCCD_S.
    assert_eq!(dram.counts()[0].queued_clocks, t.n_rcd_rd + t.n_rrd_s + t.n_rcd_rd);
}

/// Clock of the first precharge after one read, with a second read of the row at a clock.
fn closed_at(page: PagePolicy, second: Option<u64>) -> Option<u64> {
    let device = gddr5();
    let mut dram = made(&with(Controller { page, ..Controller::default() }));
    let mut wishes = vec![(0, line(&device, 0, 0, 0, 0, 0), false)];
    wishes.extend(second.map(|clock| (clock * 800, line(&device, 0, 0, 0, 0, 1), false)));
    drive(&mut dram, &wishes);
    dram.advance(4000 * 800, &mut |_, _| {}); // before the first refresh
    dram.trace(0).iter().find(|command| command.given == Given::Precharge { bank: 0 }).map(|command| command.clock)
}

#[test]
fn rows_are_closed_by_the_policy() {
    let t = gddr5().timing;
    assert_eq!(closed_at(PagePolicy::Open, None), None);
    assert_eq!(closed_at(PagePolicy::Closed, None), Some(t.n_ras));
    // The read is at nRCDRD; a second one starts the time anew.
    assert_eq!(closed_at(PagePolicy::Timeout(100), None), Some(t.n_rcd_rd + 100));
    assert_eq!(closed_at(PagePolicy::Timeout(100), Some(60)), Some(160));
    assert_eq!(closed_at(PagePolicy::Timeout(100), Some(t.n_rcd_rd + 99)), Some(t.n_rcd_rd + 199));
    assert_eq!(closed_at(PagePolicy::Closed, Some(t.n_ras - 1)), Some(t.n_ras - 1 + t.n_rtp));
}

#[test]
fn a_refresh_closes_all_rows() {
    let device = odd_device();
    let t = &device.timing;
    let mut dram = single(&device);
    let read = |clock: u64| (clock * 7, line(&device, 0, 1, 2, 3, 4), false);
    let times = drive(&mut dram, &[read(0), read(t.n_refi - 1), read(t.n_refi), read(t.n_refi + 200)]);
    let latency = |k: usize| (times[k].1 - times[k].0) / 7;
    let hit = t.n_cl + t.n_bl;
    assert_eq!(latency(1), hit, "a clock before the refresh is due");
    // The read at nREFI - 1 holds the row for nRTP; then it is closed, the rank refreshed, the row opened.
    assert_eq!(latency(2), t.n_rtp - 1 + t.n_rp + t.n_rfc + t.n_rcd_rd + hit);
    assert_eq!(latency(3), hit);
    let counts = dram.counts()[0];
    assert_eq!((counts.row_misses, counts.row_hits, counts.row_conflicts, counts.refreshes), (2, 2, 0, 2));
}

#[test]
fn a_due_refresh_lets_the_reads_go_for_which_rows_were_opened() {
    let device = odd_device();
    let t = &device.timing;
    let mut dram = single(&device);
    let read = |clock: u64, bank, column| (clock * 7, line(&device, 0, 1, bank, 3, column), false);
    // Activated a few clocks before; a second one of the row comes too late, and so does one of another bank.
    let times = drive(&mut dram, &[read(t.n_refi - 4, 2, 4), read(t.n_refi - 3, 2, 5), read(t.n_refi, 3, 6)]);
    let latency = |k: usize| (times[k].1 - times[k].0) / 7;
    assert_eq!(latency(0), t.n_rcd_rd + t.n_cl + t.n_bl);
    let refreshed = t.n_rc - 4 + t.n_rfc;
    assert_eq!(latency(1), 3 + refreshed + t.n_rcd_rd + t.n_cl + t.n_bl);
    assert!(latency(2) > refreshed);
    assert_eq!(dram.counts()[0].activates, 3);
}

#[test]
fn waking_from_power_down_costs_n_xp() {
    let device = gddr5();
    let t = &device.timing;
    let mut dram = made(&with(Controller { power_down: Some(100), ..Controller::default() }));
    // The first comes when the rank has been idle for 100 clocks and is not yet down; then it is idle from the end of the data.
    let idle = 100 + t.n_rcd_rd + t.n_cl + t.n_bl;
    let read = |clock: u64, column| (clock * 800, line(&device, 0, 0, 0, 0, column), false);
    let times = drive(&mut dram, &[read(100, 0), read(idle + 100, 1), read(idle + 1000, 2)]);
    let latency = |k: usize| (times[k].1 - times[k].0) / 800;
    assert_eq!(latency(0), t.n_rcd_rd + t.n_cl + t.n_bl);
    assert_eq!(latency(1), t.n_cl + t.n_bl);
    assert_eq!(latency(2), t.n_xp + t.n_cl + t.n_bl);
    let counts = dram.counts()[0];
    let idle_again = idle + 100 + t.n_cl + t.n_bl;
    assert_eq!(counts.active_down_clocks, idle + 1000 - (idle_again + 100));
    assert_eq!(counts.precharged_down_clocks, 0);
}
