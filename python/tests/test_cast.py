"""Rays in, hits out."""

from __future__ import annotations

import threading
import time
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest
from shapes import ball, cube, special

import lodray

DOWN = [0.0, 0.0, -1.0]


@pytest.fixture(scope="module")
def terrain() -> lodray.Scene:
    return lodray.Scene.generate("terrain", levels=4, base=128)


def some_rays(scene: lodray.Scene, many: int = 4000) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(1)
    origins = random.normal(size=(many, 3)) * 3 * scene.info["radius"]
    targets = np.array(scene.info["centre"]) + (random.random((many, 3)) - 0.5) * scene.info["radius"]
    return origins, targets - origins


def same(a: np.ndarray, b: np.ndarray) -> bool:
    return a.dtype == b.dtype and a.tobytes() == b.tobytes()


def test_hits_are_rows_of_the_programs() -> None:
    fields = {"t", "tree", "level", "node", "triangle", "barycentrics", "finest_barycentrics", "point", "normal", "front", "instance"}
    assert set(lodray.HIT.names or ()) == fields and lodray.HIT.itemsize == 96
    scene = lodray.Scene.build(*cube(), own_triangles=True)
    hits = scene.cast([[0.25, 0.5, 5.0], [3.0, 0.0, 5.0]], DOWN)
    assert hits.dtype == lodray.HIT and hits.shape == (2,)
    assert abs(hits["t"][0] - 4.0) < 1e-8 and np.allclose(hits["point"][0], [0.25, 0.5, 1.0]) and hits["front"][0] == 1
    assert np.allclose(hits["normal"][0], [0, 0, 1], atol=1e-4)
    assert np.isinf(hits["t"][1]) and hits["tree"][1] == -1 and np.isnan(hits["point"][1]).all()


def test_every_form_of_rays_is_the_same(terrain: lodray.Scene) -> None:
    origins, directions = some_rays(terrain)
    hits = terrain.cast(origins, directions, cone=0.001, t_max=50.0)
    assert (hits["tree"] >= 0).any() and (hits["tree"] < 0).any()
    rays = np.zeros(len(origins), dtype=lodray.RAY)
    rays["origin"], rays["direction"], rays["cone"], rays["t_max"], rays["after"] = origins, directions, 0.001, 50.0, -1
    assert same(hits, terrain.cast(rays))
    rows = np.column_stack([origins, directions, np.zeros(len(origins)), np.full(len(origins), 0.001)])
    assert same(hits, terrain.cast(rows, t_max=50.0))
    assert same(hits, terrain.cast(np.asfortranarray(rows), t_max=np.full(len(origins), 50.0)))
    assert same(hits, terrain.cast(origins.tolist(), directions[:], cone=np.full(len(origins), 0.001), t_max=50.0))
    assert same(hits, terrain.cast(np.repeat(origins, 2, axis=0)[::2], directions, cone=0.001, t_max=50.0))
    assert same(terrain.cast(origins, [0, 0, 1]), terrain.cast(origins, np.tile([0.0, 0.0, 1.0], (len(origins), 1))))
    assert same(terrain.cast([0, 0, 5], [0, 0, -1]), terrain.cast([[0, 0, 5]], [[0, 0, -1]]))
    assert len(terrain.cast(np.zeros((0, 3)), np.zeros((0, 3)))) == 0


def test_float64_is_not_copied(terrain: lodray.Scene) -> None:
    origins, directions = some_rays(terrain, 10)
    origins.flags.writeable = False
    before = origins.copy()
    terrain.cast(origins, directions)
    assert (origins == before).all()


def test_methods_agree_where_they_must(terrain: lodray.Scene) -> None:
    origins, directions = some_rays(terrain)
    full = terrain.cast(origins, directions, delta="inf")
    for name in ("bvh", "bvh6", "bvh32", "binary16", "grid"):
        other = terrain.method(name).cast(origins, directions)
        assert (full["t"] == other["t"]).all() and (full["triangle"] == other["triangle"]).all(), name
    truth = terrain.cast(origins, directions, method="reference")
    met = (full["tree"] >= 0) & (truth["tree"] >= 0)
    assert met.sum() > 0.99 * (truth["tree"] >= 0).sum() and np.allclose(full["t"][met], truth["t"][met], rtol=1e-6, atol=1e-6)
    coarse = terrain.method("lod", delta=4).cast(origins, directions, cone=0.02)
    met = coarse["tree"] >= 0
    assert coarse["level"][met].mean() < 3 and (full["level"][met] == 4).mean() > 0.9


