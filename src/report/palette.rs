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
    Pentagram,
    GreekCross,
    Hexagon,
    Hourglass,
    Bowtie,
    Bar,
    Post,
    Arrow,
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
const KNOWN: [(&str, Style); 17] = [
    ("lod", style([15, 107, 189], [76, 173, 248], Mark::Circle)),
    ("bvh", style([193, 76, 2], [252, 154, 84], Mark::Square)),
    ("bvh6", style([155, 20, 89], [240, 123, 174], Mark::Star)),
    ("bvh32", style([128, 57, 158], [197, 149, 220], Mark::Diamond)),
    ("binary16", style([123, 16, 248], [234, 56, 172], Mark::Hourglass)),
    ("discrete", style([14, 131, 97], [65, 206, 160], Mark::Triangle)),
    ("stochastic", style([38, 5, 0], [129, 255, 188], Mark::Arrow)),
    ("chunked", style([48, 32, 120], [132, 108, 252], Mark::Pentagram)),
    ("grid", style([13, 60, 47], [191, 255, 0], Mark::Hexagon)),
    ("cluster", style([24, 2, 35], [255, 253, 246], Mark::Bowtie)),
    ("cluster-paper", style([84, 56, 202], [225, 85, 7], Mark::Bar)),
    ("rlod", style([74, 18, 82], [31, 161, 36], Mark::Post)),
    ("input-bvh", style([142, 113, 48], [228, 195, 71], Mark::Wye)),
    ("input-bvh6", style([13, 99, 124], [137, 206, 230], Mark::Cross)),
    ("input-bvh32", style([78, 30, 0], [168, 120, 90], Mark::GreekCross)),
    ("reference", style([82, 89, 101], [188, 193, 204], Mark::Times)),
    ("full", style([82, 89, 101], [188, 193, 204], Mark::Times)),
];

/// For methods that came later.
const OTHERS: [Style; 1] = [style([105, 90, 46], [204, 190, 138], Mark::Diamond)];

/// How the method of this name is drawn.
pub fn of(method: &str) -> Style {
    let known = |name: &str| KNOWN.iter().find(|(known, _)| *known == name).map(|(_, style)| *style);
    let later = || METHODS.iter().filter(|other| known(other.name).is_none()).position(|other| other.name == method);
    // A name that is in no registry: always the same of the others.
    let by_letters = || method.bytes().fold(0usize, |sum, byte| sum.wrapping_mul(31).wrapping_add(usize::from(byte)));
    known(method).unwrap_or_else(|| OTHERS[later().unwrap_or_else(by_letters) % OTHERS.len()])
}

/// Name, colour on light and on dark ground of the parts of a frame's energy, in the order of the results; and behind them of other parts of a machine.
pub const PARTS: [(&str, [u8; 3], [u8; 3]); 7] = [
    ("L1", [61, 108, 157], [96, 157, 210]),
    ("L2", [50, 140, 169], [129, 213, 238]),
    ("DRAM", [193, 108, 17], [240, 165, 77]),
    ("compute", [159, 48, 112], [217, 122, 180]),
    ("leakage", [122, 124, 132], [171, 171, 173]),
    ("crossbar", [26, 126, 96], [76, 210, 164]),
    ("unit", [119, 50, 151], [212, 161, 243]),
];

/// How many of them are parts of the energy.
pub const ENERGY_PARTS: usize = 5;

/// How many ways of hatching there are; the first is none.
pub const HATCHES: usize = 8;

