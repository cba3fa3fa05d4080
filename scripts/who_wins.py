"""Who wins where: ours, discrete levels, BVHs, grids, clusters and R-LODs over the same scenes, each at every setting of its own sweep, and at equal error who is cheapest (`lodray error-time`, compute free; of some views by units too).

Writes tables between the marks of docs/who-wins.md, all cells to docs/who-wins.csv and docs/who-wins-units.csv, and a page of all views, report.html, beside its pieces (`lodray report`). Each view of a scene is a piece by itself, which is kept: shards take different pieces, in any order and on any machine, and the tables are the same. A run that was stopped goes on, and one of more distances or scenes measures what is new.
"""

import argparse
import csv
import json
import math
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from markdown import among, put, table
from options import add_program, ended
from who_bounces import bounces
from who_map import drawn
from who_samples import by_samples
from who_units import by_units, lines
from who_units import measured as measured_by_units

ROOT = Path(__file__).resolve().parent.parent
METHODS = ["lod", "discrete", "bvh", "bvh6", "input-bvh", "input-bvh6", "grid", "cluster", "cluster-paper", "rlod"]
# Half octaves for clusters and R-LODs, where their own sweeps have octaves: from one of those to the next a frame of clusters takes up to 4.9 times as long, so they would lose by steps that are too large. Ours keeps octaves of delta.
FINER = {
    "error": [16, 8, 4, 2, 1.4, 1, 0.7, 0.5, 0.35, 0.25, 0.18, 0.125, 0.09, 0.0625, 0.03, 0.015],
    "pixels": [256, 180, 128, 90, 64, 45, 32, 23, 16, 11, 8, 5.6, 4, 2.8, 2, 1.4, 1],
}
# From so many radii on a view counts as far.
FAR = 16
# By which knob each is coarse or fine; BVHs have none.
COARSENESS = {"lod": "delta", "discrete": "level", "grid": "cap", "cluster": "error", "cluster-paper": "pixels", "rlod": "pixels"}


def _pixels_off(point):
    """How far 99 of 100 hits are off; where so coarse a setting has none at all, further than anything allowed."""
    surface = point["geometry"]["surface"]
    return surface["percentile_99"] if surface else float("inf")


# What errors are, and how large they may be.
ERRORS = {
    "surface": ("pixels off (99 of 100)", [0.25, 0.5, 1, 2], _pixels_off),
    "flip": ("FLIP", [0.01, 0.05], lambda point: point["picture"]["flip"]["mean"]),
}
COSTS = {
    "time": lambda cost: cost["milliseconds"],
    "energy": lambda cost: cost["energy"]["total"],
    "DRAM lines": lambda cost: cost["dram_lines"],
    "time, moving": lambda cost: cost["warm"]["milliseconds"],
    "energy, moving": lambda cost: cost["warm"]["energy"],
}


# Scenes that are made here: words of `lodray generate`.
TERRAIN = ["terrain", "--base", "128", "--levels", "6"]
SCENES = {
    "terrain": TERRAIN,
    "terrain, smooth": [*TERRAIN, "--roughness", "0.3"],
    "terrain, rough": [*TERRAIN, "--roughness", "0.7"],
    "terrain, turned": TERRAIN,
    "cloth": ["cloth", "--base", "2048", "--levels", "4"],
    "wall": ["wall", "--levels", "2"],
    "street": ["street", "--levels", "4"],
    "street, along it": ["street", "--levels", "4"],
    "plain": ["terrain", "--base", "288", "--levels", "6", "--width", "64", "--roughness", "0.5"],
}
# Views from within a scene, in place of distances: from the end of the street, bodies from the height of the picture down to some pixels; and three finest steps above the ground, from an edge to the horizon at the other.
WITHIN = {"street, along it": ("[0, 0, -1]", "[[0, 0.02, 1.02]]"), "plain": ("[0, -0.05, 0]", "[[0, 0.27, 31]]")}
# Right triangles along the axes become equilateral ones, turned by 27 degrees about y: along the axes our boxes are at their worst and those of others at their best.
SHEAR, TURN = (0.5, math.sqrt(0.75)), math.radians(27)


