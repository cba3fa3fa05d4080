"""More samples a pixel, and a camera that stands: the work of clusters before a frame is done once. The views of docs/who-wins.md from one distance, of each method at its fastest setting within a pixel (haydel2023, compute free, primary rays)."""

import statistics

from keep import kept, knobs
from markdown import among, table
from who_bounces import fastest, run

# Samples a pixel: each is a ray of its own.
SAMPLES = [1, 4, 16]


def standing(args, file, point):
    """Milliseconds and energy of the second of two frames that are the same: its caches hold what the first left."""
    found = kept(args, ["--quiet", "simulate", file, "--distance", args.bounces, "--size", args.size, "--machine", "haydel2023", "--compute", "free", "--method", point["method"], *knobs(point), "--frames", "2", "--turn", "0"])
    return found["warm"]["cycles"] / found["cycles"] * found["milliseconds"], found["warm"]["energy"]


def by_samples(args, files, points, eyes, methods, error):
    """The table: of each method the median over scenes of its costs over ours, for each number of samples and for a camera that stands. `points` and `eyes` are by scene."""
    ratios = {}
    for name, own in points.items():
        best = fastest(own, error)
        if "lod" not in best:
            continue
        sampled = lambda method, samples: run(args, name, files[name], eyes[name], best[method], samples=samples, depth=1 if samples == 1 else 0)[0]
        costs = lambda method: [*(sampled(method, samples) for samples in SAMPLES), standing(args, files[name], best[method])]
        ours = costs("lod")
        for method in best:
            if method != "lod":
                ratios.setdefault(method, []).append([a / b for pair in zip(costs(method), ours) for a, b in zip(*pair)])
    heads = [f"{what}, {cost}" for what in (*("1 sample" if samples == 1 else f"{samples} samples" for samples in SAMPLES), "standing") for cost in ("time", "energy")]
    rows = [[f"`{method}`", len(ratios[method])] + [f"{statistics.median(values):.2f} ({among(values)})" for values in zip(*ratios[method])] for method in methods if method in ratios]
    return table(["method over ours, median (least to most)", "scenes", *heads], rows, 1)
