"""The page of `gearmesh studio` in a real browser. Its server without one: crates/cli/tests/scene_commands/studio.rs."""

import os
import re
from pathlib import Path

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
    it.page.evaluate("globalThis.drawn = document.querySelector('#scene').toDataURL()")
    it.slide(RELIEF, 12.5)
    it.wait(2)
    # The gears follow, if late.
    it.until("document.querySelector('#scene').toDataURL() !== globalThis.drawn")
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
        it.page.select_option("#shown", "spectrum")
        it.until("[...document.querySelectorAll('#plots figcaption')].every((one) => one.textContent.includes('Hz'))")
        it.keep("columns")
        # The whole, asked for from a spectrum of a part that is too short.
        it.page.click("#whole")
        it.until("document.querySelector('#rows').textContent === '" + whole + "'")
        it.page.select_option("#shown", "waterfall")
        it.page.wait_for_selector("#plots canvas[aria-label^=Amplitudes]")
        it.page.wait_for_timeout(500)
        assert it.colours("#plots canvas") > 20
        it.keep("waterfall")
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
    stiffness = [one["figures"]["rows"][-1]["stiffness_tangent_mean_N_per_m"] for one in (before, it.answer())]
    assert stiffness[0] < stiffness[1] < 2.0 * stiffness[0]
    it.page.click("#undo")
    it.wait(3)
    assert it.answer()["models"] == before["models"]
    assert all("409" in one for one in it.complaints), it.complaints


def test_an_optimum_is_taken_over(browser, address):
    it = studio_page.Page(browser, address)
    it.wait()
    before = it.answer()["figures"]["rows"][-1]
    it.page.locator("#seek summary").click()
    it.page.locator("#seek input[type=number]").last.fill("20")
    it.page.click("#seek-start")
    it.page.wait_for_selector("#seek svg .point", timeout=60_000)
    it.keep("optimum")
    best = it.page.locator("#seek svg .point").first
    told = re.search(r"µm at 150 Nm: ([-0-9.]+)", best.get_attribute("aria-label"))
    best.click()
    it.wait(2)
    row = it.answer()["figures"]["rows"][-1]
    assert 1e6 * row["te_peak_to_peak_m"] == pytest.approx(float(told[1]), rel=1e-3)
    relief = it.field(RELIEF).locator("input[type=number]").input_value()
    assert 0 <= float(relief) <= 60
    it.page.click("#undo")
    it.wait(3)
    assert it.answer()["figures"]["rows"][-1] == before
    assert it.complaints == []


def test_something_new(browser, tmp_path):
    with studio_page.server(PROGRAM, folder=tmp_path) as address:
        it = studio_page.Page(browser, address)
        card = lambda kind: it.page.locator(f"#kinds [data-kind={kind}]")
        card("bearing").click()
        it.page.wait_for_selector("#outcome [data-column=life_L10r_Mrev]")
        life = lambda: float(it.page.locator("#outcome [data-column=life_L10r_Mrev]").get_attribute("value"))
        at_first = life()
        text = it.page.locator("#text")
        assert "load_N" in text.input_value()
        # The text is the file: twice the load, an eighth of the life.
        text.fill(text.input_value().replace("[0.0, 1500.0, 300.0]", "[0.0, 3000.0, 600.0]"))
        it.until(f"document.querySelector('#outcome [data-column=life_L10r_Mrev]')?.value != '{at_first}'")
        assert life() < 0.2 * at_first
        it.keep("new_bearing")

        card("pair").click()
        module = it.field("tooth.module_mm").locator("input[type=number]")
        it.page.wait_for_selector(".field[data-key='tooth.module_mm']", state="attached")
        it.page.evaluate("for (const group of document.querySelectorAll('details')) group.open = true")
        it.until("document.querySelector('#text').value.includes('module_mm = 3.0')")
        module.fill("2.5")
        module.press("Enter")
        it.until("document.querySelector('#text').value.includes('module_mm = 2.5')")
        # What is wrong with it is said while one types, and Run waits.
        it.page.wait_for_selector("#problem:not([hidden])")
        assert "module" in it.page.locator("#problem").text_content() and it.page.locator("#run").is_disabled()
        text.fill(text.input_value().replace("module_mm = 2.5", "module_mm = 3.0"))
        it.until("document.querySelector('.field[data-key=\"tooth.module_mm\"] input').value === '3'")
        it.until("document.querySelector('#problem').hidden")
        for name in ("pinion.toml", "wheel.toml"):
            it.page.locator("#tabs button", has_text=name).click()
            coarse = "\n[mesh]\nflank_mm = 2.0\nfillet_mm = 1.0\nbody_mm = 6.0\naxial_mm = 5.0\n[reduction]\nslices = 3\nroll_stations = 4\n"
            text.fill(text.input_value() + coarse)
            it.page.wait_for_timeout(400)
        it.keep("new_pair")
        it.page.click("#run")
        it.page.wait_for_selector("#pair:not([hidden])", timeout=120_000)
        it.until("document.querySelector('#pair')?.hidden === false && globalThis.gearmeshStudio?.times?.length > 0", seconds=120)
        assert (tmp_path / "pair/pinion.h5").exists()
        assert len(it.answer()["figures"]["rows"]) == 3
        # What was refused, and an answer that a newer one has overtaken.
        assert all("422" in one or "409" in one for one in it.complaints), it.complaints


