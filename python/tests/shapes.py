"""Small meshes, and a description of one, that tests share."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Mesh = tuple[NDArray[np.float64], NDArray[np.int64]]


def cube(side: float = 2.0, centre: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Mesh:
    """A closed cube of twelve triangles, counter-clockwise seen from outside."""
    corners = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=np.float64)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [face for a, b, c, d in quads for face in ((a, b, c), (a, c, d))]
    return corners * (side / 2) + np.array(centre), np.array(faces, dtype=np.int64)


def ball(rings: int = 24) -> Mesh:
    """A closed ball of radius 1, whose poles many triangles share."""
    angles = np.linspace(0, np.pi, rings + 1)[1:-1]
    turns = np.linspace(0, 2 * np.pi, 2 * rings, endpoint=False)
    ring = [[np.sin(a) * np.cos(t), np.sin(a) * np.sin(t), np.cos(a)] for a in angles for t in turns]
    vertices = np.array([[0, 0, 1], *ring, [0, 0, -1]], dtype=np.float64)
    many, last = len(turns), len(vertices) - 1
    at = lambda row, k: 1 + row * many + k % many  # noqa: E731
    faces = [(0, at(0, k), at(0, k + 1)) for k in range(many)]
    for row in range(len(angles) - 1):
        for k in range(many):
            faces += [(at(row, k), at(row + 1, k), at(row + 1, k + 1)), (at(row, k), at(row + 1, k + 1), at(row, k + 1))]
    faces += [(last, at(len(angles) - 1, k + 1), at(len(angles) - 1, k)) for k in range(many)]
    return vertices, np.array(faces, dtype=np.int64)


def special(mesh: Mesh) -> NDArray[np.float64]:
    """Vertices, middles of edges and of faces: where rays are hard."""
    vertices, faces = mesh
    corners = vertices[faces]
    middles = [(corners[:, k] + corners[:, (k + 1) % 3]) / 2 for k in range(3)]
    return np.concatenate([vertices, *middles, corners.mean(axis=1)])


def described(**model: object) -> dict[str, object]:
    """A description of one model."""
    return {
        "picture": {"width": 8, "height": 6, "samples": 1, "depth": 1},
        "camera": [{"eye": [0, 0, 4], "target": [0, 0, 0]}],
        "model": [model],
        "environment": {"zenith": [1, 1, 1], "horizon": [1, 1, 1], "ground": [1, 1, 1]},
    }
