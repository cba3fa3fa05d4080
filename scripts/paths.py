#!/usr/bin/env python3
"""Runs the experiments with paths that are not in the folder yet, and fills scripts/paper/paths.md with what they measured: writes docs/paths.md. Argument: the folder."""

import itertools
import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

from markdown import table
from plot import diagram

ROOT = Path(__file__).resolve().parent.parent
LODRAY = ROOT / "target" / "release" / "lodray"
TEMPLATE = ROOT / "scripts" / "paper" / "paths.md"
MEASURED = ROOT / "scripts" / "paper" / "measured.json"
IMAGES = ROOT / "docs" / "images"
SCENES = ["room", "drape", "terrain"]

# Of the diagrams of error against time.
AXES = ["time of a picture of 64 paths a pixel, ms", "error of light: mean squared relative error"]

# Ours and the baseline, in the paper's forms and at their best.
FORMS = {
    "paper": {
        "generate": ["--bounds", "largest", "--vertices", "exact"],
        "lod": ["--line-layout", "paper"],
        "bvh": ["--node-boxes", "codes", "--leaf-layout", "line", "--leaf-size", "1"],
    },
    "best": {"generate": [], "lod": [], "bvh": []},
}
# What figure 17 leaves open, one at a time.
BASE = {"size": "512x512", "samples": 1, "spread": 0.1, "eye": 3.4, "shadow": False, "levels": 5, "walls": None}
OPEN = {
    "size": ["256x256", "1024x1024"],
    "samples": [4],
    "spread": [0, 0.02, 0.05, 0.2, 0.5],
    "eye": [0.9, 2.0, 6.0],
    "shadow": [True],
    "levels": [4, 6],
    "walls": [1, 4, 16],
}
STARTS = ["exact", "independent", "1e-6", "1e-5", "1e-4", "1e-3", "1e-2"]
DELTAS = ["4", "2", "1", "0.5", "0.25"]


class Runs:
    """Runs, each in a folder of its own that stays."""

    def __init__(self, folder):
        self.folder = folder
        folder.mkdir(parents=True, exist_ok=True)

    def scene(self, levels, walls, form):
        """The room as a scene file."""
        path = self.folder / f"room-{levels}-{walls}-{form}.lod"
        if not path.exists():
            own = ["--walls", walls] if walls else []
            run("generate", "room", "--levels", levels, *own, *FORMS[form]["generate"], "-o", path)
        return path

    def room(self, of, form):
        """A description of figure 17's scene."""
        text = (ROOT / "scenes" / "room.toml").read_text()
        scene = self.scene(of["levels"], of["walls"], form)
        text = re.sub(r"generate = .*", f'file = "{scene.name}"', text)
        text = re.sub(r"eye = .*", f"eye = [0.0, 0.05, {of['eye']}]", text)
        text = re.sub(r"shadow_rays = .*", f"shadow_rays = {str(of['shadow']).lower()}", text)
        path = self.folder / f"room-{of['levels']}-{of['walls']}-{of['eye']}-{of['shadow']}-{form}.toml"
        path.write_text(text)
        return path

    def paths(self, name, *arguments):
        """The figures of a run."""
        folder = self.folder / name
        if not (folder / "run.json").exists():
            print(name, flush=True)
            run("paths", *arguments, "-o", folder, "--force")
        return json.loads((folder / "paths.json").read_text())

    def bounces(self, of, form, method):
        name = "figure17/" + "-".join(str(v) for v in of.values() if v is not None) + f"-{form}-{method}"
        options = ["--size", of["size"], "--samples", of["samples"], "--diffuse-spread", of["spread"], "--machine", "haydel2023"]
        return self.paths(name, self.room(of, form), *options, "--method", method, *FORMS[form][method])


def run(*arguments):
    subprocess.run([str(LODRAY), *map(str, arguments)], check=True, stdout=subprocess.DEVNULL)


def gains(lod, bvh):
    """Primary energy and time of the baseline over ours; and what each bounce adds."""
    first = [bvh[0]["energy"] / lod[0]["energy"], bvh[0]["milliseconds"] / lod[0]["milliseconds"]]
    return first + [b["added_milliseconds"] / a["added_milliseconds"] for a, b in zip(lod[1:], bvh[1:])]


def factors(values):
    return [f"{v:.1f}" for v in values]


def figure17(runs):
    rows = []
    for form in FORMS:
        lod, bvh = (runs.bounces(BASE, form, method) for method in ["lod", "bvh"])
        for k, (a, b) in enumerate(zip(lod, bvh)):
            energy = [f"{v[key] / 1000:.3f}" for v in (a, b) for key in ["energy"]]
            time = [f"{v['milliseconds']:.4f}" for v in (a, b)]
            added = [f"{v['added_milliseconds']:.4f}" for v in (a, b)]
            rays = [f"{v['rays']:,}" for v in (a, b)]
            ratio = f"{b['added_milliseconds'] / a['added_milliseconds']:.1f}"
            rows.append([form, k, *rays, *energy, *time, *added, ratio, f"{b['added_energy'] / a['added_energy']:.1f}"])
    head = ["forms", "bounces", "rays, ours", "BVH", "mJ, ours", "BVH", "ms, ours", "BVH", "added ms, ours", "BVH", "BVH adds, time", "energy"]
    return table(head, rows, len(head))


def opened(runs):
    rows = []
    choices = [("as above", BASE)] + [(f"{key} {value}", {**BASE, key: value}) for key, values in OPEN.items() for value in values]
    for form in FORMS:
        for name, of in choices:
            rows.append([form, name, *factors(gains(*(runs.bounces(of, form, method) for method in ["lod", "bvh"])))])
    head = ["forms", "what is changed", "primary energy", "primary time", "1st bounce", "2nd", "3rd"]
    return table(head, rows, len(head))