/// What a context waits for, or a machine is limited by: the colour of its part of the machine, and in that its own hatching, which is its place in the list. The names of one
/// place are of one thing.
const THINGS: [(&str, &[&[&str]]); 6] = [
    ("L1", &[&["l1_turn", "l1_banks"], &["l1_queue", "l1_queues"], &["l1_mshr", "l1_mshrs"], &["l1_look_up"]]),
    ("L2", &[&["l2_turn", "l2_banks"], &["l2_queue", "l2_queues"], &["l2_mshr", "l2_mshrs"], &["l2_look_up"]]),
    ("crossbar", &[&["crossbar_request", "crossbar_requests"], &["crossbar_answer", "crossbar_answers"]]),
    (
        "DRAM",
        &[
            &["dram_bus"],
            &["dram_queue", "dram_queues"],
            &["dram_bank", "dram_banks"],
            &["dram_conflict"],
            &["dram_activate", "dram_activates"],
            &["dram_opening"],
            &["dram_access"],
        ],
    ),
    (
        "compute",
        &[
            &["lod_test", "lod_test_by"],
            &["child_test"],
            &["tri_test", "start_test"],
            &["tessellate"],
            &["ray_setup", "start_setup"],
            &["hit_divide", "start_divide"],
            &["bary_map"],
        ],
    ),
    ("unit", &[&["port"], &["stack"], &["hit_port"], &["node_address"], &["hit_select"], &["tree_deciders"], &["node_deciders"]]),
];

/// Name, part of [`PARTS`] and hatching, below [`HATCHES`], of everything that a context waits for or a machine is limited by.
pub fn things() -> impl Iterator<Item = (&'static str, usize, usize)> {
    let part = |name: &str| PARTS.iter().position(|part| part.0 == name).unwrap_or(PARTS.len());
    THINGS.iter().flat_map(move |(of, things)| {
        (0..).zip(*things).flat_map(move |(hatch, names)| names.iter().map(move |name| (*name, part(of), hatch)))
    })
}

