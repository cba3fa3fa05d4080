//! The map of winners: rows of scenes and costs, columns from near to far; each cell has the colour and the name of the cheapest method, and how far ours is ahead or
//! behind.

use super::canvas::{Area, FONT, TEXT, centred, short, svg};
use super::fault::{DiagramFault, wrong};
use super::marks::colour;
use crate::method::lod;
use crate::report::error_time::{Verdict, Winner};
use crate::report::palette;
use plotters::prelude::*;

/// A cell, and the names before the first.
const CELL: (i32, i32) = (104, 38);
const NAMES: i32 = 210;
/// Under the title.
const NOTE: i32 = 26;

/// The map of a verdict.
pub(super) fn winners(verdict: &Verdict) -> Result<String, DiagramFault> {
    let columns = verdict.rows.iter().map(|row| row.winners.len()).max().unwrap_or(0).max(4) as i32; // a few views
    let rows = verdict.rows.len() as i32; // a few scenes
    let size = ((NAMES + columns * CELL.0 + 14) as u32, (54 + NOTE + rows * CELL.1 + 14) as u32); // above 0
    let (first, second) = verdict.head.split_once(", ").unwrap_or((&verdict.head, ""));
    svg(size, [&format!("Winners at {first}"), second], |area| {
        let small = (FONT, TEXT - 2).into_font();
        let note = format!("from near to far; number: the cheapest other's cost over {}'s, below 1 it is behind", lod::METHOD.name);
        area.draw(&Text::new(note, (14, 2), small.clone())).map_err(wrong)?;
        for (k, row) in (0..).zip(&verdict.rows) {
            let top = NOTE + k * CELL.1;
            area.draw(&Text::new(format!("{}, {}", row.scene, row.words), (14, top + 11), (FONT, TEXT))).map_err(wrong)?;
            for (column, winner) in (0..).zip(&row.winners) {
                cell(area, winner, (NAMES + column * CELL.0, top))?;
            }
        }
        Ok(())
    })
}

fn cell(area: &Area<'_>, winner: &Winner, (left, top): (i32, i32)) -> Result<(), DiagramFault> {
    let ink = winner.best.as_deref().map_or(RGBColor(92, 98, 108), |method| colour(&palette::of(method)));
    let corners = [(left + 2, top + 2), (left + CELL.0 - 2, top + CELL.1 - 2)];
    area.draw(&Rectangle::new(corners, ink.mix(0.16).filled())).map_err(wrong)?;
    area.draw(&Rectangle::new(corners, ink.stroke_width(1))).map_err(wrong)?;
    let middle = left + CELL.0 / 2;
    area.draw(&Text::new(winner.name_and_ratio(), (middle, top + 13), centred(TEXT - 1, &ink))).map_err(wrong)?;
    let place = format!("{} radii", short(winner.distance));
    area.draw(&Text::new(place, (middle, top + 27), centred(TEXT - 3, &RGBColor(70, 76, 86)))).map_err(wrong)
}
