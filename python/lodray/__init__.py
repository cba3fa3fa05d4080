"""Exact rays on meshes, level of detail as ray tracing hardware has it, and what frames cost on machines.

    scene = lodray.Scene.build("bunny.obj")             # or Scene.build(vertices, faces)
    hits = scene.cast(origins, directions)              # an array of lodray.HIT, a row for each ray
    result = scene.simulate("haydel2023", scene.camera(size=(1920, 1080)))

Start with help(lodray.Scene). Everything is what the program `lodray` does: same numbers, same words. Lengths are in the units
of the mesh, angles in degrees, percentages of the diagonal of the mesh's box. What cannot be raises LodrayError, a ValueError, whose
message names the argument, the key or the ray; what is of a wrong type raises TypeError. Where the system refuses a file, that is a
LodrayFileError, an OSError too; of a file that is not there a LodrayFileNotFoundError, a FileNotFoundError too. What is lost of a mesh,
or set aside, is said as a UserWarning: warnings.simplefilter("error") makes it an exception.

lodray.RAY, the type of rays, has these fields, all float64 (96 bytes):

    origin (3), direction (3)    world units; a direction has any length but 0
    radius, cone                 of its cone: radius at the origin, tangent of the half angle; 0 for full detail
    t_min, t_max                 distances that count; inf for no end
    any                          1 if any hit serves, 0 for the nearest
    after                        number of an earlier ray, at whose hit this one starts; -1 for none

lodray.HIT, the type of hits, has these (96 bytes); of a ray that meets nothing it has what stands in brackets:

    t                                     float64: distance from the origin (inf)
    tree, level, node                     int32: the triangle that was met, a node of a level of a base triangle (-1)
    triangle                              int64: the finest triangle there, a face of Scene.mesh() (-1)
    barycentrics, finest_barycentrics     float32 (3): weights of the corners of both (nan)
    point                                 float64 (3): where (nan)
    normal                                float32 (3): shading normal (nan)
    front                                 int32: 1 for a front face, 0 for a back (-1)
    instance                              int32: the model among several, 0 (-1)

hits["tree"] >= 0 says which rays met anything. Mask with it before hits["triangle"] is an index: -1 would be the last.

Work goes to threads on all cores. A child of os.fork has none of them, and waits for ever at its first call: take multiprocessing's
"spawn". lodray.trimesh, lodray.mitsuba and lodray.cluster are imported when they are asked for.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from lodray._lodray import HIT, RAY, Camera, LodrayError, Machine, MachinePart, Scene, SceneMethod, __version__, machines, methods, paths

__all__ = [
    "HIT",
    "RAY",
    "Camera",
    "LodrayError",
    "LodrayFileError",
    "LodrayFileNotFoundError",
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


class LodrayFileError(OSError, LodrayError):
    """A file or a folder that the system refuses to read, to write or to make.

    The message names it and has the system's words; errno and filename are None. `except LodrayError` and `except OSError` both catch it.
    """


class LodrayFileNotFoundError(LodrayFileError, FileNotFoundError):
    """A file or a folder that is not there: a LodrayFileError that `except FileNotFoundError` catches too."""


if TYPE_CHECKING:
    from lodray import cluster as cluster
    from lodray import mitsuba as mitsuba
    from lodray import trimesh as trimesh
else:

    def __getattr__(name: str) -> Any:
        # A submodule when it is asked for: some need packages that this one does without.
        if name in ("cluster", "mitsuba", "trimesh"):
            return importlib.import_module(f"lodray.{name}")
        raise AttributeError(f"module 'lodray' has no attribute '{name}'")


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
