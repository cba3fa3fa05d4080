"""Traversal units balanced: gate equivalents against rays a second, ours and a BVH's.

Every unit of a grid is simulated in every view, its rays those of several tiles in turn. What no other unit beats in both gates and rate is the front; its knee is the unit
with the fewest gates for what it gives. Of the machine's own unit each block is eased in turn, to see what it costs. Writes tables between the marks of docs/hardware.md, and a diagram for each
machine to docs/images. Results are kept in --out; a run that was stopped goes on.
"""

import argparse
import itertools
import json
import math
import subprocess
from pathlib import Path

from keep import kept
from markdown import number, put, table
from options import add_program, ended
from plot import diagram

ROOT = Path(__file__).resolve().parent.parent
DOCUMENT = ROOT / "docs" / "hardware.md"
METHODS = ["lod", "bvh6"]
# Scenes that are made here, and how far the eye is in radii; from a scan (--scan) it is SCAN_RADII away.
VIEWS = {"terrain": [2, 4], "cloth": [3.15]}
SCAN_RADII = [2]
# Every number of units and contexts, with each of the blocks: edges of the LOD test and boxes a cycle; ray_setup and hit_divide in turns.
NUMBERS = {"units.per_group": [1, 2, 4], "units.contexts": [16, 32, 64]}
BLOCKS = [
    {"units.lod_edges_per_cycle": edges, "units.boxes_per_cycle": boxes, "units.setup_copies": setups, "units.divide_copies": divides}
    for (edges, boxes), (setups, divides) in itertools.product([(1, 2), (3, 4)], [(1, 1), (3, 2)])
]
KEYS = [*NUMBERS, *BLOCKS[0]]
IN_TURN = [1, 4]
SWEPT = [1, 2, 4, 8, 16, 64]


def views(args):
    """Scenes by name, and the distances of their eyes."""
    return VIEWS | ({args.scan.stem: SCAN_RADII} if args.scan else {})


def values(entries):
    return "{ " + ", ".join(f'"{key}" = {json.dumps(value)}' for key, value in entries.items()) + " }"


def jobs(args, machine, units):
    """A list of jobs: all views; units with tiles in turn, or compute free in each order where there are none."""
    lines = [f'size = "{args.size}"', f"methods = {json.dumps(METHODS)}", f'compute = ["{"units" if units else "free"}"]']
    for (name, distances), turn in itertools.product(views(args).items(), IN_TURN[1:] if units else IN_TURN):
        lines += ["[[scene]]", f'name = "{name}-{turn}"', f"file = {json.dumps(str(scene(args, name)))}", f"distances = {distances}", f"tiles_in_turn = {turn}"]
    for blocks in BLOCKS if units else [{}]:
        lines += ["[[machine]]", f'name = "{machine}"']
        if units:
            lines.append(f"set = {values({**NUMBERS, **blocks})}")
    return "\n".join(lines) + "\n"


def swept(args, machine, units):
    """The results of a sweep by method, order of tiles, and unit: of each view its result."""
    name = f"{machine}-{'units' if units else 'free'}"
    listed = args.out / f"{name}.toml"
    listed.write_text(jobs(args, machine, units), encoding="utf-8")
    subprocess.run([args.program, "sweep", listed, "-o", args.out / name], check=True, stdout=subprocess.DEVNULL)
    found = {}
    for line in (args.out / name / "results.jsonl").read_text(encoding="utf-8").splitlines():
        row = json.loads(line)
        if row.get("result") is None:
            continue
        result, (scene, turn) = row["result"], row["scene"].rsplit("-", 1)
        own = result["setup"]["machine"]["description"]["units"]
        unit = tuple(own[key.split(".")[1]] for key in KEYS) if units else None
        of = found.setdefault((result["setup"]["method"]["name"], int(turn), unit), {})
        of[scene, result["setup"]["view"]["distance"]] = result
    return found


def mean(numbers):
    """The geometric mean."""
    numbers = list(numbers)
    return math.exp(sum(map(math.log, numbers)) / len(numbers))


def points(found, free):
    """Each unit: gate equivalents of a group's, million rays a second in the mean of the views, and the share of compute free's rate."""
    for (method, turn, unit), views in found.items():
        results = list(views.values())
        rate = mean(of["rays"] / of["milliseconds"] / 1e3 for of in results)
        most = max(mean(of["rays"] / of["milliseconds"] / 1e3 for of in free[method, order, None].values()) for order in IN_TURN)
        gates = unit[0] * results[0]["units"]["gate_equivalents"]
        yield {"method": method, "turn": turn, "unit": unit, "gates": gates, "rate": rate, "kept": rate / most, "views": views}


def front(all_points):
    """Those that no other beats in both, by gates."""
    best = []
    for point in sorted(all_points, key=lambda of: (of["gates"], -of["rate"])):
        if not best or point["rate"] > best[-1]["rate"]:
            best.append(point)
    return best


