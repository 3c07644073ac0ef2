"""The functions (data set 58, text or binary) of a universal file by pyuff, each as a line of JSON on standard output. Argument: the file.

One data set is in memory at a time."""

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


def data_set(file):
    """The data set whose first line the file is at, as pyuff takes it.

    pyuff takes `    -1` for an end wherever it stands, in a head as well, and that of a binary set straight behind its
    data only; most programs begin a line for it."""
    kind = file.readline()
    head, body = [kind], b""
    if kind[:7] == b"    58b":
        lines, size = int(kind[19:31]), int(kind[31:43])
        head += [file.readline() for _ in range(lines)]
        body = file.read(size)
        if len(body) < size:
            refuse(f"a data set has {len(body)} of the {size} bytes that its head says; the file is cut")
        for line in file:
            if line.strip():
                break
        else:
            line = b""
        if line.rstrip() != b"    -1":
            refuse("a binary data set does not end where its head says; the file is damaged")
    else:
        for line in file:
            if line.rstrip() == b"    -1":
                break
            head.append(line)
        else:
            refuse("the last data set has no end (a line with -1); the file is cut")
    # Columns have fixed widths: as many characters, and the same number.
    head[1:] = [line.replace(b"    -1", b"   -01") for line in head[1:]]
    found = b"    -1\n" + b"".join(head) + body + b"    -1\n"
    # Exponents are not Fortran's D.
    return found if body else re.sub(rb"(\d)[Dd]([+-]\d)", rb"\1E\2", found)


def data_sets(wanted):
    """Number and content of the data sets of a kind, pyuff's reading of each."""
    place = 0
    with open(sys.argv[1], "rb") as file:
        for line in file:
            if line.rstrip() != b"    -1":
                continue
            place += 1
            try:
                found = data_set(file)
                if found.split(b"\n", 2)[1][:6].strip() != str(wanted).encode():
                    continue
                with open(copy, "wb") as one:
                    one.write(found)
                read = pyuff.UFF(copy)
                is_known = list(read.get_set_types()) == [wanted]
            except Exception as problem:
                refuse(f"no universal file: {problem}")
            if not is_known:
                continue
            try:
                yield place, read.read_sets(0)
            except Exception as problem:
                refuse(f"data set {place}: pyuff cannot read it: {problem}")


copy = os.path.join(tempfile.mkdtemp(), "copy.uff")
atexit.register(shutil.rmtree, os.path.dirname(copy), True)
metres = all(abs(each["length"] - 1.0) < 1e-12 for _, each in data_sets(164))


def stated(text):
    text = text.strip()
    return "" if text.upper() == "NONE" else text


def unit(found, axis):
    """The unit label; without one that of the kind of data, unless the file is in other units than SI."""
    label = stated(found[f"{axis}_axis_units_lab"])
    kind = found[f"{axis}_spec_data_type"]
    return label or (BY_KIND.get(kind, "") if metres or kind in (3, 17, 18, 19) else "")


told, complex_ones = 0, []
for place, found in data_sets(58):
    data = np.asarray(found["data"])
    if np.iscomplexobj(data):
        complex_ones.append(stated(found["id1"]) or f"set {place}")
        continue
    count = int(found["num_pts"])
    if count < 1:
        refuse(f"data set {place}: it holds no values")
    if len(data) < count:
        refuse(f"data set {place}: {len(data)} values, its head says {count}; the file is cut")
    data, x = data[:count], np.asarray(found["x"])[:count]
    if not (np.isfinite(data).all() and np.isfinite(x).all()):
        refuse(f"data set {place}: a value is no finite number")
    words = [stated(found[key]) for key in ("id1", "id2", "id3")]
    json.dump({
        "name": words[0] or f"set {place}",
        "condition": ", ".join(word for word in words[1:] if word),
        "unit": unit(found, "ordinate"),
        "axis": stated(found["abscissa_axis_lab"]) or "abscissa",
        "axis_unit": unit(found, "abscissa"),
        "x": x.tolist(), "y": data.tolist(),
    }, sys.stdout)
    print()
    told += 1
if not told and complex_ones:
    refuse(f"all its functions are complex ({', '.join(complex_ones)}); curves over an angle or a time are real")
if not told:
    refuse("no universal file with functions: it has no data set 58")
