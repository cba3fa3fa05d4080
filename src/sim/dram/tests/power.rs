//! Counts and energies against hand-computed values.

use super::{Random, Wish, drive, odd_device, single, streams};
use crate::sim::dram::trace::Given;
use crate::sim::dram::{ChannelCounts, Controller, Device, Dram, DramConfig, DramEnergy, DramPrices, PagePolicy};

const MILLISECOND_PS: u64 = 1_000_000_000;

/// Average powers in mW over a millisecond: 1 mW x 1 ms = 10^6 pJ.
fn milliwatts(pj: f64) -> f64 {
    pj / 1e6
}

fn close(value: f64, expected: f64) {
    assert!((value - expected).abs() <= 1e-9 * expected.abs(), "{value}, not {expected}");
}

fn of_millisecond(counts: &ChannelCounts, device: &Device) -> DramEnergy {
    DramPrices::new(device).energy(counts, device.organisation.ranks, MILLISECOND_PS / device.clock_ps)
}

#[test]
fn idle_gddr5_draws_precharge_standby_and_refreshes() {
    let device = Device::preset("gddr5").unwrap();
    let mut dram = single(&device);
    dram.advance(MILLISECOND_PS, &mut |_, _| {});
    // 1,250,000 clocks; one refresh of 82 clocks each 4,875.
    let counts = dram.counts()[0];
    assert_eq!(counts, ChannelCounts { refreshes: 256, active_clocks: 256 * 82, ..ChannelCounts::default() });
    let e = dram.energy();
    // 1.5 V x (250 mA + (450 - 250) mA x 20,992 / 1,250,000)
    close(milliwatts(e.background_pj), 380.03808);
    // IDD5B is IDD3N there.
    assert_eq!((e.activate_pj, e.read_pj, e.write_pj, e.refresh_pj, e.io_pj), (0.0, 0.0, 0.0, 0.0, 0.0));
    close(e.total_pj(), e.background_pj);
}

#[test]
fn idle_gddr6_draws_from_both_supplies() {
    let device = Device::preset("gddr6").unwrap();
    let mut dram = single(&device);
    dram.advance(571 * 3333 * 300, &mut |_, _| {});
    assert_eq!(dram.counts()[0].refreshes, 300);
    let e = dram.energy();
    // The last refresh has only begun. 299 x 211 clocks in refresh, the others of 999,900 precharged; VDD and VPP.
    let clock_pj = 0.571e-3 * 1e3;
    let active = 299.0 * 211.0;
    close(e.background_pj, clock_pj * (1.35 * (61.0 * active + 60.0 * (999_900.0 - active)) + 1.8 * 3.0 * 999_900.0));
    close(e.refresh_pj, clock_pj * 300.0 * 211.0 * (1.35 * 225.0 + 1.8 * 45.0));
}

#[test]
fn idle_paper_machine_draws_about_14_watts() {
    let device = Device::preset("ddr3-scaled").unwrap();
    let mut dram = Dram::new(&streams(device, 8)).unwrap();
    dram.advance(MILLISECOND_PS, &mut |_, _| {});
    let watts = milliwatts(dram.energy().total_pj()) * 1e-3;
    // 128 chips x 1.5 V x 70 mA = 13.44 W, and refreshes.
    assert!((13.44..14.2).contains(&watts), "{watts}");
}

#[test]
fn streaming_channel() {
    let device = Device::preset("gddr5").unwrap();
    // A millisecond of reads without a gap and with a bank always open: 625,000.
    let counts = ChannelCounts { reads: 625_000, active_clocks: 1_250_000, ..ChannelCounts::default() };
    let e = of_millisecond(&counts, &device);
    close(milliwatts(e.background_pj), 675.0); // 1.5 V x 450 mA
    close(milliwatts(e.read_pj), 945.0); // 1.5 V x (1080 - 450) mA
    close(milliwatts(e.io_pj), 450.0); // 40 pins x 11.25 mW
    assert_eq!((e.activate_pj, e.write_pj, e.refresh_pj), (0.0, 0.0, 0.0));
    close(milliwatts(e.total_pj()), 2070.0);
    // The same of writes.
    let counts = ChannelCounts { writes: 625_000, active_clocks: 1_250_000, ..ChannelCounts::default() };
    let e = of_millisecond(&counts, &device);
    close(milliwatts(e.write_pj), 1065.0); // 1.5 V x (1160 - 450) mA
    close(milliwatts(e.io_pj), 450.0);
    assert_eq!(e.read_pj, 0.0);
}

