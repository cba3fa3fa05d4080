"""The table of figures, on a terminal and in docs/hardware.md."""

from .blocks import WHOLE
from .tools import NEXTPNR, ROOT, YOSYS, Failure, write

DOC = ROOT / "docs/hardware.md"
BEGIN, END = "<!-- scripts/synth: begin -->", "<!-- scripts/synth: end -->"
HEADINGS = ["block", "GE", "flip-flops", "memory bits", "multipliers", "depth", "LUTs", "ECP5 FFs", "DSPs", "MHz", "seeds"]


# What a traversal unit has one of each of, and what level of detail adds to it, as (block, how many).
UNIT = ["ray_setup", "node_address", "child_test", "lod_test", "tessellate", "tri_test", "hit_divide", "hit_select", "bary_map"]
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


def share(figures):
    """What level of detail adds to the blocks of a unit, in words."""
    unit = sum(figures[name]["gates"]["ge"] for name in UNIT)
    added = sum(count * figures[name]["gates"]["ge"] for name, count in ADDED)
    parts = ", ".join(f"{count} `{name}`" if count > 1 else f"`{name}`" for name, count in ADDED)
    return f"One of each block of a traversal unit has {unit:,} GE together; what level of detail adds to it ({parts}) is {added:,} of these, {100 * added / unit:.0f} %."


def whole(figures):
    """The unit and its parts as they are in it: lines of a table, and what its blocks have together."""
    unit = figures[WHOLE]["gates"]
    parts = unit["parts"]
    others = {key: unit[key] - sum(part[key] for part in parts.values()) for key in ("ge", "flip_flops", "memory_bits")}
    others["multipliers"] = sum(unit["multipliers"].values()) - sum(part["multipliers"] for part in parts.values())
    rows = [*parts.items(), ("what is left", others), ("**together**", {**unit, "multipliers": sum(unit["multipliers"].values())})]
    lines = [[f"`{name}`" if name in UNIT or name == "hit_queue" else name, *(f"{part[key]:,}" for key in ("ge", "flip_flops", "memory_bits", "multipliers"))] for name, part in rows]
    blocks = sum(parts[name]["ge"] for name in UNIT)
    return lines, f"One of each block has {blocks:,} GE in the unit, where results always have a place and some operands' bits are always 0."


def table(headings, rows):
    """Lines of a table in Markdown, words on the left and figures on the right."""
    return ["| " + " | ".join(words) + " |" for words in [headings, ["---", *["---:"] * (len(headings) - 1)], *rows]]


def markdown(rows, figures, versions, seeds):
    """The table, what follows from it and what made it."""
    lines = table(HEADINGS, [[f"`{row[0]}`", *row[1:]] for row in rows])
    made = f"`scripts/synth --doc`, {seeds} seed{'s' if seeds > 1 else ''}, {versions[YOSYS]}, {versions[NEXTPNR]}, LFE5U-85F in CABGA756, speed grade 6."
    parts, blocks = whole(figures)
    of_unit = table(["in a `traversal_unit` of four contexts", "GE", "flip-flops", "memory bits", "multipliers"], parts)
    return "\n".join([*lines, "", made, "", share(figures), "", *of_unit, "", blocks])


def document(rows, figures, versions, seeds):
    """Puts the table between its marks in docs/hardware.md."""
    text = DOC.read_text(encoding="utf-8")
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        raise Failure(f"docs/hardware.md must hold the marks {BEGIN} and {END}, once each")
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    write(DOC, f"{before}{BEGIN}\n{markdown(rows, figures, versions, seeds)}\n{END}{after}")
