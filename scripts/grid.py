"""Grid primitives beside the BVH of the full resolution, the binary BVH that is their paper's reference (binary16), and ours: bytes a triangle, seconds to build, rays a second on one thread (`cargo bench --bench grid`), lines, cycles and energy on haydel2023 with compute free (`lodray simulate`), the same at equal error (`lodray error-time`), and what deciding by ray has of that (`cargo bench --bench one_delta`).

Writes tables between the marks of docs/baselines.md, and of docs/claims.md and its template.
"""

import argparse
import json
import os
import re
import statistics
import subprocess
import tempfile
from pathlib import Path

from markdown import among, number, put, table
from options import add_program, ended

ROOT = Path(__file__).resolve().parent.parent
LEVELS = [1, 2, 3, 4]
# What the paper says, row by row of the ledger.
SPEED = [f"trace speed against its reference at level {level}: {paper}" for level, paper in zip(LEVELS, ["0 to +28 %", "+10 to -39 %", "-16 to -68 %", "-55 to -85 %"])]
BUILD = "builds 42 times as fast as full SAH at three levels, 383 times at four"
BUILD_WHY = "both on all threads, 256 bins, a hundredth of the paper's triangles. Sampled while a grid of 8.4 M triangles is made, the BVH over primitives takes half a hundredth: what is left is reading and storing vertices, which no fewer primitives turn off"
# Steps from grids to ours, each with one thing changed.
STEPS = [
    ("full", "spheres", "boxes", "full detail: spheres, then boxes"),
    ("full", "boxes", "lod", "full detail: a grid with boxes, then our trees"),
    ("full", "prisms", "lod", "full detail: a grid with prisms, then our trees"),
    ("equal", "spheres", "boxes", "spheres, then boxes"),
    ("equal", "boxes", "trees", "a grid with boxes and one cap, then our trees cut at one level"),
    ("equal", "trees", "discrete", "our trees cut at one level, then a BVH of that level"),
    ("equal", "trees", "radius", "one level, then as many as the surface needs for one radius"),
    ("equal", "radius", "lod", "one radius for the frame, then each ray's own"),
]
WORDS = {2: "two", 4: "four", 6: "six"}
# Knobs of the variants that are simulated at full detail, and what they are called.
VARIANTS = [
    ("binary nodes", {"grid-nodes": "2"}),
    ("nodes of four", {"grid-nodes": "4"}),
    ("nodes of six", {"grid-nodes": "6"}),
    ("float vertices", {"grid-points": "float"}),
    *((f"{out} levels left out", {"grid-left-out": str(out)}) for out in (0, 1, 3, 4)),
    ("boxes", {"grid-bounds": "boxes"}),
    ("prisms", {"grid-bounds": "prisms"}),
    *((f"{levels} levels", {"grid-levels": str(levels)}) for levels in (1, 2, 3)),
]


class Runs:
    """What is run, and what of it is kept for later runs."""

    def __init__(self, args):
        self.args = args
        self.program = args.program
        self.out = Path(args.out)
        self.out.mkdir(parents=True, exist_ok=True)

    def json(self, *words):
        """What the program says as JSON, from the folder if it is there."""
        kept = self.out / (re.sub(r"[^\w.=-]+", "_", "_".join(map(str, words)))[-180:] + ".json")
        if not kept.exists():
            said = subprocess.run([self.program, *words, "--json"], check=True, capture_output=True, text=True).stdout
            part = kept.with_suffix(".part")
            part.write_text(said, encoding="utf-8")
            part.rename(kept)
        return json.loads(kept.read_text(encoding="utf-8"))

    def bench(self, name, file, scenes, **variables):
        """The lines of a benchmark, scene by scene."""
        kept = self.out / file
        if not kept.exists():
            words = ["cargo", "bench", "--quiet", "--bench", name, "--", *(scene.resolve() for scene in scenes)]
            found = subprocess.run(words, check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT, env={**os.environ, "LODRAY_GRID_SIZE": self.args.size.split("x")[0], **variables})
            part = kept.with_suffix(".part")
            part.write_text(found.stdout, encoding="utf-8")
            part.rename(kept)
        return [json.loads(line) for line in kept.read_text(encoding="utf-8").splitlines()]

    def error_time(self, scene, knobs, methods):
        """The figures of a scene with these knobs."""
        folder = self.out / ("error-time-" + "-".join([scene.stem, *methods, *knobs.values()]))
        if not (folder / "error-time.json").exists():
            with tempfile.NamedTemporaryFile("w", suffix=".toml", dir=self.out, delete=False) as jobs:
                quoted = lambda values: "[" + ", ".join(f'"{value}"' for value in values) + "]"
                jobs.write(f'size = "{self.args.size}"\nmethods = {quoted(methods)}\ncompute = ["free"]\n')
                jobs.write("[knobs]\n" + "".join(f'"{name}" = "{value}"\n' for name, value in knobs.items()))
                jobs.write(f'[[scene]]\nfile = "{scene.resolve()}"\ndistances = [{", ".join(self.args.distances)}]\n[[machine]]\nname = "haydel2023"\n')
            try:
                subprocess.run([self.program, "--quiet", "error-time", "--jobs", jobs.name, "-o", folder, "--samples", "1", "--most-samples", "0", "--no-host", "--error-size", "192"], check=True, capture_output=True)
            finally:
                Path(jobs.name).unlink()
        return json.loads((folder / "error-time.json").read_text(encoding="utf-8"))


