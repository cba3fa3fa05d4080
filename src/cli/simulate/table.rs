//! A result as text.

use lodray::report::result::{CacheResult, SimResult, UnitsResult};
use lodray::study::{count, grouped};

/// Columns of the name and of each figure.
const NAME: usize = 14;
const CELL: usize = 14;
/// Columns of names of limits and causes, and how many are shown of each.
const WIDE: usize = 19;
const SHOWN: usize = 5;

/// A number with about four digits, or all before the point.
pub fn amount(value: f64) -> String {
    match value.abs() {
        size if size >= 1e3 => grouped(value.round() as u64), // energies, times and bytes are not negative
        size if size >= 100.0 => format!("{value:.1}"),
        size if size >= 10.0 => format!("{value:.2}"),
        _ => format!("{value:.3}"),
    }
}

fn percent(share: f64) -> String {
    format!("{:.1} %", 100.0 * share)
}

/// Lines of a name and figures.
#[derive(Default)]
struct Lines(String);

impl Lines {
    fn line<T: AsRef<str>>(&mut self, name: &str, cells: impl IntoIterator<Item = T>) {
        let cells: String = cells.into_iter().map(|cell| format!("{:>CELL$}", cell.as_ref())).collect();
        self.0 += &format!("{name:<NAME$}{cells}\n");
    }

    /// The same with room for longer names.
    fn wide<T: AsRef<str>>(&mut self, name: &str, cells: impl IntoIterator<Item = T>) {
        let cells: String = cells.into_iter().map(|cell| format!("{:>WIDE$}", cell.as_ref())).collect();
        self.0 += &format!("{name:<WIDE$}{cells}\n");
    }

    fn gap(&mut self) {
        self.0.push('\n');
    }
}

/// The table of one run.
pub fn table(r: &SimResult) -> String {
    let mut lines = Lines(head(r));
    lines.line("frame", ["cycles", "ms", "frames/s", "rays", "hits", "accesses/ray"]);
    let frame = [grouped(r.cycles), amount(r.milliseconds), amount(r.frames_per_second)];
    lines.line("", frame.into_iter().chain([grouped(r.rays), grouped(r.hits), amount(r.accesses_per_ray)]));
    frames(&mut lines, r);
    lines.gap();
    memory(&mut lines, r);
    lines.gap();
    times(&mut lines, r);
    lines.gap();
    energy(&mut lines, r);
    lines.gap();
    traffic(&mut lines, r);
    if r.l1.requests == 0 {
        lines.0 += "note: no ray meets the model's box, so nothing is read\n";
    }
    lines.0.trim_end().to_owned()
}

/// What frames took one after another, or which part of a single one few rays had for themselves.
fn frames(lines: &mut Lines, r: &SimResult) {
    let energy = format!("energy, {}", r.energy.unit);
    let figures = |[cycles, bytes, energy]: [f64; 3], stragglers: f64| {
        [grouped(cycles.round() as u64), grouped(bytes.round() as u64), amount(energy), percent(stragglers)] // counts are not negative
    };
    match (r.warm, r.frames.as_slice()) {
        (Some(warm), [first, ..]) => {
            lines.gap();
            lines.line("one frame", ["cycles", "DRAM bytes", &energy, "stragglers"]);
            lines.line("  first", figures([first.cycles as f64, first.dram_bytes as f64, first.energy], first.stragglers));
            let [from, to] = warm.frames;
            lines.line(&format!("  {from} to {to}"), figures([warm.cycles, warm.dram_bytes, warm.energy], warm.stragglers));
        }
        (None, [one]) => {
            lines.0 += &format!("              {} of its cycles with rays in fewer than half of the contexts\n", percent(one.stragglers));
        }
        _ => (),
    }
}

fn head(r: &SimResult) -> String {
    let setup = &r.setup;
    // `lod at delta 1`, `bvh, leaves line 4`.
    let details = setup.method.details();
    let detail: String = details.iter().map(|d| if d.starts_with("delta") { format!(" at {d}") } else { format!(", {d}") }).collect();
    let machine = &setup.machine;
    format!(
        "{}, {}; {}{detail}; {}\n{} ({}), compute {}\n\n",
        setup.scene.name,
        count(setup.scene.finest_triangles, "triangle"),
        setup.method.name,
        setup.rays_in_words(),
        machine.description.name,
        machine.title(),
        setup.compute.name(),
    )
}

