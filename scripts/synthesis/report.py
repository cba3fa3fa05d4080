"""The table of figures, on a terminal and in docs/hardware.md."""

from .blocks import COPIES, OF_UNIT, WHOLE
from .gates import memory_area
from .tools import NEXTPNR, ROOT, YOSYS, Failure, write

DOC = ROOT / "docs/hardware.md"
# The command whose marks are around the table of blocks.
BLOCKS = "scripts/synth"
HEADINGS = ["block", "GE", "flip-flops", "memory bits", "multipliers", "depth", "LUTs", "ECP5 FFs", "DSPs", "MHz", "seeds"]

# Contexts of a unit that the cost of a unit is told for.
MANY = 32

# What level of detail adds to a traversal unit, as (block, how many).
ADDED = [("lod_test", 1), ("tessellate", 1), ("child_boxes", 1), ("bary_map", 1)]


def row(name, figures):
    """A block's figures as words, in the order of HEADINGS; what was not asked for is a dash."""
    gates, ecp5, clocks = figures.get("gates"), figures.get("ecp5"), figures.get("mhz")
    words = [name]
    if gates:
        words += [f"{gates['ge']:,}", f"{gates['flip_flops']:,}", f"{gates.get('memory_bits', 0):,}", str(sum(gates["multipliers"].values())), str(gates["depth"])]
    else:
        words += ["-"] * 5
    words += [f"{ecp5['luts']:,}", f"{ecp5['flip_flops']:,}", str(ecp5["dsps"])] if ecp5 else ["-"] * 3
    if clocks == "does not fit":
        return [*words, clocks, "-"]
    return words + ([f"{median(clocks):.1f}", " ".join(f"{clock:.0f}" for clock in clocks)] if clocks else ["-", "-"])


