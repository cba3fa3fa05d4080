"""Orders in which the lines of a scene could lie: cycles, energy and DRAM reads with each (haydel2023) over those in the first (as a rule: each tree whole).

Terrains are generated; scans can be added as scene files. What rays hit is the same in all orders.
"""

import argparse
import json
import statistics
import subprocess
import tempfile
from pathlib import Path

from options import add_program, ended

ORDERS = ["tree", "veb", "coarse", "blocks", "own"]
TERRAINS = ["0.45", "0.55", "0.6"]
DISTANCES = ["0.8", "1.6", "3", "6", "12"]


def main():
    """Prints the table."""
    parser = argparse.ArgumentParser(prog="scripts/line-orders", description=__doc__.split("\n", maxsplit=1)[0])
    add_program(parser)
    parser.add_argument("--size", default="1024x1024", help="size of the frames (default 1024x1024)")
    parser.add_argument("--method", default="lod", help="method whose lines are ordered (default lod)")
    parser.add_argument("--knob", default="line-layout", help="option of simulate that is varied (default line-layout)")
    parser.add_argument("--orders", default=",".join(ORDERS), help="its values, the first being what others are measured by")
    parser.add_argument("--compute", default="free", help="how compute is simulated: free, cores or units (default free)")
    parser.add_argument("--delta", help="quality (default 1), of methods that have one; with inf nothing is morphed")
    parser.add_argument("--scene", action="append", default=[], help="scene file, seen from 1.5, 4 and 16 radii; may be repeated")
    args = parser.parse_args()
    program, orders = args.program, args.orders.split(",")

    def simulate(scene, distance, order):
        command = [program, "simulate", scene, "--machine", "haydel2023", "--compute", args.compute, "--distance", distance]
        command += ["--delta", args.delta] if args.delta else []
        command += ["--method", args.method, "--size", args.size, f"--{args.knob}", order, "--json"]
        result = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
        return [result["cycles"], result["energy"]["total"], result["dram"]["reads"]]

    with tempfile.TemporaryDirectory() as folder:
        views = []
        for roughness in TERRAINS:
            scene = Path(folder) / f"terrain {roughness}"
            subprocess.run([program, "generate", "terrain", "--roughness", roughness, "-o", scene], check=True, capture_output=True)
            views += [(scene, distance) for distance in DISTANCES]
        views += [(Path(scene), distance) for scene in args.scene for distance in ("1.5", "4", "16")]
        print("| scene | radii | cycles | " + " | ".join(orders[1:]) + " |")
        print("|---|--:|--:|" + "--:|" * len(orders[1:]))
        ratios = {order: [] for order in orders[1:]}
        for scene, distance in views:
            base = simulate(scene, distance, orders[0])
            for order in orders[1:]:
                ratios[order].append([of / base for of, base in zip(simulate(scene, distance, order), base)])
            cells = " | ".join(f"{of[-1][0]:.2f}" for of in ratios.values())
            print(f"| {scene.stem if scene.suffix == '.lod' else scene.name} | {distance} | {base[0]:,} | {cells} |", flush=True)
        for k, what in enumerate(["cycles", "energy", "DRAM reads"]):
            cells = " | ".join(f"{statistics.median(of[k] for of in all):.2f}" for all in ratios.values())
            print(f"| median, {what} | | | {cells} |")
        print("| worst, cycles | | | " + " | ".join(f"{max(of[0] for of in all):.2f}" for all in ratios.values()) + " |")


if __name__ == "__main__":
    ended(main)
