"""Pairs on the page of `gearmesh studio` in a real browser. Its server: crates/cli/tests/scene_commands/studio.rs."""

import re
from pathlib import Path

import pytest

import gearmesh as gm
import studio_page
from studio_page import PROGRAM

RELIEF = "gear_1.microgeometry.tip_relief_um"


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
