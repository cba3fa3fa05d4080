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
