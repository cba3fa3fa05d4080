#!/usr/bin/env python3
"""Runs the frames of scripts/errors/fair.toml warm, and fills the tables of README.md, docs/error-time.md, docs/claims.md and their templates. Arguments: the program, the bunny's mesh, the folder of scripts/fair."""

import json
import statistics
import subprocess
import sys
import tomllib
from pathlib import Path

from markdown import put, table

ROOT = Path(__file__).resolve().parent.parent
FRAMES, TURN = 4, 3
# Of the list of jobs what `simulate` takes as options.
OPTIONS = ["--size", "1920x1080", "--machine", "haydel2023", "--compute", "free"]


class Frames:
    """What error-time measured, and the same frames warm."""

    def __init__(self, program, mesh, folder, name="frames", jobs="fair.toml"):
        self.program, self.mesh, self.folder = program, mesh, folder
        self.data = json.loads((folder / name / "error-time.json").read_text())
        jobs = tomllib.loads((ROOT / "scripts" / "errors" / jobs).read_text())
        self.sets = [f"{key}={value}" for key, value in jobs["machine"][0].get("set", {}).items()]
        self.scenes = {scene.get("name", scene.get("generate")): scene for scene in jobs["scene"]}
        self.cache = folder / "warm.json"
        self.warm_runs = json.loads(self.cache.read_text()) if self.cache.is_file() else {}

    def scene(self, view):
        return self.data["scenes"][self.data["views"][view]["scene"]]

    def points(self, view, *methods):
        return [point for point in self.data["points"] if point["view"] == view and point["method"] in methods]

    def file(self, name):
        """A scene's file, generated where it is not there."""
        scene = self.scenes[name]
        if "file" in scene:
            return ROOT / "scripts" / "errors" / scene["file"]
        path = self.folder / f"{name.replace(',', '').replace(' ', '-')}.lod"
        if not path.is_file():
            options = [f"--{key}={scene[key]}" for key in ("base", "levels", "roughness", "width") if key in scene]
            subprocess.run([self.program, "generate", scene["generate"], *options, "-o", path], check=True, capture_output=True)
        return path

    def warm(self, view, point):
        """The point's frame behind others, the camera turning."""
        entry, scene = self.data["views"][view], self.scene(view)["name"]
        target = self.scenes[scene].get("target")
        place = ["--distance", str(round(entry["distance"], 6))] if target is None else ["--eye=" + ",".join(map(str, entry["eye"])), "--target=" + ",".join(map(str, target))]
        knobs = [f"--{name}={value}" for name, value in {**point["knobs"], **point["choices"]}.items() if name in ("delta", "level")]
        command = ["simulate", str(self.file(scene)), "--method", point["method"], *knobs, *place, *OPTIONS]
        command += [f"--set={change}" for change in self.sets] + ["--frames", str(FRAMES), "--turn", str(TURN), "--json"]
        command += ["--mesh", self.mesh] if point["method"].startswith("input") else []
        key = " ".join([self.data["program"], *command])
        if key not in self.warm_runs:
            result = json.loads(subprocess.run([self.program, *command], check=True, capture_output=True, text=True).stdout)
            self.warm_runs[key] = {"warm": result["warm"], "first": result["frames"][0]}
            self.cache.write_text(json.dumps(self.warm_runs))
        return self.warm_runs[key]

    def rivals(self, view):
        """Name and point of ours and of what it is compared with; BVHs by time."""
        cycles = lambda point: point["costs"][0]["cycles"]
        error = lambda point: point["geometry"]["surface"]["percentile_99"]
        ours = next(iter(self.points(view, "lod")))
        levels = self.points(view, "discrete")
        near = [point for point in levels if error(point) <= error(ours)]
        bvhs = self.points(view, "input-bvh", "input-bvh6") or self.points(view, "bvh", "bvh6")
        yield "ours", ours
        yield "BVH", min(bvhs, key=cycles)
        yield "discrete, its rule", next(point for point in levels if point["is_default"])
        yield "discrete, hindsight", min(near, key=cycles) if near else None


def shown(value):
    return f"{value:.2f}" if value < 9.95 else f"{value:,.0f}"


def costs(point):
    cost = point["costs"][0]
    return [cost["cycles"], cost["energy"]["total"], cost["dram_bytes"]]


def place(frames, view):
    name = frames.scene(view)["name"]
    return name if "target" in frames.scenes[name] else f"{name}, {frames.data['views'][view]['distance']:.3g} radii"


def absolute(frames):
    """Everything, for each view and method."""
    rows = []
    for view in range(len(frames.data["views"])):
        for name, point in frames.rivals(view):
            if point is None:
                rows.append([place(frames, view), name, *["none is near enough"] + [""] * 8])
                continue
            cycles, energy, dram = costs(point)
            surface = point["geometry"]["surface"]
            run = frames.warm(view, point)
            setting = "" if name == "ours" else f" ({point['method'] if name == 'BVH' else point['setting']})"
            warm = run["warm"]
            rows.append(
                [place(frames, view), name + setting, f"{point['costs'][0]['milliseconds'] * 1e3:.1f}", f"{energy:,.0f}", f"{dram / 1e3:,.0f}", f"{point['bytes_per_triangle']:.1f}"]
                + [f"{surface['percentile_99']:.2f}", f"{warm['cycles'] / cycles * point['costs'][0]['milliseconds'] * 1e3:.1f}", f"{warm['energy']:,.0f}", f"{100 * run['first']['stragglers']:.0f} / {100 * warm['stragglers']:.0f} %"]
            )
    head = ["view", "method", "time, us", "energy, uJ", "DRAM, KB", "bytes a triangle", "error, pixels", "warm: time", "energy", "stragglers"]
    return table(head, rows, 2)