def test_any_and_all_and_counts_are_of_the_same_hits(terrain: lodray.Scene) -> None:
    origins, directions = some_rays(terrain)
    for name in ("lod", "bvh"):
        method = terrain.method(name)
        hits, ray = method.all_hits(origins, directions, t_max=20.0)
        first = method.cast(origins, directions, t_max=20.0)
        assert (np.diff(ray) >= 0).all() and ray.dtype == np.int64
        own = np.flatnonzero(np.r_[True, np.diff(ray) > 0])
        assert same(hits[own], first[first["tree"] >= 0])
        assert (method.occluded(origins, directions, t_max=20.0) == (first["tree"] >= 0)).all()
        counts = method.count(origins, directions, t_max=20.0)
        assert (counts.sum(axis=1) == np.bincount(ray, minlength=len(origins))).all()
        assert (counts[:, 0] == np.bincount(ray[hits["front"] == 1], minlength=len(origins))).all()
        inside = (np.diff(ray) == 0)
        assert (np.diff(hits["t"])[inside] >= 0).all()


@pytest.mark.parametrize("mesh", [cube(), ball(), cube(2e-9), cube(3.0, (1e6, -2e6, 5e5))], ids=["cube", "ball", "tiny", "far"])
@pytest.mark.parametrize("name", ["lod", "bvh", "bvh6", "binary16"])
def test_closed_bodies_are_entered_as_often_as_left(mesh: tuple[np.ndarray, np.ndarray], name: str) -> None:
    vertices, faces = mesh
    scene, numbers = lodray.Scene.exact(vertices, faces)
    assert sorted(numbers) == list(range(len(faces)))
    method = scene.method(name)
    middle, size = vertices.mean(axis=0), np.ptp(vertices, axis=0).max()
    places = special(mesh)
    # From the middle to every vertex, edge and face: out once.
    counts = method.count(np.tile(middle, (len(places), 1)), places - middle)
    assert (counts == [0, 1]).all()
    # From outside through each pair of them, and along the axes: in as often as out.
    random = np.random.default_rng(2)
    pairs = random.integers(len(places), size=(3000, 2))
    pairs = pairs[(places[pairs[:, 0]] != places[pairs[:, 1]]).any(axis=1)]
    directions = places[pairs[:, 1]] - places[pairs[:, 0]]
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    counts = method.count(places[pairs[:, 0]] - 3 * size * directions, directions)
    assert (counts[:, 0] == counts[:, 1]).all() and counts.sum() > 0
    for axis in np.concatenate([np.eye(3), -np.eye(3)]):
        counts = method.count(places - 3 * size * axis, np.tile(axis, (len(places), 1)))
        assert (counts[:, 0] == counts[:, 1]).all()


def test_what_is_given_is_there_as_often_as_given() -> None:
    vertices, faces = cube()
    twice = np.concatenate([faces[:1], [[3, 3, 5]], faces])
    scene, numbers = lodray.Scene.exact(vertices, twice)
    assert sorted(numbers) == [0, *range(2, 14)]
    corners = vertices[faces[0]]
    middle = corners.mean(axis=0)
    outside = middle + 5 * np.cross(corners[1] - corners[0], corners[2] - corners[0])
    hits, _ = scene.all_hits([outside], [middle - outside])
    assert sorted(numbers[hits["triangle"]])[:2] == [0, 2] and len(hits) == 3


def test_faces_of_hits_are_taken_without_misses() -> None:
    vertices, faces = cube()
    scene, numbers = lodray.Scene.exact(vertices, faces)
    hits = scene.cast([[0.3, 0.2, 5.0], [9.0, 0.2, 5.0]], DOWN)
    assert hits["triangle"][1] == -1
    met = numbers[hits["triangle"][hits["tree"] >= 0]]
    assert met.shape == (1,) and (vertices[faces[met[0]]][:, 2] == 1.0).all()


