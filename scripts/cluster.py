"""Clusters (`cluster`, `cluster-paper`) beside ours, discrete levels and BVHs, with the work before their frames charged: bytes and seconds of graphs (`cargo bench --bench cluster`), the work before frames (`lodray simulate`), and cost at equal error (`lodray error-time`), on haydel2023 with compute free.

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

ROOT = Path(__file__).resolve().parent.parent
CLUSTERS = ["cluster", "cluster-paper"]
OTHERS = ["discrete", "bvh6", "input-bvh6"]
LEVELS = {"surface": [0.25, 0.5, 1, 2], "flip": [0.01, 0.05]}
ERRORS = {"surface": lambda point: point["geometry"]["surface"]["percentile_99"], "flip": lambda point: point["picture"]["flip"]["mean"]}
NAMES = {"surface": "pixels off (99 of 100)", "flip": "FLIP"}
# Frames that the paper has times of: million triangles in a frame, and milliseconds of selection, of unpacking, and of the tree over all.
PAPER = [("Thai", 16, 1.7, 2.4, 1.6), ("Rungholt", 40, 0.9, 5.9, 2.3), ("Landscape", 21, 1.2, 2.6, 2.0)]
# Degrees by which a camera turns to its next frame: it stands, moves, jumps.
TURNS = ["0", "3", "180"]
# GB/s of an Arc A770, and of haydel2023.
BANDWIDTH = [560, 160]


class Runs:
    """What is run, and what of it is kept for later runs."""

    def __init__(self, args):
        self.args = args
        self.program = Path(args.program).resolve()
        self.out = Path(args.out)
        self.out.mkdir(parents=True, exist_ok=True)

    def kept(self, name, make):
        """What was kept of this name, or what is made now."""
        kept = self.out / name
        if not kept.exists():
            part = kept.with_suffix(".part")
            part.write_text(make(), encoding="utf-8")
            part.rename(kept)
        return kept.read_text(encoding="utf-8")

    def frame(self, scene, distance, method, *more):
        """A simulated frame, or several."""
        words = ["simulate", scene, "--machine", "haydel2023", "--compute", "free", "--distance", distance, "--size", self.args.size, "--method", method, *more, "--json"]
        run = lambda: subprocess.run([self.program, *words], check=True, stdout=subprocess.PIPE, text=True).stdout
        return json.loads(self.kept(re.sub(r"[^\w.=-]+", "_", "_".join(map(str, words)))[-180:] + ".json", run))

    def bench(self, scenes):
        """The lines of the benchmark, scene by scene."""
        run = lambda: subprocess.run(["cargo", "bench", "--quiet", "--bench", "cluster", "--", *(scene.resolve() for scene in scenes)], check=True, stdout=subprocess.PIPE, text=True, cwd=ROOT, env=os.environ).stdout
        return [json.loads(line) for line in self.kept("bench.jsonl", run).splitlines()]

    def error_time(self, scene):
        """The figures of a scene: frames of a camera that turns, the first of which finds nothing there."""
        folder = self.out / f"error-time-{scene.stem}"
        if not (folder / "error-time.json").exists():
            said = json.loads(subprocess.run([self.program, "info", scene, "--json"], check=True, stdout=subprocess.PIPE, text=True).stdout)
            has_mesh = "file" in (said.get("origin") or {})
            methods = ["lod", *CLUSTERS, *(method for method in OTHERS if has_mesh or not method.startswith("input"))]
            quoted = "[" + ", ".join(f'"{method}"' for method in methods) + "]"
            with tempfile.NamedTemporaryFile("w", suffix=".toml", dir=self.out, delete=False) as jobs:
                jobs.write(f'size = "{self.args.size}"\nmethods = {quoted}\ncompute = ["free"]\n')
                jobs.write(f'[[scene]]\nfile = "{scene.resolve()}"\ndistances = [{", ".join(self.args.distances)}]\n[[machine]]\nname = "haydel2023"\n')
            try:
                more = ["--samples", "1", "--most-samples", "0", "--no-host", "--error-size", "192", "--frames", "4", "--turn", self.args.turn]
                subprocess.run([self.program, "--quiet", "error-time", "--jobs", jobs.name, "-o", folder, *more], check=True, stdout=subprocess.DEVNULL)
            finally:
                Path(jobs.name).unlink()
        return json.loads((folder / "error-time.json").read_text(encoding="utf-8"))


def graphs(lines):
    """What graphs are made of, and rays through a frame's BVH."""
    rows, bvh = [], None
    for line in lines:
        if line["of"] == "bvh6":
            bvh = line
        else:
            rows.append(
                [line["scene"], line["of"], number(line["finest"]), number(line["clusters"]), f"{line['triangles'] / line['finest']:.2f}", f"{line['bytes'] / line['triangles']:.2f}", f"{line['bytes'] / line['finest']:.2f}"]
                + [f"{line['roots']} of {number(line['coarsest'])}", number(line["graph"]), number(line["peak"] / 2**20) if line["peak"] else "", number(line["selecting"] + line["building"]), f"{bvh['seconds'] / line['seconds']:.2f}"]
            )
    head = ["scene", "method", "triangles", "clusters", "triangles of all levels, over that", "bytes a triangle, packed", "of the mesh, all levels", "roots, triangles", "graph, s", "memory, MB", "a frame here, s", "rays a second over `bvh6`'s"]
    return table(head, rows, 2)


