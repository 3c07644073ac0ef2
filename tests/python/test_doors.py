"""A spur pair, a helical pair with tip edges and a bevel pair with bodies: the same six commands on each, and figures that are equal to the last digit at all doors."""

from __future__ import annotations

import csv
import math
import pathlib
import shutil

import h5py
import numpy as np
import pytest

import gearmesh as gm

COARSE = dict(flank_mm=2.0, fillet_mm=1.0, body_mm=6.0, axial_mm=4.0)
ROOT = [dict(name="root", tooth=0, side="right", tangent_deg=30.0, length_mm=0.6, width_mm=3.0)]
DISTANCE_MM = {"spur": 94.6, "helical": 97.9}
STUDIED = {"te_mean_um": ("te_mean_m", 1e6), "te_peak_to_peak_um": ("te_peak_to_peak_m", 1e6), "pressure_largest_MPa": ("pressure_largest_Pa", 1e-6)}
"""Columns of studies, and what they are in tables."""


def cylindrical(family: str, folder: pathlib.Path) -> gm.Scene:
    """A pair of two small gears; the helical one meets at tip edges, too."""
    keywords = dict(module_mm=3, face_width_mm=20, material=gm.STEEL, mesh=COARSE, reduction=dict(slices=4, roll_stations=4), gauge=ROOT)
    pinion_teeth, wheel_teeth = [dict(helix_angle_deg=15.0, hand=hand) if family == "helical" else {} for hand in ("right", "left")]
    pinion = gm.Gear("pinion", teeth=23, bore_diameter_mm=25, **keywords, **pinion_teeth)
    wheel = pinion.but(name="wheel", teeth=40, bore_diameter_mm=40, **wheel_teeth)
    models = [gear.reduce(folder / f"{gear.name}.h5", error_estimate=False, progress=False) for gear in (pinion, wheel)]
    tip_edges = dict(mesh=dict(teeth=dict(path="extended"))) if family == "helical" else {}
    return gm.Pair(*models, centre_distance_mm=DISTANCE_MM[family], torques_Nm=[50, 150], points_per_pitch=8, **tip_edges)


def bevel(folder: pathlib.Path) -> gm.Scene:
    """Seed 001's pair with coarse bodies."""
    shutil.copy("fe_models/bevel_20_20.toml", folder)
    models = []
    for member in ("pinion", "gear"):
        text = pathlib.Path(f"fe_models/bevel_{member}_20_20.toml").read_text(encoding="utf-8")
        file = folder / f"{member}.toml"
        file.write_text(text + "\n[mesh]\nflank_mm = 2.0\nfillet_mm = 0.8\nbody_mm = 5.0\nalong_mm = 1.0\n", encoding="utf-8")
        models.append(str(gm.reduce(file, folder / f"{member}.h5", error_estimate=False, progress=False).path))
    load = dict(torques_Nm=[50.0, 150.0], positions_per_pitch=4, models=models)
    return gm.Scene({**gm.Scene("fe_models/bevel_20_20_loaded.toml").tables, "load": load})


@pytest.fixture(scope="module", params=["spur", "helical", "bevel"])
def pair(request, tmp_path_factory):
    """The scene, its result in memory, what the program prints of it, and the folder with the program's result, pair.h5."""
    folder = tmp_path_factory.mktemp(request.param)
    scene = bevel(folder) if request.param == "bevel" else cylindrical(request.param, folder)
    scene.write(folder / "pair.toml")
    printed = gm.program("run", folder / "pair.toml", "-o", folder / "pair.h5")
    return scene, scene.run(), printed, folder


def equal(ours, theirs) -> bool:
    """To the last digit; what has no number is empty or null elsewhere."""
    as_numbers = [[math.nan if value in (None, "") else float(value) for value in values] for values in (ours, theirs)]
    return np.array_equal(*as_numbers, equal_nan=True)


def test_figures_are_the_same_at_all_doors(pair):
    scene, result, printed, folder = pair
    rows = printed["rows"]
    torques = result.tables()["torques"]
    shared = set(torques) & set(rows[0])
    assert set(name for name, _ in STUDIED.values()) <= shared
    # Fifteen to date; names that part ways leave fewer.
    assert len(shared) > 12, shared
    for name in shared:
        assert equal([row[name] for row in rows], torques[name]), name

    gm.program("export", folder / "pair.h5", "--table", "torques", "-o", folder / "torques.csv")
    result.export(folder / "in_memory.csv", "torques")
    for table in ("torques.csv", "in_memory.csv"):
        with open(folder / table, encoding="utf-8") as lines:
            exported = list(csv.DictReader(lines))
        assert set(exported[0]) == set(torques)
        for name, column in torques.items():
            assert equal([row[name] for row in exported], column), (table, name)

    gm.program("report", folder / "pair.h5", "-o", folder / "page.html")
    result.report(folder / "in_memory.html")
    heads, *texts = result._native.figure_texts()
    for page in ("page.html", "in_memory.html"):
        html = (folder / page).read_text(encoding="utf-8").replace("−", "-")
        missing = [text for row in texts for text in row if text not in html]
        assert not missing and len(heads) > 5, (page, missing)

    study = dict(title="as it is", scene=scene, columns=list(STUDIED), parameter=[dict(name="title", keys=["title"], values=["as it is"])])
    found = gm.study(study, folder / "study", progress=False)
    # The scene as it stands comes first, then the case with another title.
    assert len(found.rows) == 2 * len(rows)
    for column, (name, factor) in STUDIED.items():
        assert [float(row[column]) for row in found.rows] == 2 * [factor * value for value in torques[name]], column


def test_strain_is_recovered_alike(pair):
    _, result, _, folder = pair
    by_program = gm.program("recover", folder / "pair.h5", "-o", folder / "strain.h5")
    in_memory = result.recover(folder / "in_memory.h5")
    assert {**in_memory, "seconds": 0.0} == {**by_program, "seconds": 0.0}

    def curves(name):
        with h5py.File(folder / name) as file:
            found = {}
            file.visititems(lambda key, item: found.update({key: item[()]}) if isinstance(item, h5py.Dataset) and item.dtype.kind == "f" else None)
            return found

    ours, theirs = curves("in_memory.h5"), curves("strain.h5")
    assert ours.keys() == theirs.keys() and len(ours) > 2
    for key, values in ours.items():
        assert np.array_equal(values, theirs[key], equal_nan=True) or "seconds" in key, key


def test_it_is_compared_alike(pair):
    _, result, _, folder = pair
    teeth = 20 if "bevel" in result.title else 23
    pitch, angles = 2 * math.pi / teeth, result["angle_rad"]
    in_pitch = round(pitch / (angles[1] - angles[0]))
    turns = np.concatenate([angles[:in_pitch] + k * pitch for k in range(teeth)])
    columns = [np.degrees(turns), *(1e6 * np.tile(te[:in_pitch], teeth) for te in result["te_m"])]
    head = "angle [deg],te_um_50Nm [um],te_um_150Nm [um]"
    np.savetxt(folder / "te.csv", np.column_stack(columns), delimiter=",", header=head, comments="", fmt="%.17g")
    gm.program("record", folder / "te.csv", "-o", folder / "record", "--title", "itself", "--source", "gearmesh", "--angle-origin", "pitch point")
    by_program = gm.program("compare", folder / "pair.h5", folder / "record")
    assert gm.compare(result, folder / "record")["comparisons"] == by_program["comparisons"]
    assert len(by_program["comparisons"]) == 2