def turned(args, scene, to):
    """The scene with its vertices sheared and turned."""
    mesh, moved = to.with_suffix(".obj"), to.with_suffix(".moved.obj")
    subprocess.run([args.program, "--quiet", "export", scene, "-o", mesh], check=True, stdout=subprocess.DEVNULL)
    cos, sin = math.cos(TURN), math.sin(TURN)
    with mesh.open(encoding="utf-8") as lines, moved.open("w", encoding="utf-8") as out:
        for line in lines:
            if line.startswith("v "):
                x, y, z = map(float, line.split()[1:4])
                x, z = x + SHEAR[0] * z, SHEAR[1] * z
                line = f"v {cos * x + sin * z} {y} {cos * z - sin * x}\n"
            if not line.startswith("vn "):
                out.write(re.sub(r"//\d+", "", line))
    subprocess.run([args.program, "--quiet", "refit", scene, moved, "-o", to], check=True, stdout=subprocess.DEVNULL)
    mesh.unlink()
    moved.unlink()


def made(args, name):
    """The file of a scene of the list, made if it is not there."""
    to = args.out / "scenes" / f"{name.replace(', ', '-').replace(' ', '-')}.lod"
    if not to.exists():
        to.parent.mkdir(exist_ok=True)
        if name == "terrain, turned":
            turned(args, made(args, "terrain"), to)
        else:
            subprocess.run([args.program, "--quiet", "generate", *SCENES[name], "-o", to], check=True, stdout=subprocess.DEVNULL)
    return to


def triangles(program, scene):
    """Triangles of a scene at its finest level, and whether the mesh that it was made from is named in it."""
    said = json.loads(subprocess.run([program, "info", scene, "--json"], check=True, stdout=subprocess.PIPE, text=True).stdout)
    return said["finest_triangles"], "file" in (said.get("origin") or {})


def shard_of(pieces, count):
    """The shard of each piece: the largest first, each to the shard that has the least, so that all take about as long."""
    loads, of = [0] * count, {}
    for cost, piece in sorted(((cost, piece) for piece, cost in pieces.items()), key=lambda pair: (-pair[0], pair[1])):
        least = loads.index(min(loads))
        loads[least] += cost
        of[piece] = least + 1
    return of


def folder_of(args, file, place):
    """Where a piece is kept."""
    return args.out / f"{file.stem}-{place}-{args.size}-{'-'.join(args.machines)}"


def measured(args, name, place, file):
    """A piece, a view of a scene on all machines: run now, or kept from before (with --so-far none if it is not there). Where its eye is, and by machine the points of all methods, each with its cost there."""
    folder = folder_of(args, file, place)
    if not (folder / "error-time.json").exists():
        if args.so_far:
            return None
        _, has_mesh = triangles(args.program, file)
        methods = [method for method in METHODS if has_mesh or not method.startswith("input")]
        quoted = ", ".join(f'"{method}"' for method in methods)
        views = "target = {}\neyes = {}\n".format(*WITHIN[name]) if name in WITHIN else f"distances = [{place}]\n"
        text = f'size = "{args.size}"\nmethods = [{quoted}]\ncompute = ["free"]\n[[scene]]\nfile = "{file.resolve()}"\n{views}' + "".join(f'[[machine]]\nname = "{machine}"\n' for machine in args.machines)
        # Always of the same name: a run that goes on is one of the same jobs.
        jobs = Path(f"{folder}.toml")
        jobs.write_text(text, encoding="utf-8")
        # One normal for a hit of each: clusters know nothing of the facets that a triangle stands for.
        more = ["--samples", "1", "--most-samples", "0", "--no-host", "--error-size", "192", "--frames", "2", "--turn", "3", "--shading", "full", *(word for knob, values in FINER.items() for word in ("--values", f"{knob}={','.join(map(str, values))}"))]
        subprocess.run([args.program, "--quiet", "error-time", "--jobs", jobs, "-o", folder, *more], check=True, stdout=subprocess.DEVNULL)
        jobs.unlink()
    document = json.loads((folder / "error-time.json").read_text(encoding="utf-8"))
    own = lambda point, index: point | {"cost": next(cost for cost in point["costs"] if cost["machine"] == index)}
    return document["views"][0]["eye"], {machine: [own(point, index) for point in document["points"]] for index, machine in enumerate(args.machines)}


