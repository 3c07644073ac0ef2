"""What Python writes goes through no link. Every command of the program, among links and traps: crates/cli/tests/hostile."""

import pytest

import gearmesh as gm


def test_what_python_writes_follows_no_link(tmp_path):
    gear = gm.Gear("small", teeth=18, module_mm=3, face_width_mm=12, bore_diameter_mm=14, material=gm.STEEL)
    scene = gm.Scene("fe_models/scene_pendulum.toml")
    for name, write in (("gear.toml", gear.write), ("scene.toml", scene.write)):
        target = tmp_path / f"target-of-{name}"
        (tmp_path / name).symlink_to(target)
        with pytest.raises(gm.InputError, match="link"):
            write(tmp_path / name)
        assert not target.exists()


def test_messages_steer_no_terminal():
    with pytest.raises(gm.InputError) as told:
        gm.Scene("fe_models/scene_pendulum.toml").but({"run.kind": "a\u202eb"}).run()
    assert "\u202e" not in str(told.value) and "\\u202e" in str(told.value)


def test_large_results_are_refused_until_they_are_allowed(tmp_path):
    scene = gm.Scene("fe_models/scene_pendulum.toml").but({"output.interval_s": 1e-5})
    with pytest.raises(gm.InputError, match=r"the result will have [0-9.]+ MB, allowed are 0.001 GB.*most_result_GB=1\b"):
        scene.run(tmp_path / "large.h5", most_result_GB=0.001)
    assert list(tmp_path.iterdir()) == []
