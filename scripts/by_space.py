"""How well 1-to-4 splits cut a base triangle: areas of the boxes of 4, 16, 64... triangles as the splits group them, and as halving by space groups the same triangles.

A ray meets a box as often as its area says. Boxes are exact and of full resolution, so neither bounds nor morphs play a part. Writes the table between the marks of docs/who-wins.md. Needs NumPy.
"""

import argparse
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from markdown import put, table
from options import ROOT, add_program, ended

SCENES = ["spikes", "terrain", "sphere", "cloth"]
LEVELS, BASE = 5, 512
# Base triangles that are looked at, evenly among all.
LOOKED_AT = 64


def boxes(program, scene):
    """Lower and upper corners of the boxes of a scene's finest triangles, tree by tree."""
    with tempfile.TemporaryDirectory() as desk:
        file, mesh = Path(desk) / "scene.lod", Path(desk) / "scene.obj"
        subprocess.run([program, "--quiet", "generate", scene, "--levels", str(LEVELS), "--base", str(BASE), "-o", file], check=True, stdout=subprocess.DEVNULL)
        subprocess.run([program, "--quiet", "export", file, "-o", mesh], check=True, stdout=subprocess.DEVNULL)
        lines = mesh.read_text(encoding="utf-8").splitlines()
    vertices = np.array([line.split()[1:4] for line in lines if line.startswith("v ")], dtype=float)
    corners = np.array([[word.split("/")[0] for word in line.split()[1:4]] for line in lines if line.startswith("f ")], dtype=int) - 1
    triangles = vertices[corners]
    return triangles.min(axis=1), triangles.max(axis=1)


def area(low, high):
    """Half the surface of boxes."""
    x, y, z = np.moveaxis(high - low, -1, 0)
    return x * y + y * z + z * x


def halved(low, high, own):
    """The triangles `own` in an order in which each half, quarter, ... is one side of the best of three cuts of what it is a half of."""
    parts, middles = [own], low + high
    while len(parts[0]) > 1:
        half, after = len(parts[0]) // 2, []
        for part in parts:
            orders = [part[np.argpartition(middles[part, axis], half)] for axis in range(3)]
            cost = lambda order: sum(area(low[side].min(axis=0), high[side].max(axis=0)) for side in (order[:half], order[half:]))
            order = min(orders, key=cost)
            after += [order[:half], order[half:]]
        parts = after
    return np.concatenate(parts)


def main():
    """Compares, and writes the table."""
    parser = argparse.ArgumentParser(prog="scripts/by-space", description=__doc__.split("\n", maxsplit=1)[0])
    add_program(parser)
    parser.add_argument("--print", action="store_true", help="print the table, and leave the document alone")
    args = parser.parse_args()
    rows, below = [], 4**LEVELS
    for scene in SCENES:
        low, high = boxes(args.program, scene)
        trees = len(low) // below
        looked_at = [np.arange(tree * below, (tree + 1) * below) for tree in range(0, trees, max(1, trees // LOOKED_AT))]
        as_split, by_space = np.concatenate(looked_at), np.concatenate([halved(low, high, tree) for tree in looked_at])
        summed = lambda order, group: area(low[order].reshape(-1, group, 3).min(axis=1), high[order].reshape(-1, group, 3).max(axis=1)).sum()
        rows.append([scene, *(f"{summed(as_split, 4**k) / summed(by_space, 4**k):.2f}" for k in range(1, LEVELS))])
    text = table(["areas as split, over those by space", *(f"boxes of {4**k}" for k in range(1, LEVELS))], rows, 1)
    if args.print:
        print(text)
    else:
        put(ROOT / "docs" / "who-wins.md", "<!-- by space -->", "<!-- by space end -->", text)


if __name__ == "__main__":
    ended(main)