def limits(points, kind, level):
    """Whether an error keeps anything out: far away every setting of every method may be within it, and who is cheapest then says nothing of errors."""
    return any(ERRORS[kind][2](point) > level for point in points)


def best(points, kind, level, cost):
    """Of each method its cheapest setting among those that are no worse than `level`; none if it has no such setting."""
    error = ERRORS[kind][2]
    of = {}
    for point in points:
        of.setdefault(point["method"], None)
        if error(point) <= level and (of[point["method"]] is None or cost(point["cost"]) < cost(of[point["method"]]["cost"])):
            of[point["method"]] = point
    return of


def cheapest(points, kind, level, cost):
    """Of each method its least cost among settings that are no worse than `level`; none if it has no such setting."""
    return {method: point and cost(point["cost"]) for method, point in best(points, kind, level, cost).items()}


def winner(points, kind, level, what):
    """Who is cheapest, and what ours takes over that (none if it has no such setting); none if nobody has one, or if the error limits nothing."""
    if not limits(points, kind, level):
        return None
    reached = {method: cost for method, cost in cheapest(points, kind, level, COSTS[what]).items() if cost is not None}
    if not reached:
        return None
    first = min(reached, key=lambda method: (reached[method], METHODS.index(method)))
    return first, reached["lod"] / reached[first] if "lod" in reached else None


def named(point):
    """A setting, in a few words."""
    knob = COARSENESS.get(point["method"])
    return f"{knob} {point['knobs'][knob]}" if knob else ""


def cells(views):
    """All of it, as lines of CSV: in each view and at each error each method's least costs, each with the setting that has it, or that it cannot; and whether the error limits anything."""
    units = ["ms", "uJ", "DRAM lines", "ms, moving", "uJ, moving"]
    lines = [["scene", "radii", "machine", "error", "at most", "limits", "method", *(name for unit in units for name in (unit, f"setting of {unit}"))]]
    for view, points in views.items():
        for kind, (_, levels, _) in ERRORS.items():
            for level in levels:
                of = [best(points, kind, level, cost) for cost in COSTS.values()]
                for method in of[0]:
                    found = [(f"{cost(own[method]['cost']):.6g}", named(own[method])) if own[method] else ("cannot", "") for own, cost in zip(of, COSTS.values())]
                    lines.append([*view, kind, level, "yes" if limits(points, kind, level) else "no", method, *(cell for pair in found for cell in pair)])
    return lines


def maps(views, size):
    """A picture of the winners for each machine: its name, and SVG."""
    for machine in dict.fromkeys(view[2] for view in views):
        own = {f"{scene} {place}": points for (scene, place, called), points in views.items() if called == machine}
        groups = []
        for what in ("time", "energy"):
            columns = []
            for kind, (_, levels, _) in ERRORS.items():
                for level in levels:
                    won = {view: first for view, points in own.items() if (first := winner(points, kind, level, what))}
                    columns.append((f"{level:g} px" if kind == "surface" else f"FLIP {level:g}", won))
            groups.append((f"least {what}", columns))
        yield f"who-wins-{machine}", drawn(f"The cheapest on {machine}, {size}, and what ours takes over it", "-: ours cannot. *: over the mesh that the scene was made from. Blank: every setting of every method is within the error.", list(own), groups)


def all_over_ours(views, kind):
    """Medians of each method's costs over ours, least to most, and in how many views it reaches an error that ours reaches."""
    name, levels, _ = ERRORS[kind]
    rows = []
    for level in levels:
        for method in METHODS[1:]:
            cells, reached, asked = [], 0, 0
            for what in COSTS:
                ratios = []
                reached = asked = 0
                for points in views.values():
                    of = cheapest(points, kind, level, COSTS[what])
                    if limits(points, kind, level) and method in of and of["lod"] is not None:
                        asked += 1
                        if of[method] is not None:
                            reached += 1
                            ratios.append(of[method] / max(of["lod"], 1e-12))
                cells.append(f"{statistics.median(ratios):.2f} ({among(ratios)})" if ratios else "cannot")
            rows.append([f"{level:g}", f"`{method}`", f"{reached} of {asked}", *cells])
    return table([name, "method over ours, median (least to most)", "views reached", *COSTS], rows, 3)


