"""The package gearmesh: from the definition of a gear to curves, in one process. Coarse gears."""

import json
import pickle
import shutil
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

import gearmesh as gm
from interruption import interrupt_once

# Plane strain and long elements: reduced in a second.
COARSE = dict(
    module_mm=3, face_width_mm=20, material=gm.STEEL, mesh=dict(flank_mm=2.0, fillet_mm=1.0, body_mm=6.0, plane_strain=True)
)
PENDULUM = "fe_models/scene_pendulum.toml"


@pytest.fixture(scope="module")
def pinion():
    return gm.Gear("pinion", teeth=23, bore_diameter_mm=25, **COARSE)


@pytest.fixture(scope="module")
def models(pinion, tmp_path_factory):
    folder = tmp_path_factory.mktemp("models")
    wheel = pinion.but(name="wheel", teeth=40, bore_diameter_mm=40)
    options = dict(error_estimate=False, progress=False)
    return [gear.reduce(folder / f"{gear.name}.h5", **options) for gear in (pinion, wheel)]


@pytest.fixture(scope="module")
def pair(models):
    return gm.Pair(*models, centre_distance_mm=94.6, torques_Nm=[50, 100], points_per_pitch=12)


@pytest.fixture(scope="module")
def result(pair):
    return pair.run()


def test_keywords_stand_where_the_file_has_them(pinion):
    tables = pinion.tables
    assert tables["tooth"] == {"teeth": 23, "module_mm": 3, "face_width_mm": 20}
    assert tables["blank"] == {"kind": "solid", "bore_diameter_mm": 25}
    assert gm.Gear.from_toml(pinion.toml).tables == tables
    # d = m z, addendum 1.
    assert pinion.reference_radius_m == pytest.approx(0.5 * 3e-3 * 23, rel=1e-12)
    assert pinion.tip_radius_m == pytest.approx(0.5 * 3e-3 * 25, rel=1e-12)
    assert "23 teeth" in repr(pinion)


def test_a_wrong_keyword_is_told_with_near_names():
    with pytest.raises(TypeError, match="`modul_mm`; near are module_mm"):
        gm.Gear("gear", teeth=23, modul_mm=3)


def test_a_wrong_gear_is_told_by_its_key(tmp_path):
    with pytest.raises(gm.InputError) as caught:
        gm.Gear("gear", teeth=-3, bore_diameter_mm=25, **COARSE)
    assert isinstance(caught.value, ValueError)
    assert caught.value.key == "tooth.teeth"
    file = tmp_path / "gear.toml"
    file.write_text('name = "x"\n[tooth]\nteeth = "many"\n')
    with pytest.raises(gm.InputError, match=rf"{file}:3: ") as caught:
        gm.Gear.from_file(file)
    assert (caught.value.file, caught.value.line) == (str(file), 3)
    with pytest.raises(FileNotFoundError):
        gm.Gear.from_file(tmp_path / "none.toml")


def test_a_reduced_gear_knows_its_gear(models, pinion):
    assert [model.teeth for model in models] == [23, 40]
    assert models[0].gear.tables == pinion.tables
    assert models[0]["c_hub"].shape[2] == 23
    assert "degrees of freedom" in repr(models[0])


def test_the_cache_is_asked_before_a_gear_is_reduced_again(pinion, models, tmp_path, monkeypatch):
    monkeypatch.setenv("GEARMESH_CACHE", str(tmp_path))
    first = gm.reduce(pinion, error_estimate=False, progress=False)
    made = first.path.stat().st_mtime_ns
    assert gm.reduce(pinion.tables, error_estimate=False, progress=False).path.stat().st_mtime_ns == made
    assert np.array_equal(first["c_hub"], models[0]["c_hub"])
    other = gm.reduce(pinion.but(bore_diameter_mm=26), error_estimate=False, progress=False)
    assert other.path != first.path


def test_progress_is_told(pinion, tmp_path):
    stages = []
    gm.reduce(pinion, tmp_path / "model.h5", error_estimate=False, progress=lambda *told: stages.append(told))
    assert len({stage for stage, _, _ in stages}) >= 2
    with pytest.raises(ZeroDivisionError):
        gm.reduce(pinion, tmp_path / "none.h5", progress=lambda *told: 1 / 0)
    assert not (tmp_path / "none.h5").exists()