def test_a_bevel_pair_and_a_gearbox_from_nothing(browser, tmp_path):
    with studio_page.server(PROGRAM, folder=tmp_path) as address:
        it = studio_page.Page(browser, address)
        it.page.locator("#kinds [data-kind=bevel-pair]").click()
        text = it.page.locator("#text")
        it.until("document.querySelector('#text').value.includes('positions_per_pitch')")
        text.fill(text.input_value().replace("slices = 31", "slices = 11").replace("positions_per_pitch = 16", "positions_per_pitch = 8"))
        it.until("!document.querySelector('#run').disabled")
        it.page.click("#run")
        it.page.wait_for_selector("#outcome canvas", timeout=120_000)
        assert it.colours("#outcome canvas >> nth=0") > 5
        it.keep("new_bevel")
        picked = it.page.locator("#kinds input[type=file]")
        picked.set_input_files("fe_models/gearbox_three_stage.rexs")
        it.page.wait_for_selector("#outcome h2", timeout=120_000)
        assert it.page.locator("#outcome table").count() >= 3
        it.keep("new_gearbox")
        assert (tmp_path / "gearbox").is_dir()
        # An answer that a newer one has overtaken stands in the console, and nothing else does.
        assert all("409" in one for one in it.complaints), it.complaints


def test_gears_of_a_system_move(browser, scene, tmp_path):
    drive = f"""title = "drive"
run = {{ kind = "transient", end_s = 0.002 }}
solver = {{ step_s = 2e-5, start = "equilibrium" }}
output = {{ interval_s = 1e-4 }}
body = [
  {{ name = "pinion", gear = "{scene.parent}/pinion.h5" }},
  {{ name = "wheel", gear = "{scene.parent}/wheel.h5", position_mm = [94.6, 0.0, 0.0] }},
]
joint = [{{ name = "a", kind = "revolute", body_2 = "pinion" }}, {{ name = "b", kind = "revolute", body_2 = "wheel" }}]
motion = [{{ joint = "a", speed_rpm = -600.0 }}]
load = [{{ body = "wheel", torque_Nm = -100.0 }}]
gear_mesh = [{{ name = "mesh", gear_1 = "pinion", gear_2 = "wheel", model = {{ kind = "hybrid" }} }}]
"""
    (tmp_path / "drive.toml").write_text(drive)
    result = tmp_path / "drive.h5"
    gm.program("run", str(tmp_path / "drive.toml"), "-o", str(result))
    with studio_page.server(PROGRAM, result) as address:
        it = studio_page.Page(browser, address)
        it.page.wait_for_selector("#plots canvas")
        it.page.locator("#motion summary").click()
        it.until("Number(document.querySelector('#moment').max) > 10")
        it.page.wait_for_timeout(300)
        assert it.colours("#moving") > 20, "#moving is blank"
        # 100 N m on the wheel: the arrow is the force on the base circle of 112.8 mm.
        longest = float(it.page.locator("#force-scale").text_content().split()[2])
        assert longest == pytest.approx(100.0 / 0.05638, rel=0.05)
        first = it.page.locator("#moving").screenshot()
        it.page.locator("#moment").evaluate("(slider) => { slider.value = 9; slider.dispatchEvent(new Event('input', {bubbles: true})); }")
        it.page.wait_for_timeout(300)
        assert it.page.locator("#moving").screenshot() != first
        it.keep("motion")
        # Two columns as an orbit.
        it.page.locator("#names input").nth(1).check()
        it.page.select_option("#shown", "orbit")
        it.page.wait_for_selector("#plots canvas[aria-label^=Two]")
        assert it.colours("#plots canvas") > 3
        assert it.complaints == []