def wins(views, what):
    """How often each method is cheapest, over all views and errors, and of how many."""
    of = dict.fromkeys(METHODS, 0)
    for points in views.values():
        for kind, (_, levels, _) in ERRORS.items():
            for level in levels:
                if first := winner(points, kind, level, what):
                    of[first[0]] += 1
    return of, sum(of.values())


def machines_of(views):
    """The views of each machine."""
    return {machine: {view: points for view, points in views.items() if view[2] == machine} for machine in dict.fromkeys(view[2] for view in views)}


def counted(views):
    """How often each method is cheapest, on each machine."""
    of = {f"{what}, {machine}": wins(own, what) for machine, own in machines_of(views).items() for what in COSTS}
    return table(["cheapest", *of], [[f"`{method}`", *(f"{won[method]} of {total}" for won, total in of.values())] for method in METHODS], 1)


def by_machine(views, kind):
    """What each method takes over ours, on each machine."""
    return "\n\n".join(f"On `{machine}`:\n\n{all_over_ours(own, kind)}" for machine, own in machines_of(views).items())


def short(views, size):
    """What the tables say in a few lines."""
    scenes, machines = list(dict.fromkeys(view[0] for view in views)), machines_of(views)
    every = sum(len(levels) for _, levels, _ in ERRORS.values()) * len(views)
    asked = sum(limits(points, kind, level) for points in views.values() for kind, (_, levels, _) in ERRORS.items() for level in levels)
    lines = [f"{len(views) // len(machines)} views of {len(scenes)} scenes on {' and '.join(f'`{machine}`' for machine in machines)}, at six errors each, frames of {size}. In {every - asked} of {every} cases every setting of every method is within the error, most of them far away; these are left out here and below.", ""]
    ranked = lambda of: ", ".join(f"`{method}` {of[method]}" for method in sorted((method for method in METHODS if of[method]), key=lambda method: -of[method]))
    for machine, own in machines.items():
        near = {view: points for view, points in own.items() if view[1] == "within" or float(view[1]) < FAR}
        far = {view: points for view, points in own.items() if view not in near}
        said = []
        for where, of in ((f"nearer than {FAR} radii and from within", near), (f"from {FAR} radii on", far)):
            won, total = wins(of, "time")
            said.append(f"{where}, of {total} cases, {ranked(won)}")
        lines.append(f"- **Fastest on `{machine}`**: " + "; ".join(said) + ".")
    for what in ("energy", "DRAM lines"):
        lines.append(f"- **Least {what}**: " + "; ".join(f"on `{machine}`, of {total} cases, {ranked(won)}" for machine, own in machines.items() for won, total in [wins(own, what)]) + ".")
    for machine, own in machines.items():
        over = []
        for method in METHODS[1:]:
            pair = []
            for what in ("time", "energy"):
                both = [(of[method], of["lod"]) for of in (cheapest(points, "surface", 1, COSTS[what]) for points in own.values() if limits(points, "surface", 1)) if of.get(method) and of["lod"]]
                pair.append(statistics.median(own / ours for own, ours in both) if both else None)
            if pair[0]:
                over.append(f"`{method}` {pair[0]:.2f} and {pair[1]:.2f}")
        lines.append(f"- **Within a pixel on `{machine}`**, in the median of the views that both reach, time and energy over ours: " + ", ".join(over) + ".")
    return "\n".join(lines)


def defaults(views):
    """Each method as it is by default, over ours as it is by default: how far off it is, and its costs."""
    rows = []
    for machine, own in machines_of(views).items():
        of = [{point["method"]: point for point in points if point["is_default"]} for points in own.values()]
        for method in METHODS:
            found = [(points[method], points["lod"]) for points in of if method in points]
            # A default that no sweep has.
            if len(found) < sum(any(point["method"] == method for point in points) for points in own.values()) or not found:
                continue
            off = [_pixels_off(theirs) for theirs, _ in found]
            costs = [[cost(theirs["cost"]) / max(cost(ours["cost"]), 1e-12) for theirs, ours in found] for cost in (COSTS["time"], COSTS["energy"])]
            rows.append([f"`{machine}`", f"`{method}`", f"{statistics.median(off):.2f} ({among(off)})".replace("inf", "no hit"), *(f"{statistics.median(ratios):.2f} ({among(ratios)})" for ratios in costs)])
    return table(["machine", "method", "pixels off (99 of 100), median (least to most)", "time over ours", "energy over ours"], rows, 2)


