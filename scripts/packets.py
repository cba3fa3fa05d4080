"""Packets of 32 rays and stochastic levels (`lodray simulate --packet 32`): the energy of the paper's figure 12 by distance, on its machine `packet`; the picture of its figure 13; packets against single rays in lines, tests, time and error.

Writes tables between the marks of docs/baselines.md, and docs/images/figure12.svg and figure13-*.png. Results are kept in --out, and runs that are there are not run again.
"""

import argparse
import subprocess
from pathlib import Path

from keep import kept
from markdown import number, put, table
from options import add_program, ended
from plot import diagram

ROOT = Path(__file__).resolve().parent.parent
# Of the camera from the model's centre, in its radii: 24 from 0.5 to 20.
DISTANCES = [round(0.5 * 40 ** (k / 23), 3) for k in range(24)]
# Of the picture of figure 13, and of packets against single rays.
FIGURE_13, AGAINST = 1.5, [0.8, 1.5, 3.0, 6.0]
BEST = ["bvh", "bvh6"]


def simulated(args, machine, distance, method, *more):
    return kept(args, ["simulate", args.scene, "--machine", machine, "--compute", "free", "--size", args.size, "--distance", distance, "--method", method, *more])


def rendered(args, distance, method, *more):
    return kept(args, ["render", args.scene, "--size", args.size, "--distance", distance, "--method", method, *more])


def frames(args, distance):
    """The frames of figure 12 at a distance."""
    mean = rendered(args, distance, "lod", "--packet", 32)["stats"]["mean_level"]
    run = lambda method, *more: simulated(args, "packet", distance, method, "--packet", 32, *more)
    bvhs = {method: run(method) for method in BEST}
    best = min(BEST, key=lambda method: bvhs[method]["energy"]["total"])
    return {"mean": mean, "lod": run("lod"), "stochastic": run("stochastic", "--mean-level", f"{mean:.3f}"), "own": run("stochastic"), "best": best, **bvhs}


def energy(frame):
    return frame["energy"]["total"]


def figure_12(args):
    rows, lines = [], {"lod": [], "stochastic": [], "bvh6": []}
    for distance in DISTANCES:
        own = frames(args, distance)
        ours, best = energy(own["lod"]), own[own["best"]]
        over = lambda frame: f"{energy(frame) / ours:.2f}"
        drawn = rendered(args, distance, "stochastic", "--mean-level", f"{own['mean']:.3f}")["choices"]["drawn"]
        rows.append([f"{distance:g}", number(ours / own["lod"]["rays"]), f"{own['mean']:.2f}", drawn, over(own["stochastic"]), over(own["own"]), over(best), own["best"]])
        for name, frame in [("lod", own["lod"]), ("stochastic", own["stochastic"]), ("bvh6", best)]:
            lines[name].append((distance, energy(frame)))
    svg = diagram("Energy of data movement, packets of 32", "distance, radii", "energy, accesses of the L1", lines)
    (ROOT / "docs" / "images" / "figure12.svg").write_text(svg, encoding="utf-8")
    return table(["distance, radii", "ours, a ray", "mean level", "stochastic draws", "stochastic over ours", "by its own rule", "best BVH over ours", "which"], rows, 1)


def against(args):
    """Packets against single rays."""
    rows = []
    for machine in ["packet", "haydel2023"]:
        for distance in AGAINST:
            for method, more in [("lod", ()), ("bvh6", ()), ("discrete", ())]:
                alone, together = [simulated(args, machine, distance, method, *more, *packet) for packet in [(), ("--packet", 32)]]
                work = [rendered(args, distance, method, *more, *packet) for packet in [(), ("--packet", 32)]]
                of = lambda name: f"{work[1]['per_ray'][name] / max(work[0]['per_ray'][name], 1e-9):.2f}" if work[0]["per_ray"][name] else "-"
                ratio = lambda get: f"{get(together) / max(get(alone), 1):.2f}"
                rows.append([machine, f"{distance:g}", method, of("lines_read"), of("nodes"), of("lod_tests"), ratio(lambda r: r["dram"]["reads"]), ratio(lambda r: r["cycles"]), ratio(energy), f"{work[0]['stats']['mean_level']:.2f}", f"{work[1]['stats']['mean_level']:.2f}"])
    return table(["machine", "distance", "method", "lines asked for", "tests of nodes", "LOD tests", "DRAM reads", "cycles", "energy", "mean level alone", "in packets"], rows, 3)


def error(args):
    """The error of packets beside that of single rays."""
    rows = []
    for distance in AGAINST:
        alone, together = [rendered(args, distance, "lod", *packet, "--compare") for packet in [(), ("--packet", 32)]]
        of = lambda frame, what: f"{frame['error']['geometry_pixels'][what]:.5f}"
        image = lambda frame: f"{frame['error']['rmse']:.3f}"
        rows.append([f"{distance:g}", of(alone, "mean"), of(together, "mean"), of(alone, "percentile_99"), of(together, "percentile_99"), image(alone), image(together)])
    return table(["distance", "surface off, pixels, mean: alone", "in packets", "99 of 100 below: alone", "in packets", "RMSE of the picture: alone", "in packets"], rows, 1)


def figure_13(args):
    mean = rendered(args, FIGURE_13, "lod", "--packet", 32)["stats"]["mean_level"]
    for name, more in [("ours", ("--method", "lod", "--packet", "32")), ("stochastic", ("--method", "stochastic", "--mean-level", f"{mean:.3f}", "--packet", "32"))]:
        folder = args.out / f"figure13-{name}"
        subprocess.run([args.program, "render", args.scene, "--size", "640x480", "--distance", str(FIGURE_13), *more, "-o", folder, "--force"], check=True, stdout=subprocess.DEVNULL)
        picture = next(path for path in [folder / "levels.png", folder / "level.png"] if path.exists())
        (ROOT / "docs" / "images" / f"figure13-{name}.png").write_bytes(picture.read_bytes())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    add_program(parser)
    parser.add_argument("--out", type=Path, default=ROOT / "out" / "packets", help="folder of what is kept")
    parser.add_argument("--scene", type=Path, help="scene file (default: a terrain of 8.4 M triangles, generated)")
    parser.add_argument("--size", default="512x512")
    parser.add_argument("--only", choices=["figure-12", "packets", "error", "figure-13"], help="make this part alone")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    if args.scene is None:
        args.scene = args.out / "terrain.lod"
        if not args.scene.exists():
            subprocess.run([args.program, "generate", "terrain", "-o", args.scene], check=True)
    document = ROOT / "docs" / "baselines.md"
    wanted = lambda part: args.only in (None, part)
    if wanted("figure-12"):
        put(document, "<!-- figure 12 -->", "<!-- figure 12 end -->", figure_12(args))
    if wanted("packets"):
        put(document, "<!-- packets -->", "<!-- packets end -->", against(args))
    if wanted("error"):
        put(document, "<!-- packets' error -->", "<!-- packets' error end -->", error(args))
    if wanted("figure-13"):
        figure_13(args)


if __name__ == "__main__":
    ended(main)
