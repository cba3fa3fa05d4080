"""Exact rays on meshes, level of detail as ray tracing hardware has it, and what frames cost on machines.

    scene = lodray.Scene.build("bunny.obj")             # or Scene.build(vertices, faces)
    hits = scene.cast(origins, directions)              # an array of lodray.HIT, a row for each ray
    result = scene.simulate("haydel2023", scene.camera(size=(1920, 1080)))

Start with help(lodray.Scene). Everything is what the program `lodray` does: same numbers, same words. Lengths are in the units
of the mesh, angles in degrees, percentages of the diagonal of the mesh's box. What cannot be raises LodrayError, a ValueError.
"""

from __future__ import annotations

from typing import Any

from lodray._lodray import HIT, RAY, Camera, LodrayError, Machine, MachinePart, Scene, SceneMethod, __version__, machines, methods, paths

__all__ = [
    "HIT",
    "RAY",
    "Camera",
    "LodrayError",
    "Machine",
    "MachinePart",
    "Scene",
    "SceneMethod",
    "__version__",
    "flat",
    "machines",
    "methods",
    "paths",
    "table",
]


def flat(result: dict[str, Any], prefix: str = "") -> dict[str, Any]:
    """A result as one row: keys of dictionaries within are joined by dots, lists are left out.

    pandas.DataFrame([lodray.flat(result), ...]) is a table of simulations; polars takes the same list.
    """
    row: dict[str, Any] = {}
    for key, value in result.items():
        if isinstance(value, dict):
            row |= flat(value, f"{prefix}{key}.")
        elif not isinstance(value, list):
            row[prefix + key] = value
    return row


def table(document: dict[str, Any]) -> list[dict[str, Any]]:
    """The points of an error-time document (`Scene.error_time`) as rows for pandas or polars: one for each setting at each view on each machine.

    A row has scene, distance, machine, method, setting, and the errors and costs of that setting, as `flat` names them.
    """
    rows = []
    for point in document["points"]:
        view = document["views"][point["view"]]
        errors = flat({key: value for key, value in point.items() if key not in ("costs", "view")})
        for costs in point["costs"]:
            place = {
                "scene": document["scenes"][view["scene"]]["name"],
                "distance": view["distance"],
                "machine": document["machines"][costs["machine"]]["label"],
            }
            rows.append(place | errors | flat({key: value for key, value in costs.items() if key != "machine"}))
    return rows
