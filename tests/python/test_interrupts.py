"""Ctrl-C ends a reduction, a pair's run and a study soon, and leaves no half file; no function of the package starts the program for what it can do itself."""

import signal
import time
from pathlib import Path

import pytest

import gearmesh as gm
from interruption import interrupt_once

COARSE = dict(flank_mm=2.0, fillet_mm=1.0, body_mm=6.0, plane_strain=True)
PENDULUM = "fe_models/scene_pendulum.toml"

SOON_S = 10.0
"""A call that has heard Ctrl-C looks at it every 50 ms and waits half a second for its work; the rest is for a busy machine."""


@pytest.fixture(autouse=True)
def ctrl_c_is_heard():
    """Where tests are started in the background of a script, Ctrl-C is ignored from the start."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture(scope="module")
def pinion():
    return gm.Gear("pinion", teeth=23, module_mm=3, face_width_mm=20, material=gm.STEEL, mesh=COARSE, bore_diameter_mm=25)


@pytest.fixture(scope="module")
def models(pinion, tmp_path_factory):
    folder = tmp_path_factory.mktemp("models")
    wheel = pinion.but(name="wheel", teeth=40, bore_diameter_mm=40)
    options = dict(error_estimate=False, progress=False)
    return [gear.reduce(folder / f"{gear.name}.h5", **options) for gear in (pinion, wheel)]


class _Clock:
    """When Ctrl-C was sent."""

    def __init__(self, condition):
        self.sent_s = 0.0
        self._condition = condition

    def __call__(self) -> bool:
        if not self._condition():
            return False
        self.sent_s = time.monotonic()
        return True

    def took_s(self) -> float:
        assert self.sent_s > 0.0, "it ended before it was interrupted"
        return time.monotonic() - self.sent_s


def test_a_reduction_ends_on_ctrl_c(pinion, tmp_path):
    # Fine enough for minutes.
    fine = pinion.but(mesh=dict(flank_mm=0.4, fillet_mm=0.25, body_mm=2.0))
    stages = []
    clock = _Clock(lambda: any(stage != "meshing" for stage, _, _ in stages))
    interrupt_once(clock)
    with pytest.raises(KeyboardInterrupt):
        fine.reduce(tmp_path / "fine.h5", error_estimate=False, progress=lambda *told: stages.append(told))
    assert clock.took_s() < SOON_S
    assert list(tmp_path.iterdir()) == []


def test_a_pair_ends_on_ctrl_c(models, tmp_path):
    # Half a million positions.
    pair = gm.Pair(*models, centre_distance_mm=94.6, torques_Nm=[50, 100], pitches=23 * 40, points_per_pitch=300)
    begun = time.monotonic()
    clock = _Clock(lambda: time.monotonic() - begun > 0.5)
    interrupt_once(clock)
    with pytest.raises(KeyboardInterrupt):
        pair.run(tmp_path / "pair.h5", progress=False)
    assert clock.took_s() < SOON_S
    assert list(tmp_path.iterdir()) == []


def test_a_study_ends_on_ctrl_c_and_goes_on(tmp_path):
    scene = gm.Scene(PENDULUM).but({"solver.step_s": 1e-6})
    column = next(name for name in gm.Scene(PENDULUM).run().keys() if name != "time_s")
    parameter = dict(name="end", keys=["run.end_s"], values=[0.9, 1.0])
    tables = dict(title="lengths", scene=scene, columns=[column], parameter=[parameter])
    out = tmp_path / "out"
    clock = _Clock(lambda: any(out.glob("*.part")))
    interrupt_once(clock)
    with pytest.raises(KeyboardInterrupt):
        gm.study(tables, out, progress=False)
    assert clock.took_s() < SOON_S
    assert not list(out.glob("*.h5")) and list(out.glob("*.part"))


def test_no_function_starts_the_program_for_what_it_does_itself(pinion, models, tmp_path, monkeypatch):
    monkeypatch.setenv("GEARMESH_PROGRAM", str(tmp_path / "there is none"))
    with pytest.raises(FileNotFoundError):
        gm.program("--version")
    pair = gm.Pair(*models, centre_distance_mm=94.6, torques_Nm=[50, 100], points_per_pitch=12)
    result = pair.run(tmp_path / "pair.h5", progress=False)
    result.report(tmp_path / "page.html")
    result.export(tmp_path / "curves.csv", table="curves")
    gm.check(tmp_path / "pair.h5")
    assert gm.compare(result, "reference/pair_a")["comparisons"]
    assert gm.compliance(models[0], tooth=0, radius_mm=34.0, line_load_N_per_mm=100, half_width_mm=0.1)["rows"]
    gm.mesh(pinion, tmp_path / "pinion.vtu")
    gm.import_rexs("fe_models/gearbox_three_stage.rexs", tmp_path / "box", run=False)
    bevel = gm.BevelPair("fe_models/bevel_20_20.toml")
    assert bevel.design()["pinion"] and bevel.tca(tmp_path / "tca.html")["path"]
    with pytest.raises(gm.InputError, match="neither model has a gauge"):
        result.recover(tmp_path / "strain.h5")
    with pytest.raises(gm.InputError, match="unknown field `colour`"):
        result.report(tmp_path / "page.html", colour="red")
    written = {path.name for path in Path(tmp_path).iterdir()}
    assert {"page.html", "curves.csv", "pinion.vtu", "tca.html"} <= written


def test_a_bevel_gear_is_reduced_as_any_other(tmp_path):
    paths = gm.init("bevel", tmp_path)
    file = next(path for path in paths if path.name == "bevel_pinion.toml")
    with pytest.raises(gm.InputError, match="name the model"):
        gm.reduce(file)
    stages = []
    interrupt_once(lambda: len({stage for stage, _, _ in stages}) > 1)
    with pytest.raises(KeyboardInterrupt):
        gm.reduce(file, tmp_path / "pinion.h5", error_estimate=False, progress=lambda *told: stages.append(told))
    assert not (tmp_path / "pinion.h5").exists()
