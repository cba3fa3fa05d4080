//! What a channel delivers, and what bounds it.

use super::{Random, Wish, drive, line, made, odd_device, single, streams};
use crate::num::LINE_BYTES;
use crate::sim::dram::{ChannelCounts, Device, Dram};

/// Clocks until the last data of reads of `lines`, pushed as fast as they are taken.
fn clocks(dram: &mut Dram, device: &Device, lines: impl Iterator<Item = u64>) -> u64 {
    let wishes: Vec<Wish> = lines.map(|line| (0, line, false)).collect();
    drive(dram, &wishes).iter().map(|times| times.1).max().unwrap() / device.clock_ps
}

#[test]
fn streams_reach_nine_tenths_of_the_peak() {
    for device in Device::presets().map(|name| Device::preset(name).unwrap()) {
        for channels in [1, 8] {
            let count = 20_000 * u64::from(channels);
            let mut dram = made(&streams(device.clone(), channels));
            let seconds = (clocks(&mut dram, &device, 0..count) * device.clock_ps) as f64 * 1e-12;
            let share = (count * LINE_BYTES) as f64 / seconds / (device.peak_bytes_per_second() * f64::from(channels));
            assert!((0.9..1.0).contains(&share), "{} {channels}: {share}", device.name);
        }
    }
}

#[test]
fn peaks_are_those_of_the_pins() {
    let peaks = [("gddr5", 20.0), ("gddr6", 28.0), ("ddr3-scaled", 32.0)];
    for (name, gigabytes) in peaks {
        let peak = Device::preset(name).unwrap().peak_bytes_per_second() / 1e9;
        assert!((peak / gigabytes - 1.0).abs() < 1e-3, "{name}: {peak}");
    }
}

#[test]
fn reads_within_a_bank_group_are_paced_by_n_ccd_l() {
    let device = Device::preset("gddr5").unwrap();
    let mut dram = single(&device);
    // Two banks of one group, fewer clocks than nREFI.
    let lines: Vec<_> = (0..64).flat_map(|column| [line(&device, 0, 1, 0, 0, column), line(&device, 0, 1, 1, 0, column)]).collect();
    let t = &device.timing;
    let took = clocks(&mut dram, &device, lines.into_iter());
    let least = 127 * t.n_ccd_l + t.n_rcd_rd + t.n_cl + t.n_bl;
    assert!((least..least + t.n_rrd_l).contains(&took), "{took} clocks, not {least}");
}

#[test]
fn random_rows_of_a_bank_are_paced_by_n_rc() {
    let device = Device::preset("gddr5").unwrap();
    let mut random = Random::new(1);
    // The row changes with every read.
    let mut row = 0;
    let mut rows = || {
        row = (row + 1 + random.below(4095) as u32) % 4096;
        row
    };
    let lines: Vec<_> = (0..2000).map(|_| line(&device, 0, 2, 3, rows(), 5)).collect();
    let mut dram = single(&device);
    let took = clocks(&mut dram, &device, lines.into_iter());
    let t = &device.timing;
    let (least, refreshes) = (1999 * t.n_rc, took / t.n_refi + 1);
    assert!(took >= least, "{took}");
    assert!(took <= least + refreshes * (t.n_rfc + t.n_rc) + t.n_rcd_rd + t.n_cl + t.n_bl, "{took}");
}

#[test]
fn random_rows_of_all_banks_are_paced_by_n_faw() {
    let device = Device::preset("gddr5").unwrap();
    let mut random = Random::new(2);
    let lines: Vec<_> = (0..20_000).map(|_| random.below(1 << 22)).collect();
    let mut dram = single(&device);
    let took = clocks(&mut dram, &device, lines.into_iter());
    let activates = dram.counts()[0].activates;
    let least = (activates - 4) / 4 * device.timing.n_faw;
    assert!(activates > 19_000, "rows seldom repeat: {activates}");
    assert!((least..least * 115 / 100).contains(&took), "{took} clocks for {activates} activates, not {least}");
    // Without the window nRRD would allow more.
    let mut wide = device.clone();
    wide.timing.n_faw = device.timing.n_rrd_s;
    wide.timing.n_rrd_s = 3;
    wide.timing.n_rrd_l = 3;
    let mut random = Random::new(2);
    let unbound = clocks(&mut single(&wide), &wide, (0..20_000).map(|_| random.below(1 << 22)));
    assert!(unbound < took * 9 / 10, "{unbound}");
}

#[test]
fn idle_channels_are_refreshed_every_n_refi() {
    for device in Device::presets().map(|name| Device::preset(name).unwrap()).into_iter().chain([odd_device()]) {
        let ranks = u64::from(device.organisation.ranks);
        let mut dram = single(&device);
        for (clock, refreshes) in [(1, 0), (9, 8), (9, 9), (10, 9), (1000, 1000)] {
            // One clock before the last one is due where it is not to be counted; a second rank's comes a clock later.
            let at = clock * device.timing.n_refi - u64::from(refreshes < clock) + ranks - 1;
            let at = if refreshes < clock { at - (ranks - 1) } else { at };
            dram.advance(at * device.clock_ps, &mut |_, _| panic!("nothing was asked"));
            assert_eq!(dram.counts()[0].refreshes, ranks * refreshes, "{} {clock}", device.name);
        }
        assert_eq!(dram.next_event(), None, "refreshes alone wake nobody");
    }
}

#[test]
fn refreshes_cost_a_stream_their_time_and_their_rows() {
    let device = Device::preset("gddr5").unwrap();
    let mut calm = device.clone();
    calm.timing.n_refi = 1 << 20;
    let count = 100_000;
    let mut dram = single(&device);
    let took = clocks(&mut dram, &device, 0..count);
    let without = clocks(&mut single(&calm), &calm, 0..count);
    let refreshes = dram.counts()[0].refreshes;
    let t = &device.timing;
    assert_eq!(refreshes, took / t.n_refi);
    let each = (took - without) / refreshes;
    // Rows must be closed, the refresh takes nRFC, and the rows must be opened again.
    let most = t.n_ras + t.n_rp + t.n_rfc + t.n_rcd_rd + t.n_cl;
    assert!((t.n_rfc + t.n_rp..=most).contains(&each), "{each} clocks for each of {refreshes}");
}

#[test]
fn channels_do_not_disturb_each_other() {
    let device = Device::preset("gddr5").unwrap();
    let mut random = Random::new(3);
    let wishes: Vec<Wish> = (0..5000).map(|k| (k * 900, random.below(1 << 25), random.below(4) == 0)).collect();
    let mut all = made(&streams(device.clone(), 8));
    let together = drive(&mut all, &wishes);
    let mut sum = ChannelCounts::default();
    all.counts().iter().for_each(|counts| sum.add(counts));
    assert_eq!(sum.reads + sum.writes, 5000);
    for channel in 0..8 {
        let mine: Vec<_> = (0..wishes.len()).filter(|&k| wishes[k].1 % 8 == channel).collect();
        assert!(mine.len() > 500);
        let mut one = made(&streams(device.clone(), 8));
        let alone = drive(&mut one, &mine.iter().map(|&k| wishes[k]).collect::<Vec<_>>());
        assert!(mine.iter().zip(&alone).all(|(&k, times)| together[k] == *times), "channel {channel}");
        let (commands, all_commands) = (one.trace(channel as usize), all.trace(channel as usize));
        assert_eq!(commands, &all_commands[..commands.len()]);
    }
}