def grid_bytes(runs, scene, levels, left_out, nodes, points):
    """Bytes a finest triangle of a grid."""
    made = runs.json("simulate", scene, "--size", "16x16", "--compute", "free", "--method", "grid", "--grid-levels", str(levels), "--grid-left-out", str(left_out), "--grid-nodes", str(nodes), "--grid-points", points)
    return made["setup"]["method"]["bytes"] / runs.json("info", scene)["finest_triangles"]


def bytes_tables(runs, scenes):
    """Bytes by levels, and rows of the ledger."""
    of = lambda levels, out, nodes=2, points="float": [grid_bytes(runs, scene, levels, out, nodes, points) for scene in scenes]
    forms = [("binary nodes, all radii", 0, 2, "float"), ("binary nodes, two levels left out", 2, 2, "float"), ("nodes of four, two left out", 2, 4, "float"), ("the same with packed vertices", 2, 4, "packed")]
    rows = [[name, *(among(of(levels, out, nodes, points)) for levels in LEVELS)] for name, out, nodes, points in forms]
    reference, bvh = ([runs.json("simulate", scene, "--size", "16x16", "--compute", "free", "--method", method)["setup"]["method"]["bytes"] / runs.json("info", scene)["finest_triangles"] for scene in scenes] for method in ("binary16", "bvh"))
    ledger = [
        ["6.3 bytes a triangle at four levels", f"{among(of(4, 2, 4))} with nodes of four and two levels left out, {among(of(4, 2))} with binary nodes, {among(of(4, 4))} with these and no radii at all", "the paper does not say what its 6.3 are made of; closed surfaces have 6 bytes of vertices, 0.09 of tuples, 0.31 of radii of two levels and 0.25 of binary nodes; open borders add vertices"],
        ["the same with 28 bits a coordinate", among(of(4, 2, 4, "packed")), "not in the paper"],
        ["4.5 times fewer bytes than its reference", f"{among([a / b for a, b in zip(reference, of(4, 2))])} times fewer than `binary16` ({among(reference)} bytes a triangle), {among([a / b for a, b in zip(bvh, of(4, 2))])} times fewer than `bvh`", f"the reference has the paper's size (4.5 x 6.3 = 28.4), so it is the grid that is larger: without radii, and with nodes of four, it has {among([a / b for a, b in zip(reference, of(4, 4, 4))])} times fewer; `bvh` has leaf blocks that share vertices"],
    ]
    return table(["bytes a triangle, by levels", *map(str, LEVELS)], rows, 1), ledger


def find(lines, scene, **wanted):
    """The line of the benchmark with these values."""
    return next(line for line in lines if line["scene"] == scene and line["of"] == "grid" and all(line[key] == value for key, value in wanted.items()))


def percent(ratios):
    """Least and most of some ratios, as what is gained or lost."""
    low, high = f"{100 * (min(ratios) - 1):+.0f} %", f"{100 * (max(ratios) - 1):+.0f} %"
    return low if low == high else f"{low} to {high}"


