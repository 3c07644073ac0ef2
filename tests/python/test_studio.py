"""The page of `gearmesh studio` in a real browser. Its server without one: crates/cli/tests/scene_commands/studio.rs."""

import os
import re

import pytest

import gearmesh as gm
import studio_page

PROGRAM = os.environ.get("GEARMESH_PROGRAM", "target/debug/gearmesh")
RELIEF = "gear_1.microgeometry.tip_relief_um"
MISSING = "no Chromium: `apt-get install -y chromium` installs it (cargo xtask test does, as root)"

if studio_page.chromium() is None:
    # Where the browser must be there, its absence is a failure and no skip.
    assert os.environ.get("GEARMESH_BROWSER") != "required", MISSING
    pytest.skip(MISSING, allow_module_level=True)
pytest.importorskip("playwright")

COARSE = dict(flank_mm=2.0, fillet_mm=1.0, body_mm=6.0, axial_mm=5.0)


@pytest.fixture(scope="module")
def scene(tmp_path_factory):
    folder = tmp_path_factory.mktemp("studio")
    keywords = dict(module_mm=3, face_width_mm=20, material=gm.STEEL, mesh=COARSE, reduction=dict(slices=3, roll_stations=4))
    pinion = gm.Gear("pinion", teeth=23, bore_diameter_mm=25, **keywords)
    wheel = pinion.but(name="wheel", teeth=40, bore_diameter_mm=40)
    models = [gear.reduce(folder / f"{gear.name}.h5", error_estimate=False, progress=False) for gear in (pinion, wheel)]
    pair = gm.Pair(*models, centre_distance_mm=94.6, torques_Nm=[50, 100, 150], points_per_pitch=20)
    pair.write(folder / "pair.toml")
    return folder / "pair.toml"


@pytest.fixture(scope="module")
def address(scene):
    with studio_page.server(PROGRAM, scene) as address:
        yield address


@pytest.fixture(scope="module")
def browser():
    with studio_page.browser() as browser:
        yield browser


def without_clock(answer):
    figures = answer["figures"]
    figures.pop("seconds")
    return figures


def test_a_slider_gives_the_numbers_of_run(browser, address, scene, tmp_path):
    it = studio_page.Page(browser, address)
    it.wait()
    assert without_clock(it.answer()) == studio_page.printed(PROGRAM, scene, tmp_path)
    for canvas in ("#scene", "#flank", "#curves figure:first-child canvas"):
        assert it.colours(canvas) > 20, f"{canvas} is blank"
    before = it.page.locator("[data-figure=te_peak_to_peak_m]").get_attribute("value")
    it.page.keyboard.press("p")

    # What the amount needs beside it is set with it, and seen.
    start = f"{RELIEF.removesuffix('_um')}_start_diameter_mm"
    assert it.field(start).locator("input[type=number]").input_value() == ""
    it.slide(RELIEF, 12.5)
    it.wait(2)
    amount = it.field(RELIEF).locator("input[type=number]").input_value()
    diameter = it.field(start).locator("input[type=number]").input_value()
    assert abs(float(amount) - 12.5) < 0.1 and 69.0 < float(diameter) < 75.0
    text = scene.read_text()
    text += f"\n[gear_1.microgeometry]\ntip_relief_um = {amount}\ntip_relief_start_diameter_mm = {diameter}\n"
    changed = scene.with_name("changed.toml")
    changed.write_text(text)
    expected = studio_page.printed(PROGRAM, changed, tmp_path)
    assert without_clock(it.answer()) == expected
    # The table shows them: the highest torque.
    row = expected["rows"][-1]
    shown = it.page.locator("[data-figure=te_peak_to_peak_m]")
    assert float(shown.get_attribute("value")) == row["te_peak_to_peak_m"] != float(before)
    assert float(shown.text_content()) == pytest.approx(1e6 * row["te_peak_to_peak_m"], rel=1e-4)
    # Beside the kept state.
    difference = it.page.locator("#figures .difference").first.text_content()
    assert re.fullmatch(r"[+−±][0-9.]+ %", difference)
    it.keep("changed")

    # What is saved gives the same.
    with it.page.expect_download() as download:
        it.page.click("#save")
    download.value.save_as(tmp_path / "saved.toml")
    assert studio_page.printed(PROGRAM, tmp_path / "saved.toml", tmp_path) == expected

    # Another page at the copied address has it; undo goes back, redo forth.
    shared = studio_page.Page(browser, it.page.url)
    shared.wait()
    assert without_clock(shared.answer()) == expected
    it.page.keyboard.press("Control+z")
    it.wait(3)
    assert it.page.locator("[data-figure=te_peak_to_peak_m]").get_attribute("value") == before
    assert it.page.url == address
    it.page.click("#redo")
    it.wait(4)
    assert without_clock(it.answer()) == expected
    assert it.complaints == shared.complaints == []