def ratios(frames):
    """Theirs over ours, cold and warm."""
    rows, columns = [], [[] for _ in range(12)]
    for view in range(len(frames.data["views"])):
        points = dict(frames.rivals(view))
        ours, warm = costs(points["ours"]), frames.warm(view, points["ours"])["warm"]
        row = []
        for name in ["BVH", "discrete, its rule", "discrete, hindsight"]:
            point = points[name]
            if point is None:
                row += [None] * 4
                continue
            theirs, run = costs(point), frames.warm(view, point)["warm"]
            row += [theirs[0] / ours[0], theirs[1] / ours[1], run["cycles"] / warm["cycles"], run["energy"] / warm["energy"]]
        for column, value in zip(columns, row):
            column += [] if value is None else [value]
        rows.append([place(frames, view), *("-" if value is None else shown(value) for value in row)])
    rows.append(["median", *(shown(statistics.median(column)) for column in columns)])
    what = ["time", "energy", "warm time", "warm energy"]
    head = ["view", *[f"BVH: {what[0]}", *what[1:]], *[f"discrete, its rule: {what[0]}", *what[1:]], *[f"in hindsight: {what[0]}", *what[1:]]]
    return table(head, rows, 1)


def by_units(frames):
    """Theirs over ours on another machine, cold."""
    rows, columns = [], [[] for _ in range(6)]
    for view in range(len(frames.data["views"])):
        points = dict(frames.rivals(view))
        ours, row = points["ours"], []
        for name in ["BVH", "discrete, its rule", "discrete, hindsight"]:
            point = points[name]
            row += [None] * 2 if point is None else [theirs / own for theirs, own in zip(costs(point)[:2], costs(ours))]
        for column, value in zip(columns, row):
            column += [] if value is None else [value]
        rows.append([place(frames, view), f"{ours['costs'][0]['milliseconds'] * 1e3:,.0f}", *("-" if value is None else shown(value) for value in row)])
    rows.append(["median", "", *(shown(statistics.median(column)) for column in columns)])
    return table(["view", "ours, us", "BVH: time", "energy", "discrete, its rule: time", "energy", "in hindsight: time", "energy"], rows, 1)


def small(frames):
    """The medians at another size, and the views with depth."""
    over = {name: [] for name in ["BVH", "discrete, its rule", "discrete, hindsight"]}
    deep = []
    for view in range(len(frames.data["views"])):
        points = dict(frames.rivals(view))
        for name, ratios_of in over.items():
            if points[name] is not None:
                ratios_of.append([theirs / own for theirs, own in zip(costs(points[name])[:2], costs(points["ours"]))])
        if "target" in frames.scenes[frames.scene(view)["name"]]:
            deep.append(f"{shown(over['BVH'][-1][0])} ({place(frames, view)})")
    median = lambda name: " and ".join(shown(statistics.median(column)) for column in zip(*over[name]))
    size = "x".join(map(str, frames.data["views"][0]["size"]))
    return (
        f"The size of the frame decides as much. At {size}, cold, in the median: the best BVH takes {median('BVH')} of our time and energy, discrete LOD by its own rule {median('discrete, its rule')}, "
        f"in hindsight {median('discrete, hindsight')}; in the views with depth the BVH takes {', '.join(deep)} of our time."
    )


def warm(frames):
    """Medians of theirs over ours, cold and warm."""
    rows = []
    for name in ["BVH", "discrete, its rule", "discrete, hindsight"]:
        of = []
        for view in range(len(frames.data["views"])):
            points = dict(frames.rivals(view))
            if points[name] is not None:
                (theirs, ours), runs = map(costs, (points[name], points["ours"])), [frames.warm(view, points[of])["warm"] for of in (name, "ours")]
                of.append([theirs[0] / ours[0], runs[0]["cycles"] / runs[1]["cycles"], theirs[1] / ours[1], runs[0]["energy"] / runs[1]["energy"]])
        rows.append([name, *(shown(statistics.median(column)) for column in zip(*of))])
    return table(["theirs", "time, cold", "warm", "energy, cold", "warm"], rows, 1)


