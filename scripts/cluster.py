"""Clusters (`cluster`, `cluster-paper`): bytes and seconds of graphs (`cargo bench --bench cluster`), and the work before frames (`lodray simulate`, haydel2023, compute free). What they cost at equal error: scripts/who-wins.

Writes tables between the marks of docs/baselines.md, and of docs/claims.md and its template.
"""

import argparse
import json
import os
import re
import subprocess
from pathlib import Path

from markdown import among, number, put, table
from options import add_program, ended

ROOT = Path(__file__).resolve().parent.parent
CLUSTERS = ["cluster", "cluster-paper"]
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
        self.program = args.program
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
    add_program(parser)
    parser.add_argument("--size", default="1024x1024", help="size of the frames (default 1024x1024)")
    parser.add_argument("--distances", type=lambda text: text.split(","), default=["1.5", "4", "16"], help="distances of the eye in radii, with commas (default 1.5,4,16)")
    parser.add_argument("--out", default="target/cluster", help="folder in which what was run is kept; a run that is started again goes on with it (default target/cluster)")
    parser.add_argument("--print", action="store_true", help="print the tables, and leave the documents alone")
    parser.add_argument("scene", nargs="+", type=Path, help="scene files (generate, build)")
    args = parser.parse_args()
    runs = Runs(args)
    lines = runs.bench(args.scene)
    before, rates = works(runs, args.scene)
    texts = {"graphs": graphs(lines), "frames": before}
    rows = ledger(lines, rates)
    if args.print:
        print("\n\n".join([*texts.values(), rows]))
        return
    for name, text in texts.items():
        put(ROOT / "docs" / "baselines.md", f"<!-- cluster {name} -->", f"<!-- cluster {name} end -->", text)
    for path in [ROOT / "docs" / "claims.md", ROOT / "scripts" / "paper" / "claims.md"]:
        put(path, "<!-- cluster ledger -->", "<!-- cluster ledger end -->", rows)


if __name__ == "__main__":
    ended(main)
