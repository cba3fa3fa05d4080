"""More samples a pixel: the work of clusters before a frame is done once for all of them. The views of docs/who-wins.md from one distance, of each method at its fastest setting within a pixel (`lodray paths --machine`, compute free, primary rays)."""

import statistics

from markdown import among, table
from who_bounces import fastest, run

# Samples a pixel: each is a ray of its own.
SAMPLES = [1, 4, 16]


def by_samples(args, files, points, eyes, methods, error):
    """The table: of each method the median over scenes of its costs over ours, for each number of samples. `points` and `eyes` are by scene."""
    ratios = {}
    for name, own in points.items():
        best = fastest(own, error)
        if "lod" not in best:
            continue
        cost = lambda method, samples: run(args, name, files[name], eyes[name], best[method], samples=samples, depth=1 if samples == 1 else 0)[0]
        ours = [cost("lod", samples) for samples in SAMPLES]
        for method in best:
            if method != "lod":
                theirs = [cost(method, samples) for samples in SAMPLES]
                ratios.setdefault(method, []).append([a / b for pair in zip(theirs, ours) for a, b in zip(*pair)])
    heads = [f"{samples} {'sample' if samples == 1 else 'samples'}, {what}" for samples in SAMPLES for what in ("time", "energy")]
    rows = [[f"`{method}`", len(ratios[method])] + [f"{statistics.median(values):.2f} ({among(values)})" for values in zip(*ratios[method])] for method in methods if method in ratios]
    return table(["method over ours, median (least to most)", "scenes", *heads], rows, 1)
