"""What each step from trees of 32-byte lines and boxes brought: cycles, energy and DRAM reads of 31 views with a program of before, and with this one (haydel2023, delta 1).

`before`: the old program with --line-layout tree, trees one after the other. `order`: the old program, lines level by level. `line`: this program, a split and a record in a line. `prisms`: this program with --node-bounds prisms. Each column is over the one before it, the last two over `before`.
"""

import argparse
import json
import statistics
import subprocess
import tempfile
from pathlib import Path

from options import add_program, ended

TERRAINS = ["0.45", "0.55", "0.6"]
FAR = ["0.8", "1.6", "3", "6", "12"]
NEAR = ["1.5", "4", "8", "16"]
COSTS = ["cycles", "energy", "DRAM reads"]


def main():
    """Prints the table."""
    parser = argparse.ArgumentParser(prog="scripts/steps", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("before", type=Path, help="the program of before: lodray of commit daf6758, built")
    parser.add_argument("models", type=Path, help="folder of models with stanford-bunny.obj, igea.ply and spot.obj")
    add_program(parser)
    parser.add_argument("--size", default="1024x1024", help="size of the frames (default 1024x1024)")
    parser.add_argument("--compute", default="free", help="how compute is simulated: free, cores or units (default free)")
    args = parser.parse_args()
    programs = [args.before.resolve(), args.program]

    def simulate(program, scene, distance, *more):
        command = [program, "simulate", scene, "--machine", "haydel2023", "--compute", args.compute, "--distance", distance, "--size", args.size, *more, "--json"]
        result = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        return [result["cycles"], result["energy"]["total"], result["dram"]["reads"]], result["hits"]

    scenes = [(f"terrain {of}", ["generate", "terrain", "--roughness", of], FAR) for of in TERRAINS]
    scenes += [("cloth", ["generate", "cloth"], NEAR)]
    # With as many levels in both: the old program took five whatever the mesh.
    scenes += [(Path(mesh).stem, ["build", args.models.resolve() / mesh, "--levels", "5"], NEAR) for mesh in ("stanford-bunny.obj", "igea.ply", "spot.obj")]
    print("| scene | radii | cycles before | order | line | together | prisms | together |")
    print("|---" + "|--:" * 7 + "|")
    rows = {name: [[] for _ in COSTS] for name in ["order", "line", "boxes", "prisms", "all"]}
    with tempfile.TemporaryDirectory() as folder:
        for name, words, distances in scenes:
            files = [Path(folder) / f"{k}.lod" for k in range(2)]
            for program, file in zip(programs, files):
                subprocess.run([program, "--quiet", *words, "-o", file], check=True, capture_output=True)
            for distance in distances:
                (before, hits), (order, _) = simulate(programs[0], files[0], distance, "--line-layout", "tree"), simulate(programs[0], files[0], distance)
                (line, now), (prisms, _) = simulate(programs[1], files[1], distance), simulate(programs[1], files[1], distance, "--node-bounds", "prisms")
                ratios = {"order": (order, before), "line": (line, order), "boxes": (line, before), "prisms": (prisms, line), "all": (prisms, before)}
                for key, (of, base) in ratios.items():
                    for k in range(len(COSTS)):
                        rows[key][k].append(of[k] / base[k])
                print(f"| {name} | {distance} | {before[0]:,} | " + " | ".join(f"{rows[key][0][-1]:.2f}" for key in ratios) + f" |{'' if abs(now - hits) <= hits / 1000 else ' hits differ'}", flush=True)
            for file in files:
                file.unlink()
    for k, what in enumerate(COSTS):
        print(f"| median, {what} | | | " + " | ".join(f"{statistics.median(of[k]):.2f}" for of in rows.values()) + " |")
    for k, what in enumerate(COSTS):
        print(f"| worst, {what} | | | " + " | ".join(f"{max(of[k]):.2f}" for of in rows.values()) + " |")


if __name__ == "__main__":
    ended(main)
