"""What nine scenes do not need: bytes, simulated time and energy of a pruned scene on its own unit over the whole on the full one, pictures that are the same, and the least units.

Scenes, plans and results are kept in the folder. `scripts/synth --plan FOLDER/SCENE.fast.toml` measures the gates of a scene's least unit.
"""

import argparse
import json
import re
import subprocess
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
PROGRAM = ROOT / "target/release/lodray"
DOC = ROOT / "docs/leaving-out.md"
BEGIN, END = "<!-- scripts/leaving-out: begin -->", "<!-- scripts/leaving-out: end -->"
GENERATED = {
    "terrain 0.45": ["terrain", "--roughness", "0.45"],
    "terrain 0.60": ["terrain", "--roughness", "0.60"],
    **{name: [name] for name in ["cloth", "room", "sphere", "spikes", "wall"]},
}
MESHES = {"bunny": "stanford-bunny.obj", "igea": "igea.ply"}
DISTANCES = [1.5, 3]
SIZE = "512x512"
HEAD = 'size = "{size}"\nmethods = ["lod"]\ndeltas = [1]\ndistances = {distances}\n[[machine]]\nname = "haydel2023"\n'


def call(*words):
    """What the program prints."""
    got = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
    if got.returncode != 0:
        raise SystemExit(f"scripts/leaving-out: {' '.join(map(str, words))}: {got.stderr.strip()}")
    return got.stdout


class Scene:
    """A scene, its plan and what was found out about them."""

    def __init__(self, name, folder, models):
        self.name, self.folder = name, folder
        self.stem = name.replace(" ", "-")
        self.file = self.path("lod")
        if not self.file.exists():
            made = ["generate", *GENERATED[name]] if name in GENERATED else ["build", models / MESHES[name]]
            call("--quiet", *made, "-o", self.file)

    def path(self, ending):
        """A file of the scene's."""
        return self.folder / f"{self.stem}.{ending}"

    def planned(self, scene, ending, *more):
        """The plan of the job on a scene file, as JSON, and in a file."""
        job, plan = self.path(f"{ending}.job.toml"), self.path(f"{ending}.toml")
        job.write_text(HEAD.format(size=SIZE, distances=DISTANCES) + f'[[scene]]\nfile = "{scene.name}"\n')
        return json.loads(call("--quiet", "plan", "--job", job, "--json", "-o", plan, *more)), plan

    def simulated(self, scene, *more):
        """Cycles and picojoules of all views together, and hits."""
        runs = [
            json.loads(call("--quiet", "simulate", scene, "--distance", distance, "--size", SIZE, "--compute", "units", "--json", *more))
            for distance in DISTANCES
        ]
        return {
            "cycles": sum(run["cycles"] for run in runs),
            "energy": sum(run["energy"]["total"] for run in runs),
            "hits": sum(run["hits"] for run in runs),
        }

    def pictures(self, scene):
        """The views as pictures."""
        out = self.path("pictures")
        for distance in DISTANCES:
            call("--quiet", "render", scene, "--distance", distance, "--size", SIZE, "--shading", "full", "-o", out)
            yield from (b"".join(pixels((out / name).read_bytes())) for name in ["image.png", "levels.png", "normals.png"])


def pixels(png):
    """The pixels of a PNG file, without what it says of its scene."""
    at = 8
    while at < len(png):
        size, kind = int.from_bytes(png[at : at + 4], "big"), png[at + 4 : at + 8]
        if kind in (b"IHDR", b"IDAT"):
            yield png[at + 8 : at + 8 + size]
        at += 12 + size


def main():
    """The table."""
    parser = argparse.ArgumentParser(prog="scripts/leaving-out", description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("models", type=Path, help="folder of models with stanford-bunny.obj and igea.ply")
    parser.add_argument("--folder", type=Path, default=ROOT / "target/leaving-out", help="for scenes, plans and results (default target/leaving-out)")
    parser.add_argument("--only", nargs="*", help="these scenes alone; the document is left as it is")
    parser.add_argument("--within", type=float, metavar="PIXELS", help="besides, the coarsest grids within so many pixels")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    names = [name for name in [*GENERATED, *MESHES] if not options.only or name in options.only]
    rows = []
    for name in names:
        rows.append(row(Scene(name, options.folder, options.models), options.within))
        print(rows[-1], flush=True)
    if not options.only:
        put(table(rows))


def row(scene, within):
    """The figures of a scene: lossless, or within some pixels."""
    file = scene.file
    if within:
        _, plan = scene.planned(file, "grids", "--within", within)
        file = scene.path("coarse.lod")
        call("--quiet", "prune", scene.file, "--plan", plan, "-o", file)
    _, plan = scene.planned(file, "plan")
    document, _ = scene.planned(file, "fast", "--speed", "--speed-size", "128x128")
    pruned = scene.path("pruned.lod")
    bytes_of = json.loads(call("prune", file, "--plan", plan, "-o", pruned, "--json"))["bytes_per_finest_triangle"]
    full = scene.simulated(file)
    own = scene.simulated(pruned, "--plan", plan)
    if full["hits"] != own["hits"] or list(scene.pictures(file)) != list(scene.pictures(pruned)):
        raise SystemExit(f"scripts/leaving-out: {scene.name}: the pruned scene looks other than the whole")
    speed, unit, whole = document["plan"]["speed"], document["unit"], document["full_unit"]
    return {
        "scene": scene.name, "levels": unit["levels"], "stack": unit["stack_entries"], "contexts": unit["contexts"], "edges": unit["edges_per_cycle"],
        "context": unit["context_bits"], "full_context": whole["context_bits"], "zeros": [unit["coordinate_zeros"], unit["direction_zeros"]],
        "bytes": bytes_of, "time": own["cycles"] / full["cycles"], "energy": own["energy"] / full["energy"], "kept": speed["kept"],
    }


def table(rows):
    """Rows as Markdown."""
    lines = ["| scene | levels | stack | contexts | edges a cycle | bits of a context | bytes a finest triangle | time | energy |", "| --- |" + " ---: |" * 8]
    for of in rows:
        full, pruned = of["bytes"]
        lines.append(
            f"| {of['scene']} | {of['levels']} of 10 | {of['stack']} of 103 | {of['contexts']} of 16 | {of['edges']} of 3 | {of['context']:,} of {of['full_context']:,} "
            f"| {full:.2f} -> {pruned:.2f} | {of['time']:.2f} | {of['energy']:.2f} |"
        )
    return "\n".join(lines)


def put(text):
    """The table between its marks."""
    document = DOC.read_text(encoding="utf-8")
    DOC.write_text(re.sub(f"{BEGIN}.*{END}", f"{BEGIN}\n{text}\n{END}", document, flags=re.DOTALL), encoding="utf-8")


if __name__ == "__main__":
    main()
