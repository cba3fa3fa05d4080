"""The package as it is installed: what it shows, and its examples, which are notebooks."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import lodray

EXAMPLES = sorted((Path(__file__).parent.parent / "examples").glob("*.ipynb"))


def test_all_that_is_shown_is_explained() -> None:
    assert set(lodray.__all__) <= set(dir(lodray))
    shown = [getattr(lodray, name) for name in lodray.__all__ if name not in ("HIT", "RAY", "__version__")]
    members = [member for of in shown if inspect.isclass(of) for name, member in vars(of).items() if not name.startswith("_")]
    assert len(members) > 30
    for of in shown + members:
        assert inspect.getdoc(of), of


def test_help_has_all_fields_and_what_a_miss_has() -> None:
    said = lodray.__doc__ or ""
    for of in (lodray.RAY, lodray.HIT):
        assert all(re.search(rf"\b{name}\b", said) for name in of.names or ()) and f"({of.itemsize} bytes)" in said
    assert "fork" in said and "hits[\"tree\"] >= 0" in said
    miss = lodray.Scene.generate("sphere", levels=1, base=8).cast([[0, 0, 9]], [0, 1, 0])[0]
    for name in lodray.HIT.names or ():
        shown = re.search(rf"^ +(?:\w+, )*{name}\b.*\((inf|-1|nan)\)$", said, re.MULTILINE)
        assert shown and np.array_equal(np.unique(miss[name]), [float(shown[1])], equal_nan=True), name


def test_the_readme_runs(capsys: pytest.CaptureFixture[str]) -> None:
    text = (Path(__file__).parent.parent / "README.md").read_text()
    (code,) = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    exec(code, {})
    assert capsys.readouterr().out == re.findall(r"# (\[.*\])\n", code)[0] + "\n"


def test_submodules_are_there_when_they_are_asked_for() -> None:
    program = """
import sys, lodray
assert not any(name.startswith(("lodray.", "trimesh")) and name != "lodray._lodray" for name in sys.modules)
assert lodray.trimesh.RayMeshIntersector and lodray.cluster.submit and "trimesh" not in sys.modules
assert not hasattr(lodray, "nothing")
"""
    subprocess.run([sys.executable, "-c", program], check=True)


def test_examples_are_there() -> None:
    assert [path.stem for path in EXAMPLES] == ["exact_rays", "figure", "own_machine"]


def code(path: Path) -> list[str]:
    nbformat = pytest.importorskip("nbformat")
    book = nbformat.read(path, as_version=4)
    return ["".join(cell.source) for cell in book.cells if cell.cell_type == "code"]


def test_the_figure_has_ten_lines() -> None:
    first = code(EXAMPLES[1])[0]
    assert "simulate" in first and len(first.splitlines()) == 10


@pytest.mark.parametrize("example", EXAMPLES, ids=lambda path: path.stem)
def test_examples_run(example: Path, tmp_path: Path) -> None:
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    for module in ("matplotlib", "pandas", "trimesh"):
        if f"import {module}" in "\n".join(code(example)):
            pytest.importorskip(module)
    book = nbformat.read(example, as_version=4)
    nbformat.validate(book)
    # What is kept has no results that could grow old.
    assert all(not cell.outputs and cell.execution_count is None for cell in book.cells if cell.cell_type == "code")
    nbclient.NotebookClient(book, timeout=600, resources={"metadata": {"path": str(tmp_path)}}).execute()
    outputs = [output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs]
    kinds = {kind for output in outputs for kind in output.get("data", {})}
    said = "".join(output.get("text", "") + output.get("data", {}).get("text/plain", "") for output in outputs)
    if example.stem == "exact_rays":
        assert "'lodray': 0}" in said and "True, False" in said
    else:
        assert "image/png" in kinds
