"""Functions, as JSON on standard input, into a universal file (data sets 164 and 58) by pyuff. Argument: the file."""

import json
import sys

try:
    import numpy as np
    import pyuff
except ModuleNotFoundError as missing:
    sys.exit(f"{missing}; pip install {missing.name}")

# Specific data types of data set 58, by SI unit; all else is "general".
KINDS = {"m": 8, "N": 13, "m/s": 11, "m/s²": 12, "Pa": 15, "s": 17}
# The format is ASCII, and an axis' label and unit have 20 letters.
ASCII = {"·": "*", "²": "2", "√": "sqrt ", "µε": "ustrain"}


def ascii(text, width=80):
    for found, put in ASCII.items():
        text = text.replace(found, put)
    return text.encode("ascii", "replace").decode()[:width] or "NONE"


def label(name):
    """The end of a column's name, which says what it is."""
    return ascii(name.rsplit("/", 1)[-1], 20)


given = json.load(sys.stdin)
sets = [{
    "type": 164, "units_code": 1, "units_description": "SI", "temp_mode": 1,
    "length": 1.0, "force": 1.0, "temp": 1.0, "temp_offset": 0.0,
}]
for number, function in enumerate(given["functions"], 1):
    x, y = np.array(function["x"]), np.array(function["y"])
    steps = np.diff(x)
    even = bool(np.all(np.abs(steps - steps[0]) <= 1e-6 * abs(steps[0])))
    name = ascii(function["name"], 160)
    sets.append({
        "type": 58, "binary": 0,
        "id1": name[:80], "id2": name[80:] or "NONE", "id3": ascii(function["condition"]),
        "id4": ascii(given["title"]), "id5": ascii(given["program"]),
        "func_type": 1 if function["axis_unit"] == "s" else 0,
        "func_id": number, "rsp_node": number, "rsp_dir": 0, "ref_node": 0, "ref_dir": 0,
        "abscissa_spacing": int(even),
        "abscissa_spec_data_type": KINDS.get(function["axis_unit"], 1),
        "abscissa_axis_lab": label(function["axis"]), "abscissa_axis_units_lab": ascii(function["axis_unit"], 20),
        "ordinate_spec_data_type": KINDS.get(function["unit"], 1),
        "ordinate_axis_lab": label(function["name"]), "ordinate_axis_units_lab": ascii(function["unit"], 20),
        "orddenom_spec_data_type": 0, "z_axis_spec_data_type": 0,
        # The step over the whole length: of few digits in the file, it should be right at the end.
        "x": x[0] + (x[-1] - x[0]) / (len(x) - 1) * np.arange(len(x)) if even else x, "data": y,
    })
pyuff.UFF(sys.argv[1]).write_sets(sets, mode="overwrite")
