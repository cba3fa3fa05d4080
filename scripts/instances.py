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
    "lod": ("--delta", [0.25, 0.5, 1, 2, 4, 8]),
    "discrete": ("--delta", [0.25, 0.5, 1, 2, 4, 8]),
    "cluster": ("--error", [0.125, 0.25, 0.5, 1, 2, 4]),
    "bvh": (None, [None]),
    "bvh6": (None, [None]),
}
# Mean errors, in pixels, that a method may have at most.
WANTED = [0.125, 0.25, 0.5, 1]


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
        best = {method: min((run for run in own if run["mean"] <= error), key=lambda run: run["cycles"], default=None) for method, own in runs.items()}
        ours = best["lod"]
        for method, run in best.items():
            if run is None:
                yield [scene, f"{error:g}", method, "cannot", *["-"] * 6]
                continue
            over = lambda what: f"{run[what] / ours[what]:.2f}" if ours else "-"
            setting = "-" if run["value"] is None else f"{run['value']:g}"
            yield [scene, f"{error:g}", method, setting, f"{run['mean']:.3f}", f"{run['most']:.2f}", number(run["cycles"]), over("cycles"), over("energy"), over("lines")]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--program", default=str(ROOT / "target" / "release" / "lodray"))
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "instances", help="folder of what is kept")
    parser.add_argument("--size", default="640x360")
    parser.add_argument("--machine", default="haydel2023")
    parser.add_argument("--scenes", nargs="+", default=SCENES, choices=SCENES)
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    head = ["scene", "error at most, pixels", "method", "setting", "mean error", "99 of 100 below", "cycles", "time over ours", "energy", "DRAM lines"]
    rows = [row for scene in args.scenes for row in rows_of(args, scene)]
    put(ROOT / "docs" / "who-wins.md", "<!-- instances -->", "<!-- instances end -->", table(head, rows, 4))


if __name__ == "__main__":
    main()
