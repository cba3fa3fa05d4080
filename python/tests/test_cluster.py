"""Shards handed in from Python: the bytes of one run, with every kind of executor that is there."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

import lodray
from lodray.cluster import submit

PROGRAM = os.environ.get("LODRAY_PROGRAM") or shutil.which("lodray")
pytestmark = pytest.mark.skipif(PROGRAM is None, reason="no program: set LODRAY_PROGRAM, as scripts/python does")

LIST = """
size = "24x24"
distances = [2, 5]
methods = ["lod", "bvh"]
[[scene]]
generate = "sphere"
levels = 2
base = 8
[[scene]]
generate = "terrain"
levels = 2
base = 8
[[machine]]
name = "haydel2023"
"""


@contextmanager
def threads(_: Path) -> Iterator[Any]:
    with ThreadPoolExecutor(2) as executor:
        yield executor


@contextmanager
def submitit_local(folder: Path) -> Iterator[Any]:
    submitit = pytest.importorskip("submitit")
    executor = submitit.AutoExecutor(folder=folder / "submitit", cluster="local")
    executor.update_parameters(timeout_min=5)
    yield executor


@contextmanager
def submitit_debug(folder: Path) -> Iterator[Any]:
    submitit = pytest.importorskip("submitit")
    yield submitit.AutoExecutor(folder=folder / "submitit", cluster="debug")


@contextmanager
def dask(folder: Path) -> Iterator[Any]:
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, dashboard_address=None, local_directory=str(folder / "dask")
    ) as cluster, distributed.Client(cluster) as client:
        yield client


ENGINES = [threads, submitit_local, submitit_debug, dask]


def files(folder: Path) -> dict[str, bytes]:
    return {path.name: path.read_bytes() for path in folder.iterdir() if path.is_file()}


@pytest.fixture(scope="module")
def local(tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    folder = tmp_path_factory.mktemp("local")
    (folder / "jobs.toml").write_text(LIST)
    subprocess.run([str(PROGRAM), "sweep", "jobs.toml", "-o", "out"], cwd=folder, check=True, capture_output=True)
    return files(folder / "out")


@pytest.mark.parametrize("engine", ENGINES, ids=lambda engine: engine.__name__)
def test_results_are_those_of_one_run(engine: Any, tmp_path: Path, local: dict[str, bytes]) -> None:
    run = tmp_path / "run"
    run.mkdir()
    (run / "jobs.toml").write_text(LIST)
    with engine(tmp_path) as executor:
        handed_in = submit("sweep jobs.toml -o out", shards=3, executor=executor, program=str(PROGRAM), folder=run, threads=1)
        assert len(handed_in.shards) == 3 and handed_in.result() == run / "out"
        assert handed_in.errors == [None] * 3
        assert files(run / "out") == local and len(local["results.jsonl"].splitlines()) == 8
        # Once more: nothing is left to do.
        times = [path.read_bytes() for path in sorted((run / "out" / "shards").glob("*.seconds.jsonl"))]
        submit("sweep jobs.toml --out=out", shards=3, executor=executor, program=str(PROGRAM), folder=run).result()
        assert times == [path.read_bytes() for path in sorted((run / "out" / "shards").glob("*.seconds.jsonl"))]
        assert files(run / "out") == local


def test_what_goes_wrong_is_told(tmp_path: Path) -> None:
    with ThreadPoolExecutor(2) as executor:

        def refused(words: str, command: str | list[str] = "sweep jobs.toml -o out", **options: Any) -> None:
            with pytest.raises(lodray.LodrayError, match=words):
                submit(command, **{"shards": 2, "executor": executor, "program": str(PROGRAM), "folder": tmp_path} | options)

        refused("must begin with one of sweep, error-time, stability, but is 'render a.lod'", "render a.lod")
        refused("--shard must be left out", "sweep jobs.toml -o out --shard 1/2")
        refused("--threads must be left out", ["sweep", "jobs.toml", "--threads=2", "-o", "out"])
        refused("-o FOLDER", "sweep jobs.toml")
        refused("shards: must be 1 to 100000, but is 0", shards=0)
        refused("threads: must be 1 or more, but is 0", threads=0)
        run = submit("sweep jobs.toml -o out", shards=2, executor=executor, program=str(PROGRAM), folder=tmp_path)
        with pytest.raises(lodray.LodrayError, match="shard 1/2: error: cannot read jobs.toml"):
            run.result()
        run = submit("sweep jobs.toml -o out", shards=1, executor=executor, program="/no/program", folder=tmp_path)
        with pytest.raises(lodray.LodrayError, match="/no/program"):
            run.result()
        assert all(run.errors)
