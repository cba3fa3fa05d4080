"""Scenes of Mitsuba 3 in, scenes of ours out, and a ray intersector whose hits Mitsuba's own code goes on with.

    scene = lodray.mitsuba.from_mitsuba(mi_scene)               # levels of detail over its meshes
    mesh = lodray.mitsuba.to_mitsuba(scene, level=2)            # a mitsuba.Mesh of a level
    caster = lodray.mitsuba.Intersector(mi_scene)               # exact rays at its own triangles
    si = caster.ray_intersect(rays)                             # a mitsuba.SurfaceInteraction3f: si.bsdf(), si.uv and all else work

A variant must have been set (`mitsuba.set_variant`). Rays with differentials carry cones: with an `Intersector` over a scene with level of
detail these choose how much of it is needed.
"""

from __future__ import annotations

import tempfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import drjit
import mitsuba
import numpy as np
from numpy.typing import NDArray

from lodray._lodray import LodrayError, Scene

__all__ = ["Intersector", "from_mitsuba", "meshes", "to_mitsuba"]

# Their stubs are of one variant; which one it is, is not known before a program runs.
mi: Any = mitsuba
dr: Any = drjit


def meshes(source: Any) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
    """The triangles of a `mitsuba.Mesh`, of a list of them, or of all shapes of a `mitsuba.Scene`: (vertices, faces, shape).

    Arrays of shapes (v, 3), (f, 3) and (f,): shape is the number of a face's mesh, in the order of `Scene.shapes()`. Vertices are where
    Mitsuba has them, in world space. LodrayError for a shape that is no mesh, such as a sphere.
    """
    vertices, faces, owners, first = [], [], [], 0
    for number, shape in enumerate(_shapes(source)):
        if not shape.is_mesh():
            raise LodrayError(f"shape {number} ({shape.id()}) is no mesh, but a {shape.class_name()}: only meshes have triangles")
        at = np.asarray(mi.traverse(shape)["vertex_positions"], dtype=np.float64).reshape(-1, 3)
        of = np.asarray(mi.traverse(shape)["faces"], dtype=np.int64).reshape(-1, 3)
        vertices.append(at)
        faces.append(of + first)
        owners.append(np.full(len(of), number, dtype=np.int64))
        first += len(at)
    if not faces:
        raise LodrayError("the scene has no shapes")
    return np.concatenate(vertices), np.concatenate(faces), np.concatenate(owners)


def from_mitsuba(source: Any, **options: Any) -> Scene:
    """A scene with level of detail over the triangles of a `mitsuba.Mesh`, a list of them, or a `mitsuba.Scene`.

    options: those of `Scene.build`, such as max_error and levels. For rays at the very triangles take `Intersector`.
    """
    vertices, faces, _ = meshes(source)
    return Scene.build(vertices, faces, **options)


