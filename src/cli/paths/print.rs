//! Figures of paths as text.

use super::figures::Report;
use super::machine::Bounces;
use crate::cli::output::print_table;
use crate::cli::simulate::amount;
use lodray::study::{count, grouped};
use std::fmt::Write;
use std::path::Path;

/// What was traced, and how far it is from the truth.
pub fn report(report: &Report, out: &Path) -> anyhow::Result<()> {
    let [width, height] = report.size;
    let all = report.counts.all();
    let mut text = format!(
        "{}: {width}x{height}, {} a pixel, {}; {} in {:.1} s, {} a second",
        out.display(),
        count(report.samples, "path"),
        count(report.depth, "bounce"),
        count(all, "ray"),
        report.seconds,
        grouped((all as f64 / report.seconds.max(1e-9)) as u64)
    );
    let rows = report.counts.rays.iter().zip(&report.counts.hits).zip(report.counts.shadow_rays.iter().zip(&report.counts.shadowed));
    write!(text, "\n{:>8} {:>14} {:>14} {:>14} {:>14}", "bounce", "rays", "hits", "shadow rays", "shadowed")?;
    for (bounce, ((rays, hits), (asked, shadowed))) in rows.enumerate() {
        write!(text, "\n{bounce:>8} {:>14} {:>14} {:>14} {:>14}", grouped(*rays), grouped(*hits), grouped(*asked), grouped(*shadowed))?;
    }
    for (what, against) in [("full resolution by the same paths", &report.against_full), ("full resolution", &report.against_converged)] {
        let Some(against) = against else { continue };
        let psnr = against.image.psnr_db.map_or_else(|| "equal".to_owned(), |db| format!("{db:.2} dB"));
        write!(text, "\nagainst {what} ({} a pixel): light {:.6}, picture {psnr}", count(against.samples, "path"), against.light)?;
        if let Some(pixels) = against.pixels {
            write!(
                text,
                "; of {} {} are in shadow that should not be, {} in light",
                count(pixels.pixels, "pixel"),
                grouped(pixels.shadowed),
                grouped(pixels.leaking)
            )?;
        }
    }
    print_table(&text)
}

/// What each bounce adds.
pub fn bounces(rows: &[Bounces]) -> anyhow::Result<()> {
    let unit = rows.first().map_or("", |row| row.energy_unit.as_str());
    let mut text = format!(
        "{:>8} {:>14} {:>12} {:>16} {:>14} {:>12} {:>16}",
        "bounces",
        "rays",
        "ms",
        format!("energy, {unit}"),
        "added rays",
        "added ms",
        "added energy"
    );
    for row in rows {
        write!(
            text,
            "\n{:>8} {:>14} {:>12.4} {:>16} {:>14} {:>12.4} {:>16}",
            row.bounces,
            grouped(row.rays),
            row.milliseconds,
            amount(row.energy),
            grouped(row.added_rays),
            row.added_milliseconds,
            amount(row.added_energy)
        )?;
    }
    print_table(&text)
}
