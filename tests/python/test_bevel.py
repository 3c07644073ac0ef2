"""A bevel pair with [load] through Python: the figures of the program to the last digit, and what else is done with a pair's result."""

from __future__ import annotations

import math

import gearmesh as gm
import numpy as np
import pytest

TABLES = {**gm.Scene("fe_models/bevel_20_20_loaded.toml").tables, "load": {"torques_Nm": [50.0, 200.0], "slices": 9, "positions_per_pitch": 4}}


@pytest.fixture(scope="module")
def scene():
    return gm.Scene(TABLES)


@pytest.fixture(scope="module")
def result(scene):
    return scene.run()


def test_the_program_gives_the_same_figures(scene, result, tmp_path):
    scene.write(tmp_path / "pair.toml")
    printed = gm.program("run", tmp_path / "pair.toml", "-o", tmp_path / "pair.h5")
    stored = gm.Result.open(tmp_path / "pair.h5")
    assert stored.keys() == result.keys() and stored.kind == result.kind == "pair"
    for name in set(result.keys()) - {"seconds"}:
        assert np.array_equal(stored[name], result[name], equal_nan=True), name
    torques, rows = result.tables()["torques"], printed["rows"]
    same = set(torques) & set(rows[0])
    assert {"te_mean_m", "pressure_largest_Pa", "loaded_te_peak_to_peak_rad", "load_on_tips_share", "k_h_beta"} <= same, same
    for name in same:
        told = [math.nan if row[name] is None else row[name] for row in rows]
        assert np.array_equal(told, torques[name], equal_nan=True), name


def test_a_pair_without_load_is_refused_by_its_key():
    free = {key: table for key, table in TABLES.items() if key != "load"}
    with pytest.raises(gm.InputError, match="load: is missing"):
        gm.run(free)


def test_it_is_planned_drawn_and_reported(scene, result, tmp_path):
    assert any("bevel, z 20/20" in line for line in scene.plan())
    assert "200 N m: TE mean" in repr(result) and "transmission error" in result._repr_html_()
    result.report(tmp_path / "page.html")
    assert (tmp_path / "page.html").stat().st_size > 10_000


def test_it_is_compared_with_a_record_of_itself(result, tmp_path):
    """A revolution of the curves as they were computed has neither a mean nor an angle off."""
    pitch, angles = 2 * math.pi / 20, result["angle_rad"]
    turns = np.concatenate([angles + k * pitch for k in range(20)])
    columns = [np.degrees(turns), *(1e6 * np.tile(te, 20) for te in result["te_m"])]
    head = "angle [deg],te_um_50Nm [um],te_um_200Nm [um]"
    np.savetxt(tmp_path / "te.csv", np.column_stack(columns), delimiter=",", header=head, comments="", fmt="%.17g")
    gm.program("record", tmp_path / "te.csv", "-o", tmp_path / "record", "--title", "itself", "--source", "gearmesh", "--angle-origin", "pitch point")
    compared = gm.compare(result, tmp_path / "record")["comparisons"]
    assert len(compared) == 2
    for one in compared:
        ours, theirs = one["peak_to_peak"]["ours"], one["peak_to_peak"]["reference"]
        assert ours == pytest.approx(theirs, rel=1e-9) and abs(one["largest_deviation"]) < 1e-9 * ours


def test_a_study_has_its_columns(scene, result, tmp_path):
    """The case as the file states it has the figures of the run."""
    tables = dict(
        title="offset",
        scene=scene,
        columns=["te_peak_to_peak_um", "pressure_largest_MPa"],
        parameter=[dict(name="offset", keys=["tca.offset_um"], values=[0.0, 20.0])],
    )
    found = gm.study(tables, tmp_path / "study", progress=False)
    torques = result.tables()["torques"]
    for column, (name, factor) in {"te_peak_to_peak_um": ("te_peak_to_peak_m", 1e6), "pressure_largest_MPa": ("pressure_largest_Pa", 1e-6)}.items():
        studied = [float(row[column]) for row in found.rows if row["offset"] == "0.0"]
        assert studied == pytest.approx(list(factor * np.array(torques[name])), rel=1e-12), column