def test_rays_of_a_picture_have_flat_hits(terrain: lodray.Scene) -> None:
    rays = terrain.camera(size=(5, 4), distance=2.0).rays()
    assert rays.shape == (4, 5) and same(terrain.cast(rays), terrain.cast(rays.reshape(-1))) and terrain.occluded(rays).shape == (20,)
    with pytest.raises(lodray.LodrayError, match="origins: an array of shape"):
        terrain.cast(rays["origin"], rays["direction"])


def test_rays_follow_others_exactly() -> None:
    scene = lodray.Scene.build(*cube(), own_triangles=True)
    rays = np.zeros(2, dtype=lodray.RAY)
    rays["t_max"], rays["after"] = np.inf, -1
    rays["origin"], rays["direction"] = [[0.3, 0.2, 5.0], [0.3, 0.2, 1.0]], [DOWN, DOWN]
    rays["after"][1] = 0
    hits = scene.cast(rays)
    assert np.allclose(hits["point"], [[0.3, 0.2, 1.0], [0.3, 0.2, -1.0]])
    rays["origin"][1] = [9.0, 9.0, 9.0]
    with pytest.raises(lodray.LodrayError, match="ray 1: its origin is"):
        scene.cast(rays)
    assert np.isinf(scene.cast(rays, follow=False)["t"][1])


@pytest.mark.parametrize(
    ("rays", "directions", "more", "said"),
    [
        ([[0, 0, 0]], [[0, 0, 0]], {}, "ray 0: the direction has no length"),
        ([[0, 0, 0], [np.inf, 0, 0]], DOWN, {}, "ray 1: origin and direction must be finite numbers"),
        ([[0, 0, 0]], DOWN, {"cone": -1.0}, "ray 0: the cone"),
        ([[0, 0, 0]], DOWN, {"t_min": 2.0, "t_max": 1.0}, "ray 0: the nearest distance"),
        ([[0, 0, 0]], DOWN, {"t_max": [1.0, 2.0]}, "t_max: neither a number"),
        ([[0, 0]], DOWN, {}, "origins: an array of shape [1, 2]"),
        ([[0, 0, 0], [0, 0, 1]], [DOWN] * 3, {}, "origins: shape [2, 3], but directions has [3, 3]"),
        ([[0, 0, 0]], None, {}, "directions: missing"),
        (np.zeros((2, 7)), None, {}, "rays: an array of shape [2, 7]"),
        (np.zeros(2, dtype=[("origin", "f8", 3)]), None, {}, "rays: of type"),
        (["a"], DOWN, {}, "origins: "),
        ([["1", "2", "3"]], DOWN, {}, "origins: of type <U1, not of numbers"),
        (np.zeros((1, 3), dtype="M8[D]"), DOWN, {}, "origins: of type datetime64[D]"),
        ([[0, 0, 0]], np.array([[0, 0, 1j]]), {}, "directions: of type complex128"),
        (np.array([[0, 0, None]]), DOWN, {}, "origins: of type object"),
        (np.zeros((1, 3), dtype=bool), DOWN, {}, "origins: of type bool"),
        (np.ma.masked_array([[0.0, 0.0, 0.0]], [[0, 0, 1]]), DOWN, {}, "origins: entries of it are masked"),
        (np.ma.masked_array(np.zeros(2, lodray.RAY), [0, 1]), None, {}, "rays: entries of it are masked"),
        ([[0, 0, 0]], DOWN, {"cone": np.complex128(1)}, "cone: of type complex128"),
        ([[0, 0, 0]], DOWN, {"t_max": np.timedelta64(3, "s")}, "t_max: of type timedelta64[s]"),
        ([[0, 0, 0]], DOWN, {"t_max": "3"}, "t_max: of type"),
        ([[0, 0, 0]], DOWN, {"t_max": 10**400}, "t_max: "),
        ([[0, 0, 0]], DOWN, {"method": "magic"}, "there is no method 'magic', but: lod"),
        ([[0, 0, 0]], DOWN, {"speed": 3}, "lod has no knob 'speed', but: delta"),
        ([[0, 0, 0]], DOWN, {"delta": -1}, "delta: '-1' is not a quality"),
    ],
)
def test_what_is_no_ray_is_named(rays: object, directions: object, more: dict[str, object], said: str) -> None:
    scene = lodray.Scene.build(*cube(), own_triangles=True)
    with pytest.raises(lodray.LodrayError) as raised:
        scene.cast(rays, directions, **more)  # type: ignore[arg-type]
    assert said in str(raised.value), raised.value