def to_mitsuba(scene: Scene, *, level: int | None = None, bsdf: dict[str, Any] | None = None) -> Any:
    """A `mitsuba.Mesh` of a level of a scene, the finest if none is named, with its shading normals.

    bsdf: its material, as `mitsuba.load_dict` takes it. Faces are numbered as `triangle` of hits is, if the level is the finest.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.obj"
        scene.export(path, level=level)
        described: dict[str, Any] = {"type": "obj", "filename": str(path)}
        return mi.load_dict(described if bsdf is None else {**described, "bsdf": bsdf})


class Intersector:
    """Answers what Mitsuba's rays meet.

    source: a `mitsuba.Scene`, a `mitsuba.Mesh` or a list of them: the very triangles, exactly, without a miss or a double hit at edges and
    vertices. Or a `lodray.Scene`: with level of detail, as each ray's cone asks for it; `shapes` is then its `to_mitsuba`.
    method, knobs: as of `Scene.method`, for a `lodray.Scene`.

    Rays are rounded once to our grid, and distances are Mitsuba's 32-bit numbers. Nothing can be differentiated through it, and rays must have
    values: call it between kernels, not in a loop that is being recorded.
    """

    def __init__(self, source: Any, *, method: str = "lod", bsdf: dict[str, Any] | None = None, **knobs: Any) -> None:
        if isinstance(source, Scene):
            self.shapes: list[Any] = [to_mitsuba(source, bsdf=bsdf)]
            self._scene, self._faces = source, None
        else:
            if bsdf is not None:
                raise LodrayError("bsdf: is for a lodray.Scene; shapes of Mitsuba's have their own")
            self.shapes = _shapes(source)
            vertices, faces, _ = meshes(self.shapes)
            self._scene, self._faces = Scene.exact(vertices, faces)
        self._vertices, self._triangles, self._owners = meshes(self.shapes)
        counts = np.bincount(self._owners, minlength=len(self.shapes))
        self._first = np.concatenate([[0], np.cumsum(counts)[:-1]])
        self._method = self._scene.method(method, **knobs)

    def cast(self, rays: Any) -> NDArray[np.void]:
        """The hits of rays, as `Scene.cast` gives them: an array of `lodray.HIT`, with `t` in world units.

        rays: a `mitsuba.Ray3f` or `RayDifferential3f`, of one ray or many.
        """
        origins, directions, t_max = _columns(rays.o), _columns(rays.d), _numbers(rays.maxt)
        many = max(len(origins), len(directions), len(t_max))
        radius, cone = _cones(rays, origins, directions)
        spread = [np.ascontiguousarray(np.broadcast_to(of, (many, 3))) for of in (origins, directions)]
        # What Mitsuba has for "no end" is the largest of its numbers.
        ends = np.where(t_max >= np.finfo(np.float32).max, np.inf, t_max)
        # Mitsuba counts in lengths of directions.
        ends = np.broadcast_to(ends * np.linalg.norm(directions, axis=1), many).copy()
        return self._method.cast(*spread, radius=radius, cone=cone, t_max=ends)

    def ray_intersect(self, rays: Any) -> Any:
        """The surface interactions of rays: a `mitsuba.SurfaceInteraction3f`, of one ray in scalar variants, otherwise of as many as there are.

        Mitsuba's own code computes it from our hits, with everything that its shapes know: bsdf, uv, normals, derivatives.
        """
        hits = self.cast(rays)
        met = hits["tree"] >= 0
        faces = np.where(met, hits["triangle"], 0)
        faces = faces if self._faces is None else self._faces[faces]
        b1, b2 = self._weights(faces, hits["point"], met)
        owners = self._owners[faces]
        own = faces - self._first[owners]
        t = np.where(met, hits["t"], np.inf) / np.linalg.norm(_columns(rays.d), axis=1)
        if mi.variant().startswith("scalar"):
            if len(hits) != 1:
                raise LodrayError(f"scalar variants have one ray at a time, but these are {len(hits)}: take cast, or an llvm variant")
            if not met[0]:
                return mi.SurfaceInteraction3f()
            found = mi.PreliminaryIntersection3f()
            found.t, found.prim_uv, found.prim_index = float(t[0]), [float(b1[0]), float(b2[0])], int(own[0])
            found.shape, found.valid = self.shapes[int(owners[0])], True
            return found.compute_surface_interaction(rays)
        active = mi.Mask(met)
        found = dr.zeros(mi.PreliminaryIntersection3f, len(hits))
        found.t, found.prim_uv, found.prim_index = mi.Float(t), mi.Point2f(mi.Float(b1), mi.Float(b2)), mi.UInt32(own)
        found.shape, found.valid = self._pointers(owners), active
        return found.compute_surface_interaction(rays, mi.RayFlags.All, active)

    def ray_test(self, rays: Any) -> NDArray[np.bool_]:
        """Whether each ray meets anything: an array of shape (n,)."""
        hits = self.cast(rays)
        met: NDArray[np.bool_] = hits["tree"] >= 0
        return met

    def _weights(self, faces: NDArray[np.int64], points: NDArray[np.float64], met: NDArray[np.bool_]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Weights of the second and third corner at points of faces."""
        a, b, c = (self._vertices[self._triangles[faces, k]] for k in range(3))
        u, v, w = b - a, c - a, np.where(met[:, None], points, a) - a
        uu, uv, vv, wu, wv = ((x * y).sum(1) for x, y in ((u, u), (u, v), (v, v), (w, u), (w, v)))
        area = uu * vv - uv * uv
        area = np.where(area > 0, area, 1.0)
        b1 = np.clip((vv * wu - uv * wv) / area, 0, 1)
        return b1, np.clip((uu * wv - uv * wu) / area, 0, 1 - b1)

    def _pointers(self, owners: NDArray[np.int64]) -> Any:
        pointer = dr.zeros(mi.ShapePtr, len(owners))
        for number, shape in enumerate(self.shapes):
            pointer = dr.select(mi.Mask(owners == number), mi.ShapePtr(shape), pointer)
        return pointer


def _shapes(source: Any) -> list[Any]:
    if isinstance(source, Sequence):
        return list(source)
    return list(source.shapes()) if hasattr(source, "shapes") else [source]


def _columns(of: Any) -> NDArray[np.float64]:
    """Points or vectors as rows."""
    rows = np.asarray(of, dtype=np.float64)
    return rows.reshape(1, 3) if rows.ndim == 1 else np.ascontiguousarray(rows.T)


def _numbers(of: Any) -> NDArray[np.float64]:
    return np.atleast_1d(np.asarray(of, dtype=np.float64))


def _cones(rays: Any, origins: NDArray[np.float64], directions: NDArray[np.float64]) -> tuple[Any, Any]:
    """Radius and growth of the rays' cones: half of the way to the neighbouring pixel's ray that is nearer."""
    if not getattr(rays, "has_differentials", False):
        return None, None

    def half(x: Any, y: Any, own: NDArray[np.float64]) -> NDArray[np.float64]:
        ways = [np.linalg.norm(_columns(other) - own, axis=1) for other in (x, y)]
        nearer: NDArray[np.float64] = np.minimum(*ways) / 2
        return nearer

    lengths = np.linalg.norm(directions, axis=1)
    return half(rays.o_x, rays.o_y, origins), half(rays.d_x, rays.d_y, directions) / np.where(lengths > 0, lengths, 1.0)
