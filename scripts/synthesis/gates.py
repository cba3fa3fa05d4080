"""A block in generic gates: gate equivalents, flip-flops, multipliers, logic depth, and the netlist for simulation."""

import dataclasses
import json
import re

from . import multipliers
from .tools import ROOT, YOSYS, Failure, kept

LIMIT_S = 1800

# Areas in two-input NAND gates, as they are usual for standard cells of one drive strength.
AREAS = {
    "NOT": 0.67, "NAND": 1.0, "NOR": 1.0, "AND": 1.33, "OR": 1.33, "AOI3": 1.33, "OAI3": 1.33, "MUX": 2.33, "XOR": 2.33, "XNOR": 2.33,
    "DFF": 5.33, "DFFE": 7.67,
}
# Without abc's rewriting for area (dc2), which turns prefix adders back into ripples: three times the depth for a quarter of the adder's area.
ABC = "+strash;ifraig;scorr;dch,-f;map,-B,0.9;topo"
# What Yosys says of a netlist that is not the design.
SUSPECT = re.compile(r"implicitly declared|no driver|undriven|(?<!No )latch inferred|multiple conflicting drivers|found logic loop", re.IGNORECASE)


def script(block, folder):
    """The Yosys commands; hierarchy is kept, so that equal modules are mapped once."""
    gates = ",".join(name for name in AREAS if name not in ("NOT", "DFF", "DFFE"))
    return [
        *block.read(),
        "proc", "chformal -remove", "check -assert", "opt_expr", "opt_clean", "opt -nodffe -nosdff", "wreduce", "peepopt", "opt_clean",
        f"techmap -map {folder}/map_multipliers.v", f"read_verilog {folder}/multipliers.v", f"hierarchy -check -top {block.module}", "proc",
        "booth", "alumacc", "opt", "memory", "opt -fast -full", "opt -undriven -fine", "techmap", "opt -fast",
        "dfflegalize -cell $_DFF_P_ x -cell $_DFFE_PP_ x", "opt_expr", "opt_clean",
        f"abc -g {gates} -script {ABC}", "opt_clean", "check -assert",
        f"json -o {folder}/multipliers.json A:multiplier",
        # One flat module and the multipliers: registers that no output needs show only now. Wires of one bit simulate well.
        "flatten -noscopeinfo", "opt -nodffe -nosdff", "opt_clean", "splitnets", "opt_clean", "check -assert",
        f"tee -q -o {folder}/stat.json stat -json", f"write_verilog -noattr {folder}/netlist.v",
        "setattr -mod -unset keep_hierarchy A:multiplier", "flatten -noscopeinfo", "opt_clean", "ltp -noff",
    ]


def synthesise(block, tools):
    """Figures of a block in gates, and the folder of its netlist."""

    def make(folder):
        for name, text in (("map_multipliers.v", multipliers.MAP), ("multipliers.v", multipliers.MODULES), ("script.ys", "\n".join(script(block, folder)) + "\n")):
            (ROOT / folder / name).write_text(text, encoding="utf-8")
        log = tools.run(YOSYS, ["-s", folder / "script.ys"], folder / "log", LIMIT_S)
        refuse_suspect(log)
        mapped = {name: module for name, module in read_json(folder / "multipliers.json")["modules"].items() if multipliers.is_multiplier(name)}
        for name, module in mapped.items():
            multipliers.verify(name, module)
        return measure(block.module, read_json(folder / "stat.json"), {name: multipliers.shape(module) for name, module in mapped.items()}, log)

    texts = [multipliers.MAP, multipliers.MODULES]
    # The same script whichever package it is: what the block uses of that is among its ingredients.
    plain = dataclasses.replace(block, package="")
    ingredients = {"block": block.ingredients(), "script": script(plain, "."), "map": texts, "tool": tools.versions[YOSYS], "areas": AREAS}
    return kept(f"gates-{block.name}", ingredients, make)


def read_json(path):
    """A file that a tool wrote."""
    return json.loads((ROOT / path).read_text(encoding="utf-8"))


def refuse_suspect(log):
    """Raises the first message of Yosys that means a wrong netlist."""
    for line in log.splitlines():
        if SUSPECT.search(line):
            raise Failure(f"Yosys: {line.strip()}")


def measure(top, stat, shapes, log):
    """The figures out of Yosys' statistics and its longest path."""
    modules = {bare(name): module["num_cells_by_type"] for name, module in stat["modules"].items()}
    cells = total(top, modules)
    ge, flip_flops, products = 0.0, 0, {}
    for kind, count in cells.items():
        gate = re.fullmatch(r"\$_(DFFE|[A-Z0-9]+)_(?:PP?_)?", kind)
        if gate:
            ge += count * AREAS[gate[1]]
            flip_flops += count if gate[1].startswith("DFF") else 0
        elif kind in shapes:
            shape = " x ".join(map(str, sorted(shapes[kind], reverse=True)))
            products[shape] = products.get(shape, 0) + count
        elif kind not in modules:
            raise Failure(f"Yosys left a cell that is no gate: {kind}")
    depth = re.findall(r"Longest topological path in \S+ \(length=(\d+)\)", log)
    return {"ge": round(ge), "flip_flops": flip_flops, "multipliers": products, "depth": int(depth[-1])}


def total(top, modules):
    """Cells by type of `top` and all below it; modules count as cells too."""
    cells = {}
    for kind, count in ((bare(kind), count) for kind, count in modules[top].items()):
        cells[kind] = cells.get(kind, 0) + count
        if kind in modules:
            for inner, inner_count in total(kind, modules).items():
                cells[inner] = cells.get(inner, 0) + count * inner_count
    return cells


def bare(name):
    """A name without the backslash that Yosys puts before those of the source."""
    return name[1:] if name.startswith("\\") else name
