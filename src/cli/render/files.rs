//! The files of a picture.

use crate::cli::comparison::Against;
use crate::cli::facts::Facts;
use crate::cli::pictures::{Map, error, save_shot};
use anyhow::Context;
use image::RgbImage;
use lodray::picture::{Sheet, save_png};
use lodray::study::Shot;
use std::path::Path;

/// The contact sheet.
const SHEET: &str = "sheet.png";

/// Their names; the error map is there where the picture is compared with another.
pub fn names(compare: bool) -> impl Iterator<Item = &'static str> {
    ["image.png", "levels.png", "normals.png", SHEET, "error.png"].into_iter().take(4 + usize::from(compare))
}

/// Saves all pictures and the contact sheet, one after the other: large ones take much memory.
pub fn save<'a>(
    shot: &Shot,
    truth: Option<(Against, &RgbImage)>,
    maps: impl IntoIterator<Item = &'a dyn Fn() -> Map>,
    facts: &Facts<'_>,
    out: &Path,
) -> anyhow::Result<()> {
    let mut sheet = Sheet::default();
    save_shot(shot, out, "", facts)?;
    sheet.add(facts.method, &shot.image, None);
    if let Some((against, truth)) = truth {
        sheet.add(against.name(), truth, None);
        let error = error(shot, truth);
        error.save(out, "", facts)?;
        sheet.add(&format!("difference to {}", against.name()), &error.image, Some(error.legend));
    }
    for map in maps {
        let map = map();
        map.save(out, "", facts)?;
        sheet.add(map.name, &map.image, Some(map.legend));
    }
    let path = out.join(SHEET);
    let sheet = sheet.draw(&facts.heading(), &facts.lines());
    save_png(&sheet, &facts.notes("contact sheet"), &path).with_context(|| format!("cannot write {}", path.display()))
}