def sizes(views):
    """Bytes a triangle of each method, by scene: of its settings and views the least and the most."""
    scenes = {}
    for (scene, *_), points in views.items():
        for point in points:
            scenes.setdefault(scene, {}).setdefault(point["method"], []).append(point["bytes_per_triangle"])
    rows = [[name, *(among(own[method]) if method in own else "" for method in METHODS)] for name, own in scenes.items()]
    return table(["bytes a triangle", *(f"`{method}`" for method in METHODS)], rows, 1)


def builds(args, scene):
    """Seconds to build each method over a scene, the least of three runs; of ours, whose scene is its structure, to make all of it anew from moved vertices."""
    seconds = {}
    with tempfile.TemporaryDirectory() as desk:
        for method in METHODS:
            if method.startswith("input"):
                continue
            if method == "lod":
                words = ["refit", scene, "--motion", "wave", "-o", f"{desk}/moved.lod"]
            else:
                words = ["render", scene, "--size", "16x16", "--method", method, "--cache", "none", "-o", f"{desk}/picture"]
            for _ in range(3):
                from_then = time.monotonic()
                said = subprocess.run([args.program, *words, "--json"], check=True, stdout=subprocess.PIPE, text=True).stdout
                taken = time.monotonic() - from_then if method == "lod" else json.loads(said)["seconds"]["building"]
                seconds[method] = min(taken, seconds.get(method, math.inf))
    rows = [["`lod`, refitted" if method == "lod" else f"`{method}`", f"{own:.2f}", f"{own / seconds['bvh6']:.2f}", "boxes and bounds made anew, file read and written" if method == "lod" else "built anew, or refitted" if method.startswith("bvh") else "built anew"] for method, own in seconds.items()]
    return table(["method", "seconds", "over `bvh6`", "when vertices move"], rows, 1)


def view_of(name, place):
    """A view in words of `lodray simulate`."""
    if name not in WITHIN:
        return ["--distance", place]
    target, eyes = (json.loads(text) for text in WITHIN[name])
    return [f"--target={','.join(map(str, target))}", f"--eye={','.join(map(str, eyes[0]))}"]


def distances(text):
    """Distances, with commas, as they were written."""
    of = text.split(",")
    try:
        if all(float(distance) > 0 for distance in of):
            return of
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"'{text}' is no list of distances")


