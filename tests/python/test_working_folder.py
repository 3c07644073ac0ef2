"""Nothing that lies in the working folder runs, and no output is written through a link, whatever the command."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

import gearmesh as gm

PROGRAM = os.environ["GEARMESH_PROGRAM"]
TRAPS = "numpy scipy gmsh meshio h5py pyuff dask distributed gearmesh json os site sitecustomize usercustomize socket".split()
GEAR = """name = "small"
[tooth]
teeth = 18
module_mm = 3.0
face_width_mm = 12.0
[blank]
kind = "solid"
bore_diameter_mm = 14.0
[material]
young_GPa = 210.0
poisson = 0.3
density_kg_per_m3 = 7850.0
[reduction]
roll_stations = 4
slices = 1
flanks = ["right"]
[mesh]
flank_mm = 2.0
fillet_mm = 1.0
body_mm = 6.0
axial_mm = 6.0
"""
STUDY = """title = "masses"
scene = "scene.toml"
design = "grid"
columns = ["{column}"]
[[parameter]]
name = "mass"
keys = ["body.0.mass_kg"]
values = [1.0, 1.1]
"""
PAIR = """title = "pair"
[pair]
gear_1 = "gear.h5"
gear_2 = "gear.h5"
centre_distance_mm = 54.5
[mesh]
model = { kind = "hybrid" }
[run]
torques_Nm = [50.0]
pitches = 1
points_per_pitch = 8
"""
COMMANDS = {
    "mesh": "mesh gear.toml -o gear.vtu",
    "reduce": "reduce gear.toml -o gear.h5 --no-error-estimate",
    "modes": "modes gear.toml --up-to-Hz 20000 --shapes shapes.vtu",
    "step": "export gear.toml -o gear.step",
    "run": "run pair.toml -o pair.h5",
    "universal file": "export pair.h5 -o pair.uff",
    "record": "record pair.uff -o record --title t --source s --angle-origin o",
    "doctor": "doctor",
    "cluster": "study study.toml -o study --scheduler local",
}


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """Modules that leave a mark when they are imported, and files for each command."""
    folder = tmp_path_factory.mktemp("traps")
    for name in TRAPS:
        (folder / f"{name}.py").write_text(f"open({str(folder / 'sprung')!r}, 'a').write({name!r})\nraise SystemExit(3)\n")
    scene = gm.Scene("fe_models/scene_pendulum.toml").but({"run.end_s": 0.1})
    scene.write(folder / "scene.toml")
    column = next(name for name in scene.run(progress=False).keys() if name != "time_s")
    texts = {"gear.toml": GEAR, "pair.toml": PAIR, "study.toml": STUDY.format(column=column)}
    for name, text in texts.items():
        (folder / name).write_text(text)
    return folder


@pytest.mark.parametrize("command", COMMANDS)
def test_modules_of_the_working_folder_are_not_imported(folder, command):
    environment = {**os.environ, "GEARMESH_PYTHON": sys.executable, "PYTHONPATH": str(folder)}
    words = [PROGRAM, *COMMANDS[command].split()]
    run = subprocess.run(words, cwd=folder, env=environment, capture_output=True, text=True, check=False)
    sprung = folder / "sprung"
    assert not sprung.exists(), f"{sprung.read_text()} was imported"
    # A record of this export lacks what only its user knows; that its file was read is what matters here.
    assert run.returncode == 0 or (command == "record" and "pair.uff" in run.stderr), run.stderr


def linked(path: Path) -> Path:
    """Makes a link of this name; returns what it points to, a file that is not there yet."""
    path.parent.mkdir(parents=True, exist_ok=True)
    target = path.parent / f"target-of-{path.name}"
    path.symlink_to(target)
    return target


@pytest.mark.parametrize(
    ("link", "command"),
    [
        ("o.h5", "run scene.toml -o o.h5"),
        ("o.h5.part/rows.log", "run scene.toml -o o.h5"),
        ("o.vtu", "mesh gear.toml -o o.vtu"),
        ("o.step", "export gear.toml -o o.step"),
        ("out/study.csv", "study study.toml -o out"),
        ("out/study.html", "study study.toml -o out"),
        ("out/cluster.log", "study study.toml -o out --scheduler local"),
        ("man/gearmesh-run.1", "man -o man"),
        ("start/pair.toml", "init pair -o start"),
    ],
)
def test_no_output_is_written_through_a_link(folder, tmp_path, link, command):
    for name in ("scene.toml", "gear.toml", "study.toml"):
        (tmp_path / name).write_bytes((folder / name).read_bytes())
    target = linked(tmp_path / link)
    environment = {**os.environ, "GEARMESH_PYTHON": sys.executable}
    words = [PROGRAM, *command.split()]
    run = subprocess.run(words, cwd=tmp_path, env=environment, capture_output=True, text=True, check=False)
    assert not target.exists(), run
    assert run.returncode != 0 and Path(link).name in run.stderr, run.stderr
    assert "link" in run.stderr or "there already" in run.stderr, run.stderr


def test_what_python_writes_follows_no_link(tmp_path):
    gear = gm.Gear("small", teeth=18, module_mm=3, face_width_mm=12, bore_diameter_mm=14, material=gm.STEEL)
    scene = gm.Scene("fe_models/scene_pendulum.toml")
    for name, write in (("gear.toml", gear.write), ("scene.toml", scene.write)):
        target = linked(tmp_path / name)
        with pytest.raises(gm.InputError, match="link"):
            write(tmp_path / name)
        assert not target.exists()
