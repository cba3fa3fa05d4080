//! One colour and one mark for each method, the same in every diagram and on the page.
//!
//! Colours are told apart without red and green side by side, and have a contrast of 3 to 1 or more on their ground, light or dark; marks tell them apart without colours.

use crate::method::METHODS;
use serde::Serialize;

/// The shape of a method's points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize)]
#[serde(rename_all = "lowercase")]
#[expect(missing_docs, reason = "the names say it")]
pub enum Mark {
    Circle,
    Square,
    Triangle,
    Diamond,
    Cross,
    Star,
    Wye,
    Times,
}

/// How a method is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Style {
    /// Red, green and blue on light ground.
    pub light: [u8; 3],
    /// The same on dark ground.
    pub dark: [u8; 3],
    /// Its mark.
    pub mark: Mark,
}

/// Grounds of the page.
pub const GROUNDS: [[u8; 3]; 2] = [[255, 255, 255], [22, 25, 31]];

const fn style(light: [u8; 3], dark: [u8; 3], mark: Mark) -> Style {
    Style { light, dark, mark }
}

/// Methods by name.
const KNOWN: [(&str, Style); 7] = [
    ("lod", style([0, 98, 178], [96, 180, 255], Mark::Circle)),
    ("bvh", style([196, 78, 4], [255, 156, 84], Mark::Square)),
    ("bvh6", style([176, 40, 104], [255, 140, 190], Mark::Star)),
    ("bvh32", style([132, 60, 160], [212, 160, 240], Mark::Diamond)),
    ("discrete", style([0, 122, 92], [64, 208, 164], Mark::Triangle)),
    ("reference", style([92, 98, 108], [172, 180, 190], Mark::Times)),
    ("full", style([92, 98, 108], [172, 180, 190], Mark::Times)),
];

/// For methods that came later.
const OTHERS: [Style; 3] = [
    style([128, 100, 0], [226, 194, 70], Mark::Wye),
    style([40, 104, 128], [134, 206, 228], Mark::Cross),
    style([96, 84, 40], [206, 192, 140], Mark::Diamond),
];

/// How the method of this name is drawn.
pub fn of(method: &str) -> Style {
    let known = |name: &str| KNOWN.iter().find(|(known, _)| *known == name).map(|(_, style)| *style);
    let later = || METHODS.iter().filter(|other| known(other.name).is_none()).position(|other| other.name == method);
    // A name that is in no registry: always the same of the others.
    let by_letters = || method.bytes().fold(0usize, |sum, byte| sum.wrapping_mul(31).wrapping_add(usize::from(byte)));
    known(method).unwrap_or_else(|| OTHERS[later().unwrap_or_else(by_letters) % OTHERS.len()])
}

/// Name, colour on light and on dark ground of the parts of a frame's energy, in the order of the results.
pub const PARTS: [(&str, [u8; 3], [u8; 3]); 5] = [
    ("L1", [58, 108, 158], [104, 158, 212]),
    ("L2", [42, 140, 170], [112, 206, 236]),
    ("DRAM", [192, 108, 16], [240, 164, 74]),
    ("compute", [160, 48, 112], [226, 128, 186]),
    ("leakage", [120, 124, 130], [166, 170, 176]),
];

/// Colours on light and on dark ground of what lines hold, in the order of a method's sections.
pub const KINDS: [[[u8; 3]; 2]; 8] = [
    [[0, 98, 178], [96, 180, 255]],
    [[196, 78, 4], [255, 156, 84]],
    [[0, 122, 92], [64, 208, 164]],
    [[132, 60, 160], [212, 160, 240]],
    [[128, 100, 0], [226, 194, 70]],
    [[176, 40, 104], [255, 140, 190]],
    [[40, 104, 128], [134, 206, 228]],
    [[92, 98, 108], [172, 180, 190]],
];

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    /// Contrast as the web's accessibility guidelines define it.
    fn contrast(a: [u8; 3], b: [u8; 3]) -> f64 {
        let linear = |c: u8| {
            let c = f64::from(c) / 255.0;
            if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
        };
        let light = |[r, g, b]: [u8; 3]| 0.2126 * linear(r) + 0.7152 * linear(g) + 0.0722 * linear(b);
        let (a, b) = (light(a), light(b));
        (a.max(b) + 0.05) / (a.min(b) + 0.05)
    }

    #[test]
    fn every_method_has_its_own_colour_and_mark_and_all_are_seen() {
        let styles: Vec<_> = METHODS.iter().map(|method| of(method.name)).collect();
        let colours: HashSet<_> = styles.iter().map(|style| style.light).collect();
        let marks: HashSet<_> = styles.iter().map(|style| style.mark).collect();
        assert_eq!([colours.len(), marks.len()], [METHODS.len(); 2]);
        let pairs = styles.iter().chain(&OTHERS).map(|style| (style.light, style.dark));
        for (light, dark) in pairs.chain(PARTS.map(|(_, light, dark)| (light, dark))) {
            // Methods' names are written in these colours: text asks for 4.5.
            for (colour, ground) in [(light, GROUNDS[0]), (dark, GROUNDS[1])] {
                assert!(contrast(colour, ground) >= 3.0, "{colour:?} on {ground:?}: {}", contrast(colour, ground));
            }
        }
        for style in &styles {
            assert!(contrast(style.light, GROUNDS[0]) >= 4.5 && contrast(style.dark, GROUNDS[1]) >= 4.5, "{style:?}");
        }
        assert_eq!(of("unheard of"), of("unheard of"));
    }
}
