"""Rays that follow: what a shadow ray of each hit, and a bounce, add to the frames of docs/who-wins.md, of each method at its fastest setting within a pixel (`lodray paths --machine`, compute free)."""

import json
import statistics
import subprocess

from keep import kept, knobs
from markdown import among, table

# A hit is off by at most so many pixels (99 of 100): the setting that primary rays choose is what the others have.
WITHIN = 1
# What is traced: name, whether lights are asked, and bounces.
TRACED = [("primary rays", False, 0), ("and a shadow ray each", True, 0), ("and a bounce", True, 1)]
LIGHTS = """
[material.grey]
kind = "diffuse"
albedo = [0.5, 0.5, 0.5]

[[light]]
kind = "sun"
direction = [-1.0, 1.0, 0.35]
half_angle = 0.5
irradiance = [3.0, 3.0, 3.0]

[environment]
zenith = [0.3, 0.3, 0.5]
horizon = [0.6, 0.6, 0.6]
ground = [0.3, 0.3, 0.3]
"""


def description(args, name, file, eye, shadow, samples, depth):
    """A file that describes the scene as a camera at `eye` sees it."""
    facts = json.loads(subprocess.run([args.program, "info", file, "--json"], check=True, stdout=subprocess.PIPE, text=True).stdout)
    more = f"{samples}-samples" if samples > 1 else "shadow" if shadow else "plain"
    path = args.out / f"{name.replace(', ', '-').replace(' ', '-')}-{args.bounces}-{args.size}-{more}.toml"
    width, height = args.size.split("x")
    picture = f"[picture]\nwidth = {width}\nheight = {height}\nsamples = {samples}\ndepth = {depth}\nshadow_rays = {str(shadow).lower()}\n"
    camera = f'[[camera]]\nname = "eye"\neye = {eye}\ntarget = {facts["centre"]}\n'
    path.write_text(f'{picture}\n{camera}\n[[model]]\nfile = "{file.resolve()}"\nmaterial = "grey"\n{LIGHTS}', encoding="utf-8")
    return path


def run(args, name, file, eye, point, shadow=False, samples=1, depth=1):
    """Milliseconds and energy up to each bounce."""
    described = description(args, name, file, eye, shadow, samples, depth)
    found = kept(args, ["--quiet", "paths", described, "--method", point["method"], *knobs(point), "--machine", "haydel2023", "-o", args.out / "paths", "--force"])
    return [(up_to["milliseconds"], up_to["energy"]) for up_to in found]


def costs(args, name, file, eye, point):
    """Milliseconds and energy of all that is traced, one after the other."""
    of = {shadow: run(args, name, file, eye, point, shadow) for shadow in (False, True)}
    return [of[shadow][depth] for _, shadow, depth in TRACED]


def fastest(points, error):
    """Of each method its fastest setting within a pixel, if it has one. `paths` does not look for the mesh."""
    best = {}
    for point in points:
        method = point["method"]
        if not method.startswith("input-") and error(point) <= WITHIN and (method not in best or point["cost"]["milliseconds"] < best[method]["cost"]["milliseconds"]):
            best[method] = point
    return best


def bounces(args, files, points, eyes, methods, error, named):
    """The table: of each method the median over scenes of its costs over ours, and the scenes one by one. `points` and `eyes` are by scene."""
    ratios, rows = {}, []
    for name, own in points.items():
        best = fastest(own, error)
        if "lod" not in best:
            rows.append([name, "`lod`", "cannot", *[""] * (2 * len(TRACED))])
            continue
        ours = costs(args, name, files[name], eyes[name], best["lod"])
        for method in methods:
            if method not in best:
                continue
            theirs = costs(args, name, files[name], eyes[name], best[method])
            over = [value for a, b in zip(theirs, ours) for value in (a[0] / b[0], a[1] / b[1])]
            if method != "lod":
                ratios.setdefault(method, []).append(over)
            cells = [f"{time:.4f} ms" if what == 0 else f"{energy:.1f} uJ" for time, energy in ours for what in (0, 1)] if method == "lod" else [f"{value:.2f}" for value in over]
            rows.append([name, f"`{method}`", named(best[method]), *cells])
    heads = [f"{name}, {what}" for name, *_ in TRACED for what in ("time", "energy")]
    summary = [[f"`{method}`", len(of)] + [f"{statistics.median(values):.2f} ({among(values)})" for values in zip(*of)] for method, of in ratios.items()]
    return table(["method over ours, median (least to most)", "scenes", *heads], summary, 1) + "\n\n" + table(["scene", "method", "setting", *heads], rows, 3)
