"""Who wins where: ours, discrete levels, BVHs, grids, clusters and R-LODs over the same scenes, each at every setting of its own sweep, and at equal error who is cheapest (`lodray error-time`, compute free).

Writes tables between the marks of docs/who-wins.md. Each scene, distance and machine is a piece by itself, which is kept: shards take different pieces, in any order and on any machine, and the tables are the same.
"""

import argparse
import json
import statistics
import subprocess
import tempfile
from pathlib import Path

from markdown import among, number, put, table

ROOT = Path(__file__).resolve().parent.parent
METHODS = ["lod", "discrete", "bvh6", "input-bvh6", "grid", "cluster", "cluster-paper", "rlod"]
# What errors are, and how large they may be.
ERRORS = {
    "surface": ("pixels off (99 of 100)", [0.25, 0.5, 1, 2], lambda point: point["geometry"]["surface"]["percentile_99"]),
    "flip": ("FLIP", [0.01, 0.05], lambda point: point["picture"]["flip"]["mean"]),
}
COSTS = {
    "time": lambda cost: cost["milliseconds"],
    "energy": lambda cost: cost["energy"]["total"],
    "DRAM lines": lambda cost: cost["dram_lines"],
    "time, moving": lambda cost: cost["warm"]["milliseconds"],
    "energy, moving": lambda cost: cost["warm"]["energy"],
}


def triangles(program, scene):
    """Triangles of a scene at its finest level, and whether the mesh that it was made from is named in it."""
    said = json.loads(subprocess.run([program, "info", scene, "--json"], check=True, stdout=subprocess.PIPE, text=True).stdout)
    return said["finest_triangles"], "file" in (said.get("origin") or {})


def shard_of(pieces, count):
    """The shard of each piece: the largest first, each to the shard that has the least, so that all take about as long."""
    loads, of = [0] * count, {}
    for cost, piece in sorted(((cost, piece) for piece, cost in pieces.items()), key=lambda pair: (-pair[0], pair[1])):
        least = loads.index(min(loads))
        loads[least] += cost
        of[piece] = least + 1
    return of


def measured(args, piece):
    """A piece: run now, or kept from before."""
    scene, distance, machine = piece
    folder = args.out / f"{Path(scene).stem}-{distance}-{machine}"
    if not (folder / "error-time.json").exists():
        _, has_mesh = triangles(args.program, scene)
        methods = [method for method in METHODS if has_mesh or not method.startswith("input")]
        with tempfile.NamedTemporaryFile("w", suffix=".toml", dir=args.out, delete=False) as jobs:
            quoted = ", ".join(f'"{method}"' for method in methods)
            jobs.write(f'size = "{args.size}"\nmethods = [{quoted}]\ncompute = ["free"]\n')
            jobs.write(f'[[scene]]\nfile = "{Path(scene).resolve()}"\ndistances = [{distance}]\n[[machine]]\nname = "{machine}"\n')
        try:
            more = ["--samples", "1", "--most-samples", "0", "--no-host", "--error-size", "192", "--frames", "4", "--turn", "3"]
            subprocess.run([args.program, "--quiet", "error-time", "--jobs", jobs.name, "-o", folder, *more], check=True, stdout=subprocess.DEVNULL)
        finally:
            Path(jobs.name).unlink()
    return json.loads((folder / "error-time.json").read_text(encoding="utf-8"))


def cheapest(document, kind, level, cost):
    """Of each method its least cost among settings that are no worse than `level`; none if it has no such setting."""
    error = ERRORS[kind][2]
    best = {}
    for point in document["points"]:
        best.setdefault(point["method"], None)
        if error(point) <= level:
            own = cost(point["costs"][0])
            if best[point["method"]] is None or own < best[point["method"]]:
                best[point["method"]] = own
    return best


def winners(documents, kind, what):
    """The map: who is cheapest in each view and at each error, and by how much before the next; and what ours costs over that."""
    name, levels, _ = ERRORS[kind]
    rows = []
    for (scene, distance, machine), document in documents.items():
        row = [Path(scene).stem, distance, machine]
        for level in levels:
            reached = {method: cost for method, cost in cheapest(document, kind, level, COSTS[what]).items() if cost is not None}
            if not reached:
                row += ["nobody", ""]
                continue
            first, *rest = sorted(reached, key=lambda method: (reached[method], METHODS.index(method)))
            row.append(f"**{first}**" + (f" ({reached[rest[0]] / reached[first]:.2f} {rest[0]})" if rest else ""))
            row.append(f"{reached['lod'] / reached[first]:.2f}" if "lod" in reached else "cannot")
        rows.append(row)
    return table(["scene", "radii", "machine"] + [head for level in levels for head in (f"{name} {level:g}", "ours")], rows, 3)


