"""Scenes with short last splits over the same with compact ones (`--vertices short`, `compact`): bytes, how far storing moves vertices, and cycles and DRAM reads on haydel2023, compute free, delta 1.

Terrains are generated; meshes can be added.
"""

import argparse
import json
import statistics
import subprocess
import tempfile
from pathlib import Path

from options import add_program, ended

FORMS = ["compact", "short"]
TERRAINS = ["0.45", "0.6"]
DISTANCES = ["1.5", "4"]


def main():
    """Prints the table."""
    parser = argparse.ArgumentParser(prog="scripts/short-splits", description=__doc__.split("\n", maxsplit=1)[0])
    add_program(parser)
    parser.add_argument("--size", default="512x512", help="size of the frames (default 512x512)")
    parser.add_argument("mesh", nargs="*", help="mesh files")
    args = parser.parse_args()
    program = args.program

    def run(*words):
        return json.loads(subprocess.run([program, *words, "--json"], check=True, capture_output=True, text=True).stdout)

    def cost(scene, distance):
        made = run("simulate", scene, "--machine", "haydel2023", "--compute", "free", "--distance", distance, "--size", args.size)
        return [made["cycles"], made["dram"]["reads"]]

    scenes = [(f"terrain {of}", ["generate", "terrain", "--roughness", of]) for of in TERRAINS]
    scenes += [(Path(mesh).stem, ["build", Path(mesh).resolve()]) for mesh in args.mesh]
    head = ["scene", *(f"bytes a finest triangle, {form}" for form in FORMS), *(f"moved, % of the diagonal, {form}" for form in FORMS), *(f"{what}, {d} radii" for d in DISTANCES for what in ("cycles", "DRAM reads"))]
    print("| " + " | ".join(head) + " |")
    print("|---" + "|--:" * (len(head) - 1) + "|")
    columns = [[] for _ in range(2 * len(DISTANCES))]
    with tempfile.TemporaryDirectory() as folder:
        for name, words in scenes:
            files = [Path(folder) / f"{name}-{form}.lod" for form in FORMS]
            made = [run(*words, "--vertices", form, "-o", file) for form, file in zip(FORMS, files)]
            facts = [run("info", file) for file in files]
            costs = [[cost(file, d) for d in DISTANCES] for file in files]
            ratios = [of / base for base_view, view in zip(*costs) for base, of in zip(base_view, view)]
            for column, ratio in zip(columns, ratios):
                column.append(ratio)
            cells = [*(f"{of['hierarchy_bytes_per_triangle']:.2f}" for of in made), *(f"{50 * of['moved'] / of['radius']:.4f}" for of in facts), *(f"{ratio:.3f}" for ratio in ratios)]
            print(f"| {name} | " + " | ".join(cells) + " |", flush=True)
            for file in files:
                file.unlink()
    print("| median | | | | | " + " | ".join(f"{statistics.median(column):.3f}" for column in columns) + " |")


if __name__ == "__main__":
    ended(main)