def bench_tables(lines, builds):
    """Seconds and rates, and rows of the ledger."""
    scenes = list(dict.fromkeys(line["scene"] for line in lines))
    bvh, reference = ({line["scene"]: line for line in lines if line["of"] == method} for method in ("bvh", "binary16"))
    whole = lambda scene, levels, nodes=2, out=None, points="float": find(lines, scene, levels=levels, left_out=min(levels, 2) if out is None else out, nodes=nodes, points=points)
    rows = []
    for levels in LEVELS:
        for left in range(levels + 1):
            own = {scene: whole(scene, levels, 4, left) for scene in scenes}
            two = {scene: whole(scene, levels, 2, left) for scene in scenes}
            rate = lambda of: statistics.median(bvh[scene]["seconds"] / of[scene]["seconds"] for scene in scenes)
            rows.append([levels, left, f"{rate(own):.2f}", f"{rate(two):.2f}", number(statistics.median(two[scene]["rays"] / two[scene]["float_seconds"] / 1e6 for scene in scenes)), f"{statistics.median(reference[scene]['float_seconds'] / two[scene]['float_seconds'] for scene in scenes):.2f}", number(statistics.median(own[scene]["build"] for scene in scenes)), f"{statistics.median(bvh[scene]['build'] / own[scene]['build'] for scene in scenes):.1f}"])
    out = [table(["levels", "left out", "rays a second over `bvh`'s, nodes of four", "binary nodes", "million rays a second in floats, binary nodes", "over `binary16`'s in floats", "seconds to build, nodes of four", "`bvh`'s over that"], rows, 0)]
    boundary = [line["bytes"]["boundary"] / sum(line["bytes"][name] for name in ("corner", "boundary", "inside")) for line in (whole(scene, 3) for scene in scenes)]
    # In floats, how much faster the reference is with leaves of other sizes.
    sizes = {(line["scene"], line["leaf"]): line["float_seconds"] for line in lines if line["of"] == "leaves"}
    gains = {leaf: {scene: sizes[scene, 16] / sizes[scene, leaf] for scene in scenes} for leaf in dict.fromkeys(leaf for _, leaf in sizes)}
    speed = lambda levels: percent([reference[scene]["float_seconds"] / whole(scene, levels)["float_seconds"] for scene in scenes])
    exact = lambda levels: percent([reference[scene]["seconds"] / whole(scene, levels)["seconds"] for scene in scenes])
    # Of each level, rates by levels left out over the best.
    rates = {levels: [statistics.median(min(whole(scene, levels, 2, out)["float_seconds"] for out in range(levels + 1)) / whole(scene, levels, 2, left)["float_seconds"] for scene in scenes) for left in range(levels + 1)] for levels in LEVELS}
    built = {}
    for line in (line for line in builds if "build" in line):
        built.setdefault((line["triangles"], line["scene"]), []).append(line)
    of = lambda lines, **wanted: next(line for line in lines if all(line.get(key) == value for key, value in wanted.items()))["build"]
    build = lambda levels: among([of(own, of="binary16") / of(own, of="grid", levels=levels, nodes=2) for own in built.values()])
    others = ", ".join(f"{statistics.median(gains[leaf].values()):.2f} times as fast with {leaf}" for leaf in sorted(gains) if leaf != 16)
    leaves = f"not the leaves of 16, which the paper chose for its device: here the reference is {others}, within what runs differ. What else differs is the device, a processor in place of an RTX 2080 Ti, which was not turned off"
    why = {1: leaves, 2: "as above", 3: "as above", 4: "as above"}
    ledger = [
        ["boundary vertices are about a third of geometry (three levels)", among(boundary), "3 (M - 1) / 2 of M^2 / 2 vertices a primitive, M = 8"],
        *([paper, f"{speed(levels)} against `binary16`, both in floats on one thread; {exact(levels)} with exact tests", why[levels]] for levels, paper in zip(LEVELS, SPEED)),
        [BUILD, f"{build(3)} times and {build(4)} times as fast as `binary16`, scenes of {min(built)[0] / 1e6:.1f} to {max(built)[0] / 1e6:.1f} M triangles", BUILD_WHY],
        ["two levels without spheres are best", "in floats, the share of the best rate with 0, 1, ... left out: " + "; ".join(f"at {levels} {'level' if levels == 1 else 'levels'} " + ", ".join(f"{rate:.2f}" for rate in rates[levels]) for levels in LEVELS), "binary nodes, medians over the scenes; on a processor one and two are alike"],
    ]
    names = {"bvh": "`bvh`", "binary16": "`binary16`"}
    name = lambda line: names.get(line["of"]) or f"grid, {line['levels']} levels, nodes of {WORDS[line['nodes']]}"
    # The largest scene alone.
    rows = [[name(line), f"{line['build']:.2f}", f"{of(built[max(built)], of='binary16') / line['build']:.1f}", f"{sum(line['bytes'].values()) / line['triangles']:.2f}"] for line in built[max(built)]]
    out.append(table([f"building {max(built)[0]:,} triangles", "seconds", "`binary16`'s over that", "bytes a triangle"], rows, 1))
    return out, ledger


