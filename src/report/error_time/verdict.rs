//! Which method is the cheapest of those that are near enough, at each view, ours or not: the same verdict for the page, the diagrams and the terminal.

use super::document::{EqualError, ErrorTime};
use super::equal::{ALWAYS_BELOW, NOT_REACHED};
use crate::method::lod;
use serde::Serialize;

/// The error by which methods are near enough, and how much of it, in pixels.
const ERROR: (&str, f64) = ("surface-p99", 0.5);
/// The costs, and what they are called.
const COSTS: [(&str, &str); 3] = [("time", "time"), ("energy", "energy"), ("dram-lines", "DRAM lines")];
/// Costs that are nearer than that, as a part of the smaller, are as good as the same.
const SAME: f64 = 0.005;
/// Columns of a terminal.
const COLUMNS: usize = 80;

/// The verdict on one machine, with one kind of compute.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Verdict {
    /// Number of the machine.
    pub machine: usize,
    /// How compute is simulated.
    pub compute: String,
    /// What is compared, with the size of the frames.
    pub head: String,
    /// A sentence for each cost.
    pub said: Vec<String>,
    /// A map: rows of scenes and costs.
    pub rows: Vec<Row>,
}

/// The winners of a scene by one cost.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Row {
    /// Name of the scene.
    pub scene: String,
    /// The cost's name in files.
    pub cost: &'static str,
    /// The same in words.
    pub words: &'static str,
    /// The views, from near to far.
    pub winners: Vec<Winner>,
}

/// The winner of a view.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Winner {
    /// Number of the view.
    pub view: usize,
    /// Distance of the eye in bounding radii.
    pub distance: f64,
    /// Columns and rows of the frame.
    pub size: [u32; 2],
    /// Name of the method that costs least; absent where ours and another cost the same, or none is near enough.
    pub best: Option<String>,
    /// Its setting, where the cost is that of one.
    pub setting: Option<String>,
    /// The least cost of the others over ours: above 1 ours is ahead, below it is behind. Absent where ours or all others are not near enough.
    pub over_ours: Option<f64>,
    /// What is to be said of it.
    pub note: Option<&'static str>,
}

/// Ours and another cost the same.
const DRAW: &str = "the same";
/// Ours is not near enough.
const ONLY_OTHERS: &str = "ours is further off";
/// No other is near enough.
const ONLY_OURS: &str = "all others are further off";

impl Winner {
    fn of(document: &ErrorTime, equal: &EqualError) -> Self {
        let view = &document.views[equal.view];
        let cheaper = |a: &&_, b: &&_| -> std::cmp::Ordering {
            let cost = |of: &super::EqualCost| of.cost.unwrap_or(f64::INFINITY);
            cost(a).total_cmp(&cost(b))
        };
        let rival = equal.methods.iter().filter(|method| method.cost.is_some()).min_by(cheaper);
        let over_ours = rival.and_then(|rival| rival.ratio);
        let ours = equal.ours.map(|_| (lod::METHOD.name.to_owned(), equal.setting.clone()));
        let theirs = rival.map(|rival| (rival.method.clone(), rival.setting.clone()));
        let (best, note) = match (ours, theirs, over_ours) {
            (None, None, _) => (None, Some(NOT_REACHED)),
            (None, theirs, _) => (theirs, Some(ONLY_OTHERS)),
            (ours, None, _) => (ours, Some(ONLY_OURS)),
            (_, _, Some(over)) if (over - 1.0).abs() < SAME => (None, Some(DRAW)),
            (ours, theirs, over) => (if over.is_some_and(|over| over < 1.0) { theirs } else { ours }, None),
        };
        let (best, setting) = best.map_or((None, None), |(method, setting)| (Some(method), setting));
        let note = note.or_else(|| equal.why.as_deref().filter(|why| *why == ALWAYS_BELOW).map(|_| "ours at its coarsest is nearer"));
        Self { view: equal.view, distance: view.distance, size: view.size, best, setting, over_ours, note }
    }

    /// Who wins, and the ratio, such as `discrete 0.54`.
    pub fn name_and_ratio(&self) -> String {
        let over = self.over_ours.map(ratio);
        let who = self.best.as_deref().unwrap_or(if over.is_some() { DRAW } else { "none" });
        over.map_or_else(|| who.to_owned(), |over| format!("{who} {over}"))
    }
}

/// A ratio in few digits.
fn ratio(value: f64) -> String {
    if value < 9.995 { format!("{value:.2}") } else { format!("{value:.0}") }
}