def lenient(frames, more):
    """Time and energy in hindsight over ours, where a level may have so much more error than ours: the medians, and in how many views ours takes less time."""
    times, energies = [], []
    for view in range(len(frames.data["views"])):
        error = lambda point: point["geometry"]["surface"]["percentile_99"]
        ours = frames.points(view, "lod")[0]
        near = [costs(point) for point in frames.points(view, "discrete") if error(point) <= (1 + more) * error(ours)]
        if near:
            cheapest = min(near)
            times.append(cheapest[0] / costs(ours)[0])
            energies.append(cheapest[1] / costs(ours)[1])
    ahead = sum(time > 1 for time in times)
    return f"Levels differ by a factor of two in error or more, so that the cheapest that is no worse is often better than ours. Were {100 * more:.0f} % more error than ours allowed, it would take {shown(statistics.median(times))} of our time and {shown(statistics.median(energies))} of our energy in the median, cold, and more time than ours in {ahead} of {len(times)} views."


def chunks(frames, folder):
    """Levels by object and by chunk over ours: with the rule at delta 1, and in hindsight."""
    runs = {chunk: json.loads((folder / f"chunks-{chunk}" / "error-time.json").read_text()) for chunk in ["object", *"12345"]}
    error = lambda point: point["geometry"]["surface"]["percentile_99"]
    rows = []
    for view in range(len(frames.data["views"])):
        same = lambda other: all(other[key] == frames.data["views"][view][key] for key in ("eye", "size"))
        points = []
        for chunk, run in runs.items():
            for number, other in enumerate(run["views"]):
                if same(other) and run["scenes"][other["scene"]]["hash"] == frames.scene(view)["hash"]:
                    points += [(chunk, point) for point in run["points"] if point["view"] == number]
        if not points:
            continue
        ours = frames.points(view, "lod")[0]
        cycles = lambda entry: entry[1]["costs"][0]["cycles"]
        # Settings that choose the same stand once, with the first delta: at delta 1 that of the largest up to it.
        delta = lambda entry: float(entry[1]["knobs"]["delta"])
        rule = [max((entry for entry in points if entry[0] == chunk and delta(entry) <= 1), key=delta) for chunk in runs]
        by_object = [entry for entry in rule if entry[0] == "object"]
        # Of the size that is the default, whatever another would have cost.
        by_chunk = [entry for entry in rule if entry[0] == "2"]
        near = [entry for entry in points if error(entry[1]) <= error(ours)]
        for name, entries in [("own rule, objects", by_object), ("own rule, chunks", by_chunk), ("in hindsight", near)]:
            if not entries:
                rows.append([place(frames, view), name, *["none is near enough"] + [""] * 6])
                continue
            chunk, point = min(entries, key=cycles)
            over = [theirs / own for theirs, own in zip(costs(point), costs(ours))]
            what = "objects" if chunk == "object" else "1 split" if chunk == "1" else f"{chunk} splits"
            rows.append(
                [place(frames, view), name, f"{what}, delta {point['knobs']['delta'] if name == 'in hindsight' else '1'}", *map(shown, over), f"{error(point):.2f} / {error(ours):.2f}"]
                + [f"{int(point['choices']['triangles']):,}", f"{int(point['choices']['open edges']):,}"]
            )
    return table(["view", "levels", "chunk", "time", "energy", "DRAM", "error / ours, pixels", "triangles", "open edges"], rows, 3)


def front(frames):
    """README's: time and energy of ours, and what others take of that."""
    rows = []
    for view in range(len(frames.data["views"])):
        points = dict(frames.rivals(view))
        ours = points["ours"]
        cycles, energy, dram = costs(ours)
        over = lambda point: "-" if point is None else "/".join(shown(theirs / own) for theirs, own in zip(costs(point), [cycles, energy, dram]))
        rows.append(
            [place(frames, view).removesuffix(" radii"), f"{ours['costs'][0]['milliseconds'] * 1e3:.1f}/{energy:,.0f}/{dram / 1e3:,.0f}", over(points["BVH"]), over(points["discrete, its rule"]), over(points["discrete, hindsight"])]
            + [f"{ours['geometry']['surface']['percentile_99']:.2f}"]
        )
    return table(["view, radii", "ours: us/uJ/KB", "best BVH of the mesh", "discrete LOD, own rule", "discrete, in hindsight", "our error, pixels"], rows, 1)


def fill(path, name, text):
    """A table of a document."""
    put(path, f"<!-- {name}: by scripts/fair -->", f"<!-- {name}: end -->", text)


def main():
    program, mesh, folder = Path(sys.argv[1]).resolve(), str(Path(sys.argv[2]).resolve()), Path(sys.argv[3])
    frames = Frames(program, mesh, folder)
    values = {"absolute": absolute(frames), "ratios": ratios(frames) + "\n\n" + lenient(frames, 0.25) + "\n\n" + small(Frames(program, mesh, folder, "small"))}
    values["units"] = by_units(Frames(program, mesh, folder, "units", "fair-units.toml"))
    values["chunks"] = chunks(frames, folder)
    for path in [ROOT / "docs" / "error-time.md", ROOT / "scripts" / "errors" / "document.md"]:
        for name, text in values.items():
            fill(path, name, text)
    fill(ROOT / "README.md", "front", front(frames))
    for path in [ROOT / "docs" / "claims.md", ROOT / "scripts" / "paper" / "claims.md"]:
        fill(path, "warm", warm(frames))


if __name__ == "__main__":
    main()
