"""How many levels a scan needs: each mesh built with the number of splits that `build` chooses and with 5, and the best BVH over the mesh itself. Costs on haydel2023, compute free, delta 1."""

import argparse
import json
import statistics
import subprocess
import tempfile
from pathlib import Path

from options import add_program, ended

DISTANCES = ["1.5", "4", "16"]


def main():
    """Prints the table."""
    parser = argparse.ArgumentParser(prog="scripts/levels", description=__doc__.split("\n", maxsplit=1)[0])
    add_program(parser)
    parser.add_argument("--size", default="512x512", help="size of the frames (default 512x512)")
    parser.add_argument("mesh", nargs="+", help="mesh files")
    args = parser.parse_args()
    program = args.program

    def run(*words):
        return json.loads(subprocess.run([program, *words, "--json"], check=True, capture_output=True, text=True).stdout)

    def cycles(scene, mesh, distance, method):
        command = ["simulate", scene, "--method", method, "--machine", "haydel2023", "--compute", "free", "--distance", distance]
        return run(*command, "--size", args.size, *(["--mesh", mesh] if method.startswith("input") else []))["cycles"]

    head = ["mesh", "triangles", "levels", "finest", "KB", "KB with 5", "largest error, %", "with 5", *(f"cycles of 5, {d} radii" for d in DISTANCES), *(f"BVH of the mesh, {d} radii" for d in DISTANCES)]
    print("| " + " | ".join(head) + " |")
    print("|---" + "|--:" * (len(head) - 1) + "|")
    columns = [[] for _ in range(2 * len(DISTANCES))]
    with tempfile.TemporaryDirectory() as folder:
        for mesh in map(Path, args.mesh):
            mesh = mesh.resolve()
            scenes = [Path(folder) / f"{mesh.stem}{n}.lod" for n in ("", "-5")]
            built = [run("build", mesh, *words, "-o", scene) for words, scene in zip(([], ["--levels", "5"]), scenes)]
            error = [max(made["distance"][way]["max"] for way in made["distance"]) for made in built]
            ours = [cycles(scenes[0], mesh, d, "lod") for d in DISTANCES]
            five = [cycles(scenes[1], mesh, d, "lod") / own for d, own in zip(DISTANCES, ours)]
            bvh = [min(cycles(scenes[0], mesh, d, method) for method in ("input-bvh", "input-bvh6")) / own for d, own in zip(DISTANCES, ours)]
            for column, ratio in zip(columns, five + bvh):
                column.append(ratio)
            read = built[0]["origin"]["mesh"]["triangles_read"]
            cells = [mesh.stem, f"{read:,}", built[0]["levels"], f"{built[0]['finest_triangles']:,}", *(f"{made['bytes'] / 1e3:,.0f}" for made in built), *(f"{e:.2f}" for e in error)]
            print("| " + " | ".join(map(str, cells)) + " | " + " | ".join(f"{ratio:.2f}" for ratio in five + bvh) + " |", flush=True)
    print("| median | | | | | | | | " + " | ".join(f"{statistics.median(column):.2f}" for column in columns) + " |")


if __name__ == "__main__":
    ended(main)