/// A verdict for each machine and kind of compute; none if ours or all others are missing. Views count once: of several samples a pixel, the fewest.
pub fn verdicts(document: &ErrorTime) -> Vec<Verdict> {
    let samples = document.equal_error.iter().map(|equal| equal.samples).min();
    let of = |(machine, compute): (usize, String)| {
        let here = |equal: &&EqualError| {
            (equal.error.as_str(), equal.level) == ERROR
                && Some(equal.samples) == samples
                && equal.machine == machine
                && equal.compute == compute
                && !equal.methods.is_empty()
        };
        let all: Vec<&EqualError> = document.equal_error.iter().filter(here).collect();
        let mut rows = Vec::new();
        for (scene, entry) in document.scenes.iter().enumerate() {
            for (cost, words) in COSTS {
                let of = all.iter().filter(|equal| equal.cost == cost && document.views[equal.view].scene == scene);
                let mut winners: Vec<Winner> = of.map(|equal| Winner::of(document, equal)).collect();
                winners.sort_by(|a, b| a.distance.total_cmp(&b.distance));
                if !winners.is_empty() {
                    rows.push(Row { scene: entry.name.clone(), cost, words, winners });
                }
            }
        }
        let plural = if samples == Some(1) { "sample" } else { "samples" };
        let head = format!(
            "{}: the cheapest whose surface is within half a pixel (99th percentile), {} {plural} a pixel; {}, compute {compute}",
            document.sizes_in_words(None),
            samples.unwrap_or(1),
            document.machines[machine].title(),
        );
        let said = COSTS.iter().filter_map(|(cost, words)| sentence(words, rows.iter().filter(|row| row.cost == *cost))).collect();
        (!rows.is_empty()).then_some(Verdict { machine, compute, head, said, rows })
    };
    document.targets().into_iter().filter_map(of).collect()
}

/// Who wins by a cost, and how far ours is behind.
fn sentence<'a>(cost: &str, rows: impl Iterator<Item = &'a Row>) -> Option<String> {
    let winners: Vec<&Winner> = rows.flat_map(|row| &row.winners).collect();
    let mut counts: Vec<(&str, usize)> = Vec::new();
    for winner in winners.iter().filter_map(|winner| winner.best.as_deref()) {
        match counts.iter_mut().find(|(method, _)| *method == winner) {
            Some(count) => count.1 += 1,
            None => counts.push((winner, 1)),
        }
    }
    counts.sort_by(|a, b| b.1.cmp(&a.1).then(a.0.cmp(b.0)));
    let views = if winners.len() == 1 { "view" } else { "views" };
    let mut parts: Vec<String> = counts.iter().map(|(method, count)| format!("{method} in {count}")).collect();
    let draws = winners.iter().filter(|winner| winner.note == Some(DRAW)).count();
    if draws > 0 {
        parts.push(format!("{} and another alike in {draws}", lod::METHOD.name));
    }
    let none = winners.iter().filter(|winner| winner.note == Some(NOT_REACHED)).count();
    if none > 0 {
        parts.push(format!("none in {none}"));
    }
    let apart = |ahead: bool| {
        let over = winners.iter().filter(|winner| winner.note != Some(DRAW)).filter_map(|winner| winner.over_ours);
        let factors = over.filter(|over| (*over > 1.0) == ahead).map(|over| if ahead { over } else { 1.0 / over });
        let (least, most) = factors.fold((f64::INFINITY, 0.0f64), |(least, most), factor| (least.min(factor), most.max(factor)));
        match least <= most {
            false => String::new(),
            true if ratio(least) == ratio(most) => ratio(most),
            true => format!("{} to {}", ratio(least), ratio(most)),
        }
    };
    let mut text = format!("{cost}, {} {views}: {}", winners.len(), parts.join(", "));
    for (ahead, words) in [(false, "behind"), (true, "ahead")] {
        let apart = apart(ahead);
        if !apart.is_empty() {
            text += &format!("; {} {words} by a factor of {apart}", lod::METHOD.name);
        }
    }
    (!winners.is_empty()).then_some(text)
}

/// The verdicts as text of 80 columns, with the maps.
pub fn verdict_text(verdicts: &[Verdict]) -> String {
    let mut text = String::new();
    for verdict in verdicts {
        text += &wrapped(&verdict.head, "  ");
        verdict.said.iter().for_each(|said| text += &wrapped(&format!("  {said}"), "    "));
        text += &wrapped("  radii: the cheapest, and the cheapest other's cost over lod's (below 1 lod is behind):", "    ");
        for row in &verdict.rows {
            let cells: Vec<String> = row
                .winners
                .iter()
                .map(|winner| {
                    format!("{}: {}", (winner.distance * 1000.0).round() / 1000.0, winner.name_and_ratio()).replace(' ', "\u{a0}")
                })
                .collect();
            text += &wrapped(&format!("  {}, {}: {}", row.scene, row.words, cells.join(", ")), "    ").replace('\u{a0}', " ");
        }
    }
    text
}

/// A text broken at spaces, further lines behind `indent`.
fn wrapped(text: &str, indent: &str) -> String {
    let words = text.trim_start();
    let mut lines = String::new();
    let mut line = text[..text.len() - words.len()].to_owned();
    for (k, word) in words.split(' ').enumerate() {
        if k > 0 && line.chars().count() + 1 + word.chars().count() > COLUMNS {
            lines += &(line + "\n");
            line = format!("{indent}{word}");
        } else {
            line += if k > 0 { " " } else { "" };
            line += word;
        }
    }
    lines + &line + "\n"
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_no_longer_than_a_terminal_and_lose_no_word() {
        let text = format!("  {}", ["word"; 60].join(" "));
        let broken = wrapped(&text, "    ");
        assert!(broken.lines().count() == 4 && broken.lines().all(|line| line.chars().count() <= COLUMNS));
        assert!(broken.lines().skip(1).all(|line| line.starts_with("    word")) && broken.starts_with("  word"));
        assert_eq!(broken.split_whitespace().count(), 60);
        assert_eq!([0.544, 9.99, 9.996, 43.2].map(ratio), ["0.54", "9.99", "10", "43"]);
    }
}
