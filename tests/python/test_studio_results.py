"""The page of `gearmesh studio` in a real browser: results of multibody scenes, and the scenes of a folder."""

from pathlib import Path

import pytest

import gearmesh as gm
import studio_page
from studio_page import PROGRAM


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
