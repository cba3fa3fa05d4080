//! Tests of the DRAM model.

mod checker;
mod description;
mod latency;
mod power;
mod published;
mod reference;
mod scheduling;
mod throughput;
mod timing;

use super::device::{Organisation, Timing};
use super::mapping::Place;
use super::{Device, Dram, DramConfig};

/// A device on which every rule can be the binding one.
fn odd_device() -> Device {
    let mut device = Device::preset("gddr5").unwrap();
    device.clock_ps = 7;
    device.organisation = Organisation { ranks: 2, bank_groups: 2, banks_per_group: 4, rows: 8, columns: 16, devices_per_rank: 1 };
    device.timing = Timing {
        n_bl: 2,
        n_cl: 11,
        n_cwl: 5,
        n_rcd_rd: 13,
        n_rcd_wr: 9,
        n_rp: 10,
        n_ras: 29,
        n_rc: 43,
        n_ccd_s: 3,
        n_ccd_l: 5,
        n_rrd_s: 4,
        n_rrd_l: 7,
        n_faw: 23,
        n_wr: 12,
        n_wtr_s: 6,
        n_wtr_l: 9,
        n_rtp: 6,
        n_rtw: 12,
        n_rtrs: 4,
        n_ppd: 3,
        n_xp: 8,
        n_rfc: 97,
        n_refi: 1500,
    };
    device
}

/// So many channels, whose mapping is the one for streams.
fn streams(device: Device, channels: u32) -> DramConfig {
    DramConfig { mapping: super::mapping::STREAM_MAPPING.to_owned(), ..DramConfig::new(device, channels) }
}

/// One channel of a device, commands noted.
fn single(device: &Device) -> Dram {
    made(&streams(device.clone(), 1))
}

/// A DRAM, commands noted.
fn made(config: &DramConfig) -> Dram {
    let mut dram = Dram::new(config).unwrap();
    dram.record();
    dram
}

/// The line at a place by the mapping for streams with one channel.
fn line(device: &Device, rank: u32, group: u32, bank: u32, row: u32, column: u32) -> u64 {
    let o = &device.organisation;
    let parts = [(rank, o.ranks), (bank, o.banks_per_group), (column, o.columns), (group, o.bank_groups)];
    let line = parts.iter().fold(u64::from(row), |line, &(part, size)| line * u64::from(size) + u64::from(part));
    let place = super::mapping::Mapping::new(super::mapping::STREAM_MAPPING, 1, o).unwrap().place(line);
    assert_eq!(place, Place { channel: 0, rank, group, bank, row, column });
    line
}

/// A request: when, which line, whether it writes.
type Wish = (u64, u64, bool);

/// Runs requests in their order, each as soon as its time has come and its queue has room; then to the end. When each came and when its
/// data were through.
fn drive(dram: &mut Dram, wishes: &[Wish]) -> Vec<(u64, u64)> {
    let mut times = vec![(u64::MAX, u64::MAX); wishes.len()];
    let mut answers = 0;
    let mut now = 0;
    for (id, &(time, line, write)) in wishes.iter().enumerate() {
        now = now.max(time);
        let mut answer = |id: u64, end| {
            assert_eq!(std::mem::replace(&mut times[id as usize].1, end), u64::MAX, "answered twice");
            answers += 1;
        };
        dram.advance(now, &mut answer);
        while !dram.accepts(line, write) {
            now = dram.next_event().expect("a full queue has events");
            dram.advance(now, &mut answer);
        }
        dram.push(now, line, id as u64, write);
        times[id].0 = now;
    }
    while let Some(next) = dram.next_event() {
        assert!(next >= now, "time runs backwards");
        now = next;
        dram.advance(now, &mut |id, end| {
            assert_eq!(std::mem::replace(&mut times[id as usize].1, end), u64::MAX, "answered twice");
            answers += 1;
        });
    }
    assert_eq!(answers, wishes.len(), "every request is answered");
    assert_eq!(dram.waiting(), 0);
    times
}

/// Numbers for traffic.
struct Random(crate::num::Random);

impl Random {
    fn new(seed: u64) -> Self {
        Self(crate::num::Random::new(seed))
    }

    fn below(&mut self, limit: u64) -> u64 {
        self.0.next() % limit
    }
}
