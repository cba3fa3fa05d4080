"""A block on a Lattice ECP5 (LFE5U-85F, CABGA756, speed grade 6): LUTs, flip-flops, multipliers, and the clock after place and route.

A block has more ports than the FPGA has pins, so it is placed inside a harness: a serial shift register feeds every input, every output has a register of its
own, and these are folded into a second shift register, so that every path of the block lies between two registers and nothing is without effect. Block and
harness are synthesised apart and joined as netlists: what is counted is what is placed.
"""

import collections
import json
import re

from .gates import refuse_suspect
from .tools import NEXTPNR, ROOT, YOSYS, Failure, kept

SYNTHESIS_LIMIT_S = 1800
PLACEMENT_LIMIT_S = 5400
TARGET_MHZ = 110
DSP_BLOCKS = 156
CLOCKED = ("clk_i", "rst_ni")
PLACEMENT = ["--85k", "--package", "CABGA756", "--speed", "6", "--freq", TARGET_MHZ, "--timing-allow-fail", "--lpf-allow-unconstrained"]


def synthesise(block, tools, refinement=None):
    """Size of the block alone, and the path of its netlist; with a refinement (refine.py) that of the refined one."""
    options = " ".join(refinement.OPTIONS) if refinement else ""

    def script(folder):
        return [*block.read(), "chformal -remove", f"synth_ecp5 -top {block.module} {options} -json {folder}/netlist.json"]

    def make(folder):
        (ROOT / folder / "script.ys").write_text("\n".join(script(folder)) + "\n", encoding="utf-8")
        refuse_suspect(tools.run(YOSYS, ["-s", folder / "script.ys"], folder / "log", SYNTHESIS_LIMIT_S))
        path = ROOT / folder / "netlist.json"
        if refinement:
            refinement.refine(path, block.module)
        module = json.loads(path.read_text(encoding="utf-8"))["modules"][block.module]
        cells = collections.Counter(cell["type"] for cell in module["cells"].values())
        # As the FPGA has them: a carry cell takes two LUTs, one of distributed memory four and two for its address.
        luts = cells["LUT4"] + 2 * cells["CCU2C"] + 6 * cells["TRELLIS_DPR16X4"]
        return {"luts": luts, "flip_flops": cells["TRELLIS_FF"], "dsps": cells["MULT18X18D"], "memories": cells["DP16KD"]}

    ingredients = {"block": block.ingredients(), "script": script("."), "tool": tools.versions[YOSYS], "refinement": refinement.ingredients() if refinement else ""}
    made, folder = kept(f"ecp5-{block.name}", ingredients, make)
    return made, folder / "netlist.json"


def fits(size):
    """Whether the FPGA has the multipliers."""
    return size["dsps"] <= DSP_BLOCKS


def harness(module, ports):
    """The harness of a block with these ports (name -> direction, width), and an empty block for it."""
    inputs = [(name, width) for name, (direction, width) in ports.items() if direction == "input" and name not in CLOCKED]
    outputs = [(name, width) for name, (direction, width) in ports.items() if direction == "output"]
    inputs_w, outputs_w = (sum(width for _, width in side) for side in (inputs, outputs))

    def slices(side, register):
        at, found = 0, []
        for name, width in side:
            found.append(f".{name}({register}[{at} +: {width}])")
            at += width
        return found

    clocked = [f".{name}({register})" for name, register in zip(CLOCKED, ("clk_i", "rst_nq")) if name in ports]
    connections = ", ".join(clocked + slices(inputs, "in_q") + slices(outputs, "out"))
    declared = ", ".join(f"{direction} [{width - 1}:0] {name}" for name, (direction, width) in ports.items())
    return f"""(* blackbox *)
module {module} ({declared});
endmodule

module harness (input clk_i, input rst_ni, input serial_i, output serial_o);
  reg rst_nq;
  reg [{inputs_w - 1}:0] in_q;
  wire [{outputs_w - 1}:0] out;
  reg [{outputs_w - 1}:0] out_q, fold_q;
  {module} block ({connections});
  assign serial_o = fold_q[{outputs_w - 1}];
  always @(posedge clk_i) begin
    rst_nq <= rst_ni;
    in_q <= {{in_q, serial_i}};
    out_q <= out;
    fold_q <= {{fold_q, 1'b0}} ^ out_q;
  end
endmodule
"""


def place(block, netlist, seed, tools, options=tuple(PLACEMENT), limit=PLACEMENT_LIMIT_S, configuration=False):
    """Clock after place and route in MHz and the longest path's cells, with one seed; and the folder of the configuration."""
    netlist_text = (ROOT / netlist).read_text(encoding="utf-8")

    def make(folder):
        ports = json.loads(netlist_text)["modules"][block.module]["ports"]
        text = harness(block.module, {name: (port["direction"], len(port["bits"])) for name, port in ports.items()})
        (ROOT / folder / "harness.v").write_text(text, encoding="utf-8")
        join = [
            f"read_verilog {folder}/harness.v", "synth_ecp5 -top harness -noflatten", f"delete =A:blackbox=1 {block.module}",
            f"read_json {netlist}", "flatten", "check -assert", f"write_json {folder}/placed.json",
        ]
        (ROOT / folder / "join.ys").write_text("\n".join(join) + "\n", encoding="utf-8")
        tools.run(YOSYS, ["-s", folder / "join.ys"], folder / "join.log", SYNTHESIS_LIMIT_S)
        arguments = ["--json", folder / "placed.json", "--seed", seed, "--report", folder / "report.json", *(["--textcfg", folder / "unit.config"] if configuration else []), *options]
        log = tools.run(NEXTPNR, arguments, folder / "log", limit)
        clocks = re.findall(r"Max frequency for clock\s+\S*clk_i\S*: ([\d.]+) MHz", log)
        if not clocks:
            raise Failure(f"nextpnr named no clock; see {folder}/log")
        (ROOT / folder / "placed.json").unlink()
        report = json.loads((ROOT / folder / "report.json").read_text(encoding="utf-8"))
        # The report counts after routing, as the last of the log's lines does.
        return {"mhz": float(clocks[-1]), "path": longest_path(report)}

    ingredients = {"netlist": netlist_text, "seed": seed, "options": list(options), "tool": tools.versions[NEXTPNR], "harness": harness("block", {"a": ("input", 1), "b": ("output", 1)})}
    return kept(f"place-{block.name}-{seed}", ingredients, make)


def longest_path(report):
    """The steps of the longest path within the clock's domain: kind, delay in ns, cell it leads to."""
    paths = [path for path in report.get("critical_paths", []) if "clk" in path["from"] and path["from"].split()[-1] == path["to"].split()[-1]]
    steps = []
    for step in paths[0]["path"] if paths else []:
        if step["type"] == "logic" and len(steps) > 1 and steps[-1][0] == "routing" and steps[-1][1] == 0:
            # A wire without delay joins two halves of one cell, such as the links of a carry chain.
            steps.pop()
            steps[-1] = ["logic", steps[-1][1] + step["delay"], step["to"]["cell"]]
        else:
            steps.append([step["type"], step["delay"], step["to"]["cell"]])
    return [[kind, round(delay, 2), cell] for kind, delay, cell in steps]
