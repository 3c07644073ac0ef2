"""The package, its stubs, its tests and the notebooks are typed as they say: basedpyright finds nothing."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("basedpyright")


def found_in(project: Path) -> tuple[list[str], int]:
    """What it finds, and in how many files it has looked."""
    command = [sys.executable, "-m", "basedpyright", "--outputjson", "--pythonpath", sys.executable]
    answer = subprocess.run([*command, "--project", str(project)], capture_output=True, text=True, check=False)
    try:
        found = json.loads(answer.stdout)
    except json.JSONDecodeError:
        pytest.fail(answer.stdout + answer.stderr)
    complaints = found["generalDiagnostics"]
    told = [f"{Path(one['file']).name}:{one['range']['start']['line'] + 1}: {one['message']}" for one in complaints]
    return told, found["summary"]["filesAnalyzed"]


def test_the_package_is_typed():
    told, files = found_in(Path("pyrightconfig.json"))
    assert not told, "\n".join(told)
    assert files >= 20


def test_the_notebooks_are_typed_and_a_wrong_call_is_found(tmp_path: Path):
    for path in Path("docs/notebooks").glob("*.ipynb"):
        cells = json.loads(path.read_text(encoding="utf-8"))["cells"]
        code = ["".join(cell["source"]) for cell in cells if cell["cell_type"] == "code"]
        (tmp_path / f"{path.stem}.py").write_text("\n".join(code), encoding="utf-8")
    (tmp_path / "wrong.py").write_text(
        "import gearmesh as gm\n"
        "gm.Pair('a.h5', 'b.h5', centre_distance_mm='94.6', torques_Nm=[1.0])\n"
        "gm.Result.open('a.h5')['te_m'].no_such_method()\n"
        "gm.Scene(7)\n"
    )
    rules = {"include": ["."], "typeCheckingMode": "standard", "reportUnusedExpression": False}
    (tmp_path / "pyrightconfig.json").write_text(json.dumps(rules))
    told, files = found_in(tmp_path / "pyrightconfig.json")
    assert files >= 4
    wrong = {line.split(":")[1] for line in told if line.startswith("wrong.py:")}
    assert wrong == {"2", "3", "4"}, told
    others = [line for line in told if not line.startswith("wrong.py:")]
    assert not others, "\n".join(others)
