"""The package as it is installed: what it shows, and its examples, which are notebooks."""

from __future__ import annotations

import inspect
from pathlib import Path

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