KEYS = ["groups", "triangles", "requests", "dram_bytes", "cycles", "energy"]
HEAD = ["groups of children tested", "triangles tested", "lines asked for", "bytes of DRAM", "cycles", "energy", "cycles, least and most", "views"]


def compared(name, pairs, views):
    """A row: medians of the first of each pair over the second."""
    columns = list(zip(*([a[key] / b[key] for key in KEYS] for a, b in pairs)))
    return [name, *(f"{statistics.median(column):.2f}" for column in columns), f"{min(columns[4]):.2f} to {max(columns[4]):.2f}", f"{len(pairs)} of {views}"]


def one_delta_tables(lines, near):
    """What deciding costs and brings: ways beside one another, then step by step."""
    names = {
        "full": [("spheres", "grid, spheres"), ("boxes", "grid, boxes"), ("prisms", "grid, prisms"), ("lod", "our trees")],
        "equal": [("spheres", "grid, one cap, spheres"), ("boxes", "grid, one cap, boxes"), ("prisms", "grid, one cap, prisms"), ("discrete", "a BVH of one level"), ("trees", "our trees, cut at one level"), ("radius", "our trees, one radius for all rays")],
    }

    def pairs(lines, at, before, after):
        by = {(line["at"], line["way"], line["scene"], line["distance"]): line for line in lines}
        other = lambda line: by.get((at, after, line["scene"], line["distance"]))
        return [(line, other(line)) for line in lines if (line["at"], line["way"]) == (at, before) and other(line)]

    views = lambda lines: len({(line["scene"], line["distance"]) for line in lines})
    ways = [[title, *compared(name, pairs(lines, at, way, base), views(lines))] for at, base, title in (("full", "bvh", "full detail, over `bvh`"), ("equal", "lod", "the error of ours, over ours by ray")) for way, name in names[at]]
    steps = lambda lines: [compared(name, pairs(lines, at, before, after), views(lines)) for at, before, after, name in STEPS]
    tables = [table(["at", "what", *HEAD], ways, 2), table(["one step: before over after", *HEAD], steps(lines), 1)]
    if near:
        tables.append(table(["the same from near to far", *HEAD], steps(near), 1))
    return "\n\n".join(tables)


def simulated(runs, scenes):
    """Every variant at full detail, over `bvh`."""
    figures = lambda made: [made["cycles"], made["energy"]["total"], made["dram"]["reads"], made["accesses_per_ray"]]
    rows, per = [], {}
    for scene in scenes:
        for distance in runs.args.distances:
            frame = ["simulate", scene, "--machine", "haydel2023", "--compute", "free", "--distance", distance, "--size", runs.args.size]
            base = figures(runs.json(*frame, "--method", "bvh"))
            for name, knobs in VARIANTS:
                words = [word for knob, value in knobs.items() for word in (f"--{knob}", value)]
                own = figures(runs.json(*frame, "--method", "grid", *(["--grid-points", "packed"] if "grid-points" not in knobs else []), *words))
                per.setdefault(name, []).append([a / b for a, b in zip(own, base)])
    for name, ratios in per.items():
        columns = list(zip(*ratios))
        rows.append([name, *(f"{statistics.median(column):.2f}" for column in columns), f"{min(columns[0]):.2f} to {max(columns[0]):.2f}"])
    cycles = {left: statistics.median(ratio[0] for ratio in per[name]) for left, name in enumerate(["0 levels left out", "1 levels left out", "nodes of four", "3 levels left out", "4 levels left out"])}
    best = ["two levels without spheres are best", f"{min(cycles, key=cycles.get)} of 0 to 4, by cycles on haydel2023: over `bvh` " + ", ".join(f"{value:.2f}" for value in cycles.values()), "four levels; compute free"]
    return best, table(["grid over `bvh`", "cycles", "energy", "DRAM reads", "requests a ray", "cycles, least and most"], rows, 1)