def test_the_program_gives_the_same_curves(pair, result, tmp_path):
    pair.write(tmp_path / "pair.toml")
    printed = gm.program("run", tmp_path / "pair.toml", "-o", tmp_path / "pair.h5")
    stored = gm.Result.open(tmp_path / "pair.h5")
    assert stored.keys() == result.keys()
    for name in ("te_m", "force_N", "stiffness_tangent_N_per_m"):
        assert np.array_equal(stored[name], result[name]), name
    # The same figures: means of whole periods, peaks also between the even positions.
    torques = result.tables()["torques"]
    for name in ("te_mean_m", "te_peak_to_peak_m"):
        assert [row[name] for row in printed["rows"]] == pytest.approx(list(torques[name]), rel=1e-12), name
    assert (torques["te_peak_to_peak_m"] >= np.ptp(result["te_m"], axis=1)).all()
    shown = f"TE mean {1e6 * torques['te_mean_m'][0]:.3f} um, peak to peak {1e6 * torques['te_peak_to_peak_m'][0]:.3f} um"
    assert shown in repr(result)


def test_arrays_are_the_memory_of_the_result(result, tmp_path):
    again = result._native.data_sets()
    for name in ("te_m", "force_N", "pair_count", "angle_rad"):
        assert np.shares_memory(again[name][0], result[name]), name
        # It belongs to what has computed it, which lives as long as the array.
        assert not result[name].flags.owndata and not result[name].flags.writeable
    kept, expected = result["te_m"], result["te_m"].copy()
    result.save(tmp_path / "result.h5")
    other = gm.Result.open(tmp_path / "result.h5")
    opened = other["te_m"]
    del other
    assert np.array_equal(opened, expected) and np.array_equal(kept, expected)
    with pytest.raises(ValueError, match="read-only"):
        kept[0, 0] = 1.0
    assert np.shares_memory(result.to_xarray()["te_m"].values, kept)


def test_data_sets_say_what_they_are(result):
    assert result["te_m"].shape == (2, 12)
    assert result.axes("force_N") == ("torque", "angle", "line", "slice")
    assert (result.unit("te_m"), result.unit("pressure_Pa")) == ("m", "Pa")
    assert "negative under load" in result.describe("te_m")
    # Σ F r_b = T: the torque on gear 2 is that of the forces.
    base_radius_m = 0.5 * 3e-3 * 40 * np.cos(np.radians(20.0))
    balance = result["force_N"].sum(axis=(2, 3)) * base_radius_m / result["torque_Nm"][:, None]
    assert balance == pytest.approx(1.0, abs=2e-3)
    with pytest.raises(KeyError, match="did you mean te_m.*it has .*te_m"):
        result["te_mm"]
    with pytest.raises(gm.InputError, match="signal is for runs in time"):
        result.signal("spectrum", "te_m")


def test_a_result_goes_to_other_processes(result):
    other = pickle.loads(pickle.dumps(result))
    assert np.array_equal(other["te_m"], result["te_m"]) and repr(other) == repr(result)
    # It stands in a file of its own, and goes on from there.
    again = pickle.loads(pickle.dumps(other))
    assert np.array_equal(again["force_N"], result["force_N"])


def test_what_is_read_is_what_was_saved(result, tmp_path):
    saved = result.save(tmp_path / "saved.h5")
    assert np.array_equal(saved["pressure_Pa"], result["pressure_Pa"])
    assert "peak to peak" in repr(saved)


def test_a_relief_needs_no_further_reduction(models, result):
    flanks = dict(tip_relief_um=20, tip_relief_start_diameter_mm=72)
    relieved = gm.Pair(
        *models, centre_distance_mm=94.6, torques_Nm=100, points_per_pitch=12, gear_1_flanks=flanks
    )
    te = relieved.run()["te_m"]
    assert te.shape == (1, 12)
    # Removed material lets the wheel fall behind somewhere, nowhere ahead.
    assert te.min() < result["te_m"][1].min() - 1e-7
    assert (te <= result["te_m"][1] + 1e-9).all()