def named_by_whole_paths(name, folder, *changes):
    """A shipped scene in another folder, with some words replaced."""
    models = Path("fe_models").absolute()
    text = (models / name).read_text()
    for before, after in (*changes, ('gear = "', f'gear = "{models}/'), ('file = "', f'file = "{models}/')):
        assert before in text or before.endswith('"'), before
        text = text.replace(before, after)
    (folder / name).write_text(text)
    return folder / name


def run_of(scene, result):
    gm.program("run", str(scene), "-o", str(result))
    return result


def test_planets_show_how_they_share_the_load(browser, tmp_path):
    gm.program("init", "planetary", "-o", str(tmp_path / "set"))
    scene = next(path for path in (tmp_path / "set").glob("*.toml") if "[[planetary]]" in path.read_text())
    with studio_page.server(PROGRAM, run_of(scene, tmp_path / "set.h5")) as address:
        it = studio_page.Page(browser, address)
        it.page.select_option("#shown", "planets")
        it.until("document.querySelectorAll('#plots canvas').length === 2")
        assert all("carrier" in one for one in it.page.locator("#plots figcaption").all_text_contents())
        assert it.colours("#plots canvas >> nth=0") > 5
        it.keep("planets")
        assert it.complaints == []


def test_modes_move_the_machine(browser, tmp_path):
    scene = named_by_whole_paths("gearbox_three_stage.toml", tmp_path, ('kind = "static"', 'kind = "eigen"'))
    with studio_page.server(PROGRAM, run_of(scene, tmp_path / "modes.h5")) as address:
        it = studio_page.Page(browser, address)
        it.page.wait_for_selector("#mode-rows tr[aria-selected=true]")
        it.page.locator("#vibrate").click()
        it.page.locator("#mode-rows tr").nth(4).locator("button").click()
        it.until("document.querySelector('#mode-told').textContent.startsWith('mode 5, ')")
        it.page.wait_for_timeout(500)
        assert it.colours("#vibrating") > 20, "#vibrating is blank"
        still = it.page.locator("#vibrating").screenshot()
        it.keep("modes")
        it.page.locator("#vibrate").click()
        it.page.wait_for_timeout(600)
        it.page.locator("#vibrate").click()
        it.page.wait_for_timeout(300)
        assert it.page.locator("#vibrating").screenshot() != still
        assert it.complaints == []


def test_one_equilibrium_shows_machine_and_figures(browser, tmp_path):
    result = run_of(named_by_whole_paths("gearbox_three_stage.toml", tmp_path), tmp_path / "rest.h5")
    with studio_page.server(PROGRAM, result) as address:
        it = studio_page.Page(browser, address)
        it.page.wait_for_selector("#plots table")
        it.until("document.querySelector('#force-scale').textContent.includes('longest arrow')")
        it.page.wait_for_timeout(300)
        assert it.colours("#moving") > 20
        assert "third stage: transmission error" in it.page.locator("#plots").text_content()
        it.keep("equilibrium")
        assert it.complaints == []


def test_balls_move_and_two_results_stand_beside_each_other(browser, tmp_path):
    changes = ("end_s = 0.1", "end_s = 0.002"), ("interval_s = 1e-4", "interval_s = 1e-5")
    scene = named_by_whole_paths("spindle_6000_rpm.toml", tmp_path, *changes)
    first = run_of(scene, tmp_path / "first.h5")
    scene.write_text(scene.read_text().replace("force_N = 300.0", "force_N = 900.0"))
    second = run_of(scene, tmp_path / "second.h5")
    with studio_page.server(PROGRAM, first, beside=second) as address:
        it = studio_page.Page(browser, address)
        it.page.wait_for_selector("#plots canvas")
        labels = "[...document.querySelectorAll('#plots .u-legend .u-label')].map((one) => one.textContent)"
        assert sum(", Spindle" in label for label in it.page.evaluate(labels)) == 1
        assert "first.h5" in it.page.locator("#file").text_content() and "second.h5" in it.page.locator("#file").text_content()
        it.page.locator("#motion summary").click()
        it.until("Number(document.querySelector('#moment').max) > 10")
        it.page.wait_for_timeout(300)
        before = it.page.locator("#moving").screenshot()
        it.page.locator("#moment").evaluate("(slider) => { slider.value = 90; slider.dispatchEvent(new Event('input', {bubbles: true})); }")
        it.page.wait_for_timeout(300)
        assert it.page.locator("#moving").screenshot() != before
        it.page.select_option("#shown", "envelope")
        it.until("[...document.querySelectorAll('#plots figcaption')].every((one) => one.textContent.includes('envelope'))")
        it.keep("balls")
        assert it.complaints == []


