//! Every timing rule, on random traffic: never broken, and kept to the clock.

use super::checker::{Findings, check};
use super::{Random, Wish, drive, made, odd_device, streams};
use crate::sim::dram::trace::Given;
use crate::sim::dram::{Controller, Device, DramConfig, PagePolicy};
use std::collections::BTreeSet;

/// Random traffic of one shape: share of writes in 256, span of lines, mean gap in clocks, how often the next line follows the last one (in
/// 256).
#[derive(Clone, Copy, Debug)]
struct Shape {
    writes: u64,
    lines: u64,
    gap: u64,
    runs: u64,
}

const SHAPES: [Shape; 8] = [
    Shape { writes: 0, lines: 1 << 20, gap: 0, runs: 0 },
    Shape { writes: 0, lines: 1 << 20, gap: 0, runs: 200 },
    Shape { writes: 128, lines: 1 << 20, gap: 0, runs: 100 },
    Shape { writes: 128, lines: 1 << 20, gap: 20, runs: 100 },
    Shape { writes: 20, lines: 1 << 20, gap: 9, runs: 220 },
    Shape { writes: 128, lines: 64, gap: 3, runs: 0 },
    Shape { writes: 255, lines: 1 << 20, gap: 0, runs: 250 },
    Shape { writes: 30, lines: 1 << 20, gap: 200, runs: 128 },
];

fn traffic(shape: Shape, device: &Device, seed: u64, count: usize) -> Vec<Wish> {
    let mut random = Random::new(seed);
    let (mut time, mut line) = (0, 0);
    let mut wish = || {
        time += random.below(2 * shape.gap + 1) * device.clock_ps;
        line = if random.below(256) < shape.runs { line + 1 } else { random.below(shape.lines) };
        (time, line, random.below(256) < shape.writes)
    };
    (0..count).map(|_| wish()).collect()
}

fn controllers() -> [Controller; 4] {
    let small = Controller { read_queue: 5, write_queue: 7, write_high: 5, write_low: 2, hit_cap: 2, ..Controller::default() };
    [
        Controller::default(),
        small.clone(),
        Controller { page: PagePolicy::Closed, ..Controller::default() },
        Controller { page: PagePolicy::Timeout(60), power_down: Some(40), ..small },
    ]
}

/// The findings for every shape and controller.
fn all_findings(device: &Device, judge: &Device, count: usize) -> Vec<(String, Findings)> {
    let mut all = Vec::new();
    for controller in controllers() {
        for (seed, shape) in SHAPES.into_iter().enumerate() {
            let mut dram = made(&DramConfig { controller: controller.clone(), ..streams(device.clone(), 1) });
            drive(&mut dram, &traffic(shape, device, seed as u64, count));
            let trace = dram.trace(0);
            let accesses = trace.iter().filter(|command| matches!(command.given, Given::Read { .. } | Given::Write { .. })).count();
            assert_eq!(accesses, count, "every request has its command");
            all.push((format!("{shape:?} {controller:?}"), check(judge, trace)));
        }
    }
    all
}

#[test]
fn random_traffic_keeps_every_rule() {
    let presets = Device::presets().map(|name| Device::preset(name).unwrap());
    for device in presets.iter().chain([&odd_device()]) {
        for (name, findings) in all_findings(device, device, 4000) {
            assert!(
                findings.breaches.is_empty(),
                "{} {name}: {} breaches, first {}",
                device.name,
                findings.breaches.len(),
                findings.breaches[0]
            );
        }
    }
}

#[test]
fn every_rule_binds_to_the_clock() {
    let device = odd_device();
    let tight: BTreeSet<_> = all_findings(&device, &device, 4000).into_iter().flat_map(|(_, findings)| findings.tight).collect();
    let all = [
        "nCCD_L",
        "nCCD_L of writes",
        "nCCD_S",
        "nCCD_S of writes",
        "nFAW",
        "nPPD",
        "nRAS",
        "nRC",
        "nRCDRD",
        "nRCDWR",
        "nREFI",
        "nRFC",
        "nRP",
        "nRP before a refresh",
        "nRRD_L",
        "nRRD_S",
        "nRTP",
        "nRTRS",
        "nRTW",
        "nWR",
        "nWTR_L",
        "nWTR_S",
        "one command per clock",
    ];
    let missing: Vec<_> = all.iter().filter(|name| !tight.contains(*name)).collect();
    assert!(missing.is_empty(), "no pair of commands meets {missing:?} to the clock");
}

/// Changes a device.
type Change = fn(&mut Device);

#[test]
fn checker_finds_what_is_a_clock_too_early() {
    let device = odd_device();
    let stricter: [(&str, Change); 19] = [
        ("nRCDRD", |d| d.timing.n_rcd_rd += 1),
        ("nRCDWR", |d| d.timing.n_rcd_wr += 1),
        ("nRAS", |d| d.timing.n_ras += 1),
        ("nRC", |d| d.timing.n_rc += 1),
        ("nRP", |d| d.timing.n_rp += 1),
        ("nRTP", |d| d.timing.n_rtp += 1),
        ("nWR", |d| d.timing.n_wr += 1),
        ("nRRD_L", |d| d.timing.n_rrd_l += 1),
        ("nRRD_S", |d| d.timing.n_rrd_s += 1),
        ("nCCD_L", |d| d.timing.n_ccd_l += 1),
        ("nCCD_S", |d| d.timing.n_ccd_s += 1),
        ("nRTW", |d| d.timing.n_rtw += 1),
        ("nWTR_L", |d| d.timing.n_wtr_l += 1),
        ("nWTR_S", |d| d.timing.n_wtr_s += 1),
        ("nPPD", |d| d.timing.n_ppd += 1),
        ("nFAW", |d| d.timing.n_faw += 1),
        ("nRTRS", |d| d.timing.n_rtrs += 1),
        ("nRFC", |d| d.timing.n_rfc += 1),
        ("nREFI", |d| d.timing.n_refi += 1),
    ];
    for (name, change) in stricter {
        let mut judge = device.clone();
        change(&mut judge);
        let breaches: Vec<_> = all_findings(&device, &judge, 1500).into_iter().flat_map(|(_, findings)| findings.breaches).collect();
        assert!(breaches.iter().any(|breach| breach.starts_with(name)), "{name}");
    }
}

#[test]
fn same_traffic_gives_the_same_commands() {
    let device = odd_device();
    for controller in controllers() {
        let config = DramConfig { controller, ..streams(device.clone(), 1) };
        let wishes = traffic(SHAPES[4], &device, 99, 3000);
        let (mut one, mut other) = (made(&config), made(&config));
        assert_eq!(drive(&mut one, &wishes), drive(&mut other, &wishes));
        assert_eq!(one.trace(0), other.trace(0));
        assert_eq!(one.counts(), other.counts());
    }
}
