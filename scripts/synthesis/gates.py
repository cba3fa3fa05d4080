"""A block in generic gates: gate equivalents, flip-flops, multipliers, logic depth, and the netlist for simulation."""

import dataclasses
import fnmatch
import json
import re

from . import multipliers
from .blocks import OF_UNIT, WHOLE
from .tools import ROOT, YOSYS, Failure, kept

LIMIT_S = 3600

# Areas in two-input NAND gates, as they are usual for standard cells of one drive strength.
AREAS = {
    "NOT": 0.67, "NAND": 1.0, "NOR": 1.0, "AND": 1.33, "OR": 1.33, "AOI3": 1.33, "OAI3": 1.33, "MUX": 2.33, "XOR": 2.33, "XNOR": 2.33,
    "DFF": 5.33, "DFFE": 7.67,
}
# A memory of one write and one clocked read port, likewise in NAND gates: per bit, per column (precharge, sense amplifier, latches and drivers of both ports), per word (two decoders and word
# lines), and for control. docs/hardware.md says why.
MEMORY = {"bit": 1.0, "column": 12.0, "word": 4.0, "control": 250.0}
# Without abc's rewriting for area (dc2), which turns prefix adders back into ripples: three times the depth for a quarter of the adder's area.
ABC = "+strash;ifraig;scorr;dch,-f;map,-B,0.9;topo"
# What Yosys says of a netlist that is not the design.
SUSPECT = re.compile(r"implicitly declared|no driver|undriven|(?<!No )latch inferred|multiple conflicting drivers|found logic loop", re.IGNORECASE)


# The parts of a whole unit: a word for each, and the names of its instances in rtl/traversal_unit.sv.
PARTS = {
    **{name: f"u_{name}" for name in OF_UNIT},
    "contexts": "u_context", "arbiters and operands": "*_input", "hit_queue": "u_queue",
}


def script(block, folder):
    """The Yosys commands; hierarchy is kept, so that equal modules are mapped once."""
    gates = ",".join(name for name in AREAS if name not in ("NOT", "DFF", "DFFE"))
    # Memories stay what they are.
    memories = block.has_memories()
    return [
        *block.read(),
        "proc", "chformal -remove", "check -assert", "opt_expr", "opt_clean", "opt -nodffe -nosdff", "wreduce", "peepopt", "opt_clean",
        f"techmap -map {folder}/map_multipliers.v", f"read_verilog {folder}/multipliers.v", f"hierarchy -check -top {block.module}", "proc",
        "booth", "alumacc", "opt", "memory -nomap" if memories else "memory", "opt -fast -full", "opt -undriven -fine", "techmap", "opt -fast",
        "dfflegalize -cell $_DFF_P_ x -cell $_DFFE_PP_ x", "opt_expr", "opt_clean",
        f"abc -g {gates} -script {ABC}", "opt_clean", "check -assert",
        f"json -o {folder}/multipliers.json A:multiplier",
        # One flat module and the multipliers: registers that no output needs show only now. Wires of one bit simulate well.
        "flatten -noscopeinfo", "opt -nodffe -nosdff", "opt_clean", "splitnets", "opt_clean", "check -assert",
        *([f"json -o {folder}/memories.json t:$mem_v2"] if memories else []),
        f"tee -q -o {folder}/stat.json stat -json",
        *(f"tee -q -o {folder}/part-{number}.json stat -json c:*{instance}.*" for number, instance in enumerate(parts(block).values())),
        f"write_verilog -noattr {folder}/netlist.v",
        "setattr -mod -unset keep_hierarchy A:multiplier", "flatten -noscopeinfo", "opt_clean", "ltp -noff",
    ]


def parts(block):
    """The parts that are counted apart."""
    return PARTS if block.module == WHOLE else {}


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
        shapes = {name: multipliers.shape(module) for name, module in mapped.items()}
        memories = memories_of(read_json(folder / "memories.json")) if block.has_memories() else []
        stats = [read_json(folder / f"part-{number}.json") for number in range(len(parts(block)))]
        return measure(block, read_json(folder / "stat.json"), stats, shapes, memories, log)

    texts = [multipliers.MAP, multipliers.MODULES]
    # The same script whichever package it is: what the block uses of that is among its ingredients.
    plain = dataclasses.replace(block, package="")
    ingredients = {"block": block.ingredients(), "script": script(plain, "."), "map": texts, "tool": tools.versions[YOSYS], "areas": AREAS}
    if block.has_memories():
        ingredients["memory"] = MEMORY
    if parts(block):
        ingredients["parts"] = [*parts(block), "memories"]
    return kept(f"gates-{block.name}", ingredients, make)


