#!/usr/bin/env python3
"""Fills scripts/errors/document.md with what error-time measured: writes docs/error-time.md. Argument: the folder with the runs `knobs`, `units` and `samples`."""

import json
import math
import re
import shutil
import subprocess
import sys
from pathlib import Path

from markdown import table

ROOT = Path(__file__).resolve().parent.parent
TEMPLATE = ROOT / "scripts" / "errors" / "document.md"
OURS = "lod"
OVER_MESH = ["input-bvh", "input-bvh6"]
DIAGRAM = "surface-p99-time"


class Run:
    """A document of error-time."""

    def __init__(self, folder, name):
        self.folder = folder / name
        path = self.folder / "error-time.json"
        if not path.is_file():
            sys.exit(f"error_time: no {path}")
        self.data = json.loads(path.read_text())
        self.views = self.data["views"]
        self.others = [m["name"] for m in self.data["methods"] if m["name"] != OURS]
        self.rules = [m["name"] for m in self.data["methods"] if m["in_steps"]]
        self.size = "x".join(map(str, self.views[0]["size"]))

    def scene(self, view):
        return self.data["scenes"][self.views[view]["scene"]]["name"]

    def place(self, view):
        return f"{self.views[view]['distance']:.3g}"

    def equal(self, **keys):
        return [e for e in self.data["equal_error"] if all(e[k] == v for k, v in keys.items())]

    def points(self, **keys):
        return [p for p in self.data["points"] if all(p[k] == v for k, v in keys.items())]


def shown(value):
    if value is None:
        return "-"
    return f"{value:.2f}" if value < 9.95 else f"{value:.0f}"


def ratios(entry, of="methods"):
    return {m["method"]: m for m in entry[of]}


def at_level(run, error, level, compute):
    """One row a view: cost of the others over ours."""
    costs = ["time", "energy", "dram-lines"]
    rows = []
    for view in range(len(run.views)):
        cells = [run.scene(view), run.place(view)]
        by_time = [ratios(e) for e in run.equal(view=view, error=error, level=level, cost="time", compute=compute)]
        ratio_of = lambda of, method: of.get(method, {"ratio": None})["ratio"]
        # Over the user's mesh where there is one; the faster.
        known = lambda methods: [m for m in methods if by_time and ratio_of(by_time[0], m) is not None]
        bvh = min(known(OVER_MESH) or known(["bvh", "bvh6"]), key=lambda m: ratio_of(by_time[0], m), default="bvh")
        for cost in costs:
            found = run.equal(view=view, error=error, level=level, cost=cost, compute=compute)
            if not found:
                break
            entry = found[0]
            mark = "*" if entry.get("why") == "always below" else ""
            of = ratios(entry)
            for method in [bvh, *run.rules]:
                cells.append(shown(ratio_of(of, method)) + mark)
            for method in run.rules:
                rule = ratios(entry, "own_rule").get(method, {"ratio": None, "why": None})
                cells.append(shown(rule["ratio"]) + ("+" if rule["why"] else ""))
        else:
            rows.append(cells)
    names = {"time": "time", "energy": "energy", "dram-lines": "DRAM"}
    return table(["scene", "radii"] + [f"{names[c]}, {m}" for c in costs for m in ["BVH"] + run.rules + [f"{r} by its rule" for r in run.rules]], rows, 2)


