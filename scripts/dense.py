"""Blocks of AMD's dense geometry format: leaves of `bvh6` in them, against leaf blocks of our own; clusters in them, against vertices of 16 bits with 8-bit indices. And clusters by how many are simplified together, and what it brings that a simplifier places their triangles.

Frames are simulated with compute free. Scenes need coordinates that fit (`--coordinate-zeros`). Writes tables between the marks of docs/baselines.md. Results are kept in --out, and runs that are there are not run again.
"""

import argparse
import json
import math
import shutil
import statistics
import subprocess
from pathlib import Path

from keep import kept
from markdown import number, put, table
from options import add_program, ended

ROOT = Path(__file__).resolve().parent.parent
LEAVES = [("block", 16), ("dgf", 4), ("dgf", 2)]
PARTITIONS = [8, 16, 24, 32]


def frame(args, scene, distance, *more):
    run = kept(args, ["simulate", scene, "--size", args.size, "--machine", args.machine, "--compute", "free", "--distance", distance, *more])
    dram = run["dram"]
    work = (run["frames"][0].get("before") or {}).get("cycles", 0)
    method, setup = run["setup"]["method"], run["setup"]["scene"]
    return {"cycles": run["cycles"], "energy": run["energy"]["total"], "lines": dram["reads"] + dram.get("writes", 0), "work": work, "bytes": method["bytes"] / setup["finest_triangles"], **method.get("choices", {})}


def over(run, base):
    return [f"{run[what] / base[what]:.2f}" for what in ("cycles", "energy", "lines")]


def leaves(args):
    rows = []
    for scene in args.scenes:
        for distance in args.distances:
            base, *others = ((layout, size, frame(args, scene, distance, "--method", "bvh6", "--leaf-layout", layout, "--leaf-size", size)) for layout, size in LEAVES)
            for layout, size, run in others:
                rows.append([scene.stem, distance, f"{layout} {size}", f"{base[2]['bytes']:.2f}", f"{run['bytes']:.2f}", number(base[2]["cycles"]), *over(run, base[2])])
    head = ["scene", "radii", "leaves", "bytes a triangle, blocks of our own", "dgf", "cycles, blocks of our own", "time, dgf over those", "energy", "DRAM lines"]
    return table(head, rows, 3)


def clusters(args):
    lines = args.out / "bench.jsonl"
    if not lines.exists():
        run = subprocess.run(["cargo", "bench", "--quiet", "--bench", "cluster", "--", *(scene.resolve() for scene in args.scenes)], check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT)
        lines.write_text(run.stdout, encoding="utf-8")
    sizes = [line for line in map(json.loads, lines.read_text(encoding="utf-8").splitlines()) if line["of"] == "cluster"]
    rows = []
    for scene, size in zip(args.scenes, sizes, strict=True):
        per = [f"{size[form] / size['triangles']:.2f}" for form in ("bytes", "dense")]
        for distance in args.distances:
            base, run = (frame(args, scene, distance, "--method", "cluster", "--cluster-layout", layout) for layout in ("indexed", "dgf"))
            rows.append([scene.stem, distance, *per, number(base["work"]), f"{run['work'] / base['work']:.2f}", *over(run, base)])
    head = ["scene", "radii", "bytes a triangle, indexed", "dgf", "cycles of the work before a frame, indexed", "dgf over that", "time of the frame", "energy", "DRAM lines"]
    return table(head, rows, 2)


def partitions(args):
    rows = []
    for scene in args.scenes:
        for distance in args.distances:
            runs = [(count, frame(args, scene, distance, "--method", "cluster", "--partition", count)) for count in PARTITIONS]
            base = dict(runs)[16]
            for count, run in runs:
                seen = kept(args, ["render", scene, "--size", args.size, "--distance", distance, "--method", "cluster", "--partition", count, "--compare"])
                off = seen["error"]["geometry_pixels"]["percentile_99"]
                rows.append([scene.stem, distance, count, number(int(run["of"])), run["roots"], number(int(run["triangles"])), f"{off:.2f}", f"{100 * run['work'] / run['cycles']:.0f} %", *over(run, base)])
    head = ["scene", "radii", "clusters simplified together", "clusters", "roots", "triangles chosen", "pixels off, 99 of 100 below", "work, of the frame", "time over 16", "energy", "DRAM lines"]
    return table(head, rows, 2)


