"""Rays on trimesh's meshes, exactly: a class that takes the place of `trimesh.ray.ray_pyembree.RayMeshIntersector`.

    from lodray.trimesh import RayMeshIntersector

    mesh.ray = RayMeshIntersector(mesh)                 # mesh.ray.intersects_location(...), mesh.contains(...) and others use it

Of a closed mesh every ray from outside meets as many fronts as backs: no hit is missed and none is there twice, also where a ray goes
through an edge or a vertex, and at any coordinates. The triangles are the mesh's own, in 64-bit numbers that are rounded once, to
2^-28 of the mesh's largest side.
"""

from __future__ import annotations

from typing import Any, Literal, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from lodray._lodray import HIT, LodrayError, Scene, SceneMethod

__all__ = ["RayMeshIntersector"]

# How far a ray that meets nothing is moved to see whether it touches the mesh, in parts of the mesh's largest side: twice a step of
# its grid, as both the ray and what it touches were rounded.
_TOUCH = 2.0**-27
# Four ways to move it, across it: no two of them lie along one edge of a box.
_TURNS = [0.4 + k * np.pi / 2 for k in range(4)]


class RayMeshIntersector:
    """Answers what rays meet on a mesh.

    geometry: a `trimesh.Trimesh`; when it changes, it is read again. scale_to_box is there for trimesh's sake: nothing depends on it.
    touching: a ray that only touches the mesh, at a silhouette's edge or vertex, meets it, and so does one that starts on it, as with
    trimesh's own. Without it roundings decide, and rays that start on a surface to leave it do so.

    Results are sorted by ray, and of each ray nearest first. A ray without direction, or with a number that is none, meets nothing.
    """

    def __init__(self, geometry: Any, scale_to_box: bool = True, *, touching: bool = True) -> None:
        self.mesh = geometry
        self._scale_to_box = scale_to_box
        self._touching = touching
        self._made: tuple[int, SceneMethod, NDArray[np.int64]] | None = None

    def intersects_location(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, multiple_hits: bool = True
    ) -> tuple[NDArray[np.float64], NDArray[np.int64], NDArray[np.int64]]:
        """Where rays meet the mesh: (locations, index_ray, index_tri) of shapes (h, 3), (h,) and (h,).

        ray_origins, ray_directions: arrays of shape (n, 3). multiple_hits: every hit of each ray, otherwise the first.
        """
        index_tri, index_ray, locations = self.intersects_id(ray_origins, ray_directions, multiple_hits=multiple_hits, return_locations=True)
        return locations, index_ray, index_tri

    @overload
    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        multiple_hits: bool = True,
        max_hits: int | None = None,
        return_locations: Literal[False] = False,
    ) -> tuple[NDArray[np.int64], NDArray[np.int64]]: ...

    @overload
    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        multiple_hits: bool = True,
        max_hits: int | None = None,
        *,
        return_locations: Literal[True],
    ) -> tuple[NDArray[np.int64], NDArray[np.int64], NDArray[np.float64]]: ...

    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        multiple_hits: bool = True,
        max_hits: int | None = None,
        return_locations: bool = False,
    ) -> Any:
        """Which faces rays meet: (index_tri, index_ray), and the locations behind them if wanted, of shapes (h,), (h,) and (h, 3).

        max_hits: the first so many of each ray; all if None.
        """
        rays = _Rays(ray_origins, ray_directions)
        hits, index_ray = self._hits(rays, multiple_hits)
        if max_hits is not None and len(index_ray) > 0:
            first = np.searchsorted(index_ray, index_ray)
            near = np.arange(len(index_ray)) - first < max_hits
            hits, index_ray = hits[near], index_ray[near]
        index_tri = self._faces(hits)
        if return_locations:
            return index_tri, index_ray, np.ascontiguousarray(hits["point"])
        return index_tri, index_ray

    def intersects_first(self, ray_origins: ArrayLike, ray_directions: ArrayLike) -> NDArray[np.int64]:
        """The face that each ray meets first, -1 without one: shape (n,)."""
        rays = _Rays(ray_origins, ray_directions)
        hits, index_ray = self._hits(rays, False)
        first = np.full(rays.given, -1, dtype=np.int64)
        first[index_ray] = self._faces(hits)
        return first

    def intersects_any(self, ray_origins: ArrayLike, ray_directions: ArrayLike) -> NDArray[np.bool_]:
        """Whether each ray meets anything: shape (n,)."""
        rays = _Rays(ray_origins, ray_directions)
        met = np.zeros(rays.given, dtype=np.bool_)
        method = self._method()
        if method is not None and len(rays.numbers) > 0:
            directions = rays.directions
            origins = self._begun(rays.origins, directions)
            missed = ~method.occluded(origins, directions)
            for moved, those in self._moved(origins, directions, missed):
                missed[those] = ~method.occluded(moved, directions[those])
            met[rays.numbers] = ~missed
        return met

    def contains_points(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Whether points lie inside the mesh: points of shape (n, 3), result of shape (n,). On the surface it may be either.

        Of a mesh that is not closed, it is what trimesh makes of rays in both directions.
        """
        places = _numbers("points", points)
        if places.ndim != 2 or places.shape[1] != 3:
            raise ValueError("points must be (n,3)")
        if not self.mesh.is_watertight:
            from trimesh.ray.ray_util import contains_points

            inside: NDArray[np.bool_] = contains_points(self, places)
            return inside
        contains = np.zeros(len(places), dtype=np.bool_)
        method = self._method()
        near = np.isfinite(places).all(axis=1)
        if method is None or not near.any():
            return contains
        lo, hi = self.mesh.bounds
        near &= ((places >= lo) & (places <= hi)).all(axis=1)
        if near.any():
            crossings = method.count(places[near], [0.4395064455, 0.617598629942, 0.652231566745])
            contains[near] = crossings.sum(axis=1) % 2 == 1
        return contains

    def _method(self) -> SceneMethod | None:
        """What finds hits on the mesh as it is now; none if it has no face that a ray could meet."""
        now = hash(self.mesh)
        if self._made is None or self._made[0] != now:
            self._made = None
            if len(self.mesh.faces) == 0:
                return None
            vertices, faces = (np.asarray(of) for of in (self.mesh.vertices, self.mesh.faces))
            corners = vertices[faces]
            differ = [(corners[:, a] != corners[:, b]).any(axis=1) for a, b in ((0, 1), (1, 2), (2, 0))]
            if not np.logical_and.reduce(differ).any():
                return None
            scene, numbers = Scene.exact(vertices, faces)
            self._made = now, scene.method("bvh"), numbers
        return self._made[1]

    def _faces(self, hits: NDArray[np.void]) -> NDArray[np.int64]:
        if self._made is None:
            return np.zeros(0, dtype=np.int64)
        faces: NDArray[np.int64] = self._made[2][hits["triangle"]]
        return faces

    def _hits(self, rays: _Rays, multiple: bool) -> tuple[NDArray[np.void], NDArray[np.int64]]:
        """Hits, and whose they are, sorted."""
        method = self._method()
        if method is None or len(rays.numbers) == 0:
            return np.zeros(0, dtype=HIT), np.zeros(0, dtype=np.int64)
        directions = rays.directions
        origins = self._begun(rays.origins, directions)

        def cast(origins: NDArray[np.float64], directions: NDArray[np.float64]) -> tuple[NDArray[np.void], NDArray[np.int64]]:
            if multiple:
                return method.all_hits(origins, directions)
            hits = method.cast(origins, directions)
            met = np.flatnonzero(hits["tree"] >= 0)
            return hits[met], met

        hits, of = cast(origins, directions)
        missed = np.ones(len(rays.numbers), dtype=np.bool_)
        missed[of] = False
        for moved, those in self._moved(origins, directions, missed):
            more, own = cast(moved, directions[those])
            if len(own) > 0:
                missed[those[own]] = False
                hits, of = np.concatenate([hits, more]), np.concatenate([of, those[own]])
                order = np.argsort(of, kind="stable")
                hits, of = hits[order], of[order]
        return hits, rays.numbers[of]

    def _step(self) -> float:
        lo, hi = self.mesh.bounds
        return _TOUCH * float((hi - lo).max())

    def _begun(self, origins: NDArray[np.float64], directions: NDArray[np.float64]) -> NDArray[np.float64]:
        """Where rays start that meet what they start on."""
        if not self._touching:
            return origins
        return origins - self._step() * _unit(directions)

    def _moved(self, origins: NDArray[np.float64], directions: NDArray[np.float64], missed: NDArray[np.bool_]) -> Any:
        """Rays that meet nothing, moved to either side by next to nothing: their origins and their numbers, until none is left.

        Those that do not even touch the mesh's box are left alone.
        """
        if not self._touching or not missed.any():
            return
        (lo, hi), step = self.mesh.bounds, self._step()
        those = np.flatnonzero(missed)
        those = those[_meets(origins[those], directions[those], lo - 4 * step, hi + 4 * step)]
        # Two directions across each ray.
        along = _unit(directions[those])
        axis = np.zeros_like(along)
        axis[np.arange(len(those)), np.abs(along).argmin(axis=1)] = 1.0
        across = np.cross(along, axis)
        across = step * _unit(across)
        beside, start = np.cross(along, across), origins[those]
        for turn in _TURNS:
            left = missed[those]
            if not left.all():
                those, start, across, beside = those[left], start[left], across[left], beside[left]
            if len(those) == 0:
                return
            yield start + np.cos(turn) * across + np.sin(turn) * beside, those

    def __getstate__(self) -> dict[str, Any]:
        # What was made is made again where it is needed.
        return self.__dict__ | {"_made": None}

    def __copy__(self) -> RayMeshIntersector:
        return RayMeshIntersector(self.mesh, self._scale_to_box, touching=self._touching)

    def __deepcopy__(self, _: Any) -> RayMeshIntersector:
        return self.__copy__()


class _Rays:
    """Rays that can be, of those that were given, and their numbers among these."""

    def __init__(self, ray_origins: ArrayLike, ray_directions: ArrayLike) -> None:
        origins, directions = _vectors("ray_origins", ray_origins), _vectors("ray_directions", ray_directions)
        if origins.shape != directions.shape:
            raise LodrayError("Ray origin and direction don't match!")
        self.given = len(origins)
        finite = np.isfinite(np.concatenate([origins, directions], axis=1)).all(axis=1)
        fine: NDArray[np.bool_] = np.logical_and(finite, directions.any(axis=1))
        self.numbers = np.flatnonzero(fine)
        all_fine = len(self.numbers) == self.given
        self.origins = origins if all_fine else origins[self.numbers]
        self.directions = directions if all_fine else directions[self.numbers]


def _vectors(of: str, given: ArrayLike) -> NDArray[np.float64]:
    """Vectors of shape (n, 3), of an array of that shape, of a single vector, or of nothing."""
    array = _numbers(of, given)
    if array.size == 0 and array.ndim < 3:
        return np.zeros((0, 3))
    if array.ndim not in (1, 2) or array.shape[-1] != 3:
        raise LodrayError(f"{of}: an array of shape {array.shape}, not (n, 3)")
    return array.reshape(-1, 3)


def _numbers(of: str, given: ArrayLike) -> NDArray[np.float64]:
    """An array of numbers: of what is none the package's own calls say the same."""
    try:
        array = np.asanyarray(given)
    except (TypeError, ValueError) as error:
        raise LodrayError(f"{of}: {error}") from error
    if np.ma.is_masked(array):
        raise LodrayError(f"{of}: entries of it are masked")
    if array.dtype.kind not in "iuf":
        raise LodrayError(f"{of}: of type {array.dtype}, not of numbers")
    return np.ascontiguousarray(array, dtype=np.float64)


def _unit(vectors: NDArray[np.float64]) -> NDArray[np.float64]:
    """Vectors at length 1: scaled first, so that squares neither overflow nor vanish."""
    scaled = vectors / np.abs(vectors).max(axis=1, keepdims=True)
    unit: NDArray[np.float64] = scaled / np.sqrt(np.einsum("ij,ij->i", scaled, scaled))[:, None]
    return unit


def _meets(origins: NDArray[np.float64], directions: NDArray[np.float64], lo: NDArray[np.float64], hi: NDArray[np.float64]) -> NDArray[np.bool_]:
    """Whether rays meet a box."""
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        a, b = (lo - origins) / directions, (hi - origins) / directions
    # A ray that runs along a side is within it or not.
    within = (origins >= lo) & (origins <= hi)
    flat = directions == 0.0
    near = np.where(flat, np.where(within, -np.inf, np.inf), np.minimum(a, b)).max(axis=1)
    far = np.where(flat, np.inf, np.maximum(a, b)).min(axis=1)
    meets: NDArray[np.bool_] = (near <= far) & (far >= 0.0)
    return meets
