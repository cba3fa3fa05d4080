"""The drop-in for trimesh's ray class: the issues that people filed, right every time."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
from shapes import special

trimesh = pytest.importorskip("trimesh")

import lodray  # noqa: E402
from lodray.trimesh import RayMeshIntersector  # noqa: E402

ENGINES = ["ray_triangle", "ray_pyembree"]


def intersector(mesh: object) -> RayMeshIntersector:
    return RayMeshIntersector(mesh)


def other(mesh: object, name: str) -> object:
    if name == "ray_pyembree" and not trimesh.ray.has_embree:
        pytest.skip("no embreex")
    return getattr(trimesh.ray, name).RayMeshIntersector(mesh)


def some_rays(mesh: object, many: int) -> tuple[np.ndarray, np.ndarray]:
    random = np.random.default_rng(3)
    origins = random.normal(size=(many, 3)) * mesh.scale + mesh.centroid  # type: ignore[attr-defined]
    return origins, mesh.centroid + (random.random((many, 3)) - 0.5) * mesh.extents * 1.2 - origins  # type: ignore[attr-defined]


@pytest.mark.parametrize("name", ENGINES)
def test_other_casters_agree_where_they_are_right(name: str) -> None:
    mesh = trimesh.creation.icosphere(subdivisions=3)
    ours, theirs = intersector(mesh), other(mesh, name)
    origins, directions = some_rays(mesh, 500)
    assert (ours.intersects_any(origins, directions) == theirs.intersects_any(origins, directions)).all()
    assert (ours.intersects_first(origins, directions) == theirs.intersects_first(origins, directions)).all()
    results = []
    for caster in (ours, theirs):
        places, ray, tri = caster.intersects_location(origins, directions, multiple_hits=True)
        along = np.einsum("ij,ij->i", places - origins[ray], directions[ray])
        order = np.lexsort((along, ray))
        results.append((places[order], ray[order], tri[order]))
    (places, ray, tri), (their_places, their_ray, their_tri) = results
    assert (ray == their_ray).all() and (tri == their_tri).all() and np.allclose(places, their_places, atol=1e-5)
    points = (np.random.default_rng(4).random((500, 3)) - 0.5) * 2.4
    assert (ours.contains_points(points) == theirs.contains_points(points)).all()


def test_shapes_and_types_are_trimeshs() -> None:
    mesh = trimesh.creation.box()
    ours = intersector(mesh)
    places, ray, tri = ours.intersects_location([[0, 0, 5]], [[0, 0, -1]])
    assert places.shape == (2, 3) and ray.tolist() == [0, 0] and tri.dtype == ray.dtype == np.int64 and places.dtype == np.float64
    assert len(ours.intersects_id([[0, 0, 5]], [[0, 0, -1]])) == 2
    tri, ray, places = ours.intersects_id([[0, 0, 5]], [[0, 0, -1]], multiple_hits=False, return_locations=True)
    assert tri.shape == ray.shape == (1,) and np.allclose(places, [[0, 0, 0.5]])
    assert len(ours.intersects_id([[0, 0, 5]], [[0, 0, -1]], max_hits=1)[0]) == 1
    assert ours.intersects_first([[0, 0, 5], [0, 0, 5]], [[0, 0, -1], [0, 0, 1]])[1] == -1
    for of in (ours.intersects_id([[0, 0, 5]], [[0, 0, 1]]), ours.intersects_id(np.zeros((0, 3)), np.zeros((0, 3)))):
        assert all(part.shape == (0,) for part in of)
    assert ours.intersects_location([[0, 0, 5]], [[0, 0, 1]])[0].shape == (0, 3)
    with pytest.raises(ValueError, match="match"):
        ours.intersects_any([[0, 0, 5]], [[0, 0, 1], [0, 0, 1]])
    with pytest.raises(ValueError, match="points must be"):
        ours.contains_points([0.0, 0.0])


def test_through_vertices_and_edges_each_wall_is_met_once() -> None:
    for mesh in (trimesh.creation.box(), trimesh.creation.icosphere(2), trimesh.creation.cylinder(1.0, 4.0), trimesh.creation.torus(2.0, 0.5)):
        ours = intersector(mesh)
        places = special((mesh.vertices.view(np.ndarray), mesh.faces.view(np.ndarray)))
        for axis in np.concatenate([np.eye(3), [[1, 1, 0], [1, 2, 3]]]):
            tri, ray = ours.intersects_id(places - 10 * mesh.scale * axis, np.tile(axis, (len(places), 1)))
            fronts = np.einsum("ij,j->i", mesh.face_normals[tri], axis) < 0
            assert (np.bincount(ray[fronts], minlength=len(places)) == np.bincount(ray[~fronts], minlength=len(places))).all()
            # A ray that touches meets, wherever a wall faces it by more than a sliver.
        if mesh.is_convex:
            inside = np.tile(mesh.centroid, (len(places), 1))
            _, ray = ours.intersects_id(inside, places - mesh.centroid)
            assert (np.bincount(ray, minlength=len(places)) == 1).all()


def test_silhouettes_are_touched() -> None:
    mesh = trimesh.creation.box(extents=[2, 2, 2])
    sides = [[x, y, 5.0] for x in (-1, 0, 1) for y in (-1, 0, 1)]
    down = np.tile([0.0, 0.0, -1.0], (9, 1))
    assert intersector(mesh).intersects_any(sides, down).all()
    places, ray, _ = intersector(mesh).intersects_location(sides, down)
    assert (np.bincount(ray) == 2).all() and np.allclose(places[::2, 2], 1.0)
    # Every vertex of a ball is on it, from whichever side one looks.
    ball = trimesh.creation.icosphere(subdivisions=2)
    for axis in ([0.0, 0.0, 1.0], [0.6, 0.8, 0.0], [0.3, -0.5, 0.8]):
        along = np.tile(axis, (len(ball.vertices), 1))
        origins = ball.vertices - 4 * along
        assert intersector(ball).intersects_any(origins, along).all()
        assert (intersector(ball).intersects_first(origins, along) >= 0).all()
        exact = RayMeshIntersector(ball, touching=False)
        assert (np.bincount(exact.intersects_id(origins, along)[1], minlength=len(origins)) % 2 == 0).all()


@pytest.mark.parametrize("scale", [1e-4, 0.1, 1.0, 7.0, 1e8])
def test_rays_that_start_on_a_wall_meet_it(scale: float) -> None:
    mesh = trimesh.creation.box().subdivide()
    mesh.apply_scale(scale)
    start = [[0.01 * scale, 0.02 * scale, scale / 2]]
    assert len(intersector(mesh).intersects_id(start, [[0, 0, -1]])[0]) == 2
    assert len(intersector(mesh).intersects_id(start, [[0, 0, 1]])[0]) == 1
    beside = np.array(start) + [0, 0, 1e-6 * scale]
    assert not intersector(mesh).intersects_any(beside, [[0, 0, 1]])[0]


def test_coplanar_rays_meet_no_wall_that_they_lie_in() -> None:
    sheet = trimesh.Trimesh([[0, 0, 0], [1, 0, 0], [1, 3, 0], [0, 3, 0]], [[0, 1, 2], [0, 2, 3]], process=False)
    assert intersector(sheet).intersects_location([[-1, 1, 0]], [[1, 0, 0]])[0].shape == (0, 3)
    box = trimesh.creation.box().subdivide().subdivide()
    # Within the plane of the top: beside the ray's end faces there is nothing to meet but what the side faces are.
    counts = np.bincount(intersector(box).intersects_id([[-3.0, 0.1, 0.5]] * 3, [[1, 0, 0]] * 3)[1], minlength=3)
    assert set(counts) <= {0, 2}


@pytest.mark.parametrize("scale", [1e-12, 1e-4, 1.0, 1e4, 1e8, 1e20])
@pytest.mark.parametrize("shift", [0.0, 1.0, 1e4])
def test_any_coordinates_serve(scale: float, shift: float) -> None:
    mesh = trimesh.creation.box().subdivide().subdivide()
    mesh.apply_translation([shift, -shift, shift])
    mesh.apply_scale(scale)
    ours = intersector(mesh)
    middle, size = mesh.bounds.mean(axis=0), mesh.extents[0]
    steps = np.linspace(-0.45, 0.45, 31) * size
    origins = np.array([[middle[0] + x, middle[1] + y, middle[2] + 2 * size] for x in steps for y in steps])
    _, ray, tri = ours.intersects_location(origins, np.tile([0.0, 0.0, -1.0], (len(origins), 1)))
    assert (np.bincount(ray) == 2).all()
    assert (ours.contains_points(origins - [0, 0, 2 * size])).all()


def test_a_ray_that_leaves_a_wall_in_real_coordinates_meets_nothing() -> None:
    # Issue 48: a wall at easting 5e5, from which a ray leads away.
    wall = trimesh.Trimesh(
        [[528980.85, 183526.1, 0], [528980.85, 183526.1, 3], [528982.3, 183523.55, 0], [528982.3, 183523.55, 3]],
        [[1, 0, 2], [1, 2, 3]],
        process=False,
    )
    normal = wall.face_normals[0]
    origin = wall.vertices[[0, 2]].mean(axis=0) + [0, 0, 1] + 0.01 * normal
    assert not intersector(wall).intersects_any([origin], [normal])[0]
    assert intersector(wall).intersects_any([origin], [-normal])[0]


def test_faces_are_numbered_as_they_were_given() -> None:
    vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]]
    # Without area, two corners at one place, a vertex twice under two numbers.
    faces = [[0, 1, 1], [0, 3, 1], [0, 1, 2], [4, 5, 6]]
    mesh = trimesh.Trimesh(vertices, faces, process=False)
    ours = intersector(mesh)
    assert ours.intersects_first([[0.2, 0.2, 1], [0.8, 0.8, 1], [0.5, 0.5, 1]], [[0, 0, -1]] * 3).tolist()[:2] == [2, 3]
    _, ray = ours.intersects_id([[0.5, 0.5, 1]], [[0, 0, -1]])
    assert ray.tolist() == [0], "vertices that lie at one place are one to every ray"


def test_meshes_without_a_face_and_rays_without_direction_meet_nothing() -> None:
    for mesh in (trimesh.Trimesh(), trimesh.Trimesh([[0, 0, 0]] * 3, [[0, 1, 2]], process=False)):
        ours = intersector(mesh)
        assert not ours.intersects_any([[0, 0, 1]], [[0, 0, -1]]).any() and ours.intersects_first([[0, 0, 1]], [[0, 0, -1]])[0] == -1
    ours = intersector(trimesh.creation.box())
    origins, directions = [[0, 0, 5]] * 3, [[0, 0, 0], [0, 0, -1], [np.nan, 0, 0]]
    assert ours.intersects_any(origins, directions).tolist() == [False, True, False]
    assert ours.intersects_id(origins, directions)[1].tolist() == [1, 1]
    assert ours.intersects_first(origins, directions).tolist()[::2] == [-1, -1]


def test_a_mesh_that_changes_is_read_again_and_copies_are_new() -> None:
    mesh = trimesh.creation.box()
    mesh.ray = intersector(mesh)
    assert mesh.ray.intersects_any([[0, 0, 5]], [[0, 0, -1]])[0]
    mesh.apply_translation([3, 0, 0])
    assert not mesh.ray.intersects_any([[0, 0, 5]], [[0, 0, -1]])[0]
    for again in (pickle.loads(pickle.dumps(mesh.ray)), copy.deepcopy(mesh.ray), copy.copy(mesh.ray)):
        assert again.intersects_any([[3, 0, 5]], [[0, 0, -1]])[0]


def test_points_in_open_meshes_are_as_trimesh_has_them() -> None:
    mesh = trimesh.creation.box()
    mesh.update_faces(np.arange(len(mesh.faces)) > 0)
    points = (np.random.default_rng(5).random((200, 3)) - 0.5) * 1.5
    inside = intersector(mesh).contains_points(points)
    assert inside.any() and not inside[(np.abs(points) > 0.5).any(axis=1)].any()


def test_cavities_are_outside() -> None:
    outer, inner = trimesh.creation.box([1, 1, 1]), trimesh.creation.box([0.1, 0.1, 0.1])
    inner.invert()
    mesh = trimesh.util.concatenate([outer, inner])
    assert intersector(mesh).contains_points([[0, 0, 0], [0.3, 0, 0], [2, 0, 0]]).tolist() == [False, True, False]


def test_no_rays_have_no_results() -> None:
    ours = intersector(trimesh.creation.box())
    for none in ([], np.zeros((0, 3)), [[]]):
        assert ours.intersects_first(none, none).shape == (0,) and ours.intersects_first(none, none).dtype == np.int64
        assert ours.intersects_any(none, none).shape == (0,) and ours.intersects_any(none, none).dtype == np.bool_
        assert all(len(part) == 0 for part in ours.intersects_location(none, none))
    assert ours.intersects_first([0, 0, 5], [0, 0, -1]).shape == (1,)


def test_what_is_no_ray_is_refused() -> None:
    ours = intersector(trimesh.creation.box())
    for wrong in (np.zeros((1, 2, 3)), np.zeros((2, 4)), np.zeros((2, 3), dtype=complex), [["a", "b", "c"]], np.ma.masked_array([[0.0, 0, 5]], [[1, 0, 0]])):
        for call in (ours.intersects_first, ours.intersects_any, ours.intersects_id, ours.intersects_location):
            with pytest.raises(lodray.LodrayError, match="ray_origins: "):
                call(wrong, wrong)
    with pytest.raises(lodray.LodrayError, match="ray_directions: ") as raised:
        ours.intersects_any([[0, 0, 5]], [[0, 0], [1]])
    assert isinstance(raised.value.__cause__, ValueError)
    with pytest.raises(lodray.LodrayError, match="points: of type complex128"):
        ours.contains_points([[0, 0, 1j]])
    for call in (ours.intersects_first, ours.intersects_any, ours.intersects_id, ours.intersects_location):
        with pytest.raises(TypeError, match="multiple_hit"):
            call([[0, 0, 5]], [[0, 0, -1]], multiple_hit=False)
