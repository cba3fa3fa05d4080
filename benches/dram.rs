//! Requests that the DRAM model serves per second: streams and random reads over eight channels of each device.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use lodray::sim::dram::{Device, Dram, DramConfig};
use std::hint::black_box;

const REQUESTS: u64 = 1_000_000;

/// Reads `line(k)` for every k, each as soon as its queue has room; the time of the last data.
fn run(config: &DramConfig, line: impl Fn(u64) -> u64) -> u64 {
    let mut dram = Dram::new(config).expect("a preset is valid");
    let (mut now, mut last) = (0, 0u64);
    let mut done = |_, end: u64| last = end.max(last);
    for k in 0..REQUESTS {
        let line = line(k);
        while !dram.accepts(line, false) {
            now = dram.next_event().unwrap_or(now);
            dram.advance(now, &mut done);
        }
        dram.push(now, line, k, false);
    }
    while let Some(next) = dram.next_event() {
        dram.advance(next, &mut done);
    }
    last
}

fn requests(c: &mut Criterion) {
    let mut group = c.benchmark_group("dram");
    group.throughput(Throughput::Elements(REQUESTS)).sample_size(10);
    for name in Device::presets() {
        let config = DramConfig::new(Device::preset(name).expect("a preset is valid"), 8);
        group.bench_function(format!("{name} stream"), |b| b.iter(|| black_box(run(&config, |k| k))));
        let random = |k: u64| k.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 40;
        group.bench_function(format!("{name} random"), |b| b.iter(|| black_box(run(&config, random))));
    }
    group.finish();
}

criterion_group!(benches, requests);
criterion_main!(benches);
