"""What nine scenes do not need: units in gates, bytes, simulated time and energy and host time of pruned scenes on their own units over whole ones on full units.

Scenes, plans and results are kept in the folder. Pictures of whole and pruned scenes are compared pixel by pixel, hits field by field (benches/leaving_out.rs).
"""

import argparse
import itertools
import json
import re
import subprocess
import types
from pathlib import Path

from markdown import put
from synth import Run
from synthesis import plan as synthesis
from synthesis.blocks import Block
from synthesis.tools import Tools

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "target/release/lodray"
DOC = ROOT / "docs/leaving-out.md"
GENERATED = {
    "terrain 0.45": ["terrain", "--roughness", "0.45"],
    "terrain 0.60": ["terrain", "--roughness", "0.60"],
    **{name: [name] for name in ["cloth", "room", "sphere", "spikes", "wall"]},
}
MESHES = {"bunny": "stanford-bunny.obj", "igea": "igea.ply"}
DISTANCES = [1.5, 3]
SIZE = "512x512"
WITHIN = [0.01, 0.05, 0.25, 1]
# A unit with one of each block, where the machine's own has some in turns.
ONE_OF_EACH = ["--set", "units.setup_copies=1", "--set", "units.divide_copies=1"]
HEAD = 'size = "{size}"\nmethods = ["lod"]\ndeltas = [1]\ndistances = {distances}\n[[machine]]\nname = "haydel2023"\nset = {{ "units.setup_copies" = 1, "units.divide_copies" = 1 }}\n'


def call(*words):
    """What the program prints."""
    return command([PROGRAM, *words])


def command(words):
    """What a command prints."""
    got = subprocess.run(list(map(str, words)), cwd=ROOT, capture_output=True, text=True)
    if got.returncode != 0:
        raise SystemExit(f"scripts/leaving-out: {' '.join(map(str, words))}: {got.stderr.strip()}")
    return got.stdout


class Scene:
    """A scene, its plans and what was found out about them."""

    def __init__(self, name, options):
        self.name, self.folder = name, options.folder
        self.stem = name.replace(" ", "-")
        self.file = self.path("lod")
        if not self.file.exists():
            made = ["generate", *GENERATED[name]] if name in GENERATED else ["build", options.models / MESHES[name]]
            call("--quiet", *made, "-o", self.file)

    def path(self, ending):
        """A file of the scene's."""
        return self.folder / f"{self.stem}.{ending}"

    def planned(self, scene, ending, *more):
        """The file of the plan of the job on a scene file."""
        return planned(self.folder / f"{self.stem}.{ending}", [scene], *more)

    def simulated(self, scene, *more):
        """Cycles and picojoules of all views together, and hits."""
        runs = [
            json.loads(call("--quiet", "simulate", scene, "--distance", distance, "--size", SIZE, "--compute", "units", *ONE_OF_EACH, "--json", *more))
            for distance in DISTANCES
        ]
        return {
            "cycles": sum(run["cycles"] for run in runs),
            "energy": sum(run["energy"]["total"] for run in runs),
            "hits": sum(run["hits"] for run in runs),
        }

    def pictures(self, scene):
        """The views as pixels."""
        out = self.path("pictures")
        for distance in DISTANCES:
            call("--quiet", "render", scene, "--distance", distance, "--size", SIZE, "--shading", "full", "-o", out)
            yield from (b"".join(pixels((out / name).read_bytes())) for name in ["image.png", "levels.png", "normals.png"])


def planned(stem, scenes, *more):
    """The file of the plan of the job on scene files."""
    job, plan = Path(f"{stem}.job.toml"), Path(f"{stem}.toml")
    job.write_text(HEAD.format(size=SIZE, distances=DISTANCES) + "".join(f'[[scene]]\nfile = "{scene.name}"\n' for scene in scenes))
    call("--quiet", "plan", "--job", job, "-o", plan, *more)
    return plan


def pixels(png):
    """The pixels of a PNG file, without what it says of its scene."""
    at = 8
    while at < len(png):
        size, kind = int.from_bytes(png[at : at + 4], "big"), png[at + 4 : at + 8]
        if kind in (b"IHDR", b"IDAT"):
            yield png[at + 8 : at + 8 + size]
        at += 12 + size


