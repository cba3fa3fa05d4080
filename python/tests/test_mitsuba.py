"""Mitsuba's scenes in, ours out, and rays between them: its own caster agrees where it is right."""

from __future__ import annotations

import subprocess
import sys
from typing import Any

import numpy as np
import pytest
from shapes import ball, special

import lodray

mi = pytest.importorskip("mitsuba")

# Exits with 3 where Mitsuba finds no LLVM. With one that is too old for its kernels, such as 14, the process is aborted.
KERNEL = """
import sys
import lodray, mitsuba
try:
    mitsuba.set_variant("llvm_ad_rgb")
    print(mitsuba.Float([1.0, 2.0]) + 1)
except Exception:
    sys.exit(3)
from lodray.mitsuba import Intersector
print(Intersector(lodray.Scene.generate("sphere", levels=1, base=8)).ray_intersect(mitsuba.Ray3f([0, 0, 4], [0, 0, -1])).t)
"""


def has_llvm() -> bool:
    code = subprocess.run([sys.executable, "-c", KERNEL], capture_output=True, timeout=300, check=False).returncode
    return code >= 0 and code != 3


VARIANTS = ["scalar_rgb"] + (["llvm_ad_rgb"] if has_llvm() else [])
mi.set_variant("scalar_rgb")

from lodray.mitsuba import Intersector, from_mitsuba, meshes, to_mitsuba  # noqa: E402


def cubes() -> Any:
    """Two cubes side by side, one red."""
    red = {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.8, 0.1, 0.1]}}
    at = mi.ScalarTransform4f().translate
    return mi.load_dict({"type": "scene", "a": {"type": "cube", "bsdf": red}, "b": {"type": "cube", "to_world": at([3, 0, 0])}})


def mesh_of(vertices: np.ndarray, faces: np.ndarray) -> Any:
    mesh = mi.Mesh("mesh", len(vertices), len(faces))
    params = mi.traverse(mesh)
    params["vertex_positions"] = np.ascontiguousarray(vertices, dtype=np.float32).ravel()
    params["faces"] = np.ascontiguousarray(faces, dtype=np.uint32).ravel()
    params.update()
    return mesh


@pytest.fixture(params=VARIANTS)
def variant(request: pytest.FixtureRequest) -> str:
    mi.set_variant(request.param)
    return str(request.param)


def test_meshes_come_in_as_they_lie(variant: str) -> None:
    vertices, faces, shape = meshes(cubes())
    assert vertices.shape[1] == 3 and faces.shape == (24, 3) and list(shape) == [0] * 12 + [1] * 12
    assert np.allclose(vertices.min(0), [-1, -1, -1]) and np.allclose(vertices.max(0), [4, 1, 1])
    scene = from_mitsuba(cubes(), own_triangles=True)
    assert scene.info["trees"] == 24
    with pytest.raises(lodray.LodrayError, match="shape 0 .* is no mesh"):
        meshes(mi.load_dict({"type": "scene", "ball": {"type": "sphere"}}))


def test_levels_go_out_as_meshes(variant: str) -> None:
    scene = lodray.Scene.generate("sphere", levels=3, base=8)
    fine, coarse = to_mitsuba(scene), to_mitsuba(scene, level=1)
    assert fine.face_count() == 16 * coarse.face_count() and fine.has_vertex_normals()
    vertices, faces, _ = meshes(fine)
    assert len(faces) == fine.face_count() and np.abs(vertices).max() > 0.5


