"""The notebooks of docs/notebooks run from top to bottom. They are stored without outputs; the executed copy is not kept."""

import json
import os
from pathlib import Path

import pytest

nbformat = pytest.importorskip("nbformat")
from nbclient import NotebookClient  # noqa: E402  (needs nbformat)

NOTEBOOKS = sorted(Path("docs/notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs(path, tmp_path, monkeypatch):
    monkeypatch.setenv("GEARMESH_CACHE", str(tmp_path / "cache"))
    monkeypatch.setenv("IPYTHONDIR", str(tmp_path / "ipython"))
    monkeypatch.setenv("MPLBACKEND", "module://matplotlib_inline.backend_inline")
    book = nbformat.read(path, as_version=4)
    stored = json.dumps(book)
    assert all(not cell.get("outputs") for cell in book.cells), f"{path} is stored with outputs: clear them"
    NotebookClient(book, timeout=300, kernel_name="python3", resources={"metadata": {"path": str(tmp_path)}}).execute()
    pictures = [
        output
        for cell in book.cells
        for output in cell.get("outputs", [])
        if "image/png" in output.get("data", {})
    ]
    assert pictures and stored == json.dumps(nbformat.read(path, as_version=4))
    kept = os.environ.get("GEARMESH_KEEP_NOTEBOOKS")
    if kept:
        nbformat.write(book, Path(kept) / path.name)


def test_there_are_notebooks():
    assert [path.stem for path in NOTEBOOKS] == ["campbell_map", "first_pair", "relief_study"]