class Gates:
    """Units in gates: their blocks as synthesis has them, and their contexts by the model of their area."""

    def __init__(self, options):
        self.options = types.SimpleNamespace(seeds=1, no_place=options.no_place, no_fpga=options.no_place, no_gates=False, jobs=options.jobs)

    def unit(self, plan, **facts):
        """The unit of a plan, with these facts in place of its own."""
        unit = synthesis.read(plan)
        return self.of({**unit.own, **facts}, unit.blocks())

    def full(self, plan):
        """The full one of the machine that the plan's search for speed was on."""
        full = synthesis.read(plan).full
        return self.of(full, [Block(name) for name in full["blocks"]])

    def of(self, facts, blocks):
        """Gate equivalents, flip-flops, multipliers, and the clock of the slowest block that was placed."""
        figures, failures = Run(Tools(), self.options).all(blocks)
        if failures:
            raise SystemExit(f"scripts/leaving-out: {failures}")
        gates = [of["gates"] for of in figures.values()]
        contexts = facts["contexts"]
        return {
            **facts,
            "ge": sum(of["ge"] for of in gates) + contexts * facts["context_gates"],
            "flip_flops": sum(of["flip_flops"] for of in gates) + contexts * facts["context_bits"],
            "multipliers": sum(sum(of["multipliers"].values()) for of in gates),
            "mhz": min([(max(of["mhz"]), name) for name, of in figures.items() if isinstance(of.get("mhz"), list)], default=None),
        }