def all_over_ours(documents, kind):
    """Medians of each method's costs over ours, least to most, and in how many views it reaches an error that ours reaches."""
    name, levels, _ = ERRORS[kind]
    rows = []
    for level in levels:
        for method in METHODS[1:]:
            cells, reached, asked = [], 0, 0
            for what in COSTS:
                ratios = []
                reached = asked = 0
                for document in documents.values():
                    best = cheapest(document, kind, level, COSTS[what])
                    if method in best and best["lod"] is not None:
                        asked += 1
                        if best[method] is not None:
                            reached += 1
                            ratios.append(best[method] / max(best["lod"], 1e-12))
                cells.append(f"{statistics.median(ratios):.2f} ({among(ratios)})" if ratios else "cannot")
            rows.append([f"{level:g}", f"`{method}`", f"{reached} of {asked}", *cells])
    return table([name, "method over ours, median (least to most)", "views reached", *COSTS], rows, 3)


def counted(documents):
    """How often each method is cheapest, over all views and errors."""
    rows = []
    for method in METHODS:
        row = [f"`{method}`"]
        for what in COSTS:
            won = of = 0
            for document in documents.values():
                for kind, (_, levels, _) in ERRORS.items():
                    for level in levels:
                        best = {own: cost for own, cost in cheapest(document, kind, level, COSTS[what]).items() if cost is not None}
                        if best:
                            of += 1
                            won += min(best, key=lambda own: (best[own], METHODS.index(own))) == method
            row.append(f"{won} of {of}")
        rows.append(row)
    return table(["cheapest", *COSTS], rows, 1)


def sizes(documents):
    """Bytes a triangle of each method, by scene."""
    scenes = {}
    for (scene, *_), document in documents.items():
        own = scenes.setdefault(Path(scene).stem, {})
        for point in document["points"]:
            own[point["method"]] = point["bytes_per_triangle"]
    rows = [[name, *(f"{own[method]:.2f}" if method in own else "" for method in METHODS)] for name, own in scenes.items()]
    return table(["bytes a triangle", *(f"`{method}`" for method in METHODS)], rows, 1)


def main():
    """Measures what is not yet there, and writes the tables if all is."""
    parser = argparse.ArgumentParser(prog="scripts/who-wins", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--program", default="target/release/lodray", help="lodray, built (default target/release/lodray)")
    parser.add_argument("--size", default="1920x1080", help="size of the frames (default 1920x1080)")
    parser.add_argument("--distances", type=lambda text: text.split(","), default="0.8,1.2,2,4,8,16,32,64".split(","), help="distances of the eye in radii, with commas (default: eight from 0.8 to 64)")
    parser.add_argument("--machines", type=lambda text: text.split(","), default=["haydel2023", "turing2018"], help="machines, with commas (default haydel2023,turing2018)")
    parser.add_argument("--out", type=Path, default=Path("target/who-wins"), help="folder in which pieces are kept; a run that is started again goes on with it (default target/who-wins)")
    parser.add_argument("--shard", default="1/1", help="measure the K-th of N parts alone, K/N, and write no tables (default: all)")
    parser.add_argument("--print", action="store_true", help="print the tables, and leave the document alone")
    parser.add_argument("scene", nargs="+", help="scene files (generate, build)")
    args = parser.parse_args()
    args.program = Path(args.program).resolve()
    args.out.mkdir(parents=True, exist_ok=True)
    try:
        shard, shards = (int(part) for part in args.shard.split("/"))
    except ValueError:
        parser.error(f"--shard: '{args.shard}' is not K/N")
    if not 1 <= shard <= shards:
        parser.error(f"--shard: '{args.shard}' is no part of N")
    # Near frames cost most: a frame's rays spread over more triangles.
    pieces = {}
    for scene in args.scene:
        count, _ = triangles(args.program, scene)
        pieces.update({(scene, distance, machine): count / float(distance) for distance in args.distances for machine in args.machines})
    of = shard_of(pieces, shards)
    documents = {piece: measured(args, piece) for piece in pieces if of[piece] == shard}
    if shards > 1:
        return
    texts = {"count": counted(documents), "sizes": sizes(documents)}
    for kind in ERRORS:
        texts[f"{kind} summary"] = all_over_ours(documents, kind)
        for what in ("time", "energy"):
            texts[f"{kind} {what}"] = winners(documents, kind, what)
    views = f"{len(documents)} views of {number(len(args.scene))} scenes, {args.size}"
    if args.print:
        print("\n\n".join([views, *texts.values()]))
        return
    for name, text in texts.items():
        put(ROOT / "docs" / "who-wins.md", f"<!-- {name} -->", f"<!-- {name} end -->", text)


if __name__ == "__main__":
    main()
