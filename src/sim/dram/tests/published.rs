//! Requests of two published simulators, with what they found (`tests/data/dram/README.md`): where both sides have the same rules every column must be the same.

use super::super::channel::Channel;
use super::super::config::Scheduler;
use super::super::{ChannelCounts, Controller, Device};
use flate2::read::GzDecoder;
use std::collections::BTreeMap;
use std::io::Read;
use std::path::PathBuf;

/// A request of a trace.
#[derive(Clone, Copy)]
struct Request {
    write: bool,
    bank: usize,
    row: u32,
    /// When it arrives, if the trace says.
    clock: Option<u64>,
}

fn file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/data/dram").join(name)
}

/// The requests of each channel.
fn requests(trace: &str) -> Vec<Vec<Request>> {
    let mut text = String::new();
    GzDecoder::new(std::fs::File::open(file(&format!("{trace}.csv.gz"))).unwrap()).read_to_string(&mut text).unwrap();
    let mut channels: Vec<Vec<Request>> = Vec::new();
    for line in text.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [write, channel, rank, group, bank, row] = std::array::from_fn(|k| fields[k].parse::<usize>().unwrap());
        assert_eq!(rank, 0);
        // Trace clock 0 is clock 1.
        let clock = fields.get(7).and_then(|clock| clock.parse().ok()).map(|clock: u64| clock + 1);
        channels.resize(channels.len().max(channel + 1), Vec::new());
        channels[channel].push(Request { write: write == 1, bank: 4 * group + bank, row: row as u32, clock });
    }
    channels
}

/// The columns of `published.csv` from the fifth on.
#[derive(Clone, Debug, PartialEq)]
struct Columns {
    clocks: u64,
    mean: f64,
    /// 95th percentile and largest.
    latencies: [u64; 2],
    /// Row hits, misses, conflicts.
    rows: [u64; 3],
    activates: u64,
    refreshes: u64,
}

/// Clocks in which reads arrive and their data are through.
fn run(channel: &mut Channel, requests: &[Request], outstanding: Option<usize>) -> Vec<(u64, u64)> {
    let mut times = vec![(0, 0); requests.len()];
    let (mut next, mut clock) = (0, 1);
    // Ends of the reads that are under way and known.
    let (mut ends, mut reads) = (Vec::new(), 0);
    while next < requests.len() || channel.waiting() > 0 {
        channel.advance(clock - 1, &mut |id, way| {
            let end = way.end();
            times[id as usize].1 = end;
            if !requests[id as usize].write {
                ends.push(end);
            }
        });
        let before = ends.len();
        ends.retain(|&end| end + 1 > clock);
        reads -= before - ends.len();
        while let Some(request) = requests.get(next) {
            let may = match outstanding {
                Some(most) => request.write || reads < most,
                None => request.clock.is_some_and(|at| at <= clock),
            };
            if !may || !channel.accepts(request.write) {
                break;
            }
            times[next].0 = if outstanding.is_some() { clock } else { request.clock.unwrap_or(clock) };
            channel.push(clock, request.bank, request.row, next as u64, request.write);
            reads += usize::from(!request.write);
            next += 1;
        }
        clock += 1;
    }
    channel.advance(clock, &mut |id, way| times[id as usize].1 = way.end());
    times
}

fn measured(device: &Device, controller: &Controller, trace: &str, mode: &str) -> Columns {
    let outstanding = (mode != "open").then(|| mode.parse().unwrap());
    let (mut latencies, mut clocks, mut channels) = (Vec::new(), 0, Vec::new());
    for requests in requests(trace) {
        let mut channel = Channel::new(device, controller);
        let times = run(&mut channel, &requests, outstanding);
        clocks = times.iter().map(|times| times.1).max().unwrap_or(0).max(clocks);
        latencies.extend(times.iter().zip(&requests).filter(|(_, request)| !request.write).map(|((from, to), _)| to - from));
        channels.push(channel);
    }
    let mut counts = ChannelCounts::default();
    for channel in &mut channels {
        channel.advance(clocks, &mut |_, _| {});
        counts.add(&channel.counts);
    }
    latencies.sort_unstable();
    let mean = latencies.iter().sum::<u64>() as f64 / latencies.len() as f64;
    Columns {
        clocks,
        mean,
        latencies: [latencies[(0.95 * latencies.len() as f64).floor() as usize], latencies[latencies.len() - 1]],
        rows: [counts.row_hits, counts.row_misses, counts.row_conflicts],
        activates: counts.activates,
        refreshes: counts.refreshes,
    }
}

