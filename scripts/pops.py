"""What pops along a flight towards a terrain (`lodray fly`), by method, in long steps and in short ones.

Writes the table between the marks of docs/baselines.md and docs/images/pops.svg. Results are kept in --out, and flights that are there are not flown again.
"""

import argparse
import json
import statistics
import subprocess
from pathlib import Path

from markdown import put, table
from options import add_program, ended
from plot import diagram

ROOT = Path(__file__).resolve().parent.parent
METHODS = {
    "lod": ["--method", "lod"],
    "discrete": ["--method", "discrete"],
    "stochastic": ["--method", "stochastic"],
    "cluster": ["--method", "cluster"],
}
# Frames of a flight: its steps in the second are an eighth as long.
FRAMES = [61, 481]


def flown(args, method, frames):
    path = args.out / f"{method.replace(', ', '-')}-{frames}.json"
    if not path.exists():
        words = ["fly", args.scene, "--size", args.size, "--distance", "8", "--to", "1.2", "--frames", str(frames), "--no-pictures", "--json", "--force", "-o", args.out / "run", *METHODS[method]]
        part = path.with_suffix(".part")
        part.write_text(subprocess.run([args.program, *map(str, words)], check=True, stdout=subprocess.PIPE, text=True).stdout, encoding="utf-8")
        part.rename(path)
    return json.loads(path.read_text(encoding="utf-8"))


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    add_program(parser)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "pops", help="folder of what is kept")
    parser.add_argument("--scene", type=Path, help="scene file (default: a terrain of 0.5 M triangles, generated)")
    parser.add_argument("--size", default="256x256")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    if args.scene is None:
        args.scene = args.out / "terrain.lod"
        if not args.scene.exists():
            subprocess.run([args.program, "generate", "terrain", "--levels", "5", "-o", args.scene], check=True)
    rows, lines = [], {}
    for method in METHODS:
        row = [method]
        for frames in FRAMES:
            pops = [frame["pops"] for frame in flown(args, method, frames)["frames"] if "pops" in frame]
            most = lambda quantity, what: max(own[quantity][what] for own in pops)
            usual = statistics.median(own["surface"]["percentile_999"] for own in pops)
            row += [f"{most('surface', 'mean'):.4f}", f"{usual:.3f}", f"{most('surface', 'percentile_999'):.3f}", f"{most('surface', 'largest'):.2f}", f"{most('colour', 'percentile_999'):.0f}"]
        rows.append(row)
        # Of frames the distance from the origin that they were taken from; what is 0 has no place on a logarithmic axis. Of each eight the one that pops most.
        last = flown(args, method, FRAMES[1])["frames"][1:]
        worst = [max(last[k : k + 8], key=lambda own: own["pops"]["surface"]["mean"]) for k in range(0, len(last), 8)]
        lines[method] = [(sum(e * e for e in own["eye"]) ** 0.5, max(own["pops"]["surface"]["mean"], 1e-6)) for own in worst]
    head = ["method"] + [f"{name}, {steps} steps" for steps in ("long", "short") for name in ("mean, worst frame", "99.9 % of pixels, median frame", "worst frame", "largest of all", "colour, 99.9 %, worst frame")]
    put(ROOT / "docs" / "baselines.md", "<!-- pops -->", "<!-- pops end -->", table(head, rows, 1))
    svg = diagram("What pops along a flight, short steps", "distance of the eye, world units", "mean change of the surface, pixel widths", lines)
    (ROOT / "docs" / "images" / "pops.svg").write_text(svg, encoding="utf-8")


if __name__ == "__main__":
    ended(main)