def between(points, x):
    """What a curve of points has at x, straight lines in logarithms; none beyond its ends."""
    points = sorted(points)
    for (x0, y0), (x1, y1) in zip(points, points[1:]):
        if x0 <= x <= x1 and x0 < x1:
            part = math.log(x / x0) / math.log(x1 / x0)
            return math.exp((1 - part) * math.log(y0) + part * math.log(y1))
    return None


def placed(args):
    """Errors of levels and of clusters of as many triangles, both of the scene's own finest level, from where all of it is about as far away."""
    rows, ratios = [], ([], [])
    for scene in args.scenes:
        folder = args.out / f"placed-{scene.stem}"
        if not (folder / "error-time.json").exists():
            # Where its mesh is not beside it.
            shutil.copy(scene, args.out / scene.name)
            jobs = args.out / f"placed-{scene.stem}.toml"
            jobs.write_text(f'size = "{args.size}"\nmethods = ["discrete", "cluster"]\ncompute = ["free"]\n[[scene]]\nfile = "{scene.name}"\ndistances = [8]\n[[machine]]\nname = "{args.machine}"\n', encoding="utf-8")
            size = args.size.split("x", maxsplit=1)[0]
            subprocess.run([args.program, "--quiet", "error-time", "--jobs", jobs.name, "-o", folder.name, "--samples", "1", "--most-samples", "0", "--no-host", "--error-size", size], check=True, cwd=args.out, stdout=subprocess.DEVNULL)
        document = json.loads((folder / "error-time.json").read_text(encoding="utf-8"))
        base = document["scenes"][0]["base_triangles"]
        off = lambda point: point["geometry"]["surface"]["percentile_99"]
        clusters = [(int(point["choices"]["triangles"]), off(point)) for point in document["points"] if point["method"] == "cluster"]
        levels = [(base << 2 * int(point["choices"]["level"]), off(point)) for point in document["points"] if point["method"] == "discrete"]
        for count, error in levels[:-1]:
            own, needed = between(clusters, count), between([(error, count) for count, error in clusters], error)
            both = zip((own, needed), (error, count), ratios)
            over = [f"{value / level:.2f}" if value and not kept_.append(value / level) else "-" for value, level, kept_ in both]
            rows.append([scene.stem, number(count), f"{error:.3f}", f"{own:.3f}" if own else "-", over[0], number(round(needed)) if needed else "-", over[1]])
    rows.append(["median", "", "", "", f"{statistics.median(ratios[0]):.2f}", "", f"{statistics.median(ratios[1]):.2f}"])
    head = ["scene", "triangles of a level", "pixels off, 99 of 100 below", "clusters of as many", "over the level", "triangles of clusters as far off", "over the level's"]
    return table(head, rows, 1)


def main():
    parser = argparse.ArgumentParser(prog="scripts/dense", description=__doc__)
    add_program(parser)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "dense", help="folder of what is kept")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--machine", default="haydel2023")
    parser.add_argument("--distances", nargs="+", default=["1.5", "6"], help="of the eye, in radii")
    parser.add_argument("scenes", nargs="+", type=Path, help="scene files (generate, build), the meshes that they were built from beside them")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    for name, made in [("leaves", leaves), ("clusters", clusters), ("partitions", partitions), ("placed", placed)]:
        put(ROOT / "docs" / "baselines.md", f"<!-- dense {name} -->", f"<!-- dense {name} end -->", made(args))


if __name__ == "__main__":
    ended(main)
