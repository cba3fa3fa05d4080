"""The table of figures, on a terminal and in docs/hardware.md."""

from .tools import NEXTPNR, ROOT, YOSYS, Failure, write

DOC = ROOT / "docs/hardware.md"
BEGIN, END = "<!-- scripts/synth: begin -->", "<!-- scripts/synth: end -->"
HEADINGS = ["block", "GE", "flip-flops", "multipliers", "depth", "LUTs", "ECP5 FFs", "DSPs", "MHz", "seeds"]


def row(name, figures):
    """A block's figures as words, in the order of HEADINGS; what was not asked for is a dash."""
    gates, ecp5, clocks = figures.get("gates"), figures.get("ecp5"), figures.get("mhz")
    words = [name]
    if gates:
        shapes = ", ".join(f"{count} of {shape}" for shape, count in sorted(gates["multipliers"].items(), key=lambda found: -found[1]))
        words += [f"{gates['ge']:,}", f"{gates['flip_flops']:,}", f"{sum(gates['multipliers'].values())}", str(gates["depth"])]
        del shapes
    else:
        words += ["-"] * 4
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


def markdown(rows, versions, seeds):
    """The table and what made it."""
    marks = ["---", *["---:"] * (len(HEADINGS) - 1)]
    lines = ["| " + " | ".join(words) + " |" for words in [HEADINGS, marks, *([f"`{row[0]}`", *row[1:]] for row in rows)]]
    made = f"`scripts/synth --doc`, {seeds} seed{'s' if seeds > 1 else ''}, {versions[YOSYS]}, {versions[NEXTPNR]}, LFE5U-85F in CABGA756, speed grade 6."
    return "\n".join([*lines, "", made])


def document(rows, versions, seeds):
    """Puts the table between its marks in docs/hardware.md."""
    text = DOC.read_text(encoding="utf-8")
    if text.count(BEGIN) != 1 or text.count(END) != 1:
        raise Failure(f"docs/hardware.md must hold the marks {BEGIN} and {END}, once each")
    before, after = text.split(BEGIN)[0], text.split(END)[1]
    write(DOC, f"{before}{BEGIN}\n{markdown(rows, versions, seeds)}\n{END}{after}")
