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


def cut_from(content, start):
    """The line that begins here, with its end, and where the next begins."""
    end = content.find(b"\n", start)
    return (content[start:], len(content)) if end < 0 else (content[start : end + 1], end + 1)


def data_set(content, at):
    """The data set whose first line begins here, as pyuff takes it, and where the next begins.

    pyuff takes `    -1` for an end wherever it stands, in a head as well, and that of a binary set straight behind its
    data only; most programs begin a line for it."""
    kind, at = cut_from(content, at)
    head, body = [kind], b""
    if kind[:7] == b"    58b":
        lines, size = int(kind[19:31]), int(kind[31:43])
        for _ in range(lines):
            line, at = cut_from(content, at)
            head.append(line)
        data, at = content[at : at + size], at + size
        if len(data) < size:
            refuse(f"a data set has {len(data)} of the {size} bytes that its head says; the file is cut")
        end = content.find(b"    -1", at)
        if end < 0 or content[at:end].strip():
            refuse("a binary data set does not end where its head says; the file is damaged")
        body, at = data, cut_from(content, end)[1]
    else:
        while True:
            if at >= len(content):
                refuse("the last data set has no end (a line with -1); the file is cut")
            line, at = cut_from(content, at)
            if line.rstrip() == b"    -1":
                break
            head.append(line)
    # Columns have fixed widths: as many characters, and the same number.
    head[1:] = [line.replace(b"    -1", b"   -01") for line in head[1:]]
    return b"    -1\n" + b"".join(head) + body + b"    -1\n", at


def plain(name):
    """The name of a copy whose data sets end as pyuff wants, and whose exponents are not Fortran's D."""
    with open(name, "rb") as given:
        content = given.read()
    sets, at = [], 0
    while at < len(content):
        line, at = cut_from(content, at)
        if line.rstrip() == b"    -1":
            found, at = data_set(content, at)
            if found[7:14] != b"    58b":
                found = re.sub(rb"(\d)[Dd]([+-]\d)", rb"\1E\2", found)
            sets.append(found)
    copy = os.path.join(tempfile.mkdtemp(), "copy.uff")
    atexit.register(shutil.rmtree, os.path.dirname(copy), True)
    with open(copy, "wb") as changed:
        changed.write(b"".join(sets))
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