def main():
    """Measures what is not yet there, and writes the tables if all is."""
    parser = argparse.ArgumentParser(prog="scripts/who-wins", description=__doc__.split("\n", maxsplit=1)[0])
    add_program(parser)
    parser.add_argument("--size", default="512x512", help="size of the frames (default 512x512; 1920x1080 takes about eight times as long)")
    parser.add_argument("--distances", type=distances, default="0.8,1.2,2,4,8,16,32,64", help="distances of the eye in radii, with commas (default: eight from 0.8 to 64)")
    parser.add_argument("--machines", type=lambda text: text.split(","), default=["haydel2023", "turing2018"], help="machines, with commas (default haydel2023,turing2018)")
    parser.add_argument("--bounces", default="4", help="distance, one of the others, at which rays that follow and more samples are measured too (default 4)")
    parser.add_argument("--units", type=distances, default="1.2,4,8,16,32,64", help="distances, of the others, that are measured by units too, beside views from within (default 1.2,4,8,16,32,64)")
    parser.add_argument("--out", type=Path, default=Path("target/who-wins"), help="folder in which pieces are kept; a run that is started again goes on with it (default target/who-wins)")
    parser.add_argument("--shard", default="1/1", help="measure the K-th of N parts alone, K/N, and write no tables (default: all)")
    parser.add_argument("--so-far", action="store_true", help="tables of the views that are there, and which are not: no other is measured")
    parser.add_argument("--print", action="store_true", help="print the tables, and leave the document alone")
    parser.add_argument("--only", type=lambda text: text.split(";"), default=list(SCENES), help=f"scenes to make, by name, with semicolons: {'; '.join(SCENES)} (default all)")
    parser.add_argument("scene", nargs="*", type=Path, help="scene files beside those that are made here, of meshes (build)")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    try:
        shard, shards = (int(part) for part in args.shard.split("/"))
    except ValueError:
        parser.error(f"--shard: '{args.shard}' is not K/N")
    if not 1 <= shard <= shards:
        parser.error(f"--shard: '{args.shard}' is no part of N")
    for name in args.only:
        if name not in SCENES:
            parser.error(f"--only: '{name}' is none of {'; '.join(SCENES)}")
    for file in args.scene:
        if not file.exists():
            parser.error(f"no file {file}")
    files = {file.stem: file for file in args.scene} | {name: made(args, name) for name in args.only}
    # One distance after the other. Near frames cost most: a frame's rays spread over more triangles.
    counts = {name: triangles(args.program, file)[0] for name, file in files.items()}
    pieces = {(name, place): counts[name] / float(place) for place in args.distances for name in files if name not in WITHIN}
    pieces |= {(name, "within"): counts[name] for name in files if name in WITHIN}
    of = shard_of(pieces, shards)
    done = {piece: measured(args, *piece, files[piece[0]]) for piece in pieces if of[piece] == shard}
    if shards > 1:
        return
    missing = [f"{name} {place}" for (name, place), of in done.items() if of is None]
    done = {piece: of for piece, of in done.items() if of is not None}
    if not done:
        sys.exit(f"scripts/who-wins: no view is in {args.out} yet")
    # By scene, as people read it.
    views = {(name, place, machine): done[name, place][1][machine] for name in files for place in [*args.distances, "within"] if (name, place) in done for machine in args.machines}
    texts = {"missing": f"Views that were not measured: {', '.join(missing)}." if missing else "All views were measured.", "short": short(views, args.size), "count": counted(views), "defaults": defaults(views), "sizes": sizes(views)}
    if "terrain" in files:
        texts["builds"] = builds(args, files["terrain"])
    for kind in ERRORS:
        texts[f"{kind} summary"] = by_machine(views, kind)
    if "haydel2023" in args.machines and args.bounces in args.distances:
        own = {name: done[name, args.bounces] for name in files if (name, args.bounces) in done}
        points, eyes = {name: points["haydel2023"] for name, (_, points) in own.items()}, {name: eye for name, (eye, _) in own.items()}
        texts["bounces"] = bounces(args, files, points, eyes, METHODS, ERRORS["surface"][2], named)
        texts["samples"] = by_samples(args, files, points, eyes, METHODS, ERRORS["surface"][2])
    places = {(name, place): view_of(name, place) for name, place in done if place in [*args.units, "within"]}
    own = {view: points for view, points in views.items() if view[:2] in places}
    by_name = {kind: levels for kind, (_, levels, _) in ERRORS.items()}
    cases = measured_by_units(args, files, places, own, lambda points, kind, level: best(points, kind, level, COSTS["time"]) if limits(points, kind, level) else None, by_name)
    texts["units"] = by_units(cases, METHODS, {kind: name for kind, (name, *_) in ERRORS.items()})
    # Pieces of other versions may not go together: the tables do without the page.
    paged = [folder_of(args, files[name], place) / "error-time.json" for name, place in done]
    scenes = len({name for name, _ in done})
    subprocess.run([args.program, "--quiet", "report", *paged, "--title", f"Who wins where: {scenes} scenes, {args.size}", "-o", args.out / "report.html"], check=False)
    if args.print:
        print("\n\n".join([f"{len(views)} views of {len(files)} scenes, {args.size}", *texts.values()]))
        return
    with (ROOT / "docs" / "who-wins.csv").open("w", encoding="utf-8", newline="") as out:
        csv.writer(out, lineterminator="\n").writerows(cells(views))
    with (ROOT / "docs" / "who-wins-units.csv").open("w", encoding="utf-8", newline="") as out:
        csv.writer(out, lineterminator="\n").writerows(lines(cases, named))
    for name, picture in maps(views, args.size):
        (ROOT / "docs" / "images" / f"{name}.svg").write_text(picture, encoding="utf-8")
    for name, text in texts.items():
        put(ROOT / "docs" / "who-wins.md", f"<!-- {name} -->", f"<!-- {name} end -->", text)


if __name__ == "__main__":
    ended(main)