def described(scene):
    return ROOT / "scenes" / f"{scene}.toml"


def rule_of(runs, scene, starts):
    """What a scene's pictures with such starts come to."""
    return runs.paths(f"rule/{scene}-{starts}", described(scene), "--compare", "--samples", 16, "--size", "384x288", "--starts", starts)


def rule(runs):
    rows = []
    for scene in SCENES:
        for starts in STARTS:
            full = rule_of(runs, scene, starts)["against_full"]
            pixels = full["pixels"]
            psnr = full["image"]["psnr_db"]
            wrong = [f"{pixels[key]:,}" for key in ["shadowed", "leaking"]] if pixels["pixels"] else ["–", "–"]
            rows.append([scene, starts, f"{full['light']:.4f}", f"{psnr:.1f}", f"{pixels['pixels']:,}", *wrong])
    for scene in SCENES:
        for picture, starts in [("exact", "exact"), ("independent", "independent"), ("offset", "1e-4")]:
            shutil.copy(runs.folder / f"rule/{scene}-{starts}/paths.png", IMAGES / f"paths-{scene}-{picture}.png")
        shutil.copy(runs.folder / f"rule/{scene}-exact/full.png", IMAGES / f"paths-{scene}-full.png")
    head = ["scene", "starts", "error of light", "picture, dB", "pixels with shadow rays", "in shadow, should not be", "in light, should not be"]
    return table(head, rows, len(head))


def ledger(runs):
    """What docs/claims.md says of figure 17 and of the rule."""
    measured = json.loads(MEASURED.read_text())
    values = {}
    for form in FORMS:
        own = factors(gains(*(runs.bounces(BASE, form, method) for method in ["lod", "bvh"])))
        values |= {f"paths_{form}_{name}": f"{value} times" for name, value in zip(["energy", "time", "first", "second", "third"], own)}
    for scene, starts in itertools.product(SCENES, ["exact", "independent", "1e-3"]):
        against = rule_of(runs, scene, starts)["against_full"]
        name = f"rule_{scene}_{starts.replace('-', '_')}"
        values[name] = f"{against['light']:.4f}"
        values[f"{name}_pixels"] = f"{against['pixels']['shadowed']:,} and {against['pixels']['leaking']:,}"
    version = json.loads((runs.folder / "rule" / "room-exact" / "run.json").read_text())["lodray"]
    measured["paths"] = {"sweeps": ["paths"], "version": version, "values": values}
    MEASURED.write_text(json.dumps(measured, indent=1, sort_keys=True) + "\n")
    subprocess.run([sys.executable, str(ROOT / "scripts" / "figures.py"), str(runs.folder)], check=True)


def spread(runs):
    rows = []
    for value in ["0", "0.01", "0.02", "0.05", "0.1", "0.2", "0.5"]:
        row = [value]
        for scene in ["room", "terrain"]:
            options = [described(scene), "--size", "256x192", "--diffuse-spread", value]
            error = runs.paths(f"spread/{scene}-{value}-error", *options, "--samples", 16, "--compare")["against_full"]
            cost = runs.paths(f"spread/{scene}-{value}-cost", *options, "--samples", 1, "--machine", "haydel2023")[-1]
            row += [f"{error['light']:.4f}", f"{error['image']['psnr_db']:.1f}", f"{cost['milliseconds']:.4f}", f"{cost['energy'] / 1000:.3f}"]
        rows.append(row)
    one = ["error of light", "dB", "ms", "mJ"]
    head = ["spread"] + [f"room: {v}" for v in one] + [f"terrain: {v}" for v in one]
    return table(head, rows, len(head))


def error_time(runs):
    rows = []
    for scene in ["room", "terrain"]:
        ways = [("lod", ["--delta", delta], f"delta {delta}") for delta in DELTAS]
        ways += [("discrete", ["--level", str(level)], f"level {level}") for level in [1, 2, 3, 4, 5]] + [("bvh", [], "")]
        lines = {}
        for method, options, knob in ways:
            name = f"error-time/{scene}-{method}-{knob.replace(' ', '-')}"
            options = [described(scene), "--size", "128x96", "--method", method, *options]
            error = runs.paths(name + "-error", *options, "--samples", 64, "--converged", 512)["against_converged"]
            cost = runs.paths(name + "-cost", *options, "--samples", 4, "--machine", "haydel2023")[-1]
            # Of 64 paths a pixel, as many as the pictures have.
            figures = [f"{cost['milliseconds'] * 16:.3f}", f"{cost['energy'] * 16 / 1000:.2f}", f"{cost['dram_bytes'] * 16 / 1e6:.1f}"]
            lines.setdefault(method, []).append((cost["milliseconds"] * 16, error["light"]))
            rows.append([scene, method, knob, f"{error['light']:.5f}", f"{error['image']['psnr_db']:.2f}", *figures])
        (IMAGES / f"paths-error-time-{scene}.svg").write_text(diagram(f"{scene}.toml, haydel2023, compute free", *AXES, lines))
    head = ["scene", "method", "knob", "error of light", "picture, dB", "ms", "mJ", "MB of DRAM"]
    return table(head, rows, len(head))


def main():
    runs = Runs(Path(sys.argv[1]))
    parts = {"figure17": figure17, "open": opened, "rule": rule, "spread": spread, "error-time": error_time}
    text = TEMPLATE.read_text()
    for name, part in parts.items():
        mark = "{{" + name + "}}"
        if mark not in text:
            sys.exit(f"paths: {TEMPLATE} has no {mark}")
        text = text.replace(mark, part(runs))
    (ROOT / "docs" / "paths.md").write_text(text)
    ledger(runs)


main()
