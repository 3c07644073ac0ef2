"""The browser of the tests of pages: one a file, whose pages are closed after each test; and a pair."""

import os

import pytest

import gearmesh as gm
import studio_page

MISSING = "no Chromium: `apt-get install -y chromium` installs it (cargo xtask test does, as root)"
COARSE = dict(flank_mm=2.0, fillet_mm=1.0, body_mm=6.0, axial_mm=5.0)

TEST_S = 240.0
"""So long a test may take: beyond it the browser is killed, so that calls which wait for it fail. The longest takes 30 s."""


@pytest.fixture(scope="module")
def browser_of_file():
    if studio_page.chromium() is None:
        # Where the browser must be there, its absence is a failure and no skip.
        assert os.environ.get("GEARMESH_BROWSER") != "required", MISSING
        pytest.skip(MISSING)
    pytest.importorskip("playwright")
    with studio_page.browser() as browser:
        yield browser


@pytest.fixture
def browser(browser_of_file):
    with studio_page.killed_after(TEST_S):
        yield browser_of_file
        for context in browser_of_file.contexts:
            context.close()


@pytest.fixture(scope="session")
def scene(tmp_path_factory):
    """A pair of two small reduced gears, and its models beside it."""
    folder = tmp_path_factory.mktemp("studio")
    keywords = dict(module_mm=3, face_width_mm=20, material=gm.STEEL, mesh=COARSE, reduction=dict(slices=3, roll_stations=4))
    pinion = gm.Gear("pinion", teeth=23, bore_diameter_mm=25, **keywords)
    wheel = pinion.but(name="wheel", teeth=40, bore_diameter_mm=40)
    models = [gear.reduce(folder / f"{gear.name}.h5", error_estimate=False, progress=False) for gear in (pinion, wheel)]
    pair = gm.Pair(*models, centre_distance_mm=94.6, torques_Nm=[50, 100, 150], points_per_pitch=20)
    pair.write(folder / "pair.toml")
    return folder / "pair.toml"