@pytest.mark.parametrize("array", [lambda own: (own, DOWN, {}), lambda own: ([[0, 0, 5]], own, {}), lambda own: ([[0, 0, 5]], DOWN, {"t_max": own})])
def test_what_an_array_raises_is_passed_on(array: object) -> None:
    scene = lodray.Scene.build(*cube(), own_triangles=True)

    class Own:
        def __init__(self, error: BaseException) -> None:
            self.error = error

        def __array__(self, *_: object, **__: object) -> np.ndarray:
            raise self.error

    for error in (KeyboardInterrupt(), SystemExit(3), MemoryError("full"), OSError("gone")):
        rays, directions, more = array(Own(error))  # type: ignore[operator]
        with pytest.raises(type(error)) as raised:
            scene.cast(rays, directions, **more)
        assert raised.value is error
    for error in (TypeError("no"), ValueError("no")):
        rays, directions, more = array(Own(error))  # type: ignore[operator]
        with pytest.raises(lodray.LodrayError, match="(origins|directions|t_max): no") as raised:
            scene.cast(rays, directions, **more)
        assert raised.value.__cause__ is error


def test_numbers_of_other_types_are_read() -> None:
    scene = lodray.Scene.build(*cube(), own_triangles=True)
    hits = scene.cast([[0.25, 0.5, 5.0]], DOWN)
    for dtype in ("f4", "f2", ">f8", "longdouble"):
        assert same(hits, scene.cast(np.array([[0.25, 0.5, 5.0]], dtype=dtype), np.array(DOWN, dtype=dtype)))
    assert same(hits, scene.cast(np.ma.masked_array([[0.25, 0.5, 5.0]]), np.array(DOWN, dtype="i1")))
    assert same(hits, scene.cast([(0.25, 0.5, 5)], (0, 0, -1), t_max=np.array(9.0), t_min=np.float32(1), cone=0))
    assert np.isinf(scene.cast([[0.25, 0.5, 5.0]], DOWN, t_max=np.array(2.0))["t"][0])
    far = scene.cast([[0.25, 0.5, 1e20]], DOWN)
    assert same(far, scene.cast([[0.25, 0.5, 10**20]], DOWN)) and same(far, scene.cast([[Fraction(1, 4), Fraction(1, 2), 10**20]], DOWN))
    unmasked = np.ma.masked_array(scene.camera(size=(4, 3)).rays())
    assert same(scene.cast(unmasked), scene.cast(unmasked.data))


def test_the_closest_alone_is_no_list_of_all() -> None:
    scene = lodray.Scene.build(*cube(), own_triangles=True)
    with pytest.raises(lodray.LodrayError, match="closest"):
        scene.all_hits([[0, 0, 5]], DOWN, method="reference")


def test_others_run_meanwhile_and_are_told(terrain: lodray.Scene) -> None:
    origins, directions = some_rays(terrain, 400_000)
    seen: list[tuple[str, int, int | None]] = []
    counted, over = [0], threading.Event()

    def count() -> None:
        while not over.is_set():
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    terrain.cast(origins, directions, progress=lambda *args: seen.append(args))
    over.set()
    thread.join()
    assert counted[0] > 5
    what, done, of = seen[-1]
    assert what == "casting" and done == of == 6250


def test_what_progress_raises_ends_the_work(terrain: lodray.Scene) -> None:
    origins, directions = some_rays(terrain, 2_000_000)

    def stop(*_: object) -> None:
        raise KeyboardInterrupt

    start = time.process_time()
    terrain.cast(origins[:100_000], directions[:100_000])
    part = time.process_time() - start
    with pytest.raises(KeyboardInterrupt):
        terrain.cast(origins, directions, progress=stop)
    assert time.process_time() - start < 10 * part
    assert len(terrain.cast(origins[:10], directions[:10])) == 10


def test_files_of_rays_and_hits_are_the_programs(terrain: lodray.Scene, tmp_path: Path) -> None:
    rays = terrain.camera(size=(16, 12), distance=3.0).rays()
    assert rays.shape == (12, 16) and rays.dtype == lodray.RAY
    np.save(tmp_path / "hits.npy", terrain.cast(rays.reshape(-1)))
    assert np.load(tmp_path / "hits.npy").dtype == lodray.HIT