def test_flanks_of_an_unusual_size_are_warned_of(models):
    for flanks, key in [(dict(tip_relief_um=0.02, tip_relief_start_diameter_mm=72), "tip_relief_um"), (dict(lead_crowning_um=0.004), "lead_crowning_um")]:
        pair = gm.Pair(*models, centre_distance_mm=94.6, torques_Nm=100, points_per_pitch=12, gear_1_flanks=flanks)
        assert any(f"{key}: " in text and "is unusual" in text for text in pair.run().warnings), key


def test_what_is_no_model_and_no_number_is_told(pinion, models):
    with pytest.raises(TypeError, match="gear_2: a Gear is not reduced yet"):
        gm.Pair(models[0], pinion, centre_distance_mm=94.6, torques_Nm=[50])
    with pytest.raises(gm.InputError, match="tooth.profile_shift: found nan"):
        pinion.but(profile_shift=float("nan"))
    for value, found in [({1, 2}, "a Python set"), (b"x", "a Python bytes"), ([1.0, None], "None")]:
        with pytest.raises(gm.InputError, match=f"tooth.profile_shift.*: found {found}"):
            pinion.but(profile_shift=value)
    distance_mm: Any = np.float32(94.6)
    torque_Nm: Any = np.int64(50)
    one = gm.Pair(*models, centre_distance_mm=distance_mm, torques_Nm=torque_Nm)
    assert one.tables["run"]["torques_Nm"] == [50.0]


def test_a_scene_is_changed_by_its_keys(pair):
    assert pair.but({"run.torques_Nm": [75.0]}).tables["run"]["torques_Nm"] == [75.0]
    assert pair.tables["run"]["torques_Nm"] == [50.0, 100.0]
    with pytest.raises(gm.InputError, match="run.points_per_pitch"):
        pair.but({"run.points_per_pitch": -1})
    assert any("contact ratio" in line for line in pair.plan())


def test_a_multibody_scene_runs_without_a_file(tmp_path):
    scene = gm.Scene(PENDULUM)
    result = scene.run()
    assert result.kind == "transient"
    time_s = result["time_s"]
    assert time_s[0] == 0.0 and (np.diff(time_s) > 0.0).all()
    # The file lives as long as the result.
    path = result.path
    assert path is not None
    saved = result.save(tmp_path / "saved.h5")
    del result
    assert not path.exists()
    assert np.array_equal(saved["time_s"], time_s)


def test_ctrl_c_leaves_a_run_that_goes_on(tmp_path):
    scene = gm.Scene(PENDULUM).but({"solver.step_s": 1e-6})
    output = tmp_path / "run.h5"
    part = tmp_path / "run.h5.part"
    interrupt_once(part.exists)
    with pytest.raises(KeyboardInterrupt):
        scene.run(output)
    assert not output.exists() and part.exists()


def test_pictures_are_drawn(result):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    axes = result.plot()
    drawn = [line.get_ydata() for line in axes.get_lines()]
    assert np.array_equal(np.array(drawn), 1e6 * result["te_m"])
    assert axes.get_ylabel() == "te [um]"
    with pytest.raises(gm.InputError, match="a curve goes over angle"):
        result.plot("force_N")


def test_the_program_answers_with_its_messages(tmp_path):
    bearing = gm.Bearing("fe_models/bearing_seed_000.toml")
    found = bearing.rest([0.0, 0.0, 500.0], speed_rpm=6000)
    stiffness = np.array(found["stiffness_SI"])
    assert stiffness.shape == (5, 5) and stiffness[2, 2] > 0.0
    assert bearing.frequencies(speed_rpm=6000) != bearing.frequencies(speed_rpm=3000)
    with pytest.raises(gm.InputError, match="--load-N"):
        bearing.rest([0.0, 0.0])
    assert gm.BevelPair("fe_models/bevel_20_20.toml").tca(tmp_path / "tca.html")
    assert (tmp_path / "tca.html").stat().st_size > 10_000
    with pytest.raises(gm.InputError, match="none.toml"):
        gm.program("plan", tmp_path / "none.toml")


