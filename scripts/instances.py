"""Scenes of many models placed (`scenes/forest.toml`, `street.toml`, `wall.toml`): what an error costs, ours against a discrete level for each instance, clusters and BVHs.

Of each method it takes the coarsest setting whose error is no larger; errors are against full resolution of the same models, in pixels that the surface is off. Writes tables between the marks of docs/who-wins.md. Results are kept in --out, and runs that are there are not run again.
"""

import argparse
import re
from pathlib import Path

from keep import kept
from markdown import number, put, table
from options import add_program, ended

ROOT = Path(__file__).resolve().parent.parent
# Scenes and the sizes of their frames. In the forest a ray asks for hundreds of lines, so its frames are small.
FRAMES = ["forest:192x108", "street:640x360", "street:1920x1080", "wall:640x360"]
# What took too long for here: clusters of a large frame, compared with full resolution in clusters.
NOT_RUN = [("street", "1920x1080", "cluster")]
# Each method with the knob that decides what is seen, and its settings from coarse to fine.
METHODS = {
    "lod": ("--delta", [0.25, 0.5, 1, 2, 4, 8]),
    "discrete": ("--delta", [0.25, 0.5, 1, 2, 4, 8]),
    "bvh": (None, [None]),
    "bvh6": (None, [None]),
    # Along the ground a deviation across the surface is many times as long along the ray, so clusters need small ones.
    "cluster": ("--error", [1, 0.5, 0.25, 0.125, 0.0625]),
}
# Errors, in pixels, that 99 of 100 hits may have at most. Means are of no use here: a few rays along the ground, at an outline, meet another surface thousands of pixels away.
WANTED = [0.25, 0.5, 1, 2]


def chosen(scene, size, method, knob, value):
    return [f"scenes/{scene}.toml", "--method", method, "--size", size, *([knob, value] if knob else [])]


def cheapest(args, scene, size, method, error):
    """The coarsest setting of a method with errors no larger than `error`, and what a frame with it costs."""
    knob, values = METHODS[method]
    for value in values:
        words = chosen(scene, size, method, knob, value)
        off = kept(args, ["render", *words, "--compare"])["error"]["geometry_pixels"] or {"percentile_99": 0.0}
        if off["percentile_99"] <= error:
            frame = kept(args, ["simulate", *words, "--machine", args.machine, "--compute", "free"])
            dram = frame["dram"]
            return {"value": value, "most": off["percentile_99"], "cycles": frame["cycles"], "energy": frame["energy"]["total"], "lines": dram["reads"] + dram.get("writes", 0)}
    return None


def rows_of(args, scene, size):
    for error in WANTED:
        methods = [method for method in METHODS if args.all or (scene, size, method) not in NOT_RUN]
        best = {method: cheapest(args, scene, size, method, error) for method in methods}
        ours = best["lod"]
        for method in METHODS:
            if method not in best:
                yield [scene, size, f"{error:g}", method, "not run", *["-"] * 5]
                continue
            run = best[method]
            if run is None:
                yield [scene, size, f"{error:g}", method, "cannot reach", *["-"] * 5]
                continue
            over = lambda what: f"{run[what] / ours[what]:.2f}" if ours else "-"
            setting = "-" if run["value"] is None else f"{run['value']:g}"
            yield [scene, size, f"{error:g}", method, setting, f"{run['most']:.3f}", number(run["cycles"]), over("cycles"), over("energy"), over("lines")]


def frame(text):
    """A scene and a size, of SCENE:SIZE."""
    scene, _, size = text.partition(":")
    if not (ROOT / "scenes" / f"{scene}.toml").exists() or not re.fullmatch(r"[1-9]\d*x[1-9]\d*", size):
        raise argparse.ArgumentTypeError(f"'{text}' is not a scene of the folder scenes and a size, as street:640x360")
    return scene, size


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    add_program(parser)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "instances", help="folder of what is kept")
    parser.add_argument("--machine", default="haydel2023")
    parser.add_argument("--frames", nargs="+", type=frame, default=[frame(text) for text in FRAMES], help="SCENE:SIZE, scenes of the folder scenes")
    parser.add_argument("--all", action="store_true", help="what took too long for the document too")
    parser.add_argument("--print", action="store_true", help="print the table, and leave the document alone")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    head = ["scene", "size", "error at most, pixels", "method", "setting", "99 of 100 below", "cycles", "time over ours", "energy", "DRAM lines"]
    rows = [row for scene, size in args.frames for row in rows_of(args, scene, size)]
    text = table(head, rows, 5)
    if args.print:
        print(text)
    else:
        put(ROOT / "docs" / "who-wins.md", "<!-- instances -->", "<!-- instances end -->", text)


if __name__ == "__main__":
    ended(main)
