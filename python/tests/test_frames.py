"""Cameras, pictures, machines, paths."""

from __future__ import annotations

import numpy as np
import pytest

import lodray


@pytest.fixture(scope="module")
def scene() -> lodray.Scene:
    return lodray.Scene.generate("sphere", levels=4, base=128)


def test_cameras_are_what_they_are_asked_for(scene: lodray.Scene) -> None:
    camera = scene.camera(size=(64, 48), distance=4.0, yaw=30.0)
    assert camera.size == (64, 48) and abs(camera.distance - 4.0) < 1e-12
    eye, target = np.array(camera.eye), np.array(camera.target)
    assert abs(np.linalg.norm(eye - target) - 4.0 * scene.info["radius"]) < 1e-9
    assert "size=(64, 48)" in repr(camera) and 0.0 < camera.cone < 0.1 and camera.up[1] > 0.9
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
    with pytest.raises(lodray.LodrayError, match="samples"):
        scene.render(camera, samples=3)


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
    other.set({"l1.bytes": 16384, "cores.clock_mhz": 900})
    assert (other.l1.bytes, other.cores.clock_mhz) == (16384, 900) and machine.l1.bytes == all_keys["l1"]["bytes"]
    assert other.title == "haydel2023 l1.bytes=16384 cores.clock_mhz=900" and repr(other) == f"Machine('{other.title}')"
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
    with pytest.raises(lodray.LodrayError, match="models: 1 scenes for 2 models"):
        lodray.paths(description, [scene])
    with pytest.raises(lodray.LodrayError, match="own.lod"):
        lodray.paths(description)
    with pytest.raises(lodray.LodrayError, match="picture.samples"):
        lodray.paths(description | {"picture": {"samples": 0}}, [scene, scene])