def test_a_study_goes_on_where_it_was(tmp_path):
    scene = gm.Scene(PENDULUM)
    column = next(name for name in scene.run().keys() if name != "time_s")
    key = "run.end_s"
    tables = dict(
        title="lengths", scene=scene, columns=[column], parameter=[dict(name="end", keys=[key], values=[0.01, 0.02])]
    )
    found = gm.study(tables, tmp_path / "out")
    assert len(found.cases) == 3 and len(found.rows) == 3
    assert "lengths" in (tmp_path / "out" / "study.html").read_text(encoding="utf-8")
    files = {path.name: path.stat().st_mtime_ns for path in (tmp_path / "out").glob("*.h5")}
    gm.Study(tables).run(tmp_path / "out")
    assert {path.name: path.stat().st_mtime_ns for path in (tmp_path / "out").glob("*.h5")} == files
    with pytest.raises(gm.InputError):
        gm.study({**tables, "parameter": [dict(name="end", keys=["run.end"], values=[1.0])]}, tmp_path / "wrong")


def test_a_scene_without_a_file_gives_what_its_file_gives(models, pair, result, tmp_path):
    """A pair of gear objects, and a system of a dict with gear objects in it, against the files that the program runs."""
    pair.write(tmp_path / "pair.toml")
    gm.program("run", tmp_path / "pair.toml", "-o", tmp_path / "pair.h5")
    bodies = [{"name": name, "gear": model, "position_mm": [x, 0.0, 0.0]} for name, model, x in zip(("a", "b"), models, (0.0, 94.6))]
    scene = gm.Scene(
        {
            "title": "two gears",
            "run": {"kind": "transient", "end_s": np.float64(2e-5)},
            "solver": {"step_s": 1e-6},
            "output": {"interval_s": 1e-6},
            "body": bodies,
            "joint": [{"name": body["name"], "kind": "revolute", "body_2": body["name"]} for body in bodies],
            "motion": [{"joint": "a", "speed_rpm": -1500.0}],
            "load": [{"body": "b", "torque_Nm": -100.0}],
            "gear_mesh": [{"name": "mesh", "gear_1": "a", "gear_2": "b", "model": {"kind": "hybrid"}}],
        }
    )
    scene.write(tmp_path / "system.toml")
    gm.program("run", tmp_path / "system.toml", "-o", tmp_path / "system.h5")
    for name, found in (("pair", result), ("system", scene.run())):
        stored = gm.Result.open(tmp_path / f"{name}.h5")
        assert stored.keys() == found.keys()
        for key in set(found.keys()) - {"seconds"}:
            assert np.array_equal(stored[key], found[key], equal_nan=True), (name, key)


def test_complaints_about_tables_name_the_path_of_the_key(pair):
    with pytest.raises(gm.InputError) as caught:
        pair.but({"pair.centre_distance_mm": -1})
    assert str(caught.value) == "pair.centre_distance_mm: found -1, allowed is more than 0"
    assert (caught.value.key, caught.value.file, caught.value.line) == ("pair.centre_distance_mm", "", None)


def test_gears_of_the_wrong_hand_are_refused_before_they_are_reduced(pinion):
    helical = pinion.but(helix_angle_deg=15.0, hand="right", mesh=None)
    other = helical.but(name="wheel", teeth=40)
    # As `Gear` has it, but for what only a ring's blank needs.
    ring = SimpleNamespace(tables={"tooth": {"teeth": -60, "hand": "left"}})
    for mate, complaint in [(other, "'right', gear_1's 'right': gears on parallel axes have opposite hands"), (ring, "have the same hand")]:
        with pytest.raises(gm.InputError, match=complaint):
            gm.Pair(helical, mate, centre_distance_mm=97.0, torques_Nm=50)
    with pytest.raises(TypeError, match="is not reduced yet"):
        gm.Pair(helical, other.but(hand="left"), centre_distance_mm=97.0, torques_Nm=50)


@pytest.fixture
def drive(models):
    """The shipped scene beside models of its gears."""
    return shutil.copy("fe_models/first_pair/drive.toml", models[0].path.parent)