fn memory(lines: &mut Lines, r: &SimResult) {
    let counts = |c: &CacheResult| [c.requests, c.hits, c.misses, c.merges].map(grouped);
    lines.line("caches", ["requests", "hits", "misses", "merges", "hit rate", "conflicts"]);
    for (name, cache) in [("  L1", &r.l1), ("  L2", &r.l2)] {
        lines.line(name, counts(cache).into_iter().chain([percent(cache.hit_rate), grouped(cache.conflicts)]));
    }
    if let Some(causes) = r.l2.causes {
        lines.line("L2 misses", ["cold", "capacity", "conflict", "busiest set"]);
        let over = r.l2.busiest_set_over_mean.map_or(String::new(), |over| format!("{over:.2} of mean"));
        lines.line("", [causes.cold, causes.capacity, causes.conflict].map(grouped).into_iter().chain([over]));
    }
    lines.line("waits, cycles", ["bank queue", "before it", "bank blocked", "crossbar"]);
    // Each row with the crossbar's way to it.
    for (name, cache, crossbar) in [("  L1", &r.l1, r.crossbar.answer_cycles), ("  L2", &r.l2, r.crossbar.request_cycles)] {
        lines.line(name, [cache.queued_cycles, cache.refused_cycles, cache.blocked_cycles, crossbar].map(grouped));
    }
    let dram = &r.dram;
    lines.gap();
    lines.line("DRAM", ["reads", "row hits", "row misses", "row conflicts", "GB/s", "of peak", "queued, ns"]);
    let counts = [dram.reads, dram.row_hits, dram.row_misses, dram.row_conflicts].map(grouped);
    let rates = [amount(dram.bytes_per_second * 1e-9), percent(dram.bandwidth_share), amount(dram.mean_queue_nanoseconds)];
    lines.line("", counts.into_iter().chain(rates));
    lines.0 += &format!(
        "              {}: {}, {} GB/s at most; the busiest has {:.2} of the mean; {} cycles of misses before full queues\n",
        dram.device,
        count(dram.channels.len(), "channel"),
        amount(dram.peak_bytes_per_second * 1e-9),
        dram.busiest_over_mean,
        grouped(dram.refused_cycles)
    );
    if let (Some(bank), Some(activates)) = (dram.busiest_bank_over_mean, dram.activates_per_thousand) {
        lines.0 += &format!("              {activates:.0} rows opened for 1,000 requests; the busiest bank has {bank:.2} of the mean\n");
    }
}

fn times(lines: &mut Lines, r: &SimResult) {
    let w = &r.waits;
    match &r.units {
        None => {
            lines.line("contexts", ["wait for L1", "for L2", "for DRAM", "idle"]);
            lines.line("", [w.l1, w.l2, w.dram, w.idle].map(percent));
        }
        Some(units) => {
            lines.line("contexts", ["wait for lines", "compute", "idle"]);
            lines.line("", [w.memory, w.compute, w.idle].map(percent));
            blocks(lines, units);
        }
    }
    let stalls = by_size(r.stalls.cycles.iter().map(|(name, &cycles)| (name.as_str(), cycles as f64)));
    let with_rays = r.stalls.context_cycles as f64 - r.stalls.cycles.get("idle").map_or(0.0, |&idle| idle as f64);
    let of_rays = |cycles: f64| percent(if with_rays == 0.0 { 0.0 } else { cycles / with_rays });
    let shown: Vec<_> = stalls.into_iter().filter(|(name, _)| *name != "idle").take(SHOWN).collect();
    lines.wide("rays wait for", shown.iter().map(|(name, _)| *name));
    lines.wide("  of their time", shown.iter().map(|(_, cycles)| of_rays(*cycles)));
    let limits: Vec<_> =
        by_size(r.roofline.limits.iter().map(|(name, bound)| (name.as_str(), bound.share))).into_iter().take(SHOWN).collect();
    lines.wide("alone needs", limits.iter().map(|(name, _)| *name));
    lines.wide("  of frame", limits.iter().map(|(_, share)| percent(*share)));
    lines.line("latency", ["median", "90 %", "99 %", "largest"]);
    for (name, of) in [("  rays", &r.latencies.rays), ("  L1 misses", &r.latencies.l1_misses), ("  L2 misses", &r.latencies.l2_misses)] {
        lines.line(name, [of.median, of.percentile_90, of.percentile_99, of.largest].map(grouped));
    }
}

