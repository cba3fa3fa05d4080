//! Save files for waveform viewers: which signals, in which order and groups.

use std::collections::BTreeMap;
use std::fmt::Write;

/// How GTKWave shows a signal, as its trace flags: right-justified, and in which base; a name is shown as it is.
const HEX: &str = "@22";
const BITS: &str = "@28";
const DECIMAL: &str = "@24";
const SIGNED: &str = "@420";

/// Signals of one scope that are shown alike.
type Row = (&'static str, &'static str, &'static [&'static str]);

const UNIT: &str = "traversal_unit";
const CONTEXT: &str = "traversal_unit.g_context[0].u_context";

/// The groups, the ray's journey first.
const GROUPS: &[(&str, &[Row])] = &[
    (
        "Journey",
        &[
            (UNIT, BITS, &["clk_i"]),
            (CONTEXT, BITS, &["state"]),
            (CONTEXT, DECIMAL, &["entry.kind", "entry.level", "entry.index", "entry.t_near", "tree_q"]),
            (CONTEXT, DECIMAL, &["lod_q.refine", "lod_q.s0", "lod_q.s1", "lod_q.s2", "u_stack.len_q"]),
            (CONTEXT, BITS, &["u_closest.known_q"]),
            (CONTEXT, HEX, &["u_closest.t_max_q"]),
        ],
    ),
    (
        "Memory",
        &[
            (UNIT, BITS, &["mem_valid_o", "mem_ready_i"]),
            (UNIT, HEX, &["mem_o.tag", "mem_o.address"]),
            (UNIT, BITS, &["mem_valid_i"]),
            (UNIT, HEX, &["mem_i.tag"]),
            (CONTEXT, BITS, &["want_q", "waiting_q"]),
        ],
    ),
    (
        "Children",
        &[
            (UNIT, BITS, &["u_child_test.valid_i", "u_child_test.in_i.present", "u_child_test.in_i.tree", "u_child_test.valid_o"]),
            (CONTEXT, DECIMAL, &["sorted_q.count", "sorted_q.order[0]", "sorted_q.t_near[0]", "count_q"]),
        ],
    ),
    (
        "Level_of_detail",
        &[
            (UNIT, BITS, &["u_lod_test.valid_i"]),
            (UNIT, DECIMAL, &["u_lod_test.in_i.e0", "u_lod_test.in_i.e1", "u_lod_test.in_i.e2"]),
            (UNIT, BITS, &["u_lod_test.valid_o", "u_lod_test.out_o.refine"]),
        ],
    ),
    (
        "Morph",
        &[
            (UNIT, BITS, &["u_tessellate.valid_i", "u_tessellate.in_i.compact"]),
            (UNIT, DECIMAL, &["u_tessellate.in_i.grid"]),
            (UNIT, BITS, &["u_tessellate.valid_o"]),
            (CONTEXT, SIGNED, &["p0.x", "p0.y", "p0.z", "g0.x", "g0.y", "g0.z", "q0.x", "q0.y", "q0.z"]),
        ],
    ),
    (
        "Triangles",
        &[
            (UNIT, BITS, &["u_tri_test.valid_i", "u_tri_test.valid_o", "u_tri_test.out_o.hit", "u_tri_test.out_o.front"]),
            (CONTEXT, DECIMAL, &["left_q", "next_q", "pending_q"]),
            (UNIT, DECIMAL, &["u_queue.len_q"]),
        ],
    ),
    (
        "Division",
        &[
            (UNIT, BITS, &["u_divide.valid_i", "u_divide.ready_o"]),
            (UNIT, HEX, &["u_divide.in_i.numerator", "u_divide.in_i.denominator"]),
            (UNIT, BITS, &["u_divide.valid_o"]),
            (UNIT, HEX, &["u_divide.out_o.quotient"]),
        ],
    ),
    (
        "Comparison",
        &[
            (UNIT, BITS, &["u_hit_select.valid_i"]),
            (UNIT, HEX, &["u_hit_select.in_i.t", "u_hit_select.in_i.best_t"]),
            (UNIT, BITS, &["u_hit_select.valid_o", "u_hit_select.out_o.closer"]),
        ],
    ),
    (
        "Full_resolution",
        &[
            (UNIT, BITS, &["u_bary_map.valid_i"]),
            (UNIT, DECIMAL, &["u_bary_map.in_i.levels", "u_bary_map.in_i.node"]),
            (UNIT, BITS, &["u_bary_map.valid_o"]),
            (UNIT, DECIMAL, &["u_bary_map.out_o.node"]),
            (UNIT, HEX, &["u_bary_map.out_o.b0", "u_bary_map.out_o.b1", "u_bary_map.out_o.b2"]),
        ],
    ),
    (
        "Addresses",
        &[
            (UNIT, BITS, &["u_node_address.valid_i", "u_node_address.ready_o"]),
            (UNIT, HEX, &["u_node_address.in_i.base", "u_node_address.in_i.start", "u_node_address.in_i.place"]),
            (UNIT, DECIMAL, &["u_node_address.in_i.level", "u_node_address.in_i.index"]),
        ],
    ),
    (
        "Ray_in",
        &[
            (UNIT, BITS, &["valid_i", "ready_o"]),
            (UNIT, SIGNED, &["in_i.ray.origin.x", "in_i.ray.origin.y", "in_i.ray.origin.z"]),
            (UNIT, SIGNED, &["in_i.ray.direction.x", "in_i.ray.direction.y", "in_i.ray.direction.z"]),
            (UNIT, BITS, &["u_setup.valid_i", "u_setup.valid_o"]),
        ],
    ),
    (
        "Hit_out",
        &[
            (UNIT, BITS, &["valid_o", "ready_i", "out_o.found", "out_o.hit.front"]),
            (UNIT, HEX, &["out_o.hit.t"]),
            (UNIT, DECIMAL, &["out_o.hit.tree", "out_o.hit.level", "out_o.hit.node", "out_o.hit.full_node"]),
            (UNIT, HEX, &["out_o.hit.b0", "out_o.hit.b1", "out_o.hit.b2"]),
        ],
    ),
];

