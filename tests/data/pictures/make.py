"""Makes the pairs of pictures and the figures that other programs give for them: python make.py FOLDER, where FOLDER holds the pictures that `lodray` below
names. Needs flip-evaluator, scikit-image, scipy, numpy and pillow; figures.json says which versions made it."""

import json
import math
import platform
import sys
from importlib.metadata import version
from pathlib import Path

import flip_evaluator
import numpy as np
from PIL import Image
from scipy import ndimage
from skimage.metrics import structural_similarity

HERE = Path(__file__).parent
LOD = Path(sys.argv[1])
DEFAULT = 3840 * math.pi / 180  # 0.7 m from a monitor of 3840 columns and 0.7 m
COARSE = 30.0


def bytes_of(values):
    """8-bit picture of values from 0 to 1."""
    return np.clip(np.round(values * 255), 0, 255).astype(np.uint8)


def grid(width, height):
    y, x = np.mgrid[0:height, 0:width]
    return x.astype(float), y.astype(float)


def noise():
    """Independent colours against the same with half of the amplitude elsewhere."""
    random = np.random.default_rng(1)
    a = random.random((64, 96, 3))
    b = 0.5 * a + 0.5 * random.random((64, 96, 3))
    return bytes_of(a), bytes_of(b)


def gradients():
    """Smooth ramps, the other one a little steeper and with bands."""
    x, y = grid(256, 64)
    a = np.stack([x / 255, y / 63, 1 - x / 255], axis=2)
    b = np.stack([np.floor(x / 16) / 15, (y / 63) ** 1.2, 1 - x / 300], axis=2)
    return bytes_of(a), bytes_of(b)


def edges(shift):
    """Slanted stripes and discs with smoothed edges, moved to the right by `shift` pixels."""
    x, y = grid(160, 120)
    x = x - shift
    stripes = np.clip(0.5 + 4 * np.sin((x + 0.3 * y) / 5), 0, 1)
    disc = np.clip(30 - np.hypot(x - 110, y - 60) + 0.5, 0, 1)
    base = 0.1 + 0.6 * stripes * (x < 80)
    return np.stack([base + 0.8 * disc, base + 0.3 * disc, base + 0.05 * disc], axis=2)


def half_pixel():
    return bytes_of(edges(0)), bytes_of(edges(0.5))