def front_rows(machine, groups, own):
    """Rows of a machine's fronts, and the lines of its diagram: gates are of all groups."""
    lines = {}
    rows = []
    for method in METHODS:
        line = front(of for of in own if of["method"] == method)
        lines[method] = [(groups * of["gates"] / 1e6, of["rate"]) for of in line]
        knee = min(line, key=lambda of: of["gates"] / of["rate"])
        for of in line:
            per_group, contexts, lod, boxes, *copies = of["unit"]
            name = f"**{method}**" if of is knee else method
            costs = [number(groups * of["gates"] / 1e6), number(of["rate"]), number(groups * of["gates"] / of["rate"]), f"{100 * of['kept']:.0f} %"]
            rows.append([machine, name, per_group, contexts, lod if method == "lod" else "-", boxes, *copies, *costs])
    return rows, lines


def scene(args, name):
    """A scene as a file: the scan, or one that is made here."""
    if args.scan and name == args.scan.stem:
        return args.scan.resolve()
    path = args.out.resolve() / f"{name}.lod"
    if not path.exists():
        subprocess.run([args.program, "generate", name, "-o", path, "--quiet"], check=True, stdout=subprocess.DEVNULL)
    return path


def phase_rows(args, machine):
    """Blocks of the machine's own unit: how full they are, and the frame with each eased, tile by tile and of several tiles in turn."""
    for name, distances in views(args).items():
        for distance in distances:
            words = ["simulate", scene(args, name), "--size", args.size, "--distance", distance, "--machine", machine, "--compute", "units", "--ease"]
            runs = [kept(args, [*words, *(["--tiles-in-turn", turn] if turn > 1 else [])]) for turn in IN_TURN]
            blocks = [block for block in runs[0]["units"]["eased"] if block in runs[0]["units"]["phases"]["blocks"]]
            for block in [*blocks, "all", "latency", "split_lines"]:
                cells = []
                for run in runs:
                    of = run["units"]["phases"]["blocks"].get(block)
                    full = ["-", "-", "-"] if of is None else [f"{100 * of[key]:.0f} %" for key in ("load", "full", "fullest")]
                    cells += [*full, f"{run['units']['eased'][block] / run['cycles']:.2f}"]
                yield [machine, f"{name}, {distance:g}", block, *cells]


def turn_rows(args, machine):
    """Cycles by the number of tiles whose rays are handed out in turn, over tile by tile."""
    for name, distances in views(args).items():
        for distance in distances:
            for method in METHODS:
                for compute in ["free", "units"]:
                    words = ["simulate", scene(args, name), "--method", method, "--size", args.size, "--distance", distance, "--machine", machine, "--compute", compute]
                    cycles = [kept(args, [*words, *(["--tiles-in-turn", turn] if turn > 1 else [])])["cycles"] for turn in SWEPT]
                    yield [machine, f"{name}, {distance:g}", method, compute, number(cycles[0]), *(f"{of / cycles[0]:.2f}" for of in cycles[1:])]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    add_program(parser)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "balance", help="folder of what is kept")
    parser.add_argument("--scan", type=Path, help="the scene file of a scan (build), another view")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--machines", nargs="+", default=["haydel2023", "turing2018"])
    args = parser.parse_args()
    if args.scan and not args.scan.is_file():
        parser.error(f"--scan: no file {args.scan}")
    args.out.mkdir(parents=True, exist_ok=True)
    for machine in args.machines:
        measure(args, machine)


def measure(args, machine):
    """Writes a machine's tables and its diagram."""
    put_in = lambda what, head, rows, words: put(DOCUMENT, f"<!-- balance: {what} {machine} -->", f"<!-- balance: {what} {machine} end -->", table(head, rows, words))
    in_turn = [f"{turn} tiles" for turn in SWEPT[1:]]
    put_in("order", ["machine", "view, radii", "method", "compute", "cycles, tile by tile", *in_turn], list(turn_rows(args, machine)), 4)
    both = [f"{what}, {turn} in turn" for turn in IN_TURN for what in ("load", "90 % full", "the fullest", "cycles if eased")]
    put_in("phases", ["machine", "view, radii", "block", *both], list(phase_rows(args, machine)), 3)
    found, free = swept(args, machine, True), swept(args, machine, False)
    own = list(points(found, free))
    groups = next(iter(own[0]["views"].values()))["setup"]["machine"]["description"]["cores"]["groups"]
    rows, lines = front_rows(machine, groups, own)
    head = ["machine", "method", "units of a group", "contexts", "edges of LOD test", "boxes", "setups", "divisions", "million GE", "million rays/s", "GE for a million rays/s", "of compute free's rate"]
    put_in("front", head, rows, 2)
    image = ROOT / "docs" / "images" / f"balance-{machine}.svg"
    image.write_text(diagram(f"Traversal units of {machine}", "million gate equivalents", "million rays a second", lines), encoding="utf-8")


if __name__ == "__main__":
    ended(main)
