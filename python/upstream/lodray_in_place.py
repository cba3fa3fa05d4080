"""A plugin of pytest's: trimesh's two ray classes are lodray's, before any test is read."""

import trimesh.ray

from lodray.trimesh import RayMeshIntersector

trimesh.ray.ray_triangle.RayMeshIntersector = RayMeshIntersector
trimesh.ray.ray_pyembree.RayMeshIntersector = RayMeshIntersector