def colour_shift():
    """Patches of colour, each turned towards its neighbour."""
    x, y = grid(128, 96)
    hue = np.floor(x / 16) / 8 + np.floor(y / 24) / 40
    a = np.stack([0.5 + 0.45 * np.cos(2 * np.pi * (hue + k / 3)) for k in range(3)], axis=2)
    b = np.stack([0.5 + 0.45 * np.cos(2 * np.pi * (hue + 0.02 * (1 + y // 24) + k / 3)) for k in range(3)], axis=2)
    return bytes_of(a), bytes_of(b)


def blurred():
    """Blobs and grain, and the same blurred."""
    random = np.random.default_rng(2)
    grain = ndimage.gaussian_filter(random.random((128, 192, 3)), (1.2, 1.2, 0))
    blobs = ndimage.gaussian_filter(random.random((128, 192, 3)), (9, 9, 0))
    a = np.clip(0.5 + 2 * (grain - 0.5) + 8 * (blobs - 0.5), 0, 1)
    return bytes_of(a), bytes_of(ndimage.gaussian_filter(a, (2, 2, 0)))


def render(samples, seed):
    """A shaded ball over a chequered floor below a dim sky, with so many samples a pixel."""
    random = np.random.default_rng(seed)
    x, y = grid(256, 192)
    total = np.zeros((192, 256, 3))
    for _ in range(samples):
        u, v = (x + random.random(x.shape) - 128) / 96, (96 - y - random.random(x.shape)) / 96
        colour = np.stack([0.02 + 0.1 * np.clip(v, 0, 1), 0.04 + 0.15 * np.clip(v, 0, 1), 0.1 + 0.4 * np.clip(v, 0, 1)], axis=2)
        far = np.where(v < -0.05, -0.5 / np.minimum(v, -0.05), 0)
        tiles = (np.floor(4 * u * far) + np.floor(4 * far)) % 2
        floor = (0.05 + 0.6 * tiles)[..., None] * np.array([1.0, 0.9, 0.7]) / (1 + 0.15 * far[..., None] ** 2)
        colour = np.where((v < -0.05)[..., None], floor, colour)
        squared = 0.36 - (u - 0.1) ** 2 - (v - 0.05) ** 2
        depth = np.sqrt(np.maximum(squared, 0)) / 0.6
        light = np.clip(0.5 * (u - 0.1) / 0.6 + 0.6 * (v - 0.05) / 0.6 + 0.6 * depth, 0, 1)
        ball = light[..., None] * np.array([0.8, 0.15, 0.1]) + 0.6 * (light[..., None] ** 40)
        total += np.where((squared > 0)[..., None], ball + 0.01, colour)
    linear = np.clip(total / samples, 0, 1)
    return bytes_of(np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055))


def rendered():
    """Two samples a pixel against sixteen."""
    return render(16, 3), render(2, 4)


def lodray(other):
    """A terrain at full resolution against `other` level of detail, from the project's renderer, in FOLDER:
    lodray generate terrain --levels 3 --base 128 -o a.lod
    lodray render a.lod --size 200x150 --view three-quarter --distance 1.7 --method reference -o truth
    (--method lod --delta 0.2 -o coarse, and --method lod --delta 1 -o fine)"""
    return tuple(np.asarray(Image.open(LOD / folder / "image.png").convert("RGB")) for folder in ("truth", other))


def narrow():
    """Three columns only."""
    random = np.random.default_rng(5)
    a = ndimage.gaussian_filter(random.random((500, 3, 3)), (3, 0, 0))
    return bytes_of(a), bytes_of(np.roll(a, 2, axis=0))


def single():
    return np.array([[[200, 30, 90]]], np.uint8), np.array([[[180, 60, 90]]], np.uint8)


def black_white():
    return np.zeros((40, 48, 3), np.uint8), np.full((40, 48, 3), 255, np.uint8)


def dark():
    """Odd sides, and darkness in which the other picture differs by at most three codes."""
    random = np.random.default_rng(6)
    a = (12 + 6 * ndimage.gaussian_filter(random.standard_normal((53, 37, 3)), (2, 2, 0))).round()
    return np.clip(a, 0, 255).astype(np.uint8), np.clip(a + random.integers(-3, 4, a.shape), 0, 255).astype(np.uint8)


def perceived(a, b, pixels_per_degree):
    """Error map of flip-evaluator, and its own mean."""
    parameters = {} if pixels_per_degree is None else {"ppd": pixels_per_degree}
    pictures = [picture.astype(np.float32) / np.float32(255) for picture in (a, b)]
    values, mean, _ = flip_evaluator.evaluate(*pictures, "LDR", applyMagma=False, parameters=parameters)
    return values[..., 0].astype(float), mean


def by_definition(a, b, pixels_per_degree):
    """Error map straight from the definition: f64, whole two-dimensional filters, nothing rearranged."""
    to_xyz = np.array([[10135552 / 24577794, 8788810 / 24577794, 4435075 / 24577794],
                       [2613072 / 12288897, 8788810 / 12288897, 887015 / 12288897],
                       [1425312 / 73733382, 8788810 / 73733382, 70074185 / 73733382]])
    white = to_xyz.sum(axis=1)

    def opponent(picture):
        v = picture / 255.0
        linear = np.where(v <= 0.04045, v / 12.92, ((v + 0.055) / 1.055) ** 2.4)
        x, y, z = np.moveaxis(linear @ to_xyz.T / white, 2, 0)
        return 116 * y - 16, 500 * (x - y), 200 * (y - z)

    def hunted(linear):
        t = linear @ to_xyz.T / white
        t = np.where(t > (6 / 29) ** 3, np.cbrt(t), t / (3 * (6 / 29) ** 2) + 4 / 29)
        lightness = 116 * t[..., 1] - 16
        return np.stack([lightness, 0.01 * lightness * 500 * (t[..., 0] - t[..., 1]), 0.01 * lightness * 200 * (t[..., 1] - t[..., 2])], axis=-1)

    def distance(a, b):
        d = hunted(a) - hunted(b)
        return np.abs(d[..., 0]) + np.hypot(d[..., 1], d[..., 2])

    def filtered(plane, kernel):
        return ndimage.correlate(plane, kernel, mode="nearest")

    radius = int(np.ceil(3 * np.sqrt(0.04 / (2 * np.pi**2)) * pixels_per_degree))
    x, y = np.meshgrid(*[np.arange(-radius, radius + 1) / pixels_per_degree] * 2)
    colour = []
    for terms in ([(1, 0.0047)], [(1, 0.0053)], [(34.1, 0.04), (13.5, 0.025)]):
        kernel = sum(s * np.sqrt(np.pi / t) * np.exp(-np.pi**2 * (x * x + y * y) / t) for s, t in terms)
        colour.append(kernel / kernel.sum())
    deviation = 0.5 * 0.082 * pixels_per_degree
    radius = int(np.ceil(3 * deviation))
    x, y = np.meshgrid(*[np.arange(-radius, radius + 1.0)] * 2)
    bell = np.exp(-(x * x + y * y) / (2 * deviation**2))
    features = []
    for kernel in (-x * bell, (x * x / deviation**2 - 1) * bell):
        features.append(np.where(kernel > 0, kernel / kernel[kernel > 0].sum(), kernel / -kernel[kernel < 0].sum()))

    def seen(channels):
        y, cx, cz = (filtered(plane, kernel) for plane, kernel in zip(channels, colour))
        y = (y + 16) / 116
        linear = np.stack([y + cx / 500, y, y - cz / 200], axis=-1) * white @ np.linalg.inv(to_xyz).T
        light = (channels[0] + 16) / 116
        return np.clip(linear, 0, 1), [np.hypot(filtered(light, k), filtered(light, k.T)) for k in features]

    (colour_a, features_a), (colour_b, features_b) = (seen(opponent(picture)) for picture in (a, b))
    largest = distance(np.array([0.0, 1, 0]), np.array([0.0, 0, 1])) ** 0.7
    error = distance(colour_a, colour_b) ** 0.7
    knee = 0.4 * largest
    error = np.where(error < knee, 0.95 / knee * error, 0.95 + (error - knee) / (largest - knee) * 0.05)
    feature = np.maximum(np.abs(features_a[0] - features_b[0]), np.abs(features_a[1] - features_b[1]))
    return error ** (1 - np.sqrt(feature / np.sqrt(2)))


def similarity(a, b):
    """SSIM of scikit-image; None where its window does not fit."""
    if min(a.shape[:2]) < 11:
        return None
    return structural_similarity(a, b, gaussian_weights=True, sigma=1.5, use_sample_covariance=False, data_range=255, channel_axis=-1)


def main():
    pairs = {
        "noise": noise, "gradients": gradients, "half_pixel": half_pixel, "colour_shift": colour_shift, "blurred": blurred,
        "rendered": rendered, "lodray_coarse": lambda: lodray("coarse"), "lodray_fine": lambda: lodray("fine"), "dark": dark,
        "black_white": black_white, "narrow": narrow, "single": single,
    }
    rows = []
    for name, make in pairs.items():
        a, b = make()
        for picture, side in ((a, "a"), (b, "b")):
            Image.fromarray(picture).save(HERE / f"{name}_{side}.png", optimize=True)
        values, own_mean = perceived(a, b, None)
        coarse, _ = perceived(a, b, COARSE)
        definition = by_definition(a.astype(float), b.astype(float), DEFAULT)
        figure = lambda v: None if v is None else round(float(v), 9)
        rows.append({
            "pair": name, "flip_own_mean": figure(own_mean), "flip_mean": figure(values.mean()), "flip_maximum": figure(values.max()),
            "flip_mean_at_30": figure(coarse.mean()), "definition_mean": figure(definition.mean()),
            "definition_maximum": figure(definition.max()), "definition_mean_at_30": figure(by_definition(a.astype(float), b.astype(float), COARSE).mean()),
            "ssim": figure(similarity(a, b)),
        })
    packages = {name: version(name) for name in ("flip-evaluator", "scikit-image", "scipy", "numpy", "pillow")}
    packages["python"] = platform.python_version()
    # One pair a line, so that a change shows where it is.
    lines = ",\n".join("    " + json.dumps(row) for row in rows)
    about = {
        "flip_own_mean": "mean that flip-evaluator itself returns, at its default pixels per degree",
        "flip_mean": "f64 mean of the error map that it returns",
        "flip_mean_at_30": "the same at 30 pixels per degree",
        "definition": "independent f64 program with two-dimensional filters, by_definition in make.py",
        "ssim": "structural_similarity of scikit-image, null where a side is below 11",
    }
    head = f'  "packages": {json.dumps(packages)},\n  "pixels_per_degree": {DEFAULT!r},\n  "about": {json.dumps(about)}'
    (HERE / "figures.json").write_text("{\n" + head + ',\n  "pairs": [\n' + lines + "\n  ]\n}\n")
    json.loads((HERE / "figures.json").read_text())


main()