/// Name, colour on light and on dark ground of what lines hold.
pub const SECTIONS: [(&str, [u8; 3], [u8; 3]); 5] = [
    ("bvh_node", [11, 104, 185], [89, 175, 251]),
    ("l0_record", [214, 100, 23], [254, 160, 88]),
    ("split", [7, 117, 84], [69, 208, 163]),
    ("vertex_data", [128, 58, 157], [210, 154, 226]),
    ("leaf", [127, 98, 0], [223, 191, 65]),
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::block::Operation;
    use crate::method::lod;
    use crate::report::result::{LIMITS, part_of};
    use crate::sim::replay::Cause;
    use crate::sim::unit::State;
    use std::collections::{BTreeSet, HashSet};

    /// A channel as an amount of light.
    fn linear(channel: u8) -> f64 {
        let c = f64::from(channel) / 255.0;
        if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
    }

    /// What eyes see of linear RGB: normal ones, and those without one kind of cones, by the model of Machado, Oliveira and Fernandes (2009) at severity 1.
    const EYES: [(&str, [[f64; 3]; 3]); 4] = [
        ("normal", [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        ("protanopia", [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]]),
        ("deuteranopia", [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]]),
        ("tritanopia", [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]]),
    ];

    fn product(matrix: &[[f64; 3]; 3], v: [f64; 3]) -> [f64; 3] {
        matrix.map(|row| row.iter().zip(v).map(|(a, b)| a * b).sum())
    }

    /// CIE L*a*b* under D65 of a colour, seen with such eyes.
    fn lab(colour: [u8; 3], eyes: &[[f64; 3]; 3]) -> [f64; 3] {
        const XYZ: [[f64; 3]; 3] =
            [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]];
        const WHITE: [f64; 3] = [0.95047, 1.0, 1.08883];
        let seen = product(eyes, colour.map(linear)).map(|c| c.clamp(0.0, 1.0));
        let xyz = product(&XYZ, seen);
        let f = |t: f64| if t > 216.0 / 24389.0 { t.cbrt() } else { (24389.0 / 27.0 * t + 16.0) / 116.0 };
        let [x, y, z] = [0, 1, 2].map(|k: usize| f(xyz[k] / WHITE[k]));
        [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
    }

    /// CIE76.
    fn difference(a: [f64; 3], b: [f64; 3]) -> f64 {
        a.iter().zip(b).map(|(a, b)| (a - b) * (a - b)).sum::<f64>().sqrt()
    }

    /// Least difference of two colours that may meet in a diagram.
    const LEAST: f64 = 8.0;

    /// What may stand in one diagram: name, colours on both grounds, and hatching.
    type Series = (String, [[u8; 3]; 2], usize);

    #[test]
    fn what_meets_in_a_diagram_is_told_apart_by_all_eyes() {
        let of_part = |part: usize| [PARTS[part].1, PARTS[part].2];
        let thing = |name: &str| {
            let (_, part, hatch) = things().find(|thing| thing.0 == name).unwrap_or_else(|| panic!("{name} has no colour"));
            assert!(part < PARTS.len() && hatch < HATCHES, "{name}");
            (name.to_owned(), of_part(part), hatch)
        };
        // What remains is of the colour of leakage.
        let rest: Series = ("all others".to_owned(), of_part(ENERGY_PARTS - 1), 0);
        let names = lod::METHOD.unit.into_iter().flat_map(|unit| unit.blocks).map(|block| block.name());
        let limits: BTreeSet<&str> = LIMITS.into_iter().chain(names).chain(["start_setup", "start_test"]).collect();
        let causes: BTreeSet<&str> =
            Cause::NAMES.into_iter().chain(State::ALL.iter().map(|&state| part_of(state))).filter(|name| *name != "idle").collect();
        let plain = |name: &str, colours| (name.to_owned(), colours, 0);
        let methods = METHODS.iter().map(|method| (method.name, of(method.name)));
        let others = OTHERS.iter().map(|style| ("a later method", *style));
        // A block and what stands for it in another unit are never in one machine.
        let limits = limits.into_iter().filter(|name| !matches!(*name, "lod_test_by" | "start_setup" | "start_test" | "start_divide"));
        let diagrams: [(&str, Vec<Series>); 5] = [
            ("methods", methods.chain(others).map(|(name, style)| plain(name, [style.light, style.dark])).collect()),
            ("parts of the energy", (0..ENERGY_PARTS).map(|part| plain(PARTS[part].0, of_part(part))).collect()),
            ("what lines hold", SECTIONS.iter().map(|(name, light, dark)| plain(name, [*light, *dark])).collect()),
            ("what held the rays", causes.into_iter().map(thing).chain([rest.clone()]).collect()),
            ("limits", limits.map(thing).chain([rest]).collect()),
        ];
        let (mut by_colour, mut by_hatching) = (0, 0);
        for (diagram, series) in &diagrams {
            for (k, a) in series.iter().enumerate() {
                for b in &series[..k] {
                    if a.2 != b.2 {
                        by_hatching += 1;
                        continue;
                    }
                    by_colour += 1;
                    for (ground, (one, other)) in ["light", "dark"].into_iter().zip(a.1.into_iter().zip(b.1)) {
                        for (eyes, seen) in &EYES {
                            let d = difference(lab(one, seen), lab(other, seen));
                            assert!(d >= LEAST, "{diagram}: {} and {} on {ground} ground, {eyes}: {d:.1}", a.0, b.0);
                        }
                    }
                }
            }
        }
        println!("{by_colour} pairs told apart by colour, on two grounds with four kinds of eyes; {by_hatching} by hatching");
        assert!(by_colour > 100 && by_hatching > 300);
        // The model itself: red and green of one lightness are one colour without one of their cones, and grey is grey for all.
        for (eyes, seen) in &EYES {
            assert!(difference(lab([128; 3], seen), lab([128; 3], &EYES[0].1)) < 0.1, "{eyes}");
        }
        let [red, green] = [[176, 40, 104], [0, 122, 92]];
        assert!(
            difference(lab(red, &EYES[2].1), lab(green, &EYES[2].1)) < 3.0
                && difference(lab(red, &EYES[0].1), lab(green, &EYES[0].1)) > 60.0
        );
    }

    #[test]
    fn what_lines_hold_and_what_is_waited_for_have_a_colour_by_name() {
        let names: Vec<_> = things().map(|thing| thing.0).collect();
        assert_eq!(names.iter().collect::<HashSet<_>>().len(), names.len(), "one thing, one colour");
        for operation in Operation::ALL {
            // Only those that contexts ask for can limit them.
            let is_waited_for = lod::METHOD.unit.is_some_and(|unit| unit.blocks.contains(&operation));
            assert!(!is_waited_for || names.contains(&operation.name()), "{}", operation.name());
        }
    }

    /// Contrast as the web's accessibility guidelines define it.
    fn contrast(a: [u8; 3], b: [u8; 3]) -> f64 {
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
