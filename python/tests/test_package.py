"""The package as it is installed: what it shows, and its examples."""

from __future__ import annotations

import inspect
import os
import subprocess
import sys
from pathlib import Path

import pytest

import lodray

EXAMPLES = sorted((Path(__file__).parent.parent / "examples").glob("*.py"))


def test_all_that_is_shown_is_explained() -> None:
    assert set(lodray.__all__) <= set(dir(lodray))
    shown = [getattr(lodray, name) for name in lodray.__all__ if name not in ("HIT", "RAY", "__version__")]
    members = [member for of in shown if inspect.isclass(of) for name, member in vars(of).items() if not name.startswith("_")]
    assert len(members) > 30
    for of in shown + members:
        assert inspect.getdoc(of), of


def test_examples_are_there() -> None:
    assert [path.stem for path in EXAMPLES] == ["exact_rays", "figure", "own_machine"]


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run(example: Path, tmp_path: Path) -> None:
    for module in ("matplotlib", "trimesh"):
        if f"import {module}" in example.read_text():
            pytest.importorskip(module)
    done = subprocess.run(
        [sys.executable, example], cwd=tmp_path, capture_output=True, text=True, timeout=600, env=os.environ | {"MPLBACKEND": "Agg"}, check=False
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout or list(tmp_path.iterdir())
