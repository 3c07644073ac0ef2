"""Pages of every kind in a real browser, on a wide and a narrow screen and as printed: nothing sticks out, nothing overlaps."""

import json
from pathlib import Path

import pytest

import gearmesh as gm
import studio_page

BEARING = "fe_models/bearing_9_balls.toml"
STUDY = """design = "grid"
columns = ["displacement_y_um", "pressure_inner_largest_MPa", "life_L10_Mrev"]
[[parameter]]
name = "load N"
keys = ["operation.load_N.1"]
values = [-500.0, -1000.0, -1500.0]
[[parameter]]
name = "thrust N"
keys = ["operation.load_N.2"]
values = [100.0, 400.0]
"""
OPTIMISATION = """trials = 20
searches = 1
[[variable]]
name = "thrust N"
keys = ["operation.load_N.2"]
from = 50.0
to = 400.0
[[objective]]
name = "pressure MPa"
term = [{ column = "pressure_inner_largest_MPa" }]
[[objective]]
name = "moves um, sideways"
term = [{ column = "displacement_x_um" }]
"""
KINDS = ["pair", "ring", "bevel", "drive", "static", "bearing", "tca", "study", "optimise", "accuracy"]

# Letters of drawings that stick out of them, or stand less than a pixel from other letters.
COLLISIONS = """[...document.querySelectorAll('figure svg')].flatMap((svg) => {
    const within = svg.getBoundingClientRect();
    const words = [...svg.querySelectorAll('text')].filter((one) => one.textContent.trim());
    const boxes = words.map((one) => one.getBoundingClientRect());
    const wide = (a, b) => Math.min(a.right, b.right) - Math.max(a.left, b.left);
    const high = (a, b) => Math.min(a.bottom, b.bottom) - Math.max(a.top, b.top);
    const found = [];
    words.forEach((one, i) => {
        if (boxes[i].left < within.left - 2 || boxes[i].right > within.right + 2) found.push(`${one.textContent} sticks out`);
        words.slice(i + 1).forEach((other, j) => {
            const [a, b] = [boxes[i], boxes[i + 1 + j]];
            if (wide(a, b) > -1 && high(a, b) > 5) found.push(`${one.textContent} on ${other.textContent}`);
        });
    });
    return found;
})"""


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """The page of each kind."""
    folder = tmp_path_factory.mktemp("pages")
    at = {kind: folder / f"{kind}.html" for kind in KINDS}
    coarse = dict(flank_mm=2.0, fillet_mm=1.0, body_mm=6.0, plane_strain=True)
    pinion = gm.Gear("pinion", module_mm=3, teeth=23, face_width_mm=20, bore_diameter_mm=25, material=gm.STEEL, mesh=coarse)
    wheel = pinion.but(name="wheel", teeth=40, bore_diameter_mm=40)
    models = [gear.reduce(folder / f"{gear.name}.h5", error_estimate=False, progress=False) for gear in (pinion, wheel)]
    pair = gm.Pair(*models, centre_distance_mm=94.6, torques_Nm=[50, 100, 200])
    pair.write(folder / "pair.toml")
    inside = [gm.Gear.from_file(f"fe_models/{name}.toml").but(gauge=None, mesh=coarse) for name in ("planet_24", "ring_75")]
    models = [gear.reduce(folder / f"{gear.teeth}.h5", error_estimate=False, progress=False) for gear in inside]
    gm.Pair(*models, centre_distance_mm=51.0, torques_Nm=[100, 300]).write(folder / "ring.toml")
    # The models have no gauges.
    (folder / "drive.toml").write_text(Path("fe_models/first_pair/drive.toml").read_text().split("[[gauge]]")[0])
    for name, scene in [("pair", folder / "pair.toml"), ("ring", folder / "ring.toml"), ("bevel", "fe_models/bevel_13_35_loaded.toml"), ("drive", folder / "drive.toml"), ("static", "fe_models/gearbox_three_stage.toml")]:
        gm.program("run", str(scene), "-o", str(folder / f"{name}.h5"))
        gm.program("report", str(folder / f"{name}.h5"), "-o", str(at[name]))
    gm.program("bearing", BEARING, "--load-N", "0,-1000,100", "--report", str(at["bearing"]))
    gm.program("tca", "fe_models/bevel_13_35_loaded.toml", "--report", str(at["tca"]))
    gm.program("accuracy", str(folder / "pair.toml"), "--columns", "te_peak_to_peak_um,k_h_beta", "-o", str(at["accuracy"]))
    head = f'title = "A bearing"\nscene = {json.dumps(str(Path(BEARING).absolute()))}\noperation = {{ load_N = [0.0, -1000.0, 100.0] }}\n'
    for kind, text in [("study", STUDY), ("optimise", OPTIMISATION)]:
        (folder / f"{kind}.toml").write_text(head + text)
        gm.program(kind, str(folder / f"{kind}.toml"), "-o", str(folder / kind))
        at[kind] = folder / kind / f"{kind}.html"
    return at


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("width, medium", [(1280, "screen"), (390, "screen"), (794, "print")])
def test_a_page_fits(browser, pages, kind, width, medium):
    it = studio_page.Page(browser, pages[kind].as_uri(), width=width)
    it.page.emulate_media(media=medium)
    it.page.wait_for_timeout(200)
    assert it.complaints == []
    assert it.page.evaluate("document.documentElement.scrollWidth") <= width
    assert it.page.evaluate(COLLISIONS) == []


@pytest.mark.parametrize("kind", ["pair", "ring", "bevel"])
def test_gears_in_space_and_charts_share_a_cursor(browser, pages, kind):
    it = studio_page.Page(browser, pages[kind].as_uri())
    it.until("document.querySelector('.scene + .position output')?.textContent.endsWith('°')")
    it.page.wait_for_timeout(500)
    assert it.colours(".scene canvas >> nth=0") > 20, "the gears are blank"
    before = it.page.locator(".scene canvas").first.screenshot()
    # A quarter along the first pitch of the chart of the transmission error.
    chart = it.page.locator("figure[data-kind=line]").first
    box = chart.locator(".u-over").bounding_box()
    chart.locator(".u-over").hover(position=dict(x=0.1 * box["width"], y=60))
    shown = float(chart.locator(".u-legend .u-series").first.locator(".u-value").text_content())
    angle = float(it.page.locator(".position output").text_content().rstrip("°"))
    assert 0.0 < angle == pytest.approx(shown, rel=1e-3)
    # Another chart over the same axis has the same place under its cursor.
    others = "[...document.querySelectorAll('figure[data-kind=line]')].map((one) => one.querySelector('.u-legend .u-value')?.textContent)"
    assert sum(one == it.page.evaluate(others)[0] for one in it.page.evaluate(others)) >= 3
    it.page.wait_for_timeout(300)
    assert it.page.locator(".scene canvas").first.screenshot() != before
    it.keep(f"report_{kind}")
    assert it.complaints == []
