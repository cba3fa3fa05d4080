"""A block in generic gates: gate equivalents, flip-flops, multipliers, logic depth, and the netlist for simulation."""

import json
import re

from .tools import ROOT, YOSYS, Failure, kept

LIMIT_S = 1800

# Areas in two-input NAND gates, as they are usual for standard cells of one drive strength.
AREAS = {
    "NOT": 0.67, "NAND": 1.0, "NOR": 1.0, "AND": 1.33, "OR": 1.33, "AOI3": 1.33, "OAI3": 1.33, "MUX": 2.33, "XOR": 2.33, "XNOR": 2.33,
    "DFF": 5.33, "DFFE": 7.67,
}
# What Yosys says of a netlist that is not the design.
SUSPECT = re.compile(r"implicitly declared|no driver|undriven|(?<!No )latch inferred|multiple conflicting drivers|found logic loop", re.IGNORECASE)

# A multiplier becomes a module of its own, one per shape: mapped to gates once, however many there are.
MULTIPLIERS = r"""
(* techmap_celltype = "$mul" *)
module map_mul (A, B, Y);
  parameter A_SIGNED = 0, B_SIGNED = 0, A_WIDTH = 1, B_WIDTH = 1, Y_WIDTH = 1;
  input [A_WIDTH-1:0] A;
  input [B_WIDTH-1:0] B;
  output [Y_WIDTH-1:0] Y;
  gate_multiplier #(.A_SIGNED(A_SIGNED), .B_SIGNED(B_SIGNED), .A_WIDTH(A_WIDTH), .B_WIDTH(B_WIDTH), .Y_WIDTH(Y_WIDTH)) _TECHMAP_REPLACE_ (.A(A), .B(B), .Y(Y));
endmodule
"""
MULTIPLIER = r"""
module gate_multiplier (A, B, Y);
  parameter A_SIGNED = 0, B_SIGNED = 0, A_WIDTH = 1, B_WIDTH = 1, Y_WIDTH = 1;
  input [A_WIDTH-1:0] A;
  input [B_WIDTH-1:0] B;
  output [Y_WIDTH-1:0] Y;
  \$mul #(.A_SIGNED(A_SIGNED), .B_SIGNED(B_SIGNED), .A_WIDTH(A_WIDTH), .B_WIDTH(B_WIDTH), .Y_WIDTH(Y_WIDTH)) product (.A(A), .B(B), .Y(Y));
endmodule
"""


def script(block, folder):
    """The Yosys commands; hierarchy is kept, so that equal modules are mapped once."""
    gates = ",".join(name for name in AREAS if name not in ("NOT", "DFF", "DFFE"))
    return [
        *block.read(),
        "proc", "chformal -remove", "check -assert", "opt_expr", "opt_clean", "opt -nodffe -nosdff", "wreduce", "peepopt", "opt_clean",
        f"techmap -map {folder}/map_multipliers.v", f"read_verilog -icells {folder}/multiplier.v", f"hierarchy -check -top {block.module}",
        "booth", "alumacc", "opt", "memory", "opt -fast -full", "opt -undriven -fine", "techmap", "opt -fast",
        "dfflegalize -cell $_DFF_P_ x -cell $_DFFE_PP_ x", "opt_expr", "opt_clean",
        f"abc -g {gates}", "opt_clean", "check -assert",
        f"tee -q -o {folder}/stat.json stat -json",
        f"write_verilog -noattr {folder}/netlist.v",
        "flatten", "opt_clean", "ltp -noff",
    ]


def synthesise(block, tools):
    """Figures of a block in gates, and its netlist's path."""

    def make(folder):
        (ROOT / folder / "map_multipliers.v").write_text(MULTIPLIERS, encoding="utf-8")
        (ROOT / folder / "multiplier.v").write_text(MULTIPLIER, encoding="utf-8")
        (ROOT / folder / "script.ys").write_text("\n".join(script(block, folder)) + "\n", encoding="utf-8")
        log = tools.run(YOSYS, ["-s", folder / "script.ys"], folder / "log", LIMIT_S)
        refuse_suspect(log)
        shapes = multiplier_shapes((ROOT / folder / "netlist.v").read_text(encoding="utf-8"))
        return measure(block.module, json.loads((ROOT / folder / "stat.json").read_text(encoding="utf-8")), shapes, log)

    ingredients = {"block": block.ingredients(), "script": script(block, "."), "map": [MULTIPLIERS, MULTIPLIER], "tool": tools.versions[YOSYS], "areas": AREAS}
    made, folder = kept(f"gates-{block.name}", ingredients, make)
    return made, folder / "netlist.v"


def refuse_suspect(log):
    """Raises the first message of Yosys that means a wrong netlist."""
    for line in log.splitlines():
        if SUSPECT.search(line):
            raise Failure(f"Yosys: {line.strip()}")


def multiplier_shapes(netlist):
    """Widths of the factors of each multiplier module of a netlist."""
    modules = re.findall(r"^module \\(\S*gate_multiplier) (.*?)^endmodule", netlist, re.MULTILINE | re.DOTALL)
    return {name: [int(re.search(rf"input (?:\[(\d+):0\] )?{port};", body)[1] or 0) + 1 for port in "AB"] for name, body in modules}


def measure(top, stat, shapes, log):
    """The figures out of Yosys' statistics and its longest path."""
    modules = {name.lstrip("\\"): module["num_cells_by_type"] for name, module in stat["modules"].items()}
    cells = total(top, modules)
    ge = flip_flops = 0.0
    multipliers = {}
    for kind, count in cells.items():
        gate = re.fullmatch(r"\$_(DFFE|[A-Z0-9]+)_(?:P_|PP_)?", kind)
        if gate:
            ge += count * AREAS[gate[1]]
            flip_flops += count if gate[1].startswith("DFF") else 0
        elif "gate_multiplier" in kind:
            shape = " x ".join(map(str, sorted(shapes[kind.lstrip("\\")], reverse=True)))
            multipliers[shape] = multipliers.get(shape, 0) + count
    depth = re.findall(r"Longest topological path in \S+ \(length=(\d+)\)", log)
    return {"ge": round(ge), "flip_flops": round(flip_flops), "multipliers": multipliers, "depth": int(depth[-1])}


def total(top, modules):
    """Cells by type of `top` and all below it; modules count as cells too."""
    cells = {}
    for kind, count in modules[top].items():
        cells[kind] = cells.get(kind, 0) + count
        if kind.lstrip("\\") in modules:
            for inner, inner_count in total(kind.lstrip("\\"), modules).items():
                cells[inner] = cells.get(inner, 0) + count * inner_count
    return cells