def works(runs, scenes):
    """The work before frames, by scene, distance and method, as each is by default."""
    rows, rates = [], []
    for scene in scenes:
        for distance in runs.args.distances:
            for method in CLUSTERS:
                seen = runs.frame(scene, distance, method)
                work, choices = seen["frames"][0]["before"], seen["setup"]["method"]["choices"]
                rest, triangles = seen["cycles"] - work["cycles"], int(choices["triangles"])
                milliseconds = seen["milliseconds"] * work["cycles"] / seen["cycles"]
                shares = [f"{100 * work['cycles'] / (work['cycles'] + samples * rest):.0f} %" for samples in (1, 4, 16)]
                rates.append((method, triangles / milliseconds / 1e6))
                again = []
                for turn in TURNS:
                    frame = runs.frame(scene, distance, method, "--frames", "2", "--turn", turn)["frames"][1]
                    again.append(f"{100 * frame['before']['cycles'] / frame['cycles']:.0f} %" if frame.get("before") else "0")
                row = [scene.stem, distance, method, number(int(choices["clusters"])), number(triangles), number(1000 * milliseconds), *shares, *again]
                rows.append([*row, f"{100 * work['energy'] / seen['energy']['total']:.0f} %", number(work["stores"]), number(work["dram_bytes"] / 32), number(rates[-1][1])])
    head = ["scene", "radii", "method", "clusters", "triangles", "work, us", "of a frame of 1 sample", "of 4", "of 16", "of the next frame, standing still", *(f"turned by {turn}" for turn in TURNS[1:]), "of the energy", "lines written", "DRAM lines", "G triangles/s"]
    return table(head, rows, 3), rates


def equal(runs, scenes, kind):
    """Costs over ours where errors are equal: of each method the fastest setting that is no worse, in a frame that finds nothing there and in one of a camera that moves."""
    rows, ratios = [], {}
    for scene in scenes:
        document = runs.error_time(scene)
        for view, of in enumerate(document["views"]):
            points = [point for point in document["points"] if point["view"] == view]
            for level in LEVELS[kind]:

                def best(method, of_cost):
                    return min((point["costs"][0] for point in points if point["method"] == method and ERRORS[kind](point) <= level), key=of_cost, default=None)

                cold, warm, energy = lambda cost: cost["milliseconds"], lambda cost: cost["warm"]["milliseconds"], lambda cost: cost["energy"]["total"]
                row = [scene.stem, f"{of['distance']:g}", f"{level:g}"]
                for method in CLUSTERS + OTHERS:
                    known = any(point["method"] == method for point in points)
                    for cost in (cold, energy, warm):
                        own, other = best("lod", cost), best(method, cost)
                        if own is None or other is None:
                            row.append("" if not known else "ours cannot" if own is None else "cannot")
                            continue
                        ratios.setdefault((level, method, ("time", "energy", "moving")[(cold, energy, warm).index(cost)]), []).append(cost(other) / cost(own))
                        row.append(f"{ratios[level, method, ('time', 'energy', 'moving')[(cold, energy, warm).index(cost)]][-1]:.2f}")
                rows.append(row)
    head = ["scene", "radii", NAMES[kind]] + [f"{name}{what}" for name in (f"`{method}`" for method in CLUSTERS + OTHERS) for what in (" time", " energy", " moving")]
    summary = [[f"{level:g}", f"`{method}`"] + [f"{statistics.median(ratios[level, method, what]):.2f} ({among(ratios[level, method, what])})" if (level, method, what) in ratios else "cannot" for what in ("time", "energy", "moving")] for level in LEVELS[kind] for method in CLUSTERS + OTHERS]
    return table([NAMES[kind], "method over ours, median (least to most)", "time", "energy", "time, a camera that moves"], summary, 2) + "\n\n" + table(head, rows, 1)