/// What a published simulator found, by device, scheduler, trace and mode.
fn published() -> BTreeMap<[String; 4], Columns> {
    let text = std::fs::read_to_string(file("published.csv")).unwrap();
    let row = |line: &str| {
        let f: Vec<&str> = line.split(',').collect();
        let n = |k: usize| f[k].parse().unwrap();
        let columns = Columns {
            clocks: n(4),
            mean: f[5].parse().unwrap(),
            latencies: [n(6), n(7)],
            rows: [n(8), n(9), n(10)],
            activates: n(11),
            refreshes: n(12),
        };
        (std::array::from_fn(|k| f[k].to_owned()), columns)
    };
    text.lines().skip(1).map(row).collect()
}

/// Runs of a device in which ours are compared with theirs, and those that differ.
fn differ(device: &str, theirs: &str, scheduler: Scheduler, hit_cap: u32, is_of: impl Fn(&str) -> bool) -> (usize, Vec<String>) {
    let controller = Controller { scheduler, hit_cap, ..Controller::default() };
    let mut of = Device::preset(device).unwrap();
    if theirs.ends_with("no-refresh") {
        of.timing.n_refi = 1 << 40;
    }
    let all = published().into_iter().filter(|([on, by, trace, _], _)| (on.as_str(), by.as_str()) == (device, theirs) && is_of(trace));
    let (mut compared, mut others) = (0, Vec::new());
    for ([.., trace, mode], columns) in all {
        let found = measured(&of, &controller, &trace, &mode);
        compared += 1;
        // Their means have three digits.
        let same = Columns { mean: if (found.mean - columns.mean).abs() < 0.00051 { columns.mean } else { found.mean }, ..found.clone() };
        if same != columns {
            others.push(format!("{trace} {mode}"));
            // Ours differ a little there, not grossly.
            let part = |ours: f64, theirs: f64| (ours / theirs - 1.0).abs();
            assert!(
                part(found.clocks as f64, columns.clocks as f64) < 0.011,
                "{device} {theirs} {trace} {mode}: {found:?}, theirs {columns:?}"
            );
            assert!(part(found.mean, columns.mean) < 0.04, "{device} {theirs} {trace} {mode}: {found:?}, theirs {columns:?}");
        }
    }
    (compared, others)
}

fn reads(trace: &str) -> bool {
    trace != "mixed"
}

#[test]
fn gddr5_is_that_of_ramulator_1() {
    let same = |theirs, scheduler, is_of: fn(&str) -> bool, but: &[&str], runs| {
        let (compared, others) = differ("gddr5", theirs, scheduler, 16, is_of);
        assert_eq!((compared, others), (runs, but.iter().map(|&run| run.to_owned()).collect()), "{theirs}");
    };
    // Row hits first: all 37 runs of reads, in every column.
    same("row-hit-no-refresh", Scheduler::Hits, reads, &[], 37);
    same("row-hit", Scheduler::Hits, reads, &[], 37);
    // Where theirs, too, counts reads of opened rows before it goes over to writes.
    same("row-hit-mode", Scheduler::Hits, |_| true, &["mixed 4"], 42);
    // The oldest ready one, without their cap and with it.
    let open = ["bursts 16", "bursts 64", "bursts open", "gddr5-bvh open", "gddr5-lod 64", "gddr5-lod open"];
    same("first-ready", Scheduler::OldestReady, reads, &open, 37);
    same("default", Scheduler::OldestReadyCapped, reads, &open, 37);
}

#[test]
fn gddr6_is_that_of_ramulator_2() {
    // Its row hits first give way to an older request: without refresh, which it gives 1 to 3 clocks before nRP is over.
    let (compared, others) = differ("gddr6", "row-hit-no-refresh", Scheduler::OldestReady, 16, reads);
    assert_eq!((compared, others.join(", ").as_str()), (37, "bursts open, gddr6-lod 64, pingpong 16, pingpong 64"));
}
