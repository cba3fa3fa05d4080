//! Constructs that the free tools reject, or take and get wrong: none may stand in `rtl/`.

use super::code;

/// Words, and why they are not used.
const WORDS: [(&str, &str); 13] = [
    ("return", "Yosys rejects it; assign to the function's name"),
    ("import", "Yosys rejects it; write lod_pkg::"),
    ("inside", "Yosys rejects it"),
    ("foreach", "Yosys rejects it"),
    ("break", "Yosys rejects it"),
    ("continue", "Yosys rejects it"),
    ("interface", "the design has none"),
    ("modport", "the design has none"),
    ("property", "assertions are immediate"),
    ("sequence", "assertions are immediate"),
    ("initial", "registers start undefined"),
    ("reg", "logic says it"),
    ("union", "structs only"),
];
/// Signs (spaces left out), and why they are not used.
const SIGNS: [(&str, &str); 6] = [
    ("'{", "Yosys rejects assignment patterns; concatenate"),
    ("{<<", "Yosys rejects streaming"),
    ("{>>", "Yosys rejects streaming"),
    ("$bits(", "Yosys rejects $bits of a type; use the localparam of the width"),
    ("typedeflogicsigned", "arrays of a signed typedef compare unsigned in Yosys"),
    ("parametertype", "Yosys rejects type parameters"),
];

/// Every don't of a file, with its line.
pub fn donts(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut say = |line: usize, what: &str, why: &str| found.push(format!("line {}: {what}: {why}", line + 1));
    for (at, raw) in text.lines().enumerate() {
        if raw.contains("verilator") || raw.contains("lint_off") {
            say(at, raw.trim(), "waivers stand in lint.vlt, each with its reason");
        }
        let line = code(raw);
        let dense: String = line.split_whitespace().collect();
        let words: Vec<&str> = line.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).filter(|word| !word.is_empty()).collect();
        for (word, why) in WORDS {
            if words.contains(&word) {
                say(at, word, why);
            }
        }
        for (sign, why) in SIGNS {
            if dense.contains(sign) {
                say(at, sign, why);
            }
        }
        if negated_cast(&dense) {
            say(at, line.trim(), "Yosys rejects a cast of a negated width; negate the cast");
        }
        if array_of_structs(&line) {
            say(at, line.trim(), "Yosys leaves elements of arrays of structs undriven; keep them flat");
        }
        if words.first() == Some(&"parameter") && line.split('=').next().is_some_and(|left| left.trim_end().ends_with(']')) {
            say(at, line.trim(), "Yosys rejects array parameters");
        }
    }
    found
}

/// `-17'(x)`, where the minus is no subtraction.
fn negated_cast(dense: &str) -> bool {
    dense.match_indices("'(").any(|(at, _)| {
        let before = dense[..at].trim_end_matches(|c: char| c.is_ascii_alphanumeric() || c == '_' || c == ':');
        before.strip_suffix('-').is_some_and(|left| !left.ends_with(|c: char| c.is_ascii_alphanumeric() || "_)]}".contains(c)))
    })
}

/// `foo_t x [N]` or `foo_t [N-1:0] x`.
fn array_of_structs(line: &str) -> bool {
    let mut words = line.split_whitespace().skip_while(|word| matches!(*word, "input" | "output" | "var" | "typedef"));
    let Some(kind) = words.next() else { return false };
    let (kind, bracket) = kind.split_once('[').map_or((kind, false), |(kind, _)| (kind, true));
    let is_type = kind.ends_with("_t") && kind.chars().all(|c| c.is_ascii_alphanumeric() || c == '_' || c == ':');
    let declares = bracket || words.next().is_some_and(|next| next.starts_with('[') || (!next.starts_with('=') && next.contains('[')));
    is_type && (declares || words.next().is_some_and(|next| next.starts_with('[')))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_is_found() {
        let bad = [
            "  x = '{1, 2};",
            "  return x;",
            "import lod_pkg::*;",
            "  if (a inside {1, 2}) b;",
            "  foreach (v[i]) x;",
            "  break;",
            "  y = {<< {x}};",
            "  localparam N = $bits(lod_pkg::ray_t);",
            "  localparam N = $bits (lod_pkg::ray_t);",
            "  parameter type T = logic,",
            "  parameter int unsigned WIDTHS [2] = 3,",
            "  y = -17'(x);",
            "  assign y = -lod_pkg::W'(x);",
            "  assign y = a * -W'(x);",
            "  assert property (@(posedge clk_i) a |-> b);",
            "  lod_pkg::point_t v [4];",
            "  lod_pkg::point_t [3:0] v;",
            "  lod_pkg::point_t[3:0] v;",
            "  input point_t [3:0] v_i,",
            "  lod_pkg::point_t v[4];",
            "  typedef logic signed [7:0] byte_t;",
            "  reg [3:0] x;",
            "  // verilator lint_off WIDTH",
            "  initial x = 0;",
        ];
        for text in bad {
            assert!(!donts(text).is_empty(), "{text}");
        }
    }

    #[test]
    fn what_is_right_is_left_alone() {
        let good = [
            "  // return and import and '{ in a comment",
            "  assign y = a - W'(x);",
            "  assign y = f(a) - lod_pkg::W'(x) - (W+1)'(z);",
            "  lod_pkg::point_t v;",
            "  input  lod_pkg::point_t v_i,",
            "  logic [3:0][lod_pkg::POINT_W-1:0] v;",
            "  parameter logic [1:0] MODE = 2'd1,",
            "  logic [W-1:0] memory [DEPTH];",
            "  assign point_t_i = a[3];",
            "  assign v = lod_pkg::point_t'(w[3:0]);",
        ];
        for text in good {
            assert_eq!(donts(text), [""; 0], "{text}");
        }
    }
}
