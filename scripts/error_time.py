#!/usr/bin/env python3
"""Fills scripts/errors/document.md with what error-time measured: writes docs/error-time.md. Argument: the folder with the runs `knobs`, `units` and `samples`."""

import json
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TEMPLATE = ROOT / "scripts" / "errors" / "document.md"
OURS = "lod"


class Run:
    """A document of error-time."""

    def __init__(self, folder, name):
        path = folder / name / "error-time.json"
        if not path.is_file():
            sys.exit(f"error_time: no {path}")
        self.data = json.loads(path.read_text())
        self.views = self.data["views"]
        self.others = [m["name"] for m in self.data["methods"] if m["name"] != OURS]

    def scene(self, view):
        return self.data["scenes"][self.views[view]["scene"]]["name"]

    def place(self, view):
        return f"{self.views[view]['distance']:.3g}"

    def equal(self, **keys):
        return [e for e in self.data["equal_error"] if all(e[k] == v for k, v in keys.items())]

    def points(self, **keys):
        return [p for p in self.data["points"] if all(p[k] == v for k, v in keys.items())]


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * 2 + "---:|" * (len(head) - 2)]
    return "\n".join(lines + ["| " + " | ".join(map(str, row)) + " |" for row in rows])


def shown(value):
    if value is None:
        return "-"
    return f"{value:.2f}" if value < 9.95 else f"{value:.0f}"


def ratios(entry):
    return {m["method"]: m for m in entry["methods"]}


def at_level(run, error, level, compute):
    """One row a view: cost of the others over ours."""
    costs = ["time", "energy", "dram-lines"]
    rows = []
    for view in range(len(run.views)):
        cells = [run.scene(view), run.place(view)]
        for cost in costs:
            found = run.equal(view=view, error=error, level=level, cost=cost, compute=compute)
            if not found:
                break
            entry = found[0]
            mark = "*" if entry.get("why") == "always below" else ""
            for method in run.others:
                cells.append(shown(ratios(entry)[method]["ratio"]) + mark)
        else:
            rows.append(cells)
    names = {"time": "time", "energy": "energy", "dram-lines": "DRAM"}
    return table(["scene", "radii"] + [f"{names[c]}, {m}" for c in costs for m in run.others], rows)


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
    return table(["error", "method", "ours is cheaper in", "least ratio", "median", "largest"], rows)


def viewed(run):
    """FLIP against the converged picture: full resolution, and ours at delta 1, by samples."""
    counts = run.data["options"]["samples"]
    rows = []
    for view in range(len(run.views)):
        cells = [run.scene(view), run.place(view)]
        for method, setting in [("bvh", "full resolution"), (OURS, "delta 1"), (OURS, "delta 4")]:
            for samples in counts:
                found = run.points(view=view, method=method, setting=setting, samples=samples)
                cells.append(f"{found[0]['viewed']['flip']['mean']:.4f}" if found and found[0].get("viewed") else "-")
        rows.append(cells)
    head = [f"{name}, {n}" for name in ["full", "delta 1", "delta 4"] for n in counts]
    return table(["scene", "radii"] + head, rows)


def brightness(run):
    """Mean luminance over the converged picture's, by samples."""
    counts = run.data["options"]["samples"]
    rows = []
    for view in range(len(run.views)):
        cells = [run.scene(view), run.place(view)]
        for method, setting in [("bvh", "full resolution"), (OURS, "delta 1"), ("discrete", None)]:
            for samples in counts:
                found = run.points(view=view, method=method, samples=samples)
                found = [p for p in found if setting in (None, p["setting"]) and p.get("appearance")]
                # Of discrete levels the one that is nearest in geometry to ours at delta 1.
                cells.append(f"{100 * (found[0]['appearance']['mean_ratio'] - 1):+.1f} %" if found else "-")
        rows.append(cells)
    head = [f"{name}, {n}" for name in ["full", "delta 1", "coarsest level"] for n in counts]
    return table(["scene", "radii"] + head, rows)


def main():
    folder = Path(sys.argv[1])
    knobs, units, samples = (Run(folder, name) for name in ["knobs", "units", "samples"])
    error = "surface-p99"
    values = {
        "half": at_level(knobs, error, 0.5, "free"),
        "summary_time": summary(knobs, error, [0.25, 0.5, 1.0, 2.0], "free", "time"),
        "summary_energy": summary(knobs, error, [0.25, 0.5, 1.0, 2.0], "free", "energy"),
        "summary_flip": summary(knobs, "flip-mean", [0.01, 0.02, 0.05, 0.1], "free", "time"),
        "half_units": at_level(units, error, 0.5, "units"),
        "viewed": viewed(samples),
        "brightness": brightness(samples),
        "program": knobs.data["program"],
    }
    text = TEMPLATE.read_text()
    wanted = set(re.findall(r"\{\{(\w+)\}\}", text))
    if wanted != set(values):
        sys.exit(f"error_time: the template wants {sorted(wanted)}, there are {sorted(values)}")
    text = re.sub(r"\{\{(\w+)\}\}", lambda m: values[m[1]], text)
    (ROOT / "docs" / "error-time.md").write_text(text)


main()