def test_tables_of_a_scene_know_where_its_files_lie(drive, tmp_path, monkeypatch):
    scene = gm.Scene(drive)
    monkeypatch.chdir(tmp_path)
    tables = scene.tables
    # The models have no gauges.
    del tables["gauge"]
    tables["run"]["end_s"] = 1e-3
    again = gm.Scene(tables)
    assert again.folder == scene.folder
    assert any("mesh frequency at the start 230.000 Hz" in line for line in again.plan())


def test_what_a_run_warns_of_is_in_its_result(drive):
    tables = gm.Scene(drive).tables
    del tables["gauge"]
    tables["run"]["end_s"] = 2e-3
    tables["load"][0]["torque_Nm"] = 100.0
    warnings = gm.Scene(tables).run().warnings
    # The sign of its torque is that of its speed.
    assert any("load `torque on wheel` drives" in text for text in warnings), warnings


def test_the_schema_is_that_of_the_program():
    assert json.loads(gm.schema("gear"))["title"] == "gearmesh gear"


def test_pandas_reads_the_tables(result):
    curves = result.to_pandas()
    assert np.array_equal(curves["te_m"].to_numpy(), result["te_m"].ravel())
    assert list(curves["torque_Nm"].unique()) == [50.0, 100.0]
    torques = result.to_pandas("torques")
    added = np.split(result["between/te_m"], np.cumsum(result["between/count"])[:-1])
    ranges = [np.ptp(np.concatenate(both)) for both in zip(result["te_m"], added)]
    assert torques["te_peak_to_peak_m"].to_numpy() == pytest.approx(ranges, rel=1e-12)
    with pytest.raises(KeyError, match="it has curves, contact, torques"):
        result.to_pandas("curve")


def test_xarray_names_axes_and_shares_the_memory(result):
    data = result.to_xarray()
    assert data["te_m"].dims == ("torque_Nm", "angle_rad")
    assert data["te_m"].attrs["units"] == "m"
    chosen = data["te_m"].sel(torque_Nm=100.0)
    assert np.array_equal(chosen, result["te_m"][1])
    assert np.shares_memory(data["force_N"].to_numpy(), result["force_N"])
    rows = gm.Scene(PENDULUM).run().to_xarray()
    assert rows["time_s"].dims == ("time_s",) and rows.sizes["time_s"] == 201


def test_what_is_read_is_never_what_is_written(pinion, models, tmp_path):
    for model in models:
        shutil.copy(model.path, tmp_path)
    scene = tmp_path / "pair.toml"
    scene.write_text(
        'title = "pair"\n[pair]\ngear_1 = "pinion.h5"\ngear_2 = "wheel.h5"\ncentre_distance_mm = 94.6\n'
        '[mesh.model]\nkind = "hybrid"\nlocal = "weber-banaschek"\n[run]\ntorques_Nm = [50.0]\npitches = 1\npoints_per_pitch = 4\n'
    )
    before = (tmp_path / "wheel.h5").read_bytes()
    with pytest.raises(gm.InputError, match="wheel.h5 is read by this command"):
        gm.run(scene, tmp_path / "wheel.h5")
    assert (tmp_path / "wheel.h5").read_bytes() == before
    link = tmp_path / "link.h5"
    link.symlink_to("wheel.h5")
    with pytest.raises(gm.InputError, match="link"):
        pinion.reduce(link, error_estimate=False, progress=False)
    assert (tmp_path / "wheel.h5").read_bytes() == before


def test_a_study_writes_over_nothing_that_it_reads(tmp_path):
    scene, page = tmp_path / "scene.toml", tmp_path / "out" / "study.html"
    shutil.copy(PENDULUM, scene)
    study = tmp_path / "study.toml"
    study.write_text(
        'title = "lengths"\nscene = "scene.toml"\ncolumns = ["bodies/rod/turn_rad"]\n'
        '[[parameter]]\nname = "end"\nkeys = ["run.end_s"]\nvalues = [0.01]\n'
    )
    page.parent.mkdir()
    page.hardlink_to(scene)
    before = scene.read_bytes()
    with pytest.raises(gm.InputError, match="study.html is read by this command"):
        gm.study(study, page.parent, progress=False)
    assert scene.read_bytes() == before and not (page.parent / "study.csv").exists()