/// Path and flags of every signal of a group.
fn signals(rows: &'static [Row]) -> impl Iterator<Item = (String, &'static str)> {
    rows.iter().flat_map(|(scope, flags, names)| names.iter().map(move |name| (format!("{scope}.{name}"), *flags)))
}

/// GTKWave's save file for the waveform in file `vcd`, whose signals have these widths.
///
/// GTKWave takes a relative path from the folder that it was started in, so it should be absolute.
pub fn gtkwave_save(vcd: &str, widths: &BTreeMap<String, u32>) -> String {
    let mut text = format!(
        "[*] One ray through traversal_unit (lodray trace)\n[dumpfile] \"{vcd}\"\n[timestart] 0\n[size] 1600 1000\n[pos] -1 -1\n*-9.0 0\n[signals_width] 260\n[sst_expanded] 0\n"
    );
    for (group, rows) in GROUPS {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "@800200\n-{group}");
        for (path, flags) in signals(rows) {
            let width = widths.get(&path).copied().unwrap_or(1);
            let range = if width > 1 { format!("[{}:0]", width - 1) } else { String::new() };
            let _ = writeln!(text, "{flags}\n{path}{range}");
        }
        let _ = writeln!(text, "@1000200\n-{group}");
    }
    text
}

/// A command file for Surfer that shows the same signals.
pub fn surfer_commands() -> String {
    let mut text = String::new();
    for (group, rows) in GROUPS {
        let _ = writeln!(text, "divider_add {group}");
        for (path, _) in signals(rows) {
            let _ = writeln!(text, "variable_add {path}");
        }
    }
    text + "zoom_fit\n"
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::hardware::Hardware;
    use crate::hardware::ports::SceneConfig;
    use crate::sim::unit::TraversalUnit;
    use crate::sim::unit::wave::Waves;

    #[test]
    fn every_signal_shown_is_in_the_waveform() {
        let unit = TraversalUnit::new(Hardware::one_context(), SceneConfig::default());
        let waves = Waves::new(unit).unwrap();
        let shown: Vec<String> = GROUPS.iter().flat_map(|(_, rows)| signals(rows)).map(|(path, _)| path).collect();
        assert!(shown.len() > 50);
        for path in shown {
            assert!(path == "traversal_unit.clk_i" || waves.widths().contains_key(&path), "{path}");
        }
    }
}
