"""The functions (data set 58, text or binary) of a universal file by pyuff, as JSON on standard output. Argument: the file."""

import atexit
import json
import os
import re
import shutil
import sys
import tempfile

try:
    import numpy as np
    import pyuff
except ModuleNotFoundError as missing:
    sys.exit(f"{missing}; pip install {missing.name}")

# Units of an axis without a unit, by its specific data type, in a file that states SI or nothing.
BY_KIND = {3: "1", 8: "m", 9: "N", 11: "m/s", 12: "m/s2", 13: "N", 15: "Pa", 17: "s", 18: "Hz", 19: "rpm"}


def refuse(problem):
    print(problem, file=sys.stderr)
    sys.exit(2)




def plain(name):
    """The file's name; where a Fortran program has written exponents with D, that of a copy with E."""
    with open(name, "rb") as given:
        content = given.read()
    if b"    58b" in content[:400] or not re.search(rb"\d[Dd][+-]\d", content):
        return name
    copy = os.path.join(tempfile.mkdtemp(), "copy.uff")
    atexit.register(shutil.rmtree, os.path.dirname(copy), True)
    with open(copy, "wb") as changed:
        changed.write(re.sub(rb"(\d)[Dd]([+-]\d)", rb"\1E\2", content))
    return copy


try:
    file = pyuff.UFF(plain(sys.argv[1]))
    kinds = list(file.get_set_types())
    places = [place for place, kind in enumerate(kinds) if kind == 58]
    units = [file.read_sets(place) for place, kind in enumerate(kinds) if kind == 164]
except Exception as problem:
    refuse(f"no universal file: {problem}")
if not places:
    refuse("no universal file with functions: it has no data set 58")
metres = all(abs(each["length"] - 1.0) < 1e-12 for each in units)


def stated(text):
    text = text.strip()
    return "" if text.upper() == "NONE" else text


def unit(found, axis):
    """The unit label; without one that of the kind of data, unless the file is in other units than SI."""
    label = stated(found[f"{axis}_axis_units_lab"])
    kind = found[f"{axis}_spec_data_type"]
    return label or (BY_KIND.get(kind, "") if metres or kind in (3, 17, 18, 19) else "")


functions = []
complex_ones = []
for place in places:
    try:
        found = file.read_sets(place)
    except Exception as problem:
        refuse(f"data set {place + 1}: pyuff cannot read it: {problem}")
    data = np.asarray(found["data"])
    if np.iscomplexobj(data):
        complex_ones.append(stated(found["id1"]) or f"set {place + 1}")
        continue
    count = int(found["num_pts"])
    if count < 1:
        refuse(f"data set {place + 1}: it holds no values")
    if len(data) < count:
        refuse(f"data set {place + 1}: {len(data)} values, its head says {count}; the file is cut")
    data, x = data[:count], np.asarray(found["x"])[:count]
    if not (np.isfinite(data).all() and np.isfinite(x).all()):
        refuse(f"data set {place + 1}: a value is no finite number")
    words = [stated(found[key]) for key in ("id1", "id2", "id3")]
    functions.append({
        "name": words[0] or f"set {place + 1}",
        "condition": ", ".join(word for word in words[1:] if word),
        "unit": unit(found, "ordinate"),
        "axis": stated(found["abscissa_axis_lab"]) or "abscissa",
        "axis_unit": unit(found, "abscissa"),
        "x": x.tolist(), "y": data.tolist(),
    })
if not functions:
    refuse(f"all its functions are complex ({', '.join(complex_ones)}); curves over an angle or a time are real")
json.dump(functions, sys.stdout)