def summary(run, error, levels, compute, cost):
    """How often ours is cheaper, and the range of ratios, by level and method."""
    rows = []
    for level in levels:
        for method in run.others:
            found = [ratios(e)[method]["ratio"] for e in run.equal(error=error, level=level, cost=cost, compute=compute)]
            found = sorted(r for r in found if r is not None)
            if found:
                middle = found[len(found) // 2]
                rows.append([level, method, f"{sum(r > 1 for r in found)} of {len(found)}", f"{found[0]:.2f}", f"{middle:.2f}", f"{found[-1]:.2f}"])
    return table(["error", "method", "ours is cheaper in", "least ratio", "median", "largest"], rows, 2)


def near(run, view, method, samples):
    """The setting of a method that is nearest to ours at delta 1 in its surface's error."""
    def off(point):
        surface = point["geometry"]["surface"]
        return surface["percentile_99"] if surface else 0.0

    ours = run.points(view=view, method=OURS, setting="delta 1", samples=samples)
    own = off(ours[0]) if ours else 0.0
    found = run.points(view=view, method=method, samples=samples)
    return min(found, key=lambda p: abs(math.log((off(p) + 1e-6) / (own + 1e-6))), default=None)


def compared(run, samples, view):
    """Full resolution, ours at delta 1 and at delta 4, and the discrete level that is as far off as ours at delta 1."""
    one = lambda method, setting: next(iter(run.points(view=view, method=method, setting=setting, samples=samples)), None)
    return [one("bvh", "full resolution"), one(OURS, "delta 1"), one(OURS, "delta 4"), near(run, view, "discrete", samples)]


COMPARED = ["full", "delta 1", "delta 4", "discrete"]


def by_samples(run, value):
    """One row a view: `value` of what is compared, for all numbers of samples."""
    counts = run.data["options"]["samples"]
    rows = []
    for view in range(len(run.views)):
        points = [compared(run, samples, view) for samples in counts]
        rows.append([run.scene(view), run.place(view)] + [value(of[k]) if of[k] else "-" for k in range(len(COMPARED)) for of in points])
    return table(["scene", "radii"] + [f"{name}, {n}" for name in COMPARED for n in counts], rows, 2)


def flip(point):
    return f"{point['viewed']['flip']['mean']:.3f}" if point.get("viewed") else "-"


def brightness(point):
    return f"{100 * (point['appearance']['mean_ratio'] - 1):+.1f} %" if point.get("appearance") else "-"


def few(run):
    """Whether ours is nearer to the converged picture than full resolution with as many samples, by samples and delta."""
    rows = []
    deltas = sorted({p["setting"] for p in run.points(method=OURS)}, key=lambda s: float(s.split()[1]))
    for samples in run.data["options"]["samples"]:
        for setting in deltas:
            pairs = []
            for view in range(len(run.views)):
                ours = run.points(view=view, method=OURS, setting=setting, samples=samples)
                full = run.points(view=view, method="bvh", samples=samples)
                if ours and full and ours[0].get("viewed"):
                    pairs.append((ours[0], full[0]))
            errors = sorted(o["viewed"]["flip"]["mean"] / f["viewed"]["flip"]["mean"] for o, f in pairs if f["viewed"]["flip"]["mean"] > 0)
            times = sorted(f["costs"][0]["milliseconds"] / o["costs"][0]["milliseconds"] for o, f in pairs)
            if errors:
                rows.append([samples, setting, f"{sum(e < 1 for e in errors)} of {len(errors)}"] + [f"{e:.2f}" for e in (errors[0], errors[len(errors) // 2], errors[-1])] + [shown(times[len(times) // 2])])
    return table(["samples", "setting", "nearer than full resolution in", "least FLIP over its", "median", "largest", "its time over ours, median"], rows, 2)


def converged(run):
    """Samples and standard error of the converged pictures."""
    of = [v["converged"] for v in run.views if v.get("converged")]
    if not of:
        return "none"
    counts = sorted({c["samples"] for c in of})
    return f"{' or '.join(map(str, counts))} samples a pixel, standard error {min(c['standard_error'] for c in of):.2f} to {max(c['standard_error'] for c in of):.2f} of 255"


def structures(run, units):
    """Memory and area of each method."""
    rows = []
    for method in [m["name"] for m in run.data["methods"]]:
        of = run.points(method=method)
        bytes_each = sorted(p["bytes_per_triangle"] for p in of)
        gates = next((c["unit_gates"] for p in units.points(method=method) for c in p["costs"] if c.get("unit_gates")), None)
        rows.append([method, f"{bytes_each[0]:.0f} to {bytes_each[-1]:.0f}" if f"{bytes_each[0]:.0f}" != f"{bytes_each[-1]:.0f}" else f"{bytes_each[0]:.0f}", f"{gates / 1e6:.2f}" if gates else "-"])
    contexts = units.data["machines"][0]["description"]["units"]["contexts"]
    return table(["method", "bytes for each finest triangle", f"unit with {contexts} contexts, million gate equivalents"], rows, 2)


def lodray(*words):
    """What a command of the program says as JSON."""
    out = subprocess.run([ROOT / "target" / "release" / "lodray", *words, "--quiet"], check=True, capture_output=True, text=True).stdout
    return json.loads(out)


def why(run, folder):
    """Ours at delta 1 beside the discrete level that is as far off: what their rays do, and their times on the machine and on one with twice the banks in its L1s."""
    rows = []
    for scene in ["terrain 0.45", "terrain 0.6"]:
        file = scene_file(folder, scene)
        views = [view for view in range(len(run.views)) if run.scene(view) == scene]
        for view in (views[2], views[-2]):
            eye = ",".join(map(str, run.views[view]["eye"]))
            camera = [file, "--eye", eye, "--target", "0,0,0", "--size", run.size]
            level = near(run, view, "discrete", 1)["choices"]["level"]
            for words, setting in [(["--method", OURS, "--delta", "1"], "ours, delta 1"), (["--method", "discrete", "--level", level], f"discrete, level {level}")]:
                shot = lodray("render", *camera, *words, "--shading", "full", "--json", "-o", str(folder / "why"), "--force")["stats"]
                as_it_is = lodray("simulate", *camera, *words, "--json")
                banks = as_it_is["setup"]["machine"]["description"]["l1"]["banks"]
                wider = lodray("simulate", *camera, *words, "--set", f"l1.banks={2 * banks}", "--json")
                times = [frame["milliseconds"] for frame in (as_it_is, wider)]
                each = lambda count: f"{count / shot['hits']:.1f}"
                lines = sum(kind["read"] for kind in shot["lines"])
                rows.append([scene, run.place(view), setting, f"{shot['mean_level']:.2f}", each(shot["nodes"]), each(shot["lod_tests"]), each(lines)] + [f"{1000 * t:.1f}" for t in times])
    return table(["scene", "radii", "setting", "mean level", "nodes a hit", "LOD tests a hit", "lines a hit", "time, us", "twice the banks"], rows, 2)


def scene_file(folder, name):
    """A generated scene of scripts/errors/knobs.toml as a file."""
    file = folder / f"{plain(name)}.lod"
    if not file.is_file():
        what, *roughness = name.split()
        words = ["generate", what, *(["--roughness", *roughness] if roughness else []), "-o", file, "--quiet"]
        subprocess.run([ROOT / "target" / "release" / "lodray", *words], check=True)
    return str(file)


def lost(run, compute):
    """Views, their cameras and their levels where discrete LOD takes less than 0.6 of our time at half a pixel; with ours and the ratio as the tables have them. Of generated scenes alone."""
    for view in range(len(run.views)):
        for entry in run.equal(view=view, error="surface-p99", level=0.5, cost="time", compute=compute):
            level = ratios(entry).get("discrete", {"ratio": None})
            if level["ratio"] is None or level["ratio"] >= 0.6 or run.scene(view) in ("bunny", "igea"):
                continue
            machine = run.data["machines"][entry["machine"]]
            eye = ",".join(map(str, run.views[view]["eye"]))
            camera = ["--eye", eye, "--target", "0,0,0", "--size", run.size, *(f"--set={change}" for change in machine["set"]), "--json"]
            cycles = round(entry["ours"] * 1e3 * machine["description"]["cores"]["clock_mhz"])
            yield view, camera, level["setting"].split()[1], cycles, level["ratio"]


def far(run, folder):
    """Those of compute that takes no time: ours at half a pixel, the level, and the same level with a line for each triangle, as ours has it."""
    rows = []
    for view, camera, level, ours, ratio in lost(run, "free"):
        discrete = [scene_file(folder, run.scene(view)), *camera, "--compute", "free", "--method", "discrete", "--level", level]
        runs = [lodray("simulate", *discrete, *words) for words in ([], ["--leaf-layout", "line", "--leaf-size", "1"])]
        lines = run.equal(view=view, error="surface-p99", level=0.5, cost="dram-lines", compute="free")[0]["ours"]
        rows.append([run.scene(view), run.place(view), level, f"{ours:,}", *(f"{r['cycles']:,}" for r in runs), shown(ratio), shown(runs[1]["cycles"] / ours), f"{lines:,.0f}", *(f"{r['dram']['reads']:,}" for r in runs)])
    head = [*(f"cycles: {name}" for name in ("ours", "discrete", "a line a triangle")), "over ours: discrete", "over ours: a line a triangle", *(f"DRAM lines: {name}" for name in ("ours", "discrete", "a line a triangle"))]
    return table(["scene", "radii", "level", *head], rows, 2)


def near_units(run, folder):
    """Those by units: ours at delta 1 and the level, as the unit is, with LOD tests and boxes of a node that take a cycle, and with compute that takes no time."""
    eased = [f"--set=units.{change}" for change in ("lod_edges_per_cycle=3", "boxes_per_cycle=4")]
    rows = []
    for view, camera, level, _, _ in lost(run, "units"):
        file = scene_file(folder, run.scene(view))
        cells = []
        for words in (["--compute", "units"], ["--compute", "units", *eased], ["--compute", "free"]):
            runs = [lodray("simulate", file, *camera, *words, *method) for method in (["--delta", "1"], ["--method", "discrete", "--level", level])]
            cells += [f"{runs[0]['cycles']:,}", f"{runs[1]['cycles']:,}", shown(runs[1]["cycles"] / runs[0]["cycles"])]
        rows.append([run.scene(view), run.place(view), level, *cells])
    what = ["as it is", "tests of a cycle", "compute free"]
    return table(["scene", "radii", "level", *(f"{name}: {column}" for name in what for column in ("ours", "discrete", "ratio"))], rows, 2)


def hierarchy(folder):
    """Nodes that rays visit at full detail, ours and a BVH's over the same triangles, on terrains with and without anything to morph below the base mesh."""
    rows = []
    for relief, roughness in [("none", "0.000001"), ("0.45", "0.45"), ("0.6", "0.6")]:
        file = folder / f"hierarchy-{roughness}.lod"
        if not file.is_file():
            words = ["generate", "terrain", "--levels", "6", "--roughness", roughness, "-o", file, "--quiet"]
            subprocess.run([ROOT / "target" / "release" / "lodray", *words], check=True)
        ours = None
        for words, setting in [(["--method", OURS, "--delta", "inf"], "ours"), (["--method", OURS, "--delta", "inf", "--node-bounds", "prisms"], "ours, prisms")] + [(["--method", "discrete", "--level", "6", "--leaf-size", str(n)], f"BVH, leaves of {n}") for n in (16, 4, 1)]:
            shot = lodray("render", str(file), "--size", "512x512", "--distance", "1.5", *words, "--json", "-o", str(folder / "why"), "--force")["stats"]
            nodes = shot["nodes"] / shot["hits"]
            ours = ours or nodes
            rows.append([relief, setting, f"{nodes:.1f}", f"{shot['triangles'] / shot['hits']:.1f}", f"{sum(kind['read'] for kind in shot['lines']) / shot['hits']:.1f}", f"{ours / nodes:.2f}"])
    return table(["relief below the base mesh", "setting", "nodes a hit", "triangles a hit", "lines a hit", "our nodes over its"], rows, 2)


def plain(name):
    return "-".join(part for part in re.sub(r"[^A-Za-z0-9.]", "-", name).split("-") if part)


def pictures(run):
    """The diagrams of all scenes, copied into docs/images."""
    words = []
    for scene in run.data["scenes"]:
        name = plain(scene["name"])
        shutil.copy(run.folder / f"{name}-{DIAGRAM}.svg", ROOT / "docs" / "images" / f"error-time-{name}.svg")
        words.append(f"![{scene['name']}: error against time](images/error-time-{name}.svg)")
    return "\n\n".join(words)


def main():
    folder = Path(sys.argv[1])
    knobs, units, samples = (Run(folder, name) for name in ["knobs", "units", "samples"])
    error = "surface-p99"
    values = {
        "pictures": pictures(knobs),
        "half": at_level(knobs, error, 0.5, "free"),
        "summary_time": summary(knobs, error, [0.25, 0.5, 1.0, 2.0], "free", "time"),
        "summary_energy": summary(knobs, error, [0.25, 0.5, 1.0, 2.0], "free", "energy"),
        "summary_lines": summary(knobs, error, [0.25, 0.5, 1.0, 2.0], "free", "dram-lines"),
        "summary_requests": summary(knobs, error, [0.25, 0.5, 1.0, 2.0], "free", "l1-requests"),
        "summary_flip": summary(knobs, "flip-mean", [0.01, 0.02, 0.05, 0.1], "free", "time"),
        "why": why(knobs, folder),
        "hierarchy": hierarchy(folder),
        "far": far(knobs, folder),
        "near_units": near_units(units, folder),
        "half_units": at_level(units, error, 0.5, "units"),
        "structures": structures(knobs, units),
        "viewed": by_samples(samples, flip),
        "few": few(samples),
        "brightness": by_samples(samples, brightness),
        "converged": converged(samples),
        "size_knobs": knobs.size,
        "size_units": units.size,
        "size_samples": samples.size,
        "program": knobs.data["program"],
    }
    text = TEMPLATE.read_text()
    wanted = set(re.findall(r"\{\{(\w+)\}\}", text))
    if wanted != set(values):
        sys.exit(f"error_time: the template wants {sorted(wanted)}, there are {sorted(values)}")
    text = re.sub(r"\{\{(\w+)\}\}", lambda m: values[m[1]], text)
    (ROOT / "docs" / "error-time.md").write_text(text)


if __name__ == "__main__":
    main()
