"""In place of the module that trimesh's tests begin with, which its source package lacks, as it lacks the meshes: shapes that trimesh makes."""

import logging
import time

import numpy as np
import pytest
import trimesh

__all__ = ["data", "get_mesh", "log", "np", "random", "time", "trimesh"]

log = logging.getLogger("trimesh")
random = np.random.default_rng(0).random
MADE = {
    "unit_cube.STL": trimesh.creation.box,
    "unit_sphere.STL": trimesh.creation.icosphere,
    "featuretype.STL": lambda: trimesh.creation.annulus(1.0, 2.0, 1.0),
}


class Lacking:
    def __getitem__(self, name: str) -> None:
        pytest.skip(f"the source package has no {name}")


data = Lacking()


def get_mesh(file_name: str, **_: object) -> trimesh.Trimesh:
    if file_name not in MADE:
        pytest.skip(f"the source package has no {file_name}")
    return MADE[file_name]()