def test_a_bevel_pair_answers_while_its_fields_change(browser, tmp_path):
    scene = tmp_path / "bevel.toml"
    scene.write_text(Path("fe_models/bevel_13_35_loaded.toml").read_text())
    with studio_page.server(PROGRAM, scene) as address:
        it = studio_page.Page(browser, address)
        it.page.wait_for_selector("#outcome [data-column=te_peak_to_peak_um]")
        it.until("globalThis.gearmeshLooks.length >= 1")
        shown = lambda: [float(one.get_attribute("value")) for one in it.page.locator("#outcome [data-column=te_peak_to_peak_um]").all()]
        expected = [1e6 * row["te_peak_to_peak_m"] for row in studio_page.printed(PROGRAM, scene, tmp_path)["rows"]]
        assert shown() == pytest.approx(expected, rel=1e-12)
        # Gears and curves stand at one position.
        gears, curve = it.page.locator("#outcome .scene > canvas"), it.page.locator("#outcome .uplot").first
        it.page.wait_for_timeout(500)
        assert it.colours("#outcome .scene > canvas") > 20 and it.colours("#outcome .uplot canvas >> nth=0") > 5
        before = gears.screenshot()
        box = curve.locator(".u-over").bounding_box()
        curve.locator(".u-over").hover(position=dict(x=0.5 * box["width"], y=60))
        angle = float(it.page.locator("#outcome .position output").text_content().rstrip("°"))
        assert 0.0 < angle == pytest.approx(float(curve.locator(".u-legend .u-value").first.text_content()), rel=1e-3)
        it.page.wait_for_timeout(300)
        assert gears.screenshot() != before
        # A field: the figures of `gearmesh run` for the file as it is now.
        it.page.evaluate("for (const group of document.querySelectorAll('details')) group.open = true")
        field = it.field("bevel.spiral_angle_deg").locator("input[type=number]")
        field.fill("33")
        field.press("Enter")
        it.until(f"Number(document.querySelector('#outcome [data-column=te_peak_to_peak_um]').value) !== {shown()[0]!r}")
        changed = tmp_path / "changed.toml"
        changed.write_text(it.page.locator("#text").input_value())
        assert "spiral_angle_deg = 33" in changed.read_text()
        again = [1e6 * row["te_peak_to_peak_m"] for row in studio_page.printed(PROGRAM, changed, tmp_path)["rows"]]
        assert shown() == pytest.approx(again, rel=1e-12)
        # A pinned state stays beside the next one; a link brings it to another page.
        it.page.click("#pin-new")
        differences = it.page.locator("#outcome .difference")
        assert differences.count() > 5 and set(differences.all_text_contents()) == {"±0.0 %"}
        kept = shown()
        field.fill("34")
        field.press("Enter")
        it.until(f"Number(document.querySelector('#outcome [data-column=te_peak_to_peak_um]').value) !== {kept[0]!r}")
        assert any(one != "±0.0 %" for one in differences.all_text_contents())
        assert "pin 1" in it.page.locator("#outcome .u-legend").first.text_content()
        it.keep("bevel_pinned")
        it.page.locator("#outcome .actions button").first.click()
        it.until(f"Number(document.querySelector('#outcome [data-column=te_peak_to_peak_um]').value) === {kept[0]!r}")
        shared = studio_page.Page(browser, it.page.url)
        shared.until(f"Number(document.querySelector('#outcome [data-column=te_peak_to_peak_um]')?.value) === {kept[0]!r}")
        assert shared.page.locator("#text").input_value() == changed.read_text()
        assert shared.complaints == []
        assert it.complaints == []


def test_a_scene_of_a_folder_is_run_and_its_result_opens(browser, tmp_path):
    named_by_whole_paths("gearbox_three_stage.toml", tmp_path)
    (tmp_path / "notes.txt").write_text("no scene")
    with studio_page.server(PROGRAM, tmp_path) as address:
        it = studio_page.Page(browser, address)
        cards = it.page.locator("#choices button")
        cards.first.wait_for()
        assert cards.count() == 1 and "multibody scene" in cards.first.text_content()
        it.keep("folder")
        cards.first.click()
        it.page.locator("#run-scene").click()
        it.page.wait_for_selector("#plots table", timeout=60_000)
        assert (tmp_path / "gearbox_three_stage.h5").exists()
        assert it.complaints == []
