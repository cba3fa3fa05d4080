//! The table, for the terminal and for documents.

use lodray::lab::{Goal, Hunt, Report, Tally};
use lodray::study::grouped;

const HEAD: [&str; 11] = ["case", "rays", "balanced", "golden", "misses", "doubles", "differ", "overflows", "t ulp", "bary ulp", "pixels"];

fn cells(name: &str, t: &Tally, checked: bool) -> [String; 11] {
    let overflows = if checked { grouped(t.overflows + t.saturated) } else { "-".to_owned() };
    // Rounded down: an error below a bound does not read as the bound.
    let error = |v: f64, compared: u64| if compared == 0 { "-".to_owned() } else { format!("{:.4}", (v * 1e4).floor() / 1e4) };
    [
        name.to_owned(),
        grouped(t.rays),
        grouped(t.balanced),
        grouped(t.compared),
        grouped(t.misses),
        grouped(t.doubles),
        grouped(t.different),
        overflows,
        error(t.t_ulp, t.compared),
        error(t.bary_ulp, t.compared),
        if t.pixels == 0.0 { "-".to_owned() } else { small(t.pixels) },
    ]
}

fn small(v: f64) -> String {
    if v < 0.01 { format!("{v:.0e}") } else { format!("{v:.2}") }
}

fn rows(report: &Report, hunt: Option<&Hunt>) -> Vec<[String; 11]> {
    let checked = report.widths_checked;
    let mut rows: Vec<_> = report.rows.iter().map(|row| cells(&row.case, &row.tally, checked)).collect();
    rows.extend(hunt.map(|hunt| cells("hunt", &hunt.tally, checked)));
    let all = hunt.map(|hunt| hunt.tally).unwrap_or_default();
    rows.push(cells("all", &report.total().with(&all), checked));
    rows
}

/// For the terminal.
pub fn text(report: &Report, hunt: Option<&Hunt>, seed: u64) -> String {
    let line = |cells: &[String]| {
        let widths = [18, 15, 15, 12, 7, 8, 7, 10, 8, 9, 8];
        let cells = cells.iter().zip(widths).enumerate();
        let text: String =
            cells.map(|(k, (cell, width))| if k == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }).collect();
        text + "\n"
    };
    let mut text = line(&HEAD.map(str::to_owned));
    for row in rows(report, hunt) {
        text += &line(&row);
    }
    let hunted = hunt.map_or(0, Hunt::breaches);
    text += &format!("{} breaches", report.total().breaches() + hunted);
    for row in report.rows.iter().filter_map(|row| Some((row, row.tally.first_breach?))) {
        text += &format!("; {}: the first is ray {} of seed {seed}", row.0.case, row.1);
    }
    if !report.widths_checked {
        text += "\nnote: this build does not look for overflows; cargo run --profile checked does";
    }
    for (goal, value) in hunt.map(nearest).unwrap_or_default() {
        text += &format!("\nhunt, nearest: {} {value}", goal.name());
    }
    text
}

/// The nearest approach to each goal.
fn nearest(hunt: &Hunt) -> Vec<(Goal, String)> {
    let mut all: Vec<(Goal, String)> = Vec::new();
    for found in &hunt.found {
        if let Some(goal) = found.goal.filter(|goal| all.iter().all(|one| one.0 != *goal)) {
            // Many zeros are the nearest: noted as negative numbers.
            let value = found.value.abs();
            all.push((goal, if value == 0.0 || (1.0..1e6).contains(&value) { format!("{value}") } else { format!("{value:.1e}") }));
        }
    }
    all
}

/// For documents.
pub fn markdown(report: &Report, hunt: Option<&Hunt>) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let mut text = line(&HEAD.map(str::to_owned)) + "|---|" + &"---:|".repeat(HEAD.len() - 1) + "\n";
    for row in rows(report, hunt) {
        text += &line(&row);
    }
    text += "\n| case | what is hard about it | models | vertex rounding, units |\n|---|---|---:|---:|\n";
    for row in &report.rows {
        text += &format!("| {} | {} | {} | {:.0} |\n", row.case, row.about, row.models, row.vertex_loss);
    }
    if let Some(hunt) = hunt {
        text += &format!("\nThe hunt made {} climbs. Nearest approaches:\n\n| to | value |\n|---|---:|\n", grouped(hunt.climbs));
        for (goal, value) in nearest(hunt) {
            text += &format!("| {} | {value} |\n", goal.name());
        }
    }
    text
}
