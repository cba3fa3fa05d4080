"""Rays cast from Python against the program: see scripts/cast-rate."""

import argparse
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np

# What a user would write; it says how long the cast alone took.
CAST = """
import sys, time
import numpy as np
import lodray
scene, rays, hits, method = sys.argv[1:]
scene, rays = lodray.Scene.open(scene), np.load(rays)
start = time.perf_counter()
found = scene.cast(rays, method=method)
print(time.perf_counter() - start)
np.save(hits, found)
"""


def timed(command):
    """What it prints, and its seconds: on the clock and of the processor."""
    before, start = os.times(), time.perf_counter()
    said = subprocess.run(command, check=True, capture_output=True, text=True).stdout
    after = os.times()
    spent = after.children_user + after.children_system - before.children_user - before.children_system
    return said, time.perf_counter() - start, spent


def rays_at(scene, many):
    """Rays from around a model to places in its box."""
    import lodray

    info = lodray.Scene.open(scene).info
    random = np.random.default_rng(1)
    centre, radius = np.array(info["centre"]), info["radius"]
    around = random.normal(size=(many, 3))
    origins = centre + 3 * radius * around / np.linalg.norm(around, axis=1)[:, None]
    return np.hstack([origins, centre + (random.random((many, 3)) - 0.5) * radius - origins])


def main():
    options = argparse.ArgumentParser()
    options.add_argument("program")
    options.add_argument("folder", type=Path)
    options.add_argument("--rays", type=int, default=10_000_000)
    options.add_argument("--turns", type=int, default=2)
    options.add_argument("--method", default="lod")
    options.add_argument("--levels", default="6")
    given = options.parse_args()
    given.folder.mkdir(parents=True, exist_ok=True)
    scene, rays, ours, theirs = (given.folder / name for name in ("terrain.lod", "rays.npy", "python.npy", "program.npy"))
    subprocess.run([given.program, "generate", "terrain", "--levels", given.levels, "--quiet", "-o", scene], check=True)
    np.save(rays, rays_at(scene, given.rays))
    sums = np.zeros((2, 2))
    alone = 0.0
    for turn in range(given.turns):
        program = [given.program, "cast", scene, rays, "--method", given.method, "--quiet", "-o", theirs]
        _, *by_program = timed(program)
        said, *by_python = timed([sys.executable, "-c", CAST, scene, rays, ours, given.method])
        sums += [by_program, by_python]
        alone += float(said)
        print(f"turn {turn + 1}: program {by_program[0]:.1f} s ({by_program[1]:.1f} of processors), Python {by_python[0]:.1f} s ({by_python[1]:.1f}), cast alone {float(said):.1f} s", flush=True)
    a, b = np.load(theirs, mmap_mode="r"), np.load(ours, mmap_mode="r")
    if a.dtype != b.dtype or a.tobytes() != b.tobytes():
        sys.exit("scripts/cast-rate: hits differ")
    met = np.count_nonzero(b["tree"] >= 0) / len(b)
    rate = given.turns * given.rays / 1e6
    print(f"{given.rays} rays, {given.method}, {met:.0%} hit; hits are the same")
    for what, (clock, spent) in zip(("program", "Python"), sums):
        print(f"{what}: {rate / clock:.3f} million rays a second, {rate / spent:.3f} a second of processor time")
    print(f"cast alone: {rate / alone:.3f} million a second")
    ratio = sums[0] / sums[1]
    print(f"rate of Python to the program's: {ratio[0]:.3f}, by processor time {ratio[1]:.3f}")
    if ratio[1] < 0.95:
        sys.exit("scripts/cast-rate: less than 95 % of the program's rate")


if __name__ == "__main__":
    main()
