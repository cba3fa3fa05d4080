"""Scenes: made, opened, written, described."""

from __future__ import annotations

import pickle
import warnings
from pathlib import Path

import numpy as np
import pytest
from shapes import ball, cube, described

import lodray


def test_a_mesh_becomes_a_scene_with_levels(tmp_path: Path) -> None:
    scene = lodray.Scene.build(*ball(48), max_error=1.0, levels=2, name="ball")
    info = scene.info
    assert info["name"] == "ball" and info["levels"] == 2
    assert info["finest_triangles"] == info["base_triangles"] * 16
    assert info["origin"]["remesh"]["distance"]["to_original"]["max"] <= 1.0
    assert scene.verify()["passed"]
    path = tmp_path / "ball.lod"
    scene.save(path)
    again = lodray.Scene.open(path)
    assert again.info == info and repr(again) == repr(scene)
    counts = again.export(tmp_path / "ball.obj", level=1)
    assert counts["faces"] == 4 * info["base_triangles"]
    lines = (tmp_path / "ball.obj").read_text().splitlines()
    assert sum(line.startswith("f ") for line in lines) == counts["faces"]


def test_levels_are_arrays(tmp_path: Path) -> None:
    scene = lodray.Scene.generate("sphere", levels=2, base=32)
    for level in range(3):
        vertices, faces = scene.mesh(level)
        assert vertices.dtype == np.float64 and faces.dtype == np.int64
        # Euler's formula for a closed surface without handles.
        assert faces.shape == (32 * 4**level, 3) and len(vertices) == len(faces) // 2 + 2
        scene.export(tmp_path / "level.obj", level)
        lines = [line.split() for line in (tmp_path / "level.obj").read_text().splitlines()]
        assert (np.array([line[1:] for line in lines if line[0] == "v"], dtype=float) == vertices).all()
        assert (np.array([line[1:] for line in lines if line[0] == "f"], dtype=int) == faces + 1).all()
    # A hit's triangle is one of the finest faces, and its weights are those of its corners.
    vertices, faces = scene.mesh()
    hits = scene.cast(scene.camera(size=(16, 16), distance=2.0).rays(), delta="inf")
    hits = hits[hits["tree"] >= 0]
    points = np.einsum("hk,hkc->hc", hits["finest_barycentrics"], vertices[faces[hits["triangle"]]])
    assert len(hits) > 50 and np.abs(points - hits["point"]).max() < 1e-6


def test_vertices_move() -> None:
    scene = lodray.Scene.generate("sphere", levels=2, base=32)
    vertices, faces = scene.mesh()
    moved = scene.refit(vertices * [1.0, 2.0, 1.0] + [5.0, 0.0, 0.0])
    assert moved.verify()["passed"] and (moved.mesh()[1] == faces).all()
    # Compact vertices are stored with few bits.
    assert np.abs(moved.mesh()[0] - (vertices * [1.0, 2.0, 1.0] + [5.0, 0.0, 0.0])).max() < 1e-3
    down = ([5.0, 9.0, 0.01], [0.0, -1.0, 0.0])
    assert scene.cast(*down)["t"][0] == np.inf and abs(moved.cast(*down)["t"][0] - 7.0) < 0.1
    # The scene that was moved is another one; normals may stay as they were.
    assert (scene.mesh()[0] == vertices).all()
    kept = scene.refit(vertices * [1.0, 2.0, 1.0], normals="keep", grid="keep")
    across = ([0.3, 0.3, 9.0], [0.0, 0.0, -1.0])
    assert (kept.cast(*across)["normal"] != moved.refit(kept.mesh()[0]).cast(*across)["normal"]).any()


def test_a_file_of_a_mesh_keeps_its_name(tmp_path: Path) -> None:
    lodray.Scene.build(*cube(), own_triangles=True).export(tmp_path / "box.obj")
    scene = lodray.Scene.build(tmp_path / "box.obj", own_triangles=True)
    assert scene.info["name"] == "box" and scene.info["base_triangles"] == 12


