//! What a flight gives: numbered pictures, and figures of every frame.

use crate::cli::folder::{Overrule, RunFolder};
use crate::cli::output::{print_json, print_table, remark};
use anyhow::Context;
use lodray::picture::{Pops, save_png};
use lodray::study::{Flown, Shot, count};
use serde::Serialize;
use std::path::Path;
use std::process::ExitCode;

/// Figures of every frame.
const FIGURES: &str = "flight.json";

/// What a flight gave.
#[derive(Serialize)]
pub struct Report {
    pub method: &'static str,
    pub delta: f64,
    pub size: [u32; 2],
    pub frames: Vec<Flown>,
    /// The worst of all frames; none among several models.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub worst: Option<Pops>,
}

/// Where frames and their figures go.
pub struct Kept<'a> {
    out: &'a Path,
    folder: RunFolder,
    /// Names of the frames' pictures, if they are kept.
    pictures: Vec<String>,
}

impl<'a> Kept<'a> {
    /// Opens the folder `out` for this many pictures. `inputs` are the files that they come from.
    pub fn open(out: &'a Path, pictures: usize, inputs: &[&Path], overrule: &Overrule) -> anyhow::Result<Self> {
        let pictures: Vec<_> = (0..pictures).map(picture).collect();
        let names = pictures.iter().map(String::as_str).chain([FIGURES]);
        Ok(Self { out, folder: RunFolder::open(out, names, inputs, overrule)?, pictures })
    }

    /// Keeps the picture of a frame.
    pub fn save(&self, frame: usize, shot: &Shot) -> anyhow::Result<()> {
        let Some(name) = self.pictures.get(frame) else { return Ok(()) };
        let path = self.folder.staging().join(name);
        save_png(&shot.image, &[], &path).with_context(|| format!("cannot write {}", path.display()))
    }

    /// Keeps the figures, and says what they are.
    pub fn finish(self, is_json: bool, report: &Report) -> anyhow::Result<ExitCode> {
        let path = self.folder.staging().join(FIGURES);
        std::fs::write(&path, serde_json::to_string_pretty(report)?).with_context(|| format!("cannot write {}", path.display()))?;
        self.folder.finish()?;
        if is_json {
            print_json(report)?;
        } else {
            print_table(&table(report))?;
            remark(&format!("{} and {FIGURES} in {}", count(self.pictures.len() as u64, "frame"), self.out.display()))?;
        }
        Ok(ExitCode::SUCCESS)
    }
}

fn picture(frame: usize) -> String {
    format!("frame-{frame:05}.png")
}

/// The most of all frames.
pub fn worst(frames: &[Flown]) -> Pops {
    frames.iter().filter_map(|frame| frame.pops).fold(Pops::default(), |mut most, pops| {
        for (most, own) in [(&mut most.surface, pops.surface), (&mut most.colour, pops.colour)] {
            most.mean = most.mean.max(own.mean);
            most.percentile_999 = most.percentile_999.max(own.percentile_999);
            most.largest = most.largest.max(own.largest);
        }
        (most.pixels, most.left_out) = (most.pixels.max(pops.pixels), most.left_out.max(pops.left_out));
        most
    })
}

fn table(report: &Report) -> String {
    if report.worst.is_none() {
        return plain_table(report);
    }
    let mut text = format!("{:>6} {:>8} {:>26} {:>26}\n", "", "", "surface pops, pixel widths", "colour pops, 0 to 255");
    text += &format!("{:>6} {:>8} {:>12} {:>13} {:>12} {:>13}  {}\n", "frame", "level", "99.9 %", "largest", "99.9 %", "largest", "chosen");
    for Flown { frame, mean_level, choices, pops, .. } in &report.frames {
        let Pops { surface, colour, .. } = pops.unwrap_or_default();
        let line = format!(
            "{frame:>6} {mean_level:>8.3} {:>12.4} {:>13.4} {:>12.1} {:>13.1}  {}",
            surface.percentile_999,
            surface.largest,
            colour.percentile_999,
            colour.largest,
            chosen(choices)
        );
        text += line.trim_end();
        text.push('\n');
    }
    text
}

/// The same of several models.
fn plain_table(report: &Report) -> String {
    let mut text = format!("{:>6} {:>8}  {}\n", "frame", "level", "chosen");
    for Flown { frame, mean_level, choices, .. } in &report.frames {
        text += format!("{frame:>6} {mean_level:>8.3}  {}", chosen(choices)).trim_end();
        text.push('\n');
    }
    text
}

/// What a method chose, in a line.
fn chosen(choices: &[(&str, String)]) -> String {
    choices.iter().map(|(name, value)| format!("{name} {value}")).collect::<Vec<_>>().join(", ")
}