def test_what_is_wrong_is_said_and_undone(browser, address):
    it = studio_page.Page(browser, address)
    it.wait()
    number = it.field("pair.centre_distance_mm").locator("input[type=number]")
    number.fill("80")
    number.press("Enter")
    it.page.wait_for_selector("#problem:not([hidden])")
    assert "pair" in it.page.locator("#problem").text_content()
    it.page.click("#undo")
    it.wait(2)
    assert it.page.locator("#problem").is_hidden()
    assert number.input_value() == "94.6"
    # The server's refusal stands in the console as a failed request, and nothing else does.
    assert all("422" in one for one in it.complaints), it.complaints


def test_gears_turn_to_the_position_under_the_cursor(browser, address):
    it = studio_page.Page(browser, address, theme="dark")
    it.wait()
    assert it.page.evaluate("document.documentElement.dataset.theme") == "dark"
    picture = it.page.locator("#scene").screenshot()
    chart = it.page.locator("#curves .u-over").first
    chart.hover(position=dict(x=150, y=60))
    place = int(it.page.locator("#position").input_value())
    assert 0 < place < 19
    angle = it.page.locator("#angle").text_content()
    assert float(angle.rstrip("°")) == pytest.approx(it.answer()["angle_deg"][place], rel=1e-4)
    it.page.wait_for_timeout(300)
    assert it.page.locator("#scene").screenshot() != picture
    it.keep("dark")
    assert it.complaints == []


@pytest.mark.parametrize("width", [1280, 390])
def test_the_page_fits(browser, address, width):
    it = studio_page.Page(browser, address, width=width, height=900)
    it.wait()
    it.open_groups()
    assert it.page.evaluate("document.documentElement.scrollWidth") <= width
    # Every field has a name for screen readers.
    unnamed = "[...document.querySelectorAll('input, select, button')].filter((one) => !one.ariaLabel && !one.labels?.length && !one.textContent.trim())"
    assert it.page.evaluate(f"{unnamed}.map((one) => one.outerHTML)") == []
    it.keep(f"wide_{width}")
    assert it.complaints == []


def test_a_stranger_sees_no_numbers(browser, address):
    it = studio_page.Page(browser, address.split("?")[0])
    it.page.wait_for_selector("#problem:not([hidden])")
    assert "token" in it.page.locator("#problem").text_content()
    assert it.page.locator("#pair").is_hidden()


def test_columns_of_a_system(browser, tmp_path):
    result = tmp_path / "pendulum.h5"
    gm.program("run", "fe_models/scene_pendulum.toml", "-o", str(result))
    with studio_page.server(PROGRAM, result) as address:
        it = studio_page.Page(browser, address)
        it.page.wait_for_selector("#plots canvas")
        assert it.colours("#plots canvas") > 3
        whole = it.page.locator("#rows").text_content()
        box = it.page.locator("#plots .u-over").bounding_box()
        it.page.mouse.move(box["x"] + 0.2 * box["width"], box["y"] + 50)
        it.page.mouse.down()
        it.page.mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 50, steps=4)
        it.page.mouse.up()
        it.until("document.querySelector('#rows').textContent.includes(' from ')")
        assert int(it.page.locator("#rows").text_content().split()[0]) < int(whole.split()[0])
        it.page.fill("#filter", "angular velocity z")
        shown = it.page.locator("#names label:visible")
        assert 0 < shown.count() < 5
        shown.locator("input").first.check()
        it.page.check("#spectrum")
        it.until("[...document.querySelectorAll('#plots figcaption')].every((one) => one.textContent.includes('Hz'))")
        it.keep("columns")
        assert it.complaints == []


def test_a_changed_body_is_reduced_in_the_background(browser, address, scene, tmp_path):
    it = studio_page.Page(browser, address)
    it.wait()
    it.open_groups()
    before = it.answer()
    field = it.field("pair.gear_1:blank.bore_diameter_mm")
    slider = field.locator("input[type=range]")
    # From the schema and what is stated: half to one and a half times the bore.
    assert [float(slider.get_attribute(end)) for end in ("min", "max")] == [12.5, 37.5]
    drawn = it.page.locator("#scene").screenshot()
    it.slide("pair.gear_1:blank.bore_diameter_mm", 35)
    # The old curves stay, greyed, and how far it is can be read.
    it.until("document.querySelector('#pair').classList.contains('stale')")
    it.until("document.querySelector('#status').textContent.includes('reduced')")
    it.keep("reducing")
    it.wait(2)
    assert it.page.locator("#pair.stale").count() == 0 and it.page.locator("#stop").is_hidden()
    it.page.wait_for_timeout(500)
    assert it.page.locator("#scene").screenshot() != drawn
    assert it.answer()["models"][0] != before["models"][0] and it.answer()["models"][1] == before["models"][1]
    with it.page.expect_download() as download:
        it.page.click("#save")
    download.value.save_as(tmp_path / "saved.toml")
    assert studio_page.printed(PROGRAM, tmp_path / "saved.toml", tmp_path) == without_clock(it.answer())
    # The bore is held: less body winds up between it and the teeth. Undo needs no reduction.
    stiffness = [one["figures"]["rows"][-1]["tangent_stiffness_mean_N_per_m"] for one in (before, it.answer())]
    assert stiffness[0] < stiffness[1] < 2.0 * stiffness[0]
    it.page.click("#undo")
    it.wait(3)
    assert it.answer()["models"] == before["models"]
    assert all("409" in one for one in it.complaints), it.complaints
