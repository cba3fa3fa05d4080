"""Cameras, pictures, machines, paths."""

from __future__ import annotations

import copy
import json
import os
import pickle
import shutil
import signal
import subprocess
import threading
import time
from pathlib import Path

import numpy as np
import pytest
from shapes import described

import lodray

PROGRAM = os.environ.get("LODRAY_PROGRAM") or shutil.which("lodray")
COPIES = (copy.copy, copy.deepcopy, lambda of: pickle.loads(pickle.dumps(of)), lambda of: pickle.loads(pickle.dumps(of, protocol=0)))


@pytest.fixture(scope="module")
def scene() -> lodray.Scene:
    return lodray.Scene.generate("sphere", levels=4, base=128)


@pytest.fixture(scope="module")
def pruned(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The file of a scene for one view alone, from 8 bounding radii in 48 x 36 pixels."""
    if PROGRAM is None:
        pytest.skip("no program: set LODRAY_PROGRAM, as scripts/python does")
    folder = tmp_path_factory.mktemp("pruned")
    for words in (
        "generate sphere --levels 3 --base 32 -o whole.lod",
        "plan whole.lod --distance 8 --size 48x36 -o plan.toml",
        "prune whole.lod --plan plan.toml -o small.lod",
    ):
        subprocess.run([PROGRAM, *words.split()], cwd=folder, check=True, capture_output=True)
    return folder / "small.lod"


def test_cameras_are_what_they_are_asked_for(scene: lodray.Scene) -> None:
    camera = scene.camera(size=(64, 48), distance=4.0, yaw=30.0)
    assert camera.size == (64, 48) and abs(camera.distance - 4.0) < 1e-12
    eye, target = np.array(camera.eye), np.array(camera.target)
    assert abs(np.linalg.norm(eye - target) - 4.0 * scene.info["radius"]) < 1e-9
    assert "size=(64, 48)" in repr(camera) and 0.0 < camera.cone < 0.1 and camera.up[1] > 0.9
    for size in ([64, 48], np.array([64, 48])):
        assert scene.camera(size=size, eye=np.array([1.0, 2.0, 3.0])).size == (64, 48)  # type: ignore[arg-type]
    for wrong, said in [
        ({"size": (-1, 5)}, "size: "),
        ({"size": (1,)}, "size: "),
        ({"size": (2**200, 5)}, "size: "),
        ({"size": (65536, 65536)}, "size: "),
        ({"eye": (1, 2)}, "eye: "),
        ({"target": (1, 2, 3, 4)}, "target: "),
        ({"up": ()}, "up: "),
        ({"eye": (0, 0, 0), "target": (0, 0, 0)}, "eye must be different from target"),
    ]:
        with pytest.raises(lodray.LodrayError, match=said):
            scene.camera(**wrong)  # type: ignore[arg-type]
    for wrong in ({"size": (1.5, 2)}, {"size": "ab"}, {"eye": "abc"}):
        with pytest.raises(TypeError):
            scene.camera(**wrong)  # type: ignore[arg-type]
    for wrong, said in [({"fov": 200.0}, "fov"), ({"distance": -1.0}, "distance"), ({"size": (0, 5)}, "size"), ({"eye": (0, 0, 9), "yaw": 3.0}, "eye")]:
        with pytest.raises(lodray.LodrayError, match=said):
            scene.camera(**wrong)  # type: ignore[arg-type]


def test_pictures_are_arrays(scene: lodray.Scene) -> None:
    camera = scene.camera(size=(40, 30), distance=3.0)
    image = scene.render(camera, samples=4)
    assert image.shape == (30, 40, 3) and image.dtype == np.uint8 and np.ptp(image) > 50
    hits = scene.render(camera, what="hits")
    assert hits.shape == (30, 40) and hits.dtype == lodray.HIT
    assert (hits.reshape(-1) == scene.cast(camera.rays().reshape(-1)))[np.isfinite(hits["t"]).reshape(-1)].all()
    assert hits["level"].max() <= 4 and np.isinf(hits["t"][0, 0])
    with pytest.raises(lodray.LodrayError, match="what"):
        scene.render(camera, what="smell")
    for samples in (3, 0, -1, 2**40):
        with pytest.raises(lodray.LodrayError, match=f"samples: {samples} is"):
            scene.render(camera, samples=samples)
    with pytest.raises(lodray.LodrayError, match="samples: "):
        scene.render(camera, what="hits", samples=4)


def test_rays_of_a_camera_are_made_beside_the_interpreter(scene: lodray.Scene) -> None:
    # As many as are made on other threads are the same as one by one.
    camera = scene.camera(size=(200, 150), distance=3.0)
    rays = camera.rays()
    assert (rays["origin"] == camera.eye).all() and (rays["cone"] == camera.cone).all() and (rays["after"] == -1).all()
    along = rays["direction"][[0, 0, -1, -1], [0, -1, 0, -1]].sum(axis=0)
    assert np.allclose(np.cross(along, np.array(camera.target) - camera.eye), 0.0, atol=1e-9)
    # In order: to the right and down.
    assert (np.diff(rays["direction"] @ np.cross(np.array(camera.target) - camera.eye, camera.up)) > 0).all()
    assert (np.diff(rays["direction"][:, :, 1], axis=0) < 0).all()


@pytest.mark.skipif(not hasattr(signal, "setitimer"), reason="no timers that send signals")
def test_others_run_while_rays_of_a_camera_are_made_and_signals_are_heard(scene: lodray.Scene) -> None:
    camera, counted, begun, over = scene.camera(size=(2048, 2048)), [0], threading.Event(), threading.Event()

    def count() -> None:
        while not over.is_set():
            begun.set()
            counted[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=count)
    thread.start()
    begun.wait()
    before = counted[0]
    camera.rays()
    assert counted[0] > before + 1
    over.set()
    thread.join()
    handler = signal.signal(signal.SIGALRM, signal.default_int_handler)
    try:
        signal.setitimer(signal.ITIMER_REAL, 0.01)
        with pytest.raises(KeyboardInterrupt):
            camera.rays()
    finally:
        signal.setitimer(signal.ITIMER_REAL, 0)
        signal.signal(signal.SIGALRM, handler)


def test_frames_cost_time_and_energy(scene: lodray.Scene) -> None:
    camera = scene.camera(size=(64, 64), distance=3.0)
    result = scene.simulate("haydel2023", camera)
    assert result["rays"] == 64 * 64 and result["milliseconds"] > 0 and result["energy"]["total"] > 0
    assert result["setup"]["machine"]["label"] == "haydel2023"
    row = lodray.flat(result)
    assert row["energy.total"] == result["energy"]["total"] and row["setup.method.name"] == "lod"
    small = lodray.Machine("haydel2023")
    small.l1.bytes = 8192
    both = scene.simulate(["haydel2023", small], camera, method="bvh", compute="units")
    assert [one["setup"]["machine"]["set"] for one in both] == [[], ["l1.bytes=8192"]]
    assert both[1]["l1"]["misses"] >= both[0]["l1"]["misses"]
    warm = scene.simulate("haydel2023", camera, frames=4)
    assert len(warm["frames"]) == 4 and warm["warm"]["cycles"] < result["cycles"]
    rays = scene.simulate("haydel2023", rays=camera.rays().reshape(-1))
    assert rays["rays"] == 64 * 64 and rays["hits"] == result["hits"]
    turns = scene.simulate("haydel2023", camera, compute="units", tiles_in_turn=4)
    assert turns["setup"]["view"]["tiles_in_turn"] == 4 and turns["hits"] == result["hits"]
    assert set(turns["units"]["phases"]["blocks"]) == set(turns["units"]["blocks"])
    with pytest.raises(lodray.LodrayError, match="tiles_in_turn: 3; a power of two"):
        scene.simulate("haydel2023", camera, tiles_in_turn=3)
    for wrong, said in [
        ({"tiles_in_turn": -1}, "tiles_in_turn: -1"),
        ({"frames": -1}, "frames: -1 is not from 1 to 10000"),
        ({"frames": 2**99}, "frames: "),
        ({"turn": 400.0}, "turn: 400"),
    ]:
        with pytest.raises(lodray.LodrayError, match=said):
            scene.simulate("haydel2023", camera, **wrong)  # type: ignore[arg-type]
    with pytest.raises(lodray.LodrayError, match="compute"):
        scene.simulate("haydel2023", camera, compute="magic")
    with pytest.raises(lodray.LodrayError, match="reference"):
        scene.simulate("haydel2023", camera, method="reference")


def test_keys_of_machines_are_attributes() -> None:
    assert "haydel2023" in lodray.machines()
    machine = lodray.Machine("haydel2023")
    all_keys = machine.to_dict()
    assert set(all_keys) <= set(dir(machine)) and set(all_keys["l1"]) <= set(dir(machine.l1))
    for part in ("cores", "l1", "l2", "crossbar", "units", "dram", "energy"):
        assert getattr(machine, part).to_dict() == all_keys[part]
        for key, value in all_keys[part].items():
            assert isinstance(value, dict) or getattr(getattr(machine, part), key) == value
    other = machine.copy()
    other.set({"l1.bytes": 8192, "cores.clock_mhz": 900})
    assert (other.l1.bytes, other.cores.clock_mhz) == (8192, 900) and machine.l1.bytes == all_keys["l1"]["bytes"]
    assert other.title == "haydel2023 l1.bytes=8192 cores.clock_mhz=900" and repr(other) == f"Machine('{other.title}')"
    same = lodray.Machine(other.to_dict())
    assert same.to_dict() == other.to_dict()
    with pytest.raises(AttributeError, match="l1.size"):
        _ = machine.l1.size
    for change, said in [({"l1.bytes": 3}, "l1.bytes"), ({"l1.size": 3}, "l1"), ({"name.x": 3}, "name")]:
        with pytest.raises(lodray.LodrayError, match=said):
            machine.set(change)
    assert machine.to_dict() == all_keys
    with pytest.raises(lodray.LodrayError, match="nothing2000"):
        lodray.Machine("nothing2000")
    wrong = all_keys | {"speed": 3}
    with pytest.raises(lodray.LodrayError, match="speed"):
        lodray.Machine(wrong)
    with pytest.raises(lodray.LodrayError, match="bytes"):
        lodray.Machine(all_keys | {"l1": all_keys["l1"] | {"bytes": 3}})


def test_a_machine_names_the_last_change_of_each_key() -> None:
    machine = lodray.Machine("haydel2023")
    usual = machine.l1.bytes
    machine.l1.bytes = usual
    assert machine.title == "haydel2023"
    for value in (2 * usual, usual // 2) * 500:
        machine.l1.bytes = value
    machine.cores.clock_mhz = 900
    assert machine.title == f"haydel2023 l1.bytes={usual // 2} cores.clock_mhz=900"
    for same in (machine.copy(), lodray.Machine(machine)):
        same.l1.bytes = usual
        assert same.title == "haydel2023 cores.clock_mhz=900" and same.l1.bytes == usual
    assert machine.l1.bytes == usual // 2
    with pytest.raises(lodray.LodrayError):
        machine.l1.bytes = 3
    assert machine.title == f"haydel2023 l1.bytes={usual // 2} cores.clock_mhz=900"


def test_machines_are_copied_pickled_and_compared(scene: lodray.Scene, tmp_path: Path) -> None:
    machine = lodray.Machine("haydel2023")
    machine.l1.bytes = 8192
    for make in COPIES:
        again = make(machine)
        assert again is not machine and again == machine and again.title == machine.title and again.to_dict() == machine.to_dict()
        again.l1.bytes = 32768
        assert again != machine and machine.l1.bytes == 8192
        again.l1.bytes = lodray.Machine("haydel2023").l1.bytes
        assert again == lodray.Machine("haydel2023")
    assert machine != "haydel2023" and machine != lodray.Machine("haydel2023")
    with pytest.raises(TypeError):
        hash(machine)
    # Of a file: what it names is found beside it, from wherever it is unpickled.
    own = machine.to_dict() | {"name": "own"}
    own["energy"] = own["energy"] | {"caches": "mine"}
    own["l1"] = lodray.Machine("haydel2023").to_dict()["l1"]
    rows = ['name = "mine"', 'unit = "pJ"']
    for level in ("l1", "l2"):
        geometry = {key: own[level][key] for key in ("bytes", "ways", "banks", "line_bytes")}
        rows += [f"[[{level}]]", "read = 99.0", "fill = 1.0", "leakage_mw_per_bank = 1.0", f"[{level}.geometry]", toml(geometry)]
    (tmp_path / "energy").mkdir()
    (tmp_path / "energy" / "mine.toml").write_text("\n".join(rows))
    (tmp_path / "own.toml").write_text(toml(own))
    machine = lodray.Machine(tmp_path / "own.toml")
    machine.cores.clock_mhz = 900
    again = pickle.loads(pickle.dumps(machine))
    assert again == machine and again.title == "own cores.clock_mhz=900"
    camera = scene.camera(size=(16, 16), distance=3.0)
    assert scene.simulate(again, camera) == scene.simulate(machine, camera)
    state = pickle.dumps(machine)
    (tmp_path / "own.toml").unlink()
    with pytest.raises(lodray.LodrayError, match="own.toml"):
        pickle.loads(state)


def toml(table: dict[str, object], path: str = "") -> str:
    values = [f"{key} = {json.dumps(value)}" for key, value in table.items() if not isinstance(value, dict)]
    parts = [f"[{path}{key}]\n{toml(value, f'{path}{key}.')}" for key, value in table.items() if isinstance(value, dict)]
    return "\n".join([*values, *parts])


def test_cameras_are_copied_pickled_and_compared(scene: lodray.Scene) -> None:
    cameras = [
        scene.camera(),
        scene.camera(size=(64, 48), distance=4.0, yaw=30.0),
        scene.camera(size=(64, 48), eye=(1, 2, 3), target=(0.1, 0, 0), up=(0, 0, 1), fov=20.0),
        scene.camera(size=(64, 48), eye=(1, 2, 3), distance=2.0),
    ]
    for k, camera in enumerate(cameras):
        for make in COPIES:
            again = make(camera)
            assert again == camera and hash(again) == hash(camera) and repr(again) == repr(camera) and again.distance == camera.distance
            assert again in cameras and cameras.index(again) == k
        assert camera != 3 and (pickle.loads(pickle.dumps(camera)).rays() == camera.rays()).all()
    assert len(set(cameras)) == 4
    assert scene.simulate("haydel2023", pickle.loads(pickle.dumps(cameras[1]))) == scene.simulate("haydel2023", cameras[1])


def test_methods_say_what_may_be_chosen() -> None:
    methods = {method["name"]: method for method in lodray.methods()}
    knobs = {knob["name"]: knob for knob in methods["bvh"]["knobs"]}
    assert methods["lod"]["help"] and "leaf_layout" in knobs and knobs["leaf_layout"]["values"]


def test_paths_are_pictures_of_a_description(scene: lodray.Scene) -> None:
    description = {
        "picture": {"width": 24, "height": 16, "samples": 2, "depth": 1},
        "camera": [{"eye": [0, 0, 4], "target": [0, 0, 0]}],
        "model": [{"generate": {"scene": "sphere", "levels": 2, "base": 32}}, {"file": "own.lod", "translate": [1.0, 0.0, 0.0], "moves": {"by": [0.0, 1.0, 0.0]}}],
        "environment": {"zenith": [1, 1, 1], "horizon": [0.5, 0.5, 0.5], "ground": [0.1, 0.1, 0.1]},
    }
    made = lodray.paths(description, [scene, scene], seed=3)
    assert made["image"].shape == (16, 24, 3) and made["light"].dtype == np.float32 and made["counts"]["rays"][0] == 24 * 16 * 2
    again = lodray.paths(description, [scene, scene], seed=3)
    assert (again["light"] == made["light"]).all()
    assert (lodray.paths(description, [scene, scene], seed=3, time=0.5)["light"] != made["light"]).any()
    with pytest.raises(lodray.LodrayError, match="time: 2 is not from 0 to 1"):
        lodray.paths(description, [scene, scene], time=2.0)
    assert lodray.paths(description, [scene, scene], size=[8, 4])["image"].shape == (4, 8, 3)
    for name, value in [("samples", 0), ("samples", -1), ("depth", 65), ("depth", -1), ("seed", -1), ("size", (0, 4)), ("size", (4,))]:
        with pytest.raises(lodray.LodrayError, match=f"{name}: "):
            lodray.paths(description, [scene, scene], **{name: value})  # type: ignore[arg-type]
    large = description | {"picture": {"width": 65536, "height": 65536}}
    with pytest.raises(lodray.LodrayError, match="size must be") as raised:
        lodray.paths(large, [scene, scene])
    assert "--" not in str(raised.value)
    with pytest.raises(lodray.LodrayError, match="models: 1 scenes for 2 models"):
        lodray.paths(description, [scene])
    with pytest.raises(lodray.LodrayError, match="own.lod"):
        lodray.paths(description)
    with pytest.raises(lodray.LodrayError, match="picture.samples"):
        lodray.paths(description | {"picture": {"samples": 0}}, [scene, scene])


def test_paths_take_no_pruned_scene(pruned: Path) -> None:
    said = "job: the scene was pruned for the rays of a job, and is not there for anything else"
    with pytest.raises(lodray.LodrayError, match=rf"^model\[0\]: .*small\.lod: {said}"):
        lodray.paths(described(file=str(pruned)))
    with pytest.raises(lodray.LodrayError, match=rf"^models\[0\]: {said}"):
        lodray.paths(described(file="other.lod"), [lodray.Scene.open(pruned)])
    assert lodray.paths(described(file=str(pruned.parent / "whole.lod")))["image"].shape == (6, 8, 3)


def test_levels_are_of_mesh_files(scene: lodray.Scene, tmp_path: Path) -> None:
    scene.save(tmp_path / "ball.lod")
    scene.export(tmp_path / "ball.obj", level=1)
    with pytest.raises(lodray.LodrayError, match=r"^model\[0\]: levels is of mesh files; .*ball\.lod has its own$"):
        lodray.paths(described(file=str(tmp_path / "ball.lod"), levels=3))
    made = lodray.paths(described(file=str(tmp_path / "ball.obj"), levels=1))
    assert made["image"].shape == (6, 8, 3)


def test_pictures_of_pruned_scenes_have_the_rays_of_the_job(pruned: Path) -> None:
    small, whole = lodray.Scene.open(pruned), lodray.Scene.open(pruned.parent / "whole.lod")
    camera = small.camera(size=(48, 36), distance=8.0)
    assert (small.render(camera, shading="full") == whole.render(camera, shading="full")).all()
    no_such = "was pruned for a job, which has no such view"
    with pytest.raises(lodray.LodrayError, match=f"{no_such}: size is 96x72"):
        small.render(camera, shading="full", samples=4)
    for what in ("image", "hits"):
        with pytest.raises(lodray.LodrayError, match=f"{no_such}: size is 48x35"):
            small.render(small.camera(size=(48, 35), distance=8.0), what=what)
