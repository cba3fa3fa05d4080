"""Scenes of many models placed (`scenes/forest.toml`, `street.toml`, `wall.toml`): what an error costs, ours against a discrete level for each instance, clusters and BVHs.

Each method runs at several settings; its error is against full resolution of the same models, in pixels that the surface is off. Writes tables between the marks of docs/who-wins.md. Results are kept in --out, and runs that are there are not run again.
"""

import argparse
from pathlib import Path

from keep import kept
from markdown import number, put, table

ROOT = Path(__file__).resolve().parent.parent
SCENES = ["forest", "street", "wall"]
# Each method with the knob that decides what is seen, and its settings from fine to coarse.
METHODS = {
    "lod": ("--delta", [0.5, 1, 2, 4]),
    "discrete": ("--delta", [0.5, 1, 2, 4]),
    "bvh": (None, [None]),
    "bvh6": (None, [None]),
    # Along the ground a deviation across the surface is many times as long along the ray, so clusters need small ones.
    "cluster": ("--error", [0.0625, 0.125, 0.25, 0.5]),
}
# Errors, in pixels, that 99 of 100 hits may have at most. Means are of no use here: a few rays along the ground, at an outline, meet another surface thousands of pixels away.
WANTED = [0.25, 0.5, 1, 2]


def measured(args, scene, method, knob, value):
    chosen = [f"scenes/{scene}.toml", "--method", method, "--size", args.size, *([knob, value] if knob else [])]
    error = kept(args, ["render", *chosen, "--compare"])["error"]
    frame = kept(args, ["simulate", *chosen, "--machine", args.machine, "--compute", "free"])
    off = error["geometry_pixels"] or {"mean": 0.0, "percentile_99": 0.0}
    dram = frame["dram"]
    return {"value": value, "mean": off["mean"], "most": off["percentile_99"], "rmse": error["rmse"], "cycles": frame["cycles"], "energy": frame["energy"]["total"], "lines": dram["reads"] + dram.get("writes", 0)}


def rows_of(args, scene):
    runs = {method: [measured(args, scene, method, knob, value) for value in values] for method, (knob, values) in METHODS.items()}
    for error in WANTED:
        # The cheapest in time of those whose error is no larger.
        best = {method: min((run for run in own if run["most"] <= error), key=lambda run: run["cycles"], default=None) for method, own in runs.items()}
        ours = best["lod"]
        for method, run in best.items():
            if run is None:
                yield [scene, f"{error:g}", method, "cannot reach", *["-"] * 5]
                continue
            over = lambda what: f"{run[what] / ours[what]:.2f}" if ours else "-"
            setting = "-" if run["value"] is None else f"{run['value']:g}"
            yield [scene, f"{error:g}", method, setting, f"{run['most']:.3f}", number(run["cycles"]), over("cycles"), over("energy"), over("lines")]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=str(ROOT / "target" / "release" / "lodray"))
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "instances", help="folder of what is kept")
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--machine", default="haydel2023")
    parser.add_argument("--scenes", nargs="+", default=SCENES, choices=SCENES)
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    head = ["scene", "error at most, pixels", "method", "setting", "99 of 100 below", "cycles", "time over ours", "energy", "DRAM lines"]
    rows = [row for scene in args.scenes for row in rows_of(args, scene)]
    put(ROOT / "docs" / "who-wins.md", "<!-- instances -->", "<!-- instances end -->", table(head, rows, 4))


if __name__ == "__main__":
    main()
