"""What the program can, the package can: each command through its function."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest

import gearmesh as gm

COARSE = dict(flank_mm=2.0, fillet_mm=1.0, body_mm=6.0, plane_strain=True)
PENDULUM = "fe_models/scene_pendulum.toml"


@pytest.fixture(scope="module")
def pinion():
    keywords = dict(module_mm=3, face_width_mm=20, material=gm.STEEL, mesh=COARSE)
    return gm.Gear("pinion", teeth=23, bore_diameter_mm=25, **keywords)


@pytest.fixture(scope="module")
def models(pinion, tmp_path_factory):
    folder = tmp_path_factory.mktemp("models")
    wheel = pinion.but(name="wheel", teeth=40, bore_diameter_mm=40)
    options = dict(error_estimate=False, progress=False)
    return [gear.reduce(folder / f"{gear.name}.h5", **options) for gear in (pinion, wheel)]


@pytest.fixture(scope="module")
def pair(models):
    return gm.Pair(*models, centre_distance_mm=94.6, torques_Nm=[50, 100], points_per_pitch=12)


def test_every_command_stands_in_the_guide():
    listed = re.findall(r"^  ([a-z-]+) ", gm.program("--help").split("Commands:")[1].split("Options:")[0], re.MULTILINE)
    commands = set(listed) - {"help"}
    assert len(commands) > 20
    rows = [line.split("|") for line in Path("docs/python.md").read_text().splitlines() if line.startswith("| ")]
    named = {name for row in rows if len(row) > 4 for name in re.findall(r"`([a-z-]+)`", row[3])}
    # Of the shell, for which Python has no use, and a page that stays open until it is closed.
    assert commands - named <= {"completions", "man", "studio"}, commands - named


def test_a_relief_is_optimised(pair, tmp_path):
    keys = ["gear_1.microgeometry.tip_relief_um", "gear_2.microgeometry.tip_relief_um"]
    flanks = {"gear_1.microgeometry": dict(tip_relief_um=0, tip_relief_start_diameter_mm=72)}
    flanks["gear_2.microgeometry"] = dict(tip_relief_um=0, tip_relief_start_diameter_mm=123)
    scene = pair.but(flanks)
    term = [dict(column="te_peak_to_peak_um", torque_Nm=100.0)]
    tables = dict(
        title="relief",
        scene=scene,
        trials=20,
        variable=[{"name": "relief", "keys": keys, "from": 0.0, "to": 30.0}],
        objective=[dict(name="te", term=term)],
    )
    told = []
    found = gm.optimise(tables, tmp_path / "out", progress=lambda *stand: told.append(stand))
    best = found.best
    assert {stage for stage, _, _ in told} == {"search"} and 0.0 < told[-1][1] <= told[-1][2]
    relieved = scene.but(dict.fromkeys(keys, best["variables"]["relief"])).run(progress=False)
    ranges = relieved.to_pandas("torques")["te_peak_to_peak_m"]
    assert 1e6 * ranges[1] == pytest.approx(best["objectives"]["te"], rel=1e-9)
    assert found.before is not None and best["objectives"]["te"] < 0.7 * found.before[0]
    assert len(found.to_pandas("tried")) == found.tried
    assert found.plot().get_xlabel() == "relief"


def test_the_program_is_told_to_stop(pair, tmp_path):
    """Ctrl-C while it works, and a function for the progress that fails: the program has ended when the call does."""
    pair.write(tmp_path / "pair.toml")
    words = ("accuracy", tmp_path / "pair.toml", "--columns", "te_mean_um", "-o", tmp_path / "page.html")
    with pytest.raises(ZeroDivisionError):
        gm.program(*words, progress=lambda *told: 1 / 0)
    ran = []

    def interrupted(*told):
        ran.append(told)
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        gm.accuracy(pair, ["te_mean_um"], progress=interrupted)
    assert len(ran) == 1 and ran[0][0] == "settings"
    assert not (tmp_path / "page.html").exists()


def test_models_that_change_are_read_again(models, pair, tmp_path):
    path = tmp_path / "pinion.h5"
    path.write_bytes(models[0].path.read_bytes())
    scene = pair.but({"pair.gear_1": str(path)})
    first = scene.run(progress=False)["te_m"]
    assert np.array_equal(scene.run(progress=False)["te_m"], first)
    softer = models[0].gear.but(material=dict(young_GPa=103.0))
    softer.reduce(path, error_estimate=False, progress=False)
    assert scene.run(progress=False)["te_m"].mean() < 1.2 * first.mean()


def test_records_are_read_and_compared(pair):
    record = gm.Record("reference/pair_a")
    assert record.kind == "computed" and record.keys()[0] == "angle_deg"
    assert (np.diff(record["angle_deg"]) > 0.0).all()
    with pytest.raises(KeyError, match="it has angle_deg"):
        record["angle"]
    found = gm.compare(pair.run(progress=False), record)
    assert found["record"] == record.title and found["comparisons"]
    # An option of multibody results: refused in the program's words.
    with pytest.raises(gm.InputError, match="--from-s is for results of multibody scenes"):
        gm.compare(pair.run(progress=False), record, from_s=0.1)


def test_columns_are_analysed():
    result = gm.Scene(PENDULUM).run(progress=False)
    name = next(name for name in result.keys() if name.endswith("angular_velocity_z_rad_per_s"))
    found = result.signal("statistics", name, from_s=0.0)
    figures = {one["name"]: one["value"] for one in found["figures"]}
    assert figures["peak to peak"] == pytest.approx(np.ptp(result[name]), rel=1e-3)
    assert result.signal("spectrum", name, peaks=3)
    with pytest.raises(gm.InputError):
        result.signal("spectrum", "nothing")


def test_gears_are_meshed_and_looked_at(pinion, models, tmp_path):
    gm.mesh(pinion, tmp_path / "pinion.vtu", length_unit="mm")
    assert (tmp_path / "pinion.vtu").stat().st_size > 10_000
    found = gm.compliance(models[0], tooth=0, radius_mm=[34.0, 35.0], line_load_N_per_mm=100, half_width_mm=0.1)
    assert found
    with pytest.raises(gm.InputError, match="tooth"):
        gm.compliance(models[0], tooth=99, radius_mm=34.0, line_load_N_per_mm=100, half_width_mm=0.1)


def test_files_to_begin_with_are_written_and_checked(tmp_path):
    paths = gm.init("pair", tmp_path)
    assert {path.name for path in paths} == {"pinion.toml", "wheel.toml", "pair.toml", "drive.toml"}
    assert gm.check(tmp_path / "pinion.toml")["warnings"] == []
    slip = tmp_path / "slip.toml"
    slip.write_text((tmp_path / "pinion.toml").read_text() + "[microgeometry]\nlead_crowning_um = 0.004\n")
    assert "lead_crowning_um: 0.004 is unusual" in gm.check(slip)["warnings"][0]
    with pytest.raises(gm.InputError, match="there already"):
        gm.init("pair", tmp_path)
    bevel = gm.init("bevel", tmp_path)
    assert {path.name for path in bevel} == {"bevel_pair.toml", "bevel_pinion.toml", "bevel_gear.toml", "bevel_drive.toml"}
    assert gm.check(tmp_path / "bevel_pair.toml")
    assert gm.doctor()


def test_a_gearbox_is_imported(tmp_path):
    taken = gm.import_rexs("fe_models/gearbox_three_stage.rexs", tmp_path)
    assert taken and list(tmp_path.glob("*.toml"))


def test_the_programs_messages_have_no_colours(monkeypatch):
    # As notebooks set it.
    monkeypatch.setenv("CLICOLOR_FORCE", "1")
    monkeypatch.setenv("FORCE_COLOR", "1")
    with pytest.raises(gm.InputError) as caught:
        gm.program("check", "none.toml")
    assert "\x1b" not in str(caught.value)


def test_a_result_is_a_table_in_a_notebook(pair):
    page = pair.run(progress=False)._repr_html_()
    assert page.count("<tr>") == 3 and "TE pk-pk µm" in page
    page = gm.Scene(PENDULUM).run(progress=False)._repr_html_()
    assert "Pendulum" in page and "<Result" not in page


def test_a_missing_package_is_told_with_the_line_that_installs_it(pair, monkeypatch):
    monkeypatch.setitem(sys.modules, "pandas", None)
    with pytest.raises(ImportError, match=r"pip install 'gearmesh\[tables\]'"):
        pair.run(progress=False).to_pandas()