def read_json(path):
    """A file that a tool wrote."""
    return json.loads((ROOT / path).read_text(encoding="utf-8"))


def refuse_suspect(log):
    """Raises the first message of Yosys that means a wrong netlist."""
    for line in log.splitlines():
        if SUSPECT.search(line):
            raise Failure(f"Yosys: {line.strip()}")


def memories_of(netlist):
    """Name, words, bits in a word, and whether it is read with a clock, of every memory of a flat netlist. One that is read by more than one port is none that the areas are for."""
    found = []
    for module in netlist["modules"].values():
        for name, cell in module["cells"].items():
            own = {key: int(value, 2) for key, value in cell["parameters"].items() if key in ("SIZE", "WIDTH", "RD_PORTS", "WR_PORTS", "RD_CLK_ENABLE", "RD_TRANSPARENCY_MASK")}
            if (own["RD_PORTS"], own["WR_PORTS"]) != (1, 1):
                raise Failure(f"the memory {name} has {own['RD_PORTS']} read and {own['WR_PORTS']} write ports, not one of each")
            # Of what is written in the same cycle a macro reads nothing.
            found.append((name, own["SIZE"], own["WIDTH"], bool(own["RD_CLK_ENABLE"]) and not own["RD_TRANSPARENCY_MASK"]))
    return sorted(found)


def memory_area(words, width, clocked):
    """Gate equivalents of a memory. One that is read without a clock is flip-flops and a tree of multiplexers."""
    if not clocked:
        return words * width * AREAS["DFFE"] + (words - 1) * width * AREAS["MUX"]
    return words * width * MEMORY["bit"] + width * MEMORY["column"] + words * MEMORY["word"] + MEMORY["control"]


def measure(block, stat, stats, shapes, memories, log):
    """The figures out of Yosys' statistics, of the whole and of its parts, and out of its longest path."""
    modules = {bare(name): module["num_cells_by_type"] for name, module in stat["modules"].items()}
    ge, flip_flops, products = area(total(block.module, modules), modules, shapes)
    depth = re.findall(r"Longest topological path in \S+ \(length=(\d+)\)", log)
    in_memories = sum(memory_area(*memory[1:]) for memory in memories)
    made = {
        "ge": round(ge + in_memories), "memory_ge": round(in_memories), "flip_flops": flip_flops, "memory_bits": sum(words * width for _, words, width, _ in memories),
        "memories": [memory[1:] for memory in memories], "multipliers": products, "depth": int(depth[-1]),
    }
    for (name, instance), part in zip(parts(block).items(), stats):
        cells = part["modules"].get(block.module) or part["modules"]["\\" + block.module]
        of_part = total(block.module, {**modules, block.module: cells["num_cells_by_type"]})
        own = [memory[1:] for memory in memories if fnmatch.fnmatch(memory[0], f"*{instance}.*")]
        part_ge, part_flip_flops, part_products = area(of_part, modules, shapes)
        made.setdefault("parts", {})[name] = {
            "ge": round(part_ge + sum(memory_area(*memory) for memory in own)), "flip_flops": part_flip_flops, "memories": own,
            "memory_bits": sum(words * width for words, width, _ in own), "multipliers": sum(part_products.values()),
        }
    return made


def area(cells, modules, shapes):
    """Gate equivalents, flip-flops, and multipliers by shape, of cells by type; memories are not in it."""
    ge, flip_flops, products = 0.0, 0, {}
    for kind, count in cells.items():
        gate = re.fullmatch(r"\$_(DFFE|[A-Z0-9]+)_(?:PP?_)?", kind)
        if gate:
            ge += count * AREAS[gate[1]]
            flip_flops += count if gate[1].startswith("DFF") else 0
        elif kind in shapes:
            shape = " x ".join(map(str, sorted(shapes[kind], reverse=True)))
            products[shape] = products.get(shape, 0) + count
        elif kind not in modules and kind != "$mem_v2":
            raise Failure(f"Yosys left a cell that is no gate: {kind}")
    return ge, flip_flops, products


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
