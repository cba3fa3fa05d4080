"""Merges Verilator's coverage data: lines and toggles of rtl/, by file.

Every point of a source line counts once, however many instances, parameters and tests saw it: it is covered if any did. Gaps are explained in
scripts/coverage.toml, if there is one (file, the code of the line or the name of the signal, why); an unexplained uncovered line, or toggles under
the limit, make the script fail.
"""

import argparse
import collections
import pathlib
import re
import sys
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent
REASONS = ROOT / "scripts" / "coverage.toml"
TOGGLE_LIMIT = 90.0


def points(path):
    """(fields, count) of every point in one data file."""
    for line in path.read_text(errors="replace").splitlines():
        m = re.match(r"C '(.*)' (\d+)$", line)
        if m:
            fields = dict(part.split("\x02", 1) for part in m.group(1).split("\x01") if "\x02" in part)
            yield fields, int(m.group(2))


def span(text):
    """Line numbers of a source range such as "12-14,17"."""
    for part in filter(None, text.split(",")):
        first, _, last = part.partition("-")
        yield from range(int(first), int(last or first) + 1)


def collect(folder):
    """Counts by (file, line) and by (file, signal, bit)."""
    lines, toggles = collections.Counter(), collections.Counter()
    files = sorted(folder.glob("*.dat"))
    for path in files:
        for fields, count in points(path):
            file = pathlib.PurePath(fields["f"])
            name = file.name
            if file.parent.name == "rules":
                continue  # bound in simulation, no part of the design
            kind = fields.get("page", "")
            if kind.startswith("v_toggle"):
                toggles[name, fields["o"]] += count
            elif kind.startswith(("v_line", "v_branch")):
                for number in span(fields.get("S") or fields["l"]):
                    lines[name, number] += count
    return files, lines, toggles


def percent(part, whole):
    return 100.0 * part / whole if whole else 100.0


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=pathlib.Path, help="folder of .dat files")
    parser.add_argument("--gaps", action="store_true", help="list explained gaps and untoggled signals too")
    args = parser.parse_args()
    files, lines, toggles = collect(args.folder)
    if not lines or not toggles:
        sys.exit(f"coverage: no coverage data in {args.folder}")
    reasons = tomllib.loads(REASONS.read_text()).get("gap", []) if REASONS.exists() else []

    def reason(name, what):
        return next((r["why"] for r in reasons if r["file"] == name and re.search(r["what"], what)), None)

    unexplained, totals = 0, collections.Counter()
    print(f"{len(files)} data files\n")
    print("| file | lines | explained | toggles | explained |\n|---|---|---|---|---|")
    details = []
    for name in sorted({f for f, _ in lines} | {f for f, _ in toggles}):
        text = (ROOT / "rtl" / name).read_text().splitlines()
        mine = [(n, c) for (f, n), c in lines.items() if f == name]
        bits = [(s, c) for (f, s), c in toggles.items() if f == name]
        gaps = sorted((n, text[n - 1].strip()) for n, c in mine if c == 0)
        quiet = sorted(s for s, c in bits if c == 0)
        known = [g for g in gaps if reason(name, g[1])]
        known_quiet = [s for s in quiet if reason(name, s)]
        unexplained += len(gaps) - len(known)
        totals.update(lines=len(mine), covered=len(mine) - len(gaps), bits=len(bits), toggled=len(bits) - len(quiet), known=len(known), quiet=len(known_quiet))
        print(f"| {name} | {percent(len(mine) - len(gaps), len(mine)):.1f} % of {len(mine)} | {len(known)} | {percent(len(bits) - len(quiet), len(bits)):.1f} % of {len(bits)} | {len(known_quiet)} |")
        for number, code in gaps:
            why = reason(name, code)
            if why is None or args.gaps:
                details.append(f"{name}:{number}: {code}" + (f"  [{why}]" if why else "  [NOT COVERED]"))
        if args.gaps:
            details += [f"{name}: {s} does not toggle  [{reason(name, s) or 'not explained'}]" for s in quiet]
    toggle = percent(totals["toggled"], totals["bits"])
    print(f"\nlines {percent(totals['covered'], totals['lines']):.2f} % of {totals['lines']} ({totals['known']} gaps explained); toggles {toggle:.2f} % of {totals['bits']} ({totals['quiet']} explained)")
    print("\n".join(details))
    if unexplained:
        sys.exit(f"coverage: {unexplained} lines neither covered nor explained in scripts/coverage.toml")
    if toggle < TOGGLE_LIMIT:
        sys.exit(f"coverage: toggles under {TOGGLE_LIMIT} %")


if __name__ == "__main__":
    main()