/// What the blocks of units did, and how full they were.
fn blocks(lines: &mut Lines, units: &UnitsResult) {
    let eased = if units.eased.is_empty() { "" } else { "cycles, eased" };
    lines.line(&count(units.units, "unit"), ["operations", "busy", "refused", "load", "90 % full", "the fullest", eased]);
    for (name, block) in &units.blocks {
        let phases = units.phases.as_ref().and_then(|phases| phases.blocks.get(name));
        let full = phases.map_or_else(Default::default, |of| [of.load, of.full, of.fullest].map(percent));
        let eased = units.eased.get(name).map_or(String::new(), |&cycles| grouped(cycles));
        let done = [grouped(block.operations), percent(block.busy), percent(block.refused)];
        lines.line(&format!("  {name}"), done.into_iter().chain(full).chain([eased]));
    }
    // What was eased and is no block.
    for (name, &cycles) in units.eased.iter().filter(|(name, _)| !units.blocks.contains_key(*name) && *name != "all") {
        lines.line(&format!("  {name}"), ["", "", "", "", "", "", &grouped(cycles)]);
    }
    if let Some(phases) = &units.phases {
        let all = units.eased.get("all").map_or(String::new(), |&cycles| grouped(cycles));
        lines.line("  none, all", ["", "", "", "", "", &percent(phases.none_full), &all]);
    }
}

/// The largest first.
fn by_size<'a>(all: impl Iterator<Item = (&'a str, f64)>) -> Vec<(&'a str, f64)> {
    let mut all: Vec<_> = all.collect();
    all.sort_by(|a, b| b.1.total_cmp(&a.1));
    all
}

fn energy(lines: &mut Lines, r: &SimResult) {
    let e = &r.energy;
    let split = e.split();
    lines.line("energy", split.iter().map(|part| part.0).chain(["all", if e.average_watts.is_some() { "mean W" } else { "" }]));
    let unit = format!("  {}", e.unit);
    let watts = e.average_watts.map_or_else(String::new, amount);
    lines.line(&unit, split.iter().map(|part| amount(part.1)).chain([amount(e.total), watts]));
    lines.line("  of all", split.iter().map(|part| percent(if e.total == 0.0 { 0.0 } else { part.1 / e.total })));
    lines.line("  DRAM", e.dram.parts.keys());
    lines.line("", e.dram.parts.values().map(|&part| amount(part)));
}

fn traffic(lines: &mut Lines, r: &SimResult) {
    lines.line("lines of", ["L1", "L2", "DRAM", "bytes/ray, L1", "L2", "DRAM"]);
    for k in &r.traffic.kinds {
        let bytes = [k.bytes_per_ray.l1, k.bytes_per_ray.l2, k.bytes_per_ray.dram].map(amount);
        lines.line(&format!("  {}", k.kind), [k.l1, k.l2, k.dram].map(grouped).into_iter().chain(bytes));
    }
    let all = r.traffic.bytes_per_ray;
    let bytes = [all.l1, all.l2, all.dram].map(amount);
    lines.line("  all", [r.l1.requests, r.l2.requests, r.dram.reads].map(grouped).into_iter().chain(bytes));
    if let Some(share) = r.traffic.l0_share_of_l1 {
        lines.0 +=
            &format!("  {} of the L1s' requests read the L0 part: nodes over the base triangles, and their records\n", percent(share));
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn amounts_have_four_digits() {
        assert_eq!([0.0, 1.23456, 12.3456, 123.456, 12345.6].map(super::amount), ["0.000", "1.235", "12.35", "123.5", "12,346"]);
    }
}