#[test]
fn random_channel() {
    let device = Device::preset("gddr5").unwrap();
    // One bank at one row each nRC, as IDD0 is measured, and a read of each row: 25,000 in a millisecond.
    let counts =
        ChannelCounts { activates: 25_000, precharges: 25_000, reads: 25_000, active_clocks: 25_000 * 35, ..ChannelCounts::default() };
    let e = of_millisecond(&counts, &device);
    // 1.5 V x (490 - (450 x 35 + 250 x 15) / 50) mA; with the background it is IDD0 again.
    close(milliwatts(e.activate_pj), 150.0);
    close(milliwatts(e.background_pj + e.activate_pj), 1.5 * 490.0);
    close(e.read_pj, 25_000.0 * 1512.0); // 1.5 V x 630 mA x 1.6 ns
    close(e.io_pj, 25_000.0 * 720.0);
    assert_eq!((e.write_pj, e.refresh_pj), (0.0, 0.0));
}

#[test]
fn power_down_lowers_the_background() {
    let device = Device::preset("gddr5").unwrap();
    let mut config = streams(device, 1);
    config.controller.power_down = Some(20);
    let mut dram = Dram::new(&config).unwrap();
    dram.advance(MILLISECOND_PS, &mut |_, _| {});
    let counts = dram.counts()[0];
    // Each refresh waits nXP = 10 for the waking; 20 clocks after it the rank is down again.
    assert_eq!(counts.refreshes, 256);
    let awake = 20 + 256 * (10 + 82 + 20);
    assert_eq!(counts.precharged_down_clocks, 1_250_000 - awake);
    let standby = (awake - 256 * 82) as f64;
    let expected = 1.5 * (210.0 * (1_250_000 - awake) as f64 + 250.0 * standby + 450.0 * 256.0 * 82.0) / 1_250_000.0;
    close(milliwatts(dram.energy().background_pj), expected);
}

/// Counts anew from the trace, in a plainer way.
fn recount(dram: &Dram, device: &Device, clocks: u64) -> ChannelCounts {
    let mut counts = ChannelCounts::default();
    let per_rank = (device.banks() / device.organisation.ranks) as usize;
    let mut open = vec![false; device.banks() as usize];
    let mut refreshed = vec![0; device.organisation.ranks as usize];
    let mut commands = dram.trace(0).iter().peekable();
    for clock in 0..clocks {
        while let Some(command) = commands.next_if(|command| command.clock == clock) {
            match command.given {
                Given::Activate { bank, .. } => {
                    open[bank] = true;
                    counts.activates += 1;
                }
                Given::Precharge { bank } => {
                    counts.precharges += u64::from(std::mem::take(&mut open[bank]));
                }
                Given::PrechargeAll { rank } => {
                    let banks = open[rank * per_rank..(rank + 1) * per_rank].iter_mut();
                    counts.precharges += banks.map(|open| u64::from(std::mem::take(open))).sum::<u64>();
                }
                Given::Read { .. } => counts.reads += 1,
                Given::Write { .. } => counts.writes += 1,
                Given::Refresh { rank } => {
                    refreshed[rank] = clock + device.timing.n_rfc;
                    counts.refreshes += 1;
                }
            }
        }
        let ranks = open.chunks(per_rank).zip(&refreshed);
        counts.active_clocks += ranks.filter(|(open, end)| open.contains(&true) || clock < **end).count() as u64;
    }
    counts.bus_clocks = (counts.reads + counts.writes) * device.timing.n_bl;
    counts
}

#[test]
fn counts_are_those_of_the_commands() {
    let device = odd_device();
    for (page, seed) in [(PagePolicy::Open, 5), (PagePolicy::Timeout(30), 6)] {
        let controller = Controller { page, ..Controller::default() };
        let mut dram = super::made(&DramConfig { controller, ..streams(device.clone(), 1) });
        let mut random = Random::new(seed);
        let wishes: Vec<Wish> = (0..3000).map(|k| (k * 20 * 7, random.below(1 << 11), random.below(3) == 0)).collect();
        drive(&mut dram, &wishes);
        // Also in the middle of a refresh.
        for clocks in [70_001, 100 * 1500 + 20, 100 * 1500 + 200] {
            dram.advance(clocks * 7, &mut |_, _| {});
            let counts = dram.counts()[0];
            let expected = recount(&dram, &device, clocks);
            assert!(counts.row_hits > 40 && counts.row_misses > 50 && counts.row_conflicts > 50 && counts.refreshes > 90, "{counts:?}");
            assert_eq!(counts.row_hits + counts.row_misses + counts.row_conflicts, 3000);
            let ChannelCounts { row_hits, row_misses, row_conflicts, queued_clocks, longest_queue, .. } = counts;
            let same = ChannelCounts { row_hits, row_misses, row_conflicts, queued_clocks, longest_queue, ..expected };
            assert_eq!(counts, same, "{page:?} {clocks}");
        }
    }
}