def test_a_generated_scene_is_the_same_each_time() -> None:
    scene = lodray.Scene.generate("terrain", levels=3, base=32, seed=7)
    assert scene.info["origin"]["generate"]["seed"] == 7
    rays = scene.camera(size=(32, 24), distance=2.0).rays().reshape(-1)
    again = lodray.Scene.generate("terrain", levels=3, base=32, seed=7)
    assert (scene.cast(rays)["t"] == again.cast(rays)["t"]).all()


def test_methods_over_the_mesh_need_it() -> None:
    with pytest.raises(lodray.LodrayError):
        lodray.Scene.build(*ball(), max_error=2.0).method("input-bvh")
    scene = lodray.Scene.build(*ball(), max_error=2.0, keep_mesh=True)
    assert scene.cast([[0.0, 0.0, 3.0]], [0.0, 0.1, -1.0], method="input-bvh")["t"][0] < 3.0


@pytest.mark.parametrize(
    ("make", "said"),
    [
        (lambda: lodray.Scene.open("nowhere.lod"), "nowhere.lod"),
        (lambda: lodray.Scene.build([[0, 0, 0]], [[0, 1, 2]]), "triangle 0: vertex index 1 is out of range"),
        (lambda: lodray.Scene.build([[0, 0, np.nan]], [[0, 0, 0]]), "vertex 0"),
        (lambda: lodray.Scene.build(np.zeros((3, 2)), [[0, 1, 2]]), "vertices: an array of shape [3, 2]"),
        (lambda: lodray.Scene.build(np.zeros((3, 3)), [[0, 1, -2]]), "faces: face 0 is [0, 1, -2]"),
        (lambda: lodray.Scene.build(np.zeros((3, 3)), [[0.0, 1.0, 2.0]]), "faces: of type float64"),
        (lambda: lodray.Scene.build(np.zeros((3, 3)), [[0, 1, 2]]), "no triangle is left"),
        (lambda: lodray.Scene.build(np.zeros((3, 3))), "faces: missing"),
        (lambda: lodray.Scene.build(*cube(), max_error=0.0), "max_error: 0"),
        (lambda: lodray.Scene.build(*cube(), bounds="some"), "bounds: "),
        (lambda: lodray.Scene.generate("hills"), "scene: "),
        (lambda: lodray.Scene.generate("terrain", levels=11), "11"),
        (lambda: lodray.Scene.exact(np.zeros((3, 3)), [[0, 1, 2]]), "no triangle is left"),
        (lambda: lodray.Scene.generate("sphere", levels=1, base=8).export("x.obj", level=3), "level: 3 is not from 0 to 1"),
        (lambda: lodray.Scene.generate("sphere", levels=1, base=8).export("x.obj", level=-1), "level: -1 is not from 0 to 1"),
        (lambda: lodray.Scene.generate("sphere", levels=1, base=8).mesh(2), "level: 2 is not from 0 to 1"),
        (lambda: lodray.Scene.generate("sphere", levels=1, base=8).refit(np.zeros((3, 3))), "3 positions, but the finest level of the scene has 18"),
        (lambda: lodray.Scene.generate("sphere", levels=1, base=8).refit(np.full((18, 3), np.nan)), "position 0 is"),
        (lambda: lodray.Scene.generate("sphere", levels=1, base=8).refit(np.zeros((18, 3)), normals="none"), "normals: unknown variant `none`"),
        (lambda: lodray.Scene.generate("sphere", levels=1, base=8).render(what="hits", shading="full"), "shading: is of an image"),
        (lambda: lodray.Scene.build(*cube(), levels=-1), "levels: -1 is not from 0 to 10"),
        (lambda: lodray.Scene.build(*cube(), levels=2**200), "levels: "),
        (lambda: lodray.Scene.build(*cube(), base=-1), "base: -1"),
        (lambda: lodray.Scene.build(*cube(), base=0), "base: 0"),
        (lambda: lodray.Scene.build(*cube(), max_error=1e-12), "give a max_error of"),
        (lambda: lodray.Scene.build(*cube(), own_triangles=True, levels=2), "levels: goes with no own_triangles"),
        (lambda: lodray.Scene.build(*cube(), own_triangles=True, base=2), "base: goes with no own_triangles"),
        (lambda: lodray.Scene.build(*cube(), own_triangles=True, max_error=0.3), "max_error: goes with no own_triangles"),
        (lambda: lodray.Scene.build(*cube(), own_triangles=True, crease_angle=30), "crease_angle: goes with no own_triangles"),
        (lambda: lodray.Scene.build(np.zeros((3, 3)), [[0, 1], [2]]), "faces: "),
        (lambda: lodray.Scene.build(np.zeros((3, 3), dtype="M8[s]"), [[0, 1, 2]]), "vertices: of type datetime64[s]"),
        (lambda: lodray.Scene.build(np.zeros((3, 3)), np.ma.masked_array([[0, 1, 2]], [[0, 0, 1]])), "faces: entries of it are masked"),
        (lambda: lodray.Scene.generate("sphere", seed=-1), "seed: -1"),
        (lambda: lodray.Scene.generate("sphere", seed=2**64), "seed: 18446744073709551616"),
        (lambda: lodray.Scene.generate("sphere", base=-1), "base: -1"),
        (lambda: lodray.Scene.generate("sphere", levels=-1), "levels: -1"),
        (lambda: lodray.Scene.generate("room", walls=0), "walls: 0"),
        (lambda: lodray.Scene.generate("sphere", levels=1, base=8).plan([2.0], size=(0, 1)), "size: "),
    ],
)
def test_what_cannot_be_is_named(make: object, said: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(lodray.LodrayError) as raised:
        make()  # type: ignore[operator]
    assert said in str(raised.value), raised.value
    assert isinstance(raised.value, ValueError)


def said(record: list[warnings.WarningMessage]) -> list[str]:
    assert all(one.category is UserWarning and one.filename == __file__ for one in record)
    return [str(one.message) for one in record]


def test_what_a_mesh_loses_is_a_warning(tmp_path: Path) -> None:
    # A triangle that is there twice, a line, and a triangle without area.
    vertices, faces = cube()
    faces = np.concatenate([faces, faces[:1], [[0, 0, 1]]])
    path = tmp_path / "box.obj"
    rows = [f"v {x} {y} {z}" for x, y, z in vertices] + [f"f {a + 1} {b + 1} {c + 1}" for a, b, c in faces]
    path.write_text("\n".join([*rows, "l 1 2"]) + "\n")
    for mesh, of in [((path,), str(path)), ((vertices, faces), "mesh")]:
        with pytest.warns(UserWarning) as record:
            scene = lodray.Scene.build(*mesh, own_triangles=True)
        lines = said(list(record))
        assert scene.info["base_triangles"] == 12 and all(line.startswith(f"{of}: ") for line in lines)
        for lost in ("1 of its 14 triangles have the corners of another", "1 of its 14 triangles have no area"):
            assert any(lost in line for line in lines), lines
        assert any("only faces (f) are kept" in line for line in lines) == (of != "mesh")
    with pytest.warns(UserWarning) as record:
        lodray.paths(described(file=str(path), levels=1))
    assert all(line.startswith(f"{path}: ") for line in said(list(record)))
    # Whoever wants no warnings has an exception in place of the scene.
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(UserWarning, match="box.obj: "):
            lodray.Scene.build(path, own_triangles=True)
        with pytest.raises(UserWarning, match="mesh: "):
            lodray.Scene.build(vertices, faces, own_triangles=True)
        lodray.Scene.build(*cube(), own_triangles=True)


def test_what_remeshing_loses_is_a_warning(tmp_path: Path) -> None:
    vertices, faces = ball()
    with pytest.warns(UserWarning) as record:
        scene = lodray.Scene.build(vertices, faces, levels=1, base=20)
    (line,) = said(list(record))
    assert line.startswith("mesh: it is up to ") and "(wanted: 0.3 %)" in line and "; leave base out, or try a larger one" in line
    assert line.replace("mesh: ", "").split(";")[0] == scene.info["origin"]["remesh"]["warning"].split(";")[0]
    lodray.Scene.exact(vertices, faces)[0].export(tmp_path / "ball.obj")
    with pytest.warns(UserWarning, match="ball.obj: it is up to "):
        lodray.Scene.build(tmp_path / "ball.obj", levels=1, base=20)


def test_errors_of_files_are_those_of_python_too(tmp_path: Path) -> None:
    scene = lodray.Scene.generate("sphere", levels=1, base=8)
    for make in (
        lambda: lodray.Scene.open(tmp_path / "none.lod"),
        lambda: lodray.Scene.build(tmp_path / "none.obj"),
        lambda: lodray.Machine(tmp_path / "none.toml"),
        lambda: lodray.paths(tmp_path / "none.toml"),
        lambda: lodray.paths(described(file=str(tmp_path / "none.lod"))),
        lambda: lodray.paths(described(file=str(tmp_path / "none.ply"))),
        lambda: scene.save(tmp_path / "none" / "a.lod"),
        lambda: scene.export(tmp_path / "none" / "a.obj"),
    ):
        with pytest.raises(FileNotFoundError, match="none") as raised:
            make()
        assert type(raised.value) is lodray.LodrayFileNotFoundError and isinstance(raised.value, lodray.LodrayFileError)
        assert isinstance(raised.value, lodray.LodrayError) and isinstance(raised.value, ValueError)
        assert raised.value.errno is None and raised.value.filename is None
        again = pickle.loads(pickle.dumps(raised.value))
        assert type(again) is type(raised.value) and str(again) == str(raised.value)
    # A folder is there, and is no file to write.
    for make in (lambda: scene.save(tmp_path), lambda: scene.export(tmp_path)):
        with pytest.raises(OSError, match="it is not an ordinary file") as refused:
            make()
        assert type(refused.value) is lodray.LodrayFileError
    # What is wrong within a file is no fault of the system's.
    (tmp_path / "damaged.lod").write_bytes(b"no scene")
    with pytest.raises(lodray.LodrayError, match="damaged.lod") as damaged:
        lodray.Scene.open(tmp_path / "damaged.lod")
    assert not isinstance(damaged.value, OSError)


def test_plans_say_what_a_unit_needs() -> None:
    scene = lodray.Scene.generate("sphere", levels=3, base=32)
    plan = scene.plan()
    assert 0 < plan["gates"] <= plan["full_gates"] and plan["plan"]["scenes"] == ["sphere"]
    far = scene.plan([64.0], size=(256, 256))
    assert far["gates"] < plan["gates"] and far["plan"]["rays"]["deepest-level"] < 3
    assert all(set(line) == {"part", "what", "needed", "full", "reason", "saved"} for line in far["savings"])


def test_errors_against_time_are_rows_of_a_table(tmp_path: Path) -> None:
    scene = lodray.Scene.generate("sphere", levels=3, base=32)
    seen: list[str] = []
    document = scene.error_time(
        [2.0, 8.0],
        size=(64, 48),
        values={"delta": [1, 4]},
        error_size=64,
        out=tmp_path / "study",
        progress=lambda what, done, of: seen.append(what),
    )
    rows = lodray.table(document)
    assert {row["method"] for row in rows} == {"lod", "bvh"} and {row["distance"] for row in rows} == {2.0, 8.0}
    assert all(row["milliseconds"] > 0 and row["energy.total"] > 0 for row in rows)
    assert (tmp_path / "study" / "views.jsonl").is_file() and seen
    again = scene.error_time([2.0, 8.0], size=(64, 48), values={"delta": [1, 4]}, error_size=64, out=tmp_path / "study")
    assert again == document


def test_a_folder_is_for_one_run_at_a_time(tmp_path: Path) -> None:
    scene = lodray.Scene.generate("sphere", levels=1, base=8)
    folder = tmp_path / "study"

    def measured(out: Path | None, **more: object) -> dict[str, object]:
        return scene.error_time([2.0], size=(8, 8), values={"delta": [1]}, error_size=8, out=out, **more)  # type: ignore[arg-type]

    refused: list[object] = []

    def again(*_: object) -> None:
        with pytest.raises(lodray.LodrayError, match="^out: .*study: another run is writing to this folder$") as raised:
            measured(folder)
        refused.append(raised.value)
        # Others have other folders.
        assert measured(None)["points"]

    document = measured(folder, progress=again)
    assert refused and not (folder / ".lodray-run.tmp").exists()
    assert measured(folder) == document
    (tmp_path / "file").write_text("")
    with pytest.raises(lodray.LodrayFileError, match="^out: cannot make folder .*file: "):
        measured(tmp_path / "file")


def test_lines_that_are_set_aside_are_named_in_a_warning(tmp_path: Path) -> None:
    scene = lodray.Scene.generate("sphere", levels=1, base=8)

    def measured() -> dict[str, object]:
        return scene.error_time([2.0], size=(8, 8), values={"delta": [1]}, error_size=8, out=tmp_path)

    document = measured()
    lines = tmp_path / "views.jsonl"
    good = lines.read_text()
    lines.write_text(good + "no line\n")
    with pytest.warns(UserWarning, match=r"views\.jsonl: line 2 is no result: .*set aside in .*views\.bad\.jsonl"):
        again = measured()
    assert again == document and lines.read_text() == good and (tmp_path / "views.bad.jsonl").read_text() == "no line\n"
    lines.write_text(good + "no line\n")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        with pytest.raises(UserWarning, match="set aside in"):
            measured()
        assert measured() == document


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ({"distances": []}, "distances: there is none"),
        ({"methods": []}, "methods: there is none"),
        ({"methods": ["lod", "input-bvh"]}, "methods: input-bvh is over the mesh"),
        ({"methods": ["magic"]}, "magic"),
        ({"error_size": 0}, "error_size: 0"),
        ({"error_size": -1}, "error_size: -1"),
        ({"samples": 0}, "samples: 0"),
        ({"samples": 3}, "samples: 3 is no square"),
        ({"most_samples": -1}, "most_samples: -1"),
        ({"values": {"delt": [1]}}, "no method trades error by 'delt'; there are: "),
        ({"values": {"delta": "12"}}, "values: delta has 12, and no list of values"),
        ({"values": {"delta": 2}}, "values: delta has 2, and no list of values"),
        ({"values": {"delta": []}}, "values: delta has none"),
        ({"values": {"delta": [-1]}}, "values: delta: '-1'"),
        ({"values": {3: [1]}}, "values: 3"),
        ({"size": (0, 3)}, "size: "),
    ],
)
def test_errors_against_time_refuse_what_would_be_left_out(wrong: dict[str, object], said: str) -> None:
    scene = lodray.Scene.generate("sphere", levels=1, base=8)
    with pytest.raises(lodray.LodrayError) as raised:
        scene.error_time(**({"distances": [2.0], "size": (8, 8)} | wrong))  # type: ignore[arg-type]
    assert said in str(raised.value), raised.value


def test_whole_numbers_are_those_of_numpy_too_and_nothing_else() -> None:
    scene = lodray.Scene.generate("sphere", levels=np.int32(1), base=np.uint8(8), seed=2**64 - 1)  # type: ignore[arg-type]
    assert scene.info["levels"] == 1 and scene.info["origin"]["generate"]["seed"] == 2**64 - 1
    for wrong in ("1", 1.5, None):
        with pytest.raises(TypeError):
            lodray.Scene.generate("sphere", seed=wrong)  # type: ignore[arg-type]
