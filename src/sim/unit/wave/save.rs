//! Save files for waveform viewers: which signals, in which order and groups.

use crate::sim::unit::State;
use std::collections::BTreeMap;
use std::fmt::Write;

/// How GTKWave shows a signal: its trace flags, right-justified hexadecimal, binary and decimal, and through a file of names.
const HEX: &str = "@22";
const BITS: &str = "@28";
const DECIMAL: &str = "@24";
const NAMES: &str = "@2022";

/// A signal to show: path and GTKWave's flags.
type Shown = (String, &'static str);

/// The groups of signals, the ray's journey first.
fn groups() -> Vec<(&'static str, Vec<Shown>)> {
    let top = |name: &str| format!("traversal_unit.{name}");
    let context = |name: &str| format!("traversal_unit.g_context[0].u_context.{name}");
    let of = |flags: &'static str, names: &[&str], path: &dyn Fn(&str) -> String| -> Vec<Shown> {
        names.iter().map(|name| (path(name), flags)).collect()
    };
    let mut all = vec![
        ("Clock", of(BITS, &["clk_i"], &top)),
        (
            "Journey",
            [
                of(NAMES, &["state_q"], &context),
                of(DECIMAL, &["tree_q", "level_q", "node_q"], &context),
                of(HEX, &["lod_q", "entry_q"], &context),
                of(DECIMAL, &["u_stack.len_q"], &context),
                of(BITS, &["u_closest.known_q"], &context),
                of(HEX, &["u_closest.t_max_q"], &context),
            ]
            .concat(),
        ),
        (
            "Memory",
            [
                of(BITS, &["mem_valid_o", "mem_ready_i"], &top),
                of(HEX, &["mem_o"], &top),
                of(BITS, &["mem_valid_i"], &top),
                of(HEX, &["mem_i"], &top),
                of(BITS, &["want_q", "waiting_q", "base_want_q", "base_ready_q"], &context),
            ]
            .concat(),
        ),
    ];
    let blocks = [
        ("Children", "child_test"),
        ("Level_of_detail", "lod_test"),
        ("Morph", "tessellate"),
        ("Triangles", "tri_test"),
        ("Division", "hit_divide"),
        ("Comparison", "hit_select"),
        ("Full_resolution", "bary_map"),
        ("Ray_setup", "ray_setup"),
        ("Tree_base", "tree_base"),
        ("Line_address", "node_address"),
    ];
    for (group, block) in blocks {
        let port = |name: &str| top(&format!("u_{block}.{name}"));
        let mut signals = [of(BITS, &["valid_i", "ready_o"], &port), of(HEX, &["in_i"], &port)].concat();
        signals.extend([of(BITS, &["valid_o"], &port), of(HEX, &["out_o"], &port)].concat());
        match block {
            "child_test" => signals.extend(of(DECIMAL, &["count_q"], &context)),
            "tri_test" => {
                signals.extend(of(DECIMAL, &["left_q", "next_q", "pending_q"], &context));
                signals.extend(of(DECIMAL, &["u_queue.len_q"], &top));
            }
            _ => (),
        }
        all.push((group, signals));
    }
    let ray = [of(BITS, &["valid_i", "ready_o"], &top), of(HEX, &["in_i"], &top)].concat();
    let hit = [of(BITS, &["valid_o", "ready_i"], &top), of(HEX, &["out_o"], &top)].concat();
    all.extend([("Ray_in", ray), ("Hit_out", hit)]);
    all
}

/// GTKWave's save file for the waveform in file `vcd`, whose signals have these widths; `states` is the file of [`gtkwave_states`].
pub fn gtkwave_save(vcd: &str, states: &str, widths: &BTreeMap<String, u32>) -> String {
    let mut text = format!(
        "[*] One ray through traversal_unit (lodray trace)\n[dumpfile] \"{vcd}\"\n[timestart] 0\n[size] 1600 1000\n[pos] -1 -1\n*-8.0 0\n[signals_width] 300\n[sst_expanded] 0\n"
    );
    for (group, signals) in groups() {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "@800200\n-{group}");
        for (path, flags) in signals {
            let width = widths.get(&path).copied().unwrap_or(1);
            let range = if width > 1 { format!("[{}:0]", width - 1) } else { String::new() };
            let names = if flags == NAMES { format!("^1 {states}\n") } else { String::new() };
            let _ = writeln!(text, "{flags}\n{names}{path}{range}");
        }
        let _ = writeln!(text, "@1000200\n-{group}");
    }
    text
}

/// Names of the states by their numbers, as GTKWave's translation of hexadecimal values takes them.
pub fn gtkwave_states() -> String {
    State::ALL.iter().fold(String::new(), |text, &state| text + &format!("{:02X} {}\n", state as u8, state.name()))
}

/// A command file for Surfer that shows the same signals.
pub fn surfer_commands() -> String {
    let mut text = String::new();
    for (group, signals) in groups() {
        let _ = writeln!(text, "divider_add {group}");
        for (path, _) in signals {
            let _ = writeln!(text, "variable_add {path}");
        }
    }
    text + "zoom_fit\n"
}