def median(values):
    """The median; of two in the middle the lower."""
    return sorted(values)[(len(values) - 1) // 2]


def plain(rows):
    """The table with aligned columns."""
    widths = [max(len(row[k]) for row in [HEADINGS, *rows]) for k in range(len(HEADINGS))]
    lines = ["  ".join(word.ljust(width) if k == 0 else word.rjust(width) for k, (word, width) in enumerate(zip(row, widths))) for row in [HEADINGS, *rows]]
    return "\n".join(line.rstrip() for line in lines)


def share(area):
    """What level of detail adds to the blocks of a unit, in words, from the GE of each."""
    unit = sum(area[name] for name in OF_UNIT)
    added = sum(count * area[name] for name, count in ADDED)
    parts = ", ".join(f"{count} `{name}`" if count > 1 else f"`{name}`" for name, count in ADDED)
    return f"One of each block of a traversal unit has {unit:,} GE together; what level of detail adds to it ({parts}) is {added:,} of these, {100 * added / unit:.0f} %."


def whole(gates, contexts, versions):
    """The unit and its parts as they are in it, and what its blocks have together."""
    parts, keys = gates["parts"], ("ge", "flip_flops", "memory_bits", "multipliers")
    together = {**gates, "multipliers": sum(gates["multipliers"].values())}
    others = {key: together[key] - sum(part[key] for part in parts.values()) for key in keys}
    rows = [[f"`{name}`" if name in OF_UNIT or name == "hit_queue" else name, *(f"{part[key]:,}" for key in keys)] for name, part in [*parts.items(), ("what is left", others), ("**together**", together)]]
    blocks, own, chosen = sum(parts[name]["ge"] for name in OF_UNIT), parts["contexts"]["ge"] / contexts, parts["arbiters and operands"]["ge"] / contexts
    return "\n".join([
        *table([f"in a `traversal_unit` of {contexts} contexts", "GE", "flip-flops", "memory bits", "multipliers"], rows), "",
        f"`scripts/synth --doc {WHOLE}`, {versions[YOSYS]}, multipliers counted with their blocks.", "",
        f"One of each block has {blocks:,} GE in the unit. A context has {own:,.0f} GE there, and arbiters and the choice of its operands {chosen:,.0f} more. "
        f"So a unit of {MANY} contexts has {larger(parts, contexts, others['ge']) / 1e6:.2f} million GE: blocks and what is left as here, contexts and operands {MANY} times, the memory of the queue as deep as that takes.",
    ])


def larger(parts, contexts, others):
    """GE of a unit with `MANY` contexts, from the parts of one with fewer."""
    queue = parts["hit_queue"]
    deeper = sum(memory_area(words * MANY // contexts, width, clocked) - memory_area(words, width, clocked) for words, width, clocked in queue["memories"])
    each = (parts["contexts"]["ge"] + parts["arbiters and operands"]["ge"]) / contexts
    return sum(parts[name]["ge"] for name in OF_UNIT) + MANY * each + queue["ge"] + deeper + others


def clock(mhz):
    """A clock as a reader sees it; 0 is that of a seed that was not routed."""
    return f"{mhz:.1f}" if mhz else "not routed"


def fpga(contexts, size, placed, options, versions):
    """The unit on the FPGA: what it takes, and its clock with each seed."""
    clocks = [made["mhz"] for made in placed]
    return "\n".join([
        *table(["contexts", "LUTs", "flip-flops", "multipliers", "block RAMs", "MHz, median", "of seeds 1 and on"], [[
            str(contexts), f"{size['luts']:,}", f"{size['flip_flops']:,}", str(size["dsps"]), str(size["memories"]), clock(median(clocks)), ", ".join(map(clock, clocks))]]),
        "", f"`scripts/synth --fpga {contexts} --seeds {len(clocks)} --doc`, {versions[YOSYS]}, {versions[NEXTPNR]} (`{' '.join(map(str, options))}`).",
    ])


def table(headings, rows):
    """Lines of a table in Markdown, words on the left and figures on the right."""
    return ["| " + " | ".join(words) + " |" for words in [headings, ["---", *["---:"] * (len(headings) - 1)], *rows]]


def markdown(rows, versions, some):
    """The table, what follows from it and what made it. With `some` these rows take their places in the table that is there, which must be of the same tools."""
    made = f"`scripts/synth --doc`, {versions[YOSYS]}, {versions[NEXTPNR]}, LFE5U-85F in CABGA756, speed grade 6."
    cells = {f"`{row[0]}`": row[1:] for row in rows}
    if some:
        standing = between(BLOCKS)
        if made not in standing:
            raise Failure("the table of docs/hardware.md was made with other versions of the tools: name no block, so that all rows are made again")
        there = [line.strip("| ").split(" | ") for line in standing.splitlines() if line.startswith("| `")]
        cells = {**{name: row for name, *row in there}, **cells}
    unplaced = " A dash: not placed again since its RTL last changed." if any(row[-2] == "-" for row in cells.values()) else ""
    area = {name.strip("`"): int(row[0].replace(",", "")) for name, row in cells.items()}
    return "\n".join([*table(HEADINGS, [[name, *row] for name, row in cells.items()]), "", made + unplaced, "", share(area)])


def copies(rows, versions):
    """The table of blocks that take turns."""
    made = f"`scripts/synth {' '.join(COPIES)} --doc`, {versions[YOSYS]}."
    return "\n".join([*table(HEADINGS[:6], [[f"`{name}`", *row[:5]] for name, *row in rows]), "", made])


def between(command):
    """What stands between a command's marks in docs/hardware.md."""
    document = DOC.read_text(encoding="utf-8")
    begin, end = marks(command, document)
    return document.split(begin)[1].split(end)[0]


def marks(command, document):
    """A command's two marks, once each in the document."""
    both = [f"<!-- {command}: {mark} -->" for mark in ("begin", "end")]
    if any(document.count(mark) != 1 for mark in both):
        raise Failure(f"docs/hardware.md must hold the marks {both[0]} and {both[1]}, once each")
    return both


def document(command, text):
    """Puts what a command has measured between its marks in docs/hardware.md."""
    document = DOC.read_text(encoding="utf-8")
    begin, end = marks(command, document)
    before, after = document.split(begin)[0], document.split(end)[1]
    write(DOC, f"{before}{begin}\n{text}\n{end}{after}")
