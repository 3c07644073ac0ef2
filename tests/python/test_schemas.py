"""The JSON Schemas that `gearmesh schema` prints, asked by another program (`jsonschema`): every shipped file satisfies the
schema of its kind, and files with wrong keys do not.
"""

import functools
import json
import os
import pathlib
import subprocess

import jsonschema
import pytest

try:
    import tomllib
except ModuleNotFoundError:  # Python 3.10
    import tomli as tomllib

ROOT = pathlib.Path(__file__).parents[2]
MODELS = ROOT / "fe_models"
# `cargo xtask test` names the program that it built.
PROGRAM = os.environ.get("GEARMESH_PROGRAM", ROOT / "target/debug/gearmesh")
# A key at the top of a file tells its kind.
KIND_OF_KEY = {"tooth": "gear", "pair": "scene", "body": "scene", "parameter": "study", "pitch_diameter_mm": "bearing", "pinion": "bevel", "bevel_gear": "bevel-gear", "objective": "optimise"}
# S-N tables have no schema.
FILES = sorted(path for path in MODELS.rglob("*.toml") if path.name != "sn_example.toml")


@functools.cache
def validator(kind):
    printed = subprocess.run([PROGRAM, "schema", kind], check=True, capture_output=True, text=True).stdout
    schema = json.loads(printed)
    jsonschema.Draft202012Validator.check_schema(schema)
    return jsonschema.Draft202012Validator(schema)


def kind_of(content):
    kinds = {kind for key, kind in KIND_OF_KEY.items() if key in content}
    assert len(kinds) == 1, f"{kinds}: {list(content)}"
    return kinds.pop()


def messages(error):
    """The messages of an error and of all alternatives that were tried."""
    return [error.message] + [text for inner in error.context for text in messages(inner)]


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(MODELS)))
def test_shipped_files_satisfy_their_schema(path):
    content = tomllib.loads(path.read_text())
    errors = [f"{error.json_path}: {messages(error)}" for error in validator(kind_of(content)).iter_errors(content)]
    assert not errors, "\n".join(errors)


def test_files_of_every_kind_are_shipped():
    kinds = {kind_of(tomllib.loads(path.read_text())) for path in FILES}
    assert kinds == set(KIND_OF_KEY.values())


@pytest.mark.parametrize(
    ("before", "after", "part"),
    [
        ("exponent = 1.5", "exponnt = 1.5", "'exponnt' was unexpected"),
        ("exponent = 1.5", 'exponent = "a"', "'a' is not of type 'number'"),
        ('kind = "impact"', 'kind = "impct"', "'impct'"),
        # A key of another kind.
        ("exponent = 1.5", 'exponent = 1.5\nlocal = "none"', "'local' was unexpected"),
        ("from = 0.0, ", "", "'from' is a required property"),
        ('name = "mesh"', "", "'name' is a required property"),
        ("position_mm = [150.0, 0.0, 0.0]", "position_mm = [150.0, 0.0]", "[150.0, 0.0] is too short"),
        ('gear_2 = "wheel"', 'gear_2 = "wheel"\nteeth.errors_1 = [{ kind = "spall", tooth = 1 }]', "'errors_1'"),
    ],
)
def test_wrong_files_do_not(before, after, part):
    text = (MODELS / "scene_two_wheels.toml").read_text()
    assert text.count(before) == 1
    found = [text for error in validator("scene").iter_errors(tomllib.loads(text.replace(before, after))) for text in messages(error)]
    assert any(part in text for text in found), found