def ledger(lines, rates):
    """The paper's figures beside ours."""
    of = lambda method: [line for line in lines if line["of"] == method]
    packed = {method: among([line["bytes"] / line["triangles"] for line in of(method)]) for method in CLUSTERS}
    paper = "; ".join(f"{name}, {millions} M triangles: {sum(parts):.1f} ms ({' + '.join(map(str, parts))})" for name, millions, *parts in PAPER)
    scaled = [millions / sum(parts) * BANDWIDTH[1] / BANDWIDTH[0] for _, millions, *parts in PAPER]
    own = among([rate for method, rate in rates if method == "cluster-paper"])
    return table(
        ["paper", "measured", "difference, and why"],
        [
            [f"{paper} (Arc A770): 2.8 to 4.4 G triangles/s in all, {among(scaled)} at the bandwidth of `haydel2023`", f"{own} G triangles/s with `cluster-paper`", "frames of few triangles: what they write stays in the L2 of 2 MB; the largest, which writes more than that, has the lowest rate of those above 50,000 triangles. Operations take no time here; leaf blocks of shared vertices in place of a quad a leaf"],
            ["4 to 6 bytes a triangle, 165 to 222 M triangles a GB", f"{packed['cluster-paper']} with `cluster-paper`, {packed['cluster']} with `cluster`", "6 bytes a vertex, and clusters are not full: 152 to 176 triangles of 256, 121 of 128"],
            ["16,647 roots of 1,194,821 clusters (197 M triangles)", "; ".join(f"{line['scene']}: {line['roots']} of {line['clusters']:,}" for line in of("cluster-paper")), "locked borders end the graph: pairs whose borders are too long are not simplified to half"],
        ],
        3,
    )


def main():
    """Runs all of it, and writes the tables."""
    parser = argparse.ArgumentParser(prog="scripts/cluster", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--program", default="target/release/lodray", help="lodray, built (default target/release/lodray)")
    parser.add_argument("--size", default="1024x1024", help="size of the frames (default 1024x1024)")
    parser.add_argument("--distances", type=lambda text: text.split(","), default=["1.5", "4", "16"], help="distances of the eye in radii, with commas (default 1.5,4,16)")
    parser.add_argument("--turn", default="3", help="degrees between frames of a camera that moves (default 3)")
    parser.add_argument("--out", default="target/cluster", help="folder in which what was run is kept; a run that is started again goes on with it (default target/cluster)")
    parser.add_argument("--print", action="store_true", help="print the tables, and leave the documents alone")
    parser.add_argument("scene", nargs="+", type=Path, help="scene files (generate, build)")
    args = parser.parse_args()
    runs = Runs(args)
    lines = runs.bench(args.scene)
    before, rates = works(runs, args.scene)
    texts = {"graphs": graphs(lines), "frames": before, "errors": equal(runs, args.scene, "surface") + "\n\n" + equal(runs, args.scene, "flip")}
    rows = ledger(lines, rates)
    if args.print:
        print("\n\n".join([*texts.values(), rows]))
        return
    for name, text in texts.items():
        put(ROOT / "docs" / "baselines.md", f"<!-- cluster {name} -->", f"<!-- cluster {name} end -->", text)
    for path in [ROOT / "docs" / "claims.md", ROOT / "scripts" / "paper" / "claims.md"]:
        put(path, "<!-- cluster ledger -->", "<!-- cluster ledger end -->", rows)


if __name__ == "__main__":
    main()