def equal_error(runs, scenes):
    """Ours by ray, whole levels, and grids with a cap, at the error that ours has at delta 1."""
    rows = []
    for scene in scenes:
        ours = runs.error_time(scene, {}, ["lod", "discrete", "grid", "bvh"])
        boxes = runs.error_time(scene, {"grid-bounds": "boxes"}, ["grid"])
        for view, of in enumerate(ours["views"]):
            points = [point for point in ours["points"] if point["view"] == view]
            error = lambda point: point["geometry"]["surface"]["percentile_99"]
            lod = next(point for point in points if point["method"] == "lod" and point["is_default"])
            cost = lambda point: point["costs"][0]["cycles"]
            limit = max(error(lod), 1e-9)

            def serves(method, among_points):
                fit = [point for point in among_points if point["method"] == method and error(point) <= limit]
                return min(fit, key=cost, default=None)

            def over(point):
                if point is None:
                    return ["none", "", "", ""]
                a, b = point["costs"][0], lod["costs"][0]
                return [point["setting"].split(",")[0] if point["method"] == "discrete" else "cap " + point["knobs"].get("cap", ""), *(f"{x / y:.2f}" for x, y in ((a["cycles"], b["cycles"]), (a["energy"]["total"], b["energy"]["total"]), (a["dram_lines"], b["dram_lines"])))]

            grid = serves("grid", points)
            of_boxes = serves("grid", [point for point in boxes["points"] if point["view"] == view])
            row = [scene.stem, f"{of['distance']:g}", f"{limit:.2f}", *over(serves("discrete", points)), *over(grid), *over(of_boxes)[1:2]]
            seen = runs.json("simulate", scene, "--machine", "haydel2023", "--compute", "free", "--distance", f"{of['distance']:g}", "--size", runs.args.size, "--method", "grid", "--grid-points", "packed", "--cap", "distance")
            row += [f"{seen['cycles'] / lod['costs'][0]['cycles']:.2f}", seen["setup"]["method"]["choices"]["open edges"]]
            rows.append(row)
    head = ["scene", "radii", "surface off, 99th percentile, pixels", "whole level", "cycles", "energy", "DRAM lines", "grid", "cycles", "energy", "DRAM lines", "with boxes, cycles", "`--cap distance`, cycles", "its open edges"]
    return table(head, rows, 1)


def main():
    """Runs all of it, and writes the tables."""
    parser = argparse.ArgumentParser(prog="scripts/grid", description=__doc__.split("\n", maxsplit=1)[0])
    add_program(parser)
    parser.add_argument("--size", default="512x512", help="size of the frames (default 512x512)")
    parser.add_argument("--distances", type=lambda text: text.split(","), default=["1.5", "4", "16"], help="distances of the eye in radii, with commas (default 1.5,4,16)")
    parser.add_argument("--out", default="target/grid", help="folder in which what was run is kept; a run that is started again goes on with it (default target/grid)")
    parser.add_argument("--large", type=Path, help="scene file of which building alone is timed too")
    parser.add_argument("--near", type=Path, help="scene file, a wide terrain, that is seen from 0.1 and 0.3 radii too")
    parser.add_argument("--no-bench", action="store_true", help="leave building and rays a second out; the ledger stays as it is")
    parser.add_argument("--no-frames", action="store_true", help="leave the simulated frames out; the ledger stays as it is")
    parser.add_argument("--print", action="store_true", help="print the tables, and leave the documents alone")
    parser.add_argument("scene", nargs="+", type=Path, help="scene files (generate, build)")
    args = parser.parse_args()
    runs = Runs(args)
    text, ledger = bytes_tables(runs, args.scene)
    texts = {"bytes": text}
    if not args.no_bench:
        builds = runs.bench("grid", "build.jsonl", [*args.scene, *([args.large] if args.large else [])], LODRAY_GRID_BUILD="1", LODRAY_GRID_SIZE="64")
        tables, more = bench_tables(runs.bench("grid", "bench.jsonl", args.scene), builds)
        texts["bench"], ledger = "\n\n".join(tables), ledger + more
    if not args.no_frames:
        best, frames = simulated(runs, args.scene)
        ledger.append(best)
        texts["frames"] = frames + "\n\n" + equal_error(runs, args.scene)
        lines = runs.bench("one_delta", "one-delta.jsonl", args.scene, LODRAY_GRID_DISTANCES=",".join(args.distances))
        near = runs.bench("one_delta", "near.jsonl", [args.near], LODRAY_GRID_DISTANCES="0.1,0.3") if args.near else []
        texts["decisions"] = one_delta_tables(lines, near)
    rows = table(["paper", "measured", "difference, and why"], ledger, 3)
    if args.print:
        print("\n\n".join([*texts.values(), rows]))
        return
    for name, text in texts.items():
        put(ROOT / "docs" / "baselines.md", f"<!-- grid {name} -->", f"<!-- grid {name} end -->", text)
    # Half a ledger says nothing.
    is_whole = not (args.no_bench or args.no_frames)
    for path in [ROOT / "docs" / "claims.md", ROOT / "scripts" / "paper" / "claims.md"] if is_whole else []:
        put(path, "<!-- grid ledger -->", "<!-- grid ledger end -->", rows)


if __name__ == "__main__":
    ended(main)
