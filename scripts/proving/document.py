"""The tables: what a run prints, and that of docs/formal.md."""

from .tools import ROOT

PAGE = ROOT / "docs/formal.md"
BEGIN, END = "<!-- scripts/prove: begin -->", "<!-- scripts/prove: end -->"


def report(results):
    """The table of a run."""
    rows = [("property", "method", "width", "seconds", "verdict", "covers", "mutants")]
    for result in results:
        one = result.property
        told = lambda verdicts: ", ".join(verdict.got for verdict in verdicts)
        rows.append((one.name, one.method, one.width, f"{result.seconds:.1f}", told(result.proof), told(result.covers), told(result.mutants)))
    sizes = [max(len(row[at]) for row in rows) for at in range(len(rows[0]))]
    return "\n".join("  ".join(cell.ljust(size) for cell, size in zip(row, sizes)).rstrip() for row in rows)


def table(every):
    """The table of the page."""
    code = lambda text: " ".join(text.split()).replace("|", "\\|")
    lines = ["| property | what it says | block | width | method | mutant rejected |", "|---|---|---|---|---|---|"]
    for one in every:
        mutants = "<br>".join(f"`{change.file}`: `{code(change.old)}` → `{code(change.new)}`" for change in one.mutants)
        lines.append(f"| `{one.name}` | {one.says} | `{one.block}` | {one.width} | {one.method} | {mutants} |")
    return "\n".join(lines)


def expected(every):
    """(the page, the page as it should be)."""
    page = PAGE.read_text(encoding="utf-8")
    head, _, rest = page.partition(BEGIN)
    _, _, tail = rest.partition(END)
    return page, f"{head}{BEGIN}\n{table(every)}\n{END}{tail}"


def stale(every):
    """A complaint if the page does not show the properties as they are."""
    page, wanted = expected(every)
    return [] if page == wanted else ["docs/formal.md is not up to date; run scripts/prove --doc"]


def write(every):
    """Writes the table into the page."""
    PAGE.write_text(expected(every)[1], encoding="utf-8")
