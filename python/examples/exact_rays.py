"""For users of trimesh: change one import, and no hit is missed and none is there twice."""

import numpy as np
import trimesh

from lodray.trimesh import RayMeshIntersector

mesh = trimesh.creation.icosphere(subdivisions=3)
places = mesh.vertices.view(np.ndarray)
# From outside through every vertex, along an axis: as often in as out.
axis = np.array([0.0, 0.0, -1.0])
origins, directions = places - 5 * axis, np.tile(axis, (len(places), 1))

exact = RayMeshIntersector(mesh)
for name, ray in [("trimesh", mesh.ray), ("lodray", exact)]:
    _, index_ray, _ = ray.intersects_location(origins, directions)
    hits = np.bincount(index_ray, minlength=len(places))
    print(f"{name}: {(hits % 2 == 1).sum()} of {len(places)} rays through vertices meet an odd number of walls")

mesh.ray = exact  # from here on everything of trimesh that casts rays uses it
print(mesh.contains([[0.0, 0.0, 0.0], [0.0, 0.0, 2.0]]))
