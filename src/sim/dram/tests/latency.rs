//! Latency of single requests, to the clock.

use super::{drive, line, odd_device, single};
use crate::sim::dram::Device;

fn devices() -> Vec<Device> {
    Device::presets().into_iter().map(|name| Device::preset(name).unwrap()).chain([odd_device()]).collect()
}

#[test]
fn idle_bank_costs_activate_read_and_burst() {
    for device in devices() {
        let t = &device.timing;
        let mut dram = single(&device);
        let times = drive(&mut dram, &[(0, 0, false)]);
        assert_eq!(times, [(0, (t.n_rcd_rd + t.n_cl + t.n_bl) * device.clock_ps)], "{}", device.name);
        let mut dram = single(&device);
        let times = drive(&mut dram, &[(0, 0, true)]);
        assert_eq!(times, [(0, (t.n_rcd_wr + t.n_cwl + t.n_bl) * device.clock_ps)], "{}", device.name);
    }
}

#[test]
fn open_row_costs_read_and_burst() {
    for device in devices() {
        let t = &device.timing;
        let mut dram = single(&device);
        let later = 500 * device.clock_ps;
        let times = drive(&mut dram, &[(0, 0, false), (later, line(&device, 0, 0, 0, 0, 1), false)]);
        assert_eq!(times[1].1 - later, (t.n_cl + t.n_bl) * device.clock_ps, "{}", device.name);
        let counts = dram.counts()[0];
        assert_eq!((counts.row_hits, counts.row_misses, counts.row_conflicts), (1, 1, 0));
    }
}

#[test]
fn other_row_costs_a_precharge_more() {
    for device in devices() {
        let t = &device.timing;
        let mut dram = single(&device);
        let later = 500 * device.clock_ps;
        let times = drive(&mut dram, &[(0, 0, false), (later, line(&device, 0, 0, 0, 1, 0), false)]);
        assert_eq!(times[1].1 - later, (t.n_rp + t.n_rcd_rd + t.n_cl + t.n_bl) * device.clock_ps, "{}", device.name);
        let counts = dram.counts()[0];
        assert_eq!((counts.row_hits, counts.row_misses, counts.row_conflicts), (0, 1, 1));
    }
}

#[test]
fn a_request_waits_for_the_next_clock() {
    let device = odd_device();
    let read = (device.timing.n_rcd_rd + device.timing.n_cl + device.timing.n_bl) * 7;
    for (pushed, clock) in [(0, 0), (1, 1), (7, 1), (8, 2), (13, 2), (14, 2)] {
        assert_eq!(drive(&mut single(&device), &[(pushed, 0, false)]), [(pushed, clock * 7 + read)]);
    }
}

#[test]
fn nothing_happens_before_the_next_event() {
    let device = odd_device();
    let mut dram = single(&device);
    assert_eq!(dram.next_event(), None);
    dram.push(0, 0, 5, false);
    dram.advance(0, &mut |_, _| panic!("too early"));
    let read = device.timing.n_rcd_rd * 7;
    assert_eq!(dram.next_event(), Some(read));
    dram.advance(read - 1, &mut |_, _| panic!("too early"));
    let mut answers = Vec::new();
    dram.advance(read, &mut |id, end| answers.push((id, end)));
    assert_eq!(answers, [(5, read + (device.timing.n_cl + device.timing.n_bl) * 7)]);
    assert_eq!(dram.next_event(), None);
}

/// Requests of an idle channel, all pushed at time 0, and the clock in which each one's data are through as two published simulators have it, by hand from their sources:
/// Ramulator (src/GDDR5.h, speed GDDR5_5000; GDDR5.cpp: data are through nCL + nBL after RD; ACT to RD nRCDR, ACT to ACT nRRD and by fours nFAW, RD to RD nCCDL within a bank
/// group, PRE after nRAS, ACT after nRP) and USIMM (memory_controller.c: T_CAS + T_DATA_TRANS after the column command) with the timings of the paper's authors.
#[test]
fn published_simulators_have_the_same_latencies() {
    let gddr5 = Device::preset("gddr5").unwrap();
    let at = |group, bank, row, column| line(&gddr5, 0, group, bank, row, column);
    let (ras, rcd, cl, bl, rp, ccd_l, rrd) = (35, 15, 15, 2, 15, 3, 7);
    let closed = rcd + cl + bl;
    let cases: [(Vec<u64>, Vec<u64>); 4] = [
        (vec![at(0, 0, 0, 0)], vec![closed]),
        (vec![at(0, 0, 0, 0), at(0, 0, 0, 1)], vec![closed, closed + ccd_l]),
        (vec![at(0, 0, 0, 0), at(1, 0, 0, 0), at(2, 0, 0, 0), at(3, 0, 0, 0)], (0..4).map(|k| closed + k * rrd).collect()),
        (vec![at(0, 0, 0, 0), at(0, 0, 1, 0)], vec![closed, ras + rp + closed]),
    ];
    for (lines, clocks) in cases {
        let wishes: Vec<_> = lines.iter().map(|&line| (0, line, false)).collect();
        let through: Vec<u64> = drive(&mut single(&gddr5), &wishes).iter().map(|times| times.1 / 800).collect();
        assert_eq!(through, clocks);
    }
    assert_eq!(closed * 800, 25_600, "picoseconds");

    let ddr3 = Device::preset("ddr3-scaled").unwrap();
    let later = 1000 * 250;
    let others = [line(&ddr3, 0, 0, 0, 0, 1), line(&ddr3, 0, 0, 0, 1, 0)];
    // T_RCD, T_CAS, T_RP and T_DATA_TRANS: 28, 28, 28 and 4 clocks.
    for (other, clocks) in others.into_iter().zip([28 + 4, 28 + 28 + 28 + 4]) {
        let times = drive(&mut single(&ddr3), &[(0, 0, false), (later, other, false)]);
        assert_eq!([times[0].1 / 250, (times[1].1 - later) / 250], [28 + 28 + 4, clocks]);
    }
}
