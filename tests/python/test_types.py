"""The package, its stubs, its tests and the notebooks are typed as they say: basedpyright finds nothing."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("basedpyright")


def checked(*words: object) -> dict[str, int]:
    """Counts of what it finds; what it says, where it finds anything."""
    command = [sys.executable, "-m", "basedpyright", "--outputjson", *map(str, words)]
    answer = subprocess.run(command, capture_output=True, text=True, check=False)
    try:
        found = json.loads(answer.stdout)
    except json.JSONDecodeError:
        pytest.fail(answer.stdout + answer.stderr)
    told = [f"{one['file']}:{one['range']['start']['line'] + 1}: {one['message']}" for one in found["generalDiagnostics"]]
    assert not told, "\n".join(told)
    return found["summary"]


def test_the_package_is_typed():
    summary = checked("--project", "pyrightconfig.json", "--pythonpath", sys.executable)
    assert summary["filesAnalyzed"] >= 20


def test_a_wrong_call_is_found(tmp_path: Path):
    wrong = tmp_path / "wrong.py"
    wrong.write_text(
        "import gearmesh as gm\n"
        "gm.Pair('a.h5', 'b.h5', centre_distance='94.6', torques_Nm=[1.0])\n"
        "gm.Result.open('a.h5')['te_m'].no_such_method()\n"
        "gm.Scene(7)\n"
    )
    answer = subprocess.run(
        [sys.executable, "-m", "basedpyright", "--pythonpath", sys.executable, str(wrong)],
        capture_output=True, text=True, check=False, cwd=tmp_path,
    )  # fmt: skip
    for line in (2, 3, 4):
        assert f"wrong.py:{line}:" in answer.stdout, answer.stdout


def test_the_notebooks_are_typed(tmp_path: Path):
    for path in Path("docs/notebooks").glob("*.ipynb"):
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
        (tmp_path / f"{path.stem}.py").write_text("\n".join(code), encoding="utf-8")
    rules = {
        "include": ["."],
        "typeCheckingMode": "standard",
        "reportUnusedExpression": False,
    }
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(rules))
    checked("--project", tmp_path / "pyrightconfig.json", "--pythonpath", sys.executable)