def main():
    """The tables."""
    parser = argparse.ArgumentParser(prog="scripts/leaving-out", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("models", type=Path, help="folder of models with stanford-bunny.obj and igea.ply")
    parser.add_argument("--folder", type=Path, default=ROOT / "target/leaving-out", help="for scenes, plans and results (default target/leaving-out)")
    parser.add_argument("--only", nargs="*", help="these scenes alone; the document is left as it is")
    parser.add_argument("--within", type=float, metavar="PIXELS", help="first the coarsest grids within so many pixels; the table of those")
    parser.add_argument("--go-on", action="store_true", help="take the figures of scenes that the folder has them of, and measure the others")
    parser.add_argument("--no-place", action="store_true", help="no clocks: leave place and route out")
    parser.add_argument("--jobs", type=int, default=2, help="tools of synthesis at work at once (default 2)")
    parser.add_argument("--errors", action="store_true", help="in place of all that: errors against area and bytes, by error-time")
    options = parser.parse_args()
    options.models, options.folder = options.models.resolve(), options.folder.resolve()
    options.folder.mkdir(parents=True, exist_ok=True)
    names = [name for name in [*GENERATED, *MESHES] if not options.only or name in options.only]
    if options.errors:
        fill(errors([Scene(name, options) for name in names], options.folder / "errors"), "errors")
        return
    gates, rows = Gates(options), []
    for name in names:
        scene = Scene(name, options)
        done = scene.path(f"within-{options.within:g}.row.json" if options.within else "row.json")
        if not (options.go_on and done.exists()):
            done.write_text(json.dumps(row(scene, options.within, gates), indent=1), encoding="utf-8")
        rows.append(json.loads(done.read_text(encoding="utf-8")))
        print(f"{name}: {rows[-1]['unit']['ge']:,.0f} gate equivalents", flush=True)
    # One unit for all of them.
    if not options.only:
        scenes = [Path(of["pruned"]) for of in rows]
        together = planned(options.folder / "all.fast", scenes, "--speed", "--speed-size", "128x128")
        wide = gates.unit(planned(options.folder / "all.unit", scenes), contexts=rows[0]["full"]["contexts"])
        rows.append({"scene": "all of them", "unit": gates.unit(together), "wide": wide, "kept": speed(together)["kept"]})
    print(table(rows))
    if not options.only:
        fill(table(rows), f"within {options.within:g}" if options.within else "lossless")


def errors(scenes, out):
    """The table of error-time."""
    within, distances = ",".join(map(str, WITHIN)), ",".join(map(str, DISTANCES))
    views = ["--distances", distances, "--size", SIZE, "--error-size", SIZE.split("x")[0], "--samples", "1", "--methods", "lod", "--values", "delta=1", "--compute", "units", *ONE_OF_EACH]
    call("--quiet", "error-time", *[scene.file for scene in scenes], "-o", out, *views, "--most-samples", "0", "--no-host", "--within", within)
    document = json.loads((out / "error-time.json").read_text(encoding="utf-8"))
    heads = ["scene", "radii", "left out", "zeros of coordinates, directions", "error in pixels: mean", "99th percentile", "largest", "GE of a unit", "bytes a finest triangle", "time", "energy"]
    lines = [f"| {' | '.join(heads)} |", "| --- | ---: | --- |" + " ---: |" * (len(heads) - 3)]
    # Where more pixels give no coarser grids one row has them all.
    grids = lambda left: (left["point"]["view"], left["what"] if left["pixels"] == 0 else "within", left["coordinate_zeros"], left["direction_zeros"])
    for (of, what, *zeros), alike in itertools.groupby(document["left_out"], grids):
        alike = list(alike)
        point, view = alike[0]["point"], document["views"][of]
        costs, surface = point["costs"][0], point["geometry"]["surface"]
        if what == "whole":
            whole = costs
        lines.append("| " + " | ".join([
            document["scenes"][view["scene"]]["name"], f"{view['distance']:g}", what if what != "within" else "within " + ", ".join(f"{left['pixels']:g}" for left in alike),
            ", ".join(map(str, zeros)), *[f"{surface[of]:.4f}" for of in ["mean", "percentile_99", "maximum"]],
            f"{costs['unit_gates']:,.0f}", f"{point['bytes_per_triangle']:.2f}",
            f"{costs['cycles'] / whole['cycles']:.3f}", f"{costs['energy']['total'] / whole['energy']['total']:.3f}",
        ]) + " |")
    return "\n".join(lines)


def speed(plan):
    """What a plan says of speed."""
    return json.loads(call("plan", "--plan", plan, "--json"))["plan"]["speed"]


def row(scene, within, gates):
    """The figures of a scene: lossless, or within some pixels."""
    file, own = scene.file, ""
    if within:
        own = f"within-{within:g}."
        file = scene.path(f"{own}lod")
        call("--quiet", "prune", scene.file, "--plan", scene.planned(scene.file, f"{own}grids", "--within", within), "-o", file)
    # What the job's rays read; the unit is that of what is left.
    pruned = scene.path(f"{own}pruned.lod")
    job = scene.planned(file, f"{own}whole")
    bytes_of = json.loads(call("prune", file, "--plan", job, "-o", pruned, "--json"))["bytes_per_finest_triangle"]
    plan = scene.planned(pruned, f"{own}unit")
    fast = scene.planned(pruned, f"{own}fast", "--speed", "--speed-size", "128x128")
    whole, less = scene.simulated(file), scene.simulated(pruned, "--plan", plan)
    if whole["hits"] != less["hits"] or list(scene.pictures(file)) != list(scene.pictures(pruned)):
        raise SystemExit(f"scripts/leaving-out: {scene.name}: the pruned scene looks other than the whole")
    host = command(["cargo", "bench", "--quiet", "--bench", "leaving_out", "--", file, pruned, job])
    full = gates.full(fast)
    unit, wide = gates.unit(fast), gates.unit(plan, contexts=full["contexts"])
    return {
        "scene": scene.name, "pruned": str(pruned), "unit": unit, "wide": wide, "full": full, "kept": speed(fast)["kept"], "bytes": bytes_of,
        "time": less["cycles"] / whole["cycles"], "energy": less["energy"] / whole["energy"],
        "host": float(re.search(r"pruned over whole: ([\d.]+)", host)[1]),
    }


def table(rows):
    """Rows as Markdown."""
    heads = ["scene", "levels", "stack", "index", "contexts", "edges", "of LOD tests", "boxes", "bits of divisions", "bits of a context", "GE with the machine's contexts and edges", "less", "GE", "less", "flip-flops and memory bits", "multipliers", "MHz"]
    heads += ["bytes a finest triangle", "time", "energy", "host rays/s"]
    full = next((of["full"] for of in rows if "full" in of), None)
    lines = [f"| {' | '.join(heads)} |", "| --- |" + " ---: |" * (len(heads) - 1)]
    if full:
        lines.append(f"| the full unit | {cells(full, full, full)} | | | | |")
    for of in rows:
        ends = [f"{of['bytes'][0]:.2f} -> {of['bytes'][1]:.2f}", f"{of['time']:.3f}", f"{of['energy']:.3f}", f"{of['host']:.2f}"] if "bytes" in of else [""] * 4
        lines.append(f"| {of['scene']} | {cells(of['unit'], of['wide'], full)} | {' | '.join(ends)} |")
    return "\n".join(lines)


def cells(unit, wide, full):
    """A unit's; `wide` is the same with all the contexts and edge functions of the machine."""
    less = [f"{100 * (1 - of['ge'] / full['ge']):.0f} %" for of in [unit, wide]]
    zeros = unit["coordinate_zeros"] + unit["direction_zeros"]
    return " | ".join([
        f"{unit['stored_levels']} of {unit['levels']}" + (f", zeros {unit['coordinate_zeros']}, {unit['direction_zeros']}" if zeros else ""),
        str(unit["stack_entries"]), str(unit["index_bits"]), str(unit["contexts"]), str(unit["edges_per_cycle"]), str(unit["lod_edges_per_cycle"]), str(unit["boxes_per_cycle"]), f"{unit['divide_bits']}, {unit['setup_bits']}", f"{unit['context_bits']:,}",
        f"{wide['ge']:,.0f}", less[1], f"{unit['ge']:,.0f}", less[0], f"{unit['flip_flops']:,}", str(unit["multipliers"]),
        f"{unit['mhz'][0]:.0f} ({unit['mhz'][1]})" if unit["mhz"] else "-",
    ])


def fill(text, name):
    """A table of the document."""
    put(DOC, f"<!-- scripts/leaving-out: {name}: begin -->", f"<!-- scripts/leaving-out: {name}: end -->", text)


if __name__ == "__main__":
    main()