def test_interactions_are_mitsubas_where_it_is_right(variant: str) -> None:
    scene = cubes()
    ours = Intersector(scene)
    random = np.random.default_rng(1)
    origins = random.normal(size=(300, 3)) * 4 + [1.5, 0, 0]
    toward = random.uniform([-1, -1, -1], [4, 1, 1], size=(300, 3)) - origins
    toward *= 1.5 / np.linalg.norm(toward, axis=1)[:, None]
    met = 0
    if variant.startswith("scalar"):
        for origin, direction in zip(origins[:60], toward):
            ray = mi.Ray3f(origin, direction)
            a, b = ours.ray_intersect(ray), scene.ray_intersect(ray)
            assert a.is_valid() == b.is_valid() == ours.ray_test(ray)[0]
            if a.is_valid():
                met += 1
                assert np.allclose(a.t, b.t, rtol=1e-5) and np.allclose(a.p, b.p, atol=1e-5) and np.allclose(a.n, b.n)
                assert np.allclose(a.uv, b.uv, atol=1e-4) and a.shape == b.shape and a.prim_index == b.prim_index
        with pytest.raises(lodray.LodrayError, match="one ray at a time"):
            Intersector(scene).ray_intersect(type("Rays", (), {"o": origins.T, "d": toward.T, "maxt": np.inf})())
    else:
        rays = mi.Ray3f(mi.Point3f(origins.T), mi.Vector3f(toward.T))
        a, b = ours.ray_intersect(rays), scene.ray_intersect(rays)
        valid = np.asarray(b.is_valid())
        met = int(valid.sum())
        assert (np.asarray(a.is_valid()) == valid).all() and (ours.ray_test(rays) == valid).all()
        for name, close in [("t", 1e-5), ("p", 1e-5), ("n", 1e-6), ("uv", 1e-4)]:
            mine, theirs = (np.atleast_2d(np.asarray(getattr(si, name)))[..., valid] for si in (a, b))
            assert np.allclose(mine, theirs, atol=close), name
        assert (np.asarray(a.prim_index) == np.asarray(b.prim_index))[valid].all()
        # Materials are there: the red cube's and the other's.
        colour = np.asarray(a.bsdf().eval_diffuse_reflectance(a, mi.Mask(valid)))[:, valid]
        first = np.asarray(a.p)[0, valid] < 1.5
        assert np.allclose(colour[:, first].T, [0.8, 0.1, 0.1], atol=1e-3) and np.allclose(colour[:, ~first], 0.5, atol=1e-3)
    assert met > 20


def test_no_ray_through_a_vertex_or_edge_is_missed(variant: str) -> None:
    vertices, faces = ball(12)
    caster = Intersector(mesh_of(vertices, faces))
    places = special((meshes(caster.shapes)[0], faces))
    # From the middle every ray meets the ball.
    rays = mi.Ray3f([0, 0, 0], [0, 0, 1])
    if variant.startswith("scalar"):
        assert all(caster.ray_test(mi.Ray3f([0, 0, 0], place))[0] for place in places[:200])
    else:
        rays = mi.Ray3f(mi.Point3f(0, 0, 0), mi.Vector3f(places.T))
        assert caster.ray_test(rays).all()


def test_cones_of_rays_choose_the_level(variant: str) -> None:
    scene = lodray.Scene.generate("sphere", levels=4, base=8)
    caster = Intersector(scene)
    levels = []
    for spread in (0.0, 0.001, 0.1):
        ray = mi.RayDifferential3f(mi.Ray3f([0, 0, 4], [0.01, 0.02, -1]))
        ray.o_x, ray.o_y = ray.o, ray.o
        ray.d_x, ray.d_y = mi.Vector3f([0.01 + spread, 0.02, -1]), mi.Vector3f([0.01, 0.02 + spread, -1])
        ray.has_differentials = True
        levels.append(int(caster.cast(ray)["level"][0]))
    assert levels[0] == 4 and levels == sorted(levels, reverse=True) and levels[2] < levels[0]
    plain = mi.Ray3f([0, 0, 4], [0.01, 0.02, -1])
    assert int(caster.cast(plain)["level"][0]) == 4
    si = caster.ray_intersect(plain)
    assert np.allclose(np.linalg.norm(np.asarray(si.p).ravel()), 1.0, atol=0.3)


def test_ends_of_rays_count(variant: str) -> None:
    caster = Intersector(cubes())
    # Directions of length 2: distances are in them.
    for end, meets in [(1.4, False), (1.6, True)]:
        ray = mi.Ray3f([0.1, 0.2, 4], [0, 0, -2])
        ray.maxt = end
        assert caster.ray_test(ray)[0] == meets
    far = caster.ray_intersect(mi.Ray3f([0.1, 0.2, 4], [0, 0, -2]))
    assert np.allclose(np.asarray(far.t), 1.5, atol=1e-5)
