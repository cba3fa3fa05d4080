//! `rtl/lod_pkg.sv` of a hardware.

mod numbers;
mod structs;

use super::{Fetch, Hardware, RayError, State};
use std::fmt::Write;

/// What no value changes: the head, functions of widths, and what passes between two modules of the unit.
const HEAD: &str = include_str!("head.sv");
const FUNCTIONS: &str = include_str!("functions.sv");
const UNIT: &str = include_str!("unit.sv");

impl Hardware {
    /// The text of `rtl/lod_pkg.sv` for this hardware: every width, size, latency and packed struct of the RTL.
    pub fn package(&self) -> String {
        let mut out = HEAD.to_owned();
        numbers::print(self, &mut out);
        out += FUNCTIONS;
        let structs = structs::all();
        structs.iter().for_each(|of| of.print(&structs, &mut out));
        let states: Vec<(&str, u32, &str)> = State::ALL.iter().map(|&state| (state.name(), state as u32, "")).collect();
        enumeration("State of a context.", "context_state_t", &states, &mut out);
        let fetches = [
            ("NODE", Fetch::Node as u32, "quad-BVH node"),
            ("RECORD", Fetch::Record as u32, "L0 record"),
            (
                "SPLIT",
                Fetch::Split as u32,
                "split: of a node whose children are nodes its record, and inserted vertices where they are not in that",
            ),
        ];
        enumeration("What a context fetches.", "fetch_t", &fetches, &mut out);
        let error = |error: RayError| (error.named().0, error as u32, error.named().1);
        let errors: Vec<(&str, u32, &str)> = [("ERROR_NONE", 0, "")].into_iter().chain(RayError::ALL.map(error)).collect();
        enumeration("Why a ray ended early.", "ray_error_t", &errors, &mut out);
        out + UNIT
    }
}

/// An enum of as many bits as its largest member needs.
fn enumeration(heading: &str, name: &str, members: &[(&str, u32, &str)], out: &mut String) {
    let bits = members.iter().map(|member| u32::BITS - member.1.leading_zeros()).max().unwrap_or(1);
    let longest = members.iter().map(|member| member.0.len()).max().unwrap_or(0);
    let _ = write!(out, "\n  // {heading}\n  typedef enum logic [{}:0] {{\n", bits - 1);
    for (at, (member, number, comment)) in members.iter().enumerate() {
        let comma = if at + 1 < members.len() { "," } else { "" };
        let line = format!("    {member:longest$} = {bits}'d{number}{comma}");
        let _ = match *comment {
            "" => writeln!(out, "{line}"),
            // Where the last member has no comma its comment keeps the column.
            comment => writeln!(out, "{line}{}  // {comment}", if comma.is_empty() { " " } else { "" }),
        };
    }
    let _ = writeln!(out, "  }} {name};");
}
