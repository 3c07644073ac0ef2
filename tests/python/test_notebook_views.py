"""What notebooks show: static pictures of pair, result, reduced gear and bearing, and the studio behind a link."""

import os
import re
import urllib.error
import urllib.request
import xml.etree.ElementTree as xml

import numpy as np
import pytest

import gearmesh as gm

COARSE = dict(flank_mm=2.0, fillet_mm=1.0, body_mm=6.0, axial_mm=5.0)
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def pair(tmp_path_factory):
    folder = tmp_path_factory.mktemp("views")
    keywords = dict(module_mm=3, face_width_mm=20, material=gm.STEEL, mesh=COARSE, reduction=dict(slices=3, roll_stations=4))
    pinion = gm.Gear("pinion <1>", teeth=23, bore_diameter_mm=25, **keywords)
    wheel = pinion.but(name="wheel", teeth=40, bore_diameter_mm=40)
    models = [gear.reduce(folder / f"{k}.h5", error_estimate=False, progress=False) for k, gear in enumerate((pinion, wheel))]
    return gm.Pair(*models, centre_distance_mm=94.6, torques_Nm=[50, 100], points_per_pitch=20)


def picture(view):
    """The picture of a view; it is well-formed."""
    return xml.fromstring(re.search(r"<svg.*</svg>", view)[0])


def test_a_pair_shows_its_circles(pair):
    view = pair._repr_html_()
    radii = [float(circle.get("r")) for circle in picture(view).iter(f"{SVG}circle")]
    # Tip circles of 75 and 126 mm, in one scale; titles are text and no markup.
    assert len(radii) == 6 and radii[3] / radii[0] == pytest.approx(126 / 75, rel=0.01)
    assert "pinion &lt;1&gt;" in view and "<1>" not in view


def test_a_result_shows_its_curves(pair):
    result = pair.run()
    view = f"<div>{result._repr_html_()}</div>"
    lines = list(picture(view).iter(f"{SVG}polyline"))
    assert len(lines) == 2
    heights = np.array([[float(part.split(",")[1]) for part in line.get("points").split()] for line in lines])
    # As te_m: downwards in the picture is negative, the scale is one.
    te = np.asarray(result["te_m"])
    drawn = (heights.max() - heights) / np.ptp(heights)
    assert np.allclose(drawn, (te - te.min()) / np.ptp(te), atol=2e-3)


def test_a_reduced_gear_shows_the_compliance_of_its_flank(pair):
    model = gm.ReducedGear(pair.tables["pair"]["gear_1"])
    line = next(picture(model._repr_html_()).iter(f"{SVG}polyline"))
    places = [tuple(map(float, part.split(","))) for part in line.get("points").split()]
    assert len(places) == len(model["roll_angles_rad"])
    # Softer towards the tip: up in the picture, from left to right.
    assert all(b[0] > a[0] and b[1] < a[1] for a, b in zip(places, places[1:]))


def test_a_bearing_shows_its_balls():
    bearing = gm.Bearing("fe_models/bearing_9_balls.toml")
    # Nine balls and their circle.
    assert len(list(picture(bearing._repr_html_()).iter(f"{SVG}circle"))) == 10
    catalogue = gm.Bearing(dict(kind="catalogue", designation="6205"))
    assert "6205" in catalogue._repr_html_() and "<svg" not in catalogue._repr_html_()


@pytest.mark.skipif("GEARMESH_PROGRAM" not in os.environ, reason="the program is named by GEARMESH_PROGRAM")
def test_the_studio_opens_and_closes(pair):
    with gm.studio(pair) as opened:
        assert opened.url in opened._repr_html_() and opened.is_open
        assert b"gearmesh studio" in urllib.request.urlopen(opened.url, timeout=60).read()
    assert not opened.is_open and "closed" in repr(opened)
    with pytest.raises(urllib.error.URLError):
        urllib.request.urlopen(opened.url, timeout=5)
    with pytest.raises(gm.InputError, match="nowhere.toml"):
        gm.studio("nowhere.toml")
