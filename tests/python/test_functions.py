"""Python functions as loads, motions and force elements: beside the same scenes with closed forms."""

import time
import traceback

import numpy as np
import pytest

import gearmesh as gm
from interruption import interruption

WHEEL = {
    "title": "wheel",
    "run": {"kind": "transient", "end_s": 0.5},
    "solver": {"step_s": 1e-3},
    "output": {"interval_s": 1e-2},
    "body": [{"name": "wheel", "mass_kg": 1.0, "inertia_kg_m2": [0.5, 0.5, 0.5]}],
    "joint": [{"name": "axis", "kind": "revolute", "body_2": "wheel"}],
}
SPEED = "bodies/wheel/angular_velocity_z_rad_per_s"
SINE = {"sine": {"amplitude": 2.0, "frequency_Hz": 3.0}}


def sine(time_s):
    return 2.0 * np.sin(2.0 * np.pi * 3.0 * time_s)


def loaded(torque):
    return {**WHEEL, "load": [{"body": "wheel", "torque_Nm": torque}]}


def test_a_load_is_that_of_the_closed_form():
    expected = gm.run(loaded(SINE), progress=False)
    found = gm.run(loaded({"python": "fan"}), functions={"fan": sine}, progress=False)
    assert found[SPEED] == pytest.approx(expected[SPEED], rel=1e-12, abs=1e-12)
    # One call an evaluation; the cost is told.
    assert 500 <= found.calls["fan"] <= 5000
    note = next(note for note in found.notes if "fan" in note)
    assert f"{found.calls['fan']} calls" in note and " s of the run's " in note
    assert f"`fan` called {found.calls['fan']} times" in repr(found)


def test_a_motion_is_that_of_the_closed_form():
    def driven(function):
        return {**WHEEL, "motion": [{"joint": "axis", "angle_deg": function}]}

    def angle_deg(time_s):
        omega = 2.0 * np.pi * 3.0
        phase = omega * time_s
        return 2.0 * np.sin(phase), 2.0 * omega * np.cos(phase), -2.0 * omega**2 * np.sin(phase)

    expected = gm.run(driven(SINE), progress=False)
    found = gm.run(driven({"python": "swing"}), functions={"swing": angle_deg}, progress=False)
    assert found[SPEED] == pytest.approx(expected[SPEED], rel=1e-10, abs=1e-10)
    with pytest.raises(gm.InputError, match=r"motion.0.angle_deg: .*\(value, rate, acceleration\)"):
        gm.run(driven({"python": "swing"}), functions={"swing": lambda time_s: 0.0}, progress=False)


def test_an_element_is_the_same_spring():
    spring = {"name": "spring", "body_2": "wheel", "stiffness_Nm_per_rad": 8.0, "damping_Nm_s_per_rad": 0.1}
    start = {**WHEEL, "body": [{**WHEEL["body"][0], "speed_rpm": 100.0}]}
    expected = gm.run({**start, "torsion_spring": [spring]}, progress=False)

    def law(time_s, displacement_m, rotation_rad, velocity_m_per_s, angular_velocity_rad_per_s):
        assert len(displacement_m) == len(velocity_m_per_s) == 3
        return (0.0, 0.0, 0.0), (0.0, 0.0, -8.0 * rotation_rad[2] - 0.1 * angular_velocity_rad_per_s[2])

    element = {"name": "spring", "function": "law", "body_2": "wheel"}
    found = gm.run({**start, "python_element": [element]}, functions={"law": law}, progress=False)
    assert found[SPEED] == pytest.approx(expected[SPEED], rel=1e-6, abs=1e-6)
    # It winds up and swings back: the law is no constant.
    assert found[SPEED].min() < -0.3 * found[SPEED].max()
    torque = found["elements/spring/moment_z_Nm"]
    assert torque == pytest.approx(expected["elements/spring/moment_z_Nm"], rel=1e-5, abs=1e-5)


def test_an_exception_comes_back_with_its_traceback():
    calls = []

    def fan(time_s):
        calls.append(time_s)
        return 1.0 / (0.0 if time_s > 0.1 else 1.0)

    with pytest.raises(gm.WorkError, match=r"Python function `fan` at t = 0\.1\d* s raised ZeroDivisionError") as caught:
        gm.run(loaded({"python": "fan"}), functions={"fan": fan}, progress=False)
    cause = caught.value.__cause__
    assert isinstance(cause, ZeroDivisionError)
    assert any(frame.name == "fan" for frame in traceback.extract_tb(cause.__traceback__))
    # It is called no more.
    assert sum(time_s > 0.1 for time_s in calls) == 1
    with pytest.raises(gm.WorkError, match="it returned 'much'"):
        gm.run(loaded({"python": "fan"}), functions={"fan": lambda time_s: "much"}, progress=False)
    with pytest.raises(gm.WorkError, match="its function gave nan|NaN"):
        gm.run(loaded({"python": "fan"}), functions={"fan": lambda time_s: float("nan")}, progress=False)


def test_ctrl_c_in_a_function_is_ctrl_c():
    def stop(time_s):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        gm.run(loaded({"python": "fan"}), functions={"fan": stop}, progress=False)


def test_functions_and_scenes_must_fit(tmp_path):
    with pytest.raises(gm.InputError, match="load.0.torque_Nm.python.*`fan`.*functions="):
        gm.run(loaded({"python": "fan"}), progress=False)
    with pytest.raises(gm.InputError, match="the scene calls no fan"):
        gm.Scene(loaded(1.0), functions={"fan": sine})
    scene = gm.Scene(loaded({"python": "fan"}), functions={"fan": sine})
    assert any("load" in line or "torque" in line for line in scene.plan())
    # A scene with other keys calls the same functions.
    assert scene.but({"run.end_s": 0.1}).run(progress=False).calls["fan"] > 100
    # The program has none.
    scene.write(tmp_path / "scene.toml")
    with pytest.raises(gm.InputError, match="only a run from Python"):
        gm.program("plan", tmp_path / "scene.toml")


def test_a_run_is_not_resumed_with_other_functions(tmp_path):
    output = tmp_path / "run.h5"

    with interruption() as interrupt:

        def slow(time_s):
            if time_s > 0.05:
                interrupt()
                # Time for the run to be told.
                time.sleep(1e-3)
            return 1.0

        scene = gm.Scene(loaded({"python": "fan"}), functions={"fan": slow})
        with pytest.raises(KeyboardInterrupt):
            scene.run(output, progress=False)
    assert (tmp_path / "run.h5.part").exists() and not output.exists()
    with pytest.raises(gm.InputError, match="unfinished run"):
        gm.run(loaded({"python": "fan"}), output, functions={"fan": sine}, progress=False)
    # The same Scene goes on.
    resumed = scene.run(output, progress=False)
    whole = gm.run(loaded(1.0), progress=False)
    assert np.array_equal(resumed[SPEED], whole[SPEED])
