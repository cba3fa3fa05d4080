#!/usr/bin/env python3
"""What a displacement bound of each kind costs at equal error: table of total over largest, from runs that are kept, so that it goes on where it was stopped.

Arguments: the program, a folder for scenes and results, a folder of models with stanford-bunny.obj and igea.ply.
`--only free|units|table`: some of the work alone. Time is compute free and by units (haydel2023); the error is the picture's 99th percentile along the ray.
"""

import argparse
import itertools
import json
import math
import subprocess
import tempfile
from pathlib import Path

TERRAINS = {f"terrain {r}": ["generate", "terrain", "--roughness", r] for r in ["0.45", "0.55", "0.60"]}
SCENES = TERRAINS | {name: ["generate", name] for name in ["cloth", "wall"]}
MESHES = {"bunny": "stanford-bunny.obj", "igea": "igea.ply"}
DELTAS = {"total": ["0.5", "1", "2", "4"], "largest": ["1", "2", "4", "8"]}
RADII = ["2", "8", "0.5"]
ERRORS = [0.5, 1, 2]
COSTS = {"free": ["lines", "ms", "energy"], "units": ["ms, units", "energy, units"]}


class Runs:
    """Results by scene, kind of bounds, distance, delta and what was run."""

    def __init__(self, program, folder, models):
        self.program, self.folder, self.models = program, folder, models
        self.path = folder / "results.jsonl"
        lines = self.path.read_text().splitlines() if self.path.exists() else []
        self.known = {tuple(key): values for key, values in map(json.loads, lines)}

    def call(self, *words):
        return subprocess.run([self.program, *map(str, words)], check=True, capture_output=True, text=True).stdout

    def scene(self, name, kind):
        path = self.folder / f"{name.replace(' ', '-')}-{kind}.lod"
        if not path.exists():
            made = SCENES.get(name) or ["build", self.models / MESHES[name]]
            self.call(*made, "--bounds", kind, "-o", path)
        return path

    def run(self, what, name, kind, radii, delta):
        key = (name, kind, radii, delta, what)
        if key in self.known:
            return
        view = [self.scene(name, kind), "--size", "512x512", "--distance", radii, "--delta", delta, "--json"]
        result = json.loads(self.call("simulate", *view, "--compute", what))
        ms, energy = result["milliseconds"], result["energy"]["total"]
        if what == "units":
            values = {"ms, units": ms, "energy, units": energy}
        else:
            with tempfile.TemporaryDirectory() as folder:
                picture = json.loads(self.call("render", *view, "--compare", "-o", Path(folder) / "picture.png"))
            off = picture["error"]["geometry_pixels"]
            lines = sum(part["distinct"] for part in picture["stats"]["lines"])
            values = {"error": off and off["percentile_99"], "lines": lines, "ms": ms, "energy": energy}
        self.known[key] = values
        with self.path.open("a") as out:
            out.write(json.dumps([key, values]) + "\n")
        print(key, values, flush=True)

    def cost(self, name, kind, radii, what, error):
        """Cost at that error, interpolated on logarithms; nothing outside what was measured."""
        points = []
        for delta in DELTAS[kind]:
            free = self.known.get((name, kind, radii, delta, "free"), {})
            found = next((run[what] for run in [free, self.known.get((name, kind, radii, delta, "units"), {})] if what in run), None)
            if free.get("error") and found:
                points.append((math.log(free["error"]), math.log(found)))
        points.sort()
        for (x, a), (y, b) in itertools.pairwise(points):
            if x <= math.log(error) <= y and x < y:
                return math.exp(a + (b - a) * (math.log(error) - x) / (y - x))
        return None

    def table(self):
        costs = [cost for costs in COSTS.values() for cost in costs]
        print("| scene, radii | " + " | ".join(costs) + " |\n|---|" + "---|" * len(costs))
        for name, radii in itertools.product([*SCENES, *MESHES], sorted(RADII, key=float)):
            cells = []
            for what in costs:
                pairs = [[self.cost(name, kind, radii, what, error) for kind in DELTAS] for error in ERRORS]
                cells.append(", ".join(f"{total / largest:.2f}" if total and largest else "-" for total, largest in pairs))
            print(f"| {name}, {radii} | " + " | ".join(cells) + " |")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder", type=Path)
    parser.add_argument("models", type=Path)
    parser.add_argument("--only", choices=["free", "units", "table"])
    args = parser.parse_args()
    args.folder.mkdir(parents=True, exist_ok=True)
    runs = Runs(args.program, args.folder, args.models)
    for what, radii in itertools.product(COSTS, RADII):
        if args.only not in (None, what):
            continue
        for name in [*SCENES, *MESHES]:
            for kind, deltas in DELTAS.items():
                for delta in deltas:
                    runs.run(what, name, kind, radii, delta)
    runs.table()


if __name__ == "__main__":
    main()
