"""Dicts as texts of files, and keys of files by dotted paths."""

from __future__ import annotations

import copy
import json
import math
import os
from pathlib import Path
from typing import Any

from . import _native

Tables = dict[str, Any]


def to_toml(tables: Tables) -> str:
    """TOML text of nested dicts, lists, numbers, texts and truth values; None leaves a key out."""
    return _native.toml_from_json(json.dumps(plain(tables)))


def from_toml(text: str, file: str) -> Tables:
    """Nested dicts of a TOML text; file is its name in complaints (InputError)."""
    return json.loads(_native.json_from_toml(text, file))


def plain(value: Any, path: str = "") -> Any:
    """What JSON knows: paths become texts, NumPy's numbers and arrays Python's. InputError for numbers that are not finite and
    for what a file cannot hold."""
    if isinstance(value, dict):
        below = {str(key): item for key, item in value.items() if item is not None}
        return {key: plain(item, f"{path}.{key}" if path else key) for key, item in below.items()}
    if isinstance(value, os.PathLike):
        return str(Path(value).absolute())
    if hasattr(value, "tolist"):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(item, f"{path}.{place}") for place, item in enumerate(value)]
    if isinstance(value, float) and not math.isfinite(value):
        raise _native.InputError(f"{path}: found {value}, allowed is a finite number")
    if isinstance(value, (str, int, float)):
        return value
    found = "None" if value is None else f"a Python {type(value).__name__}"
    raise _native.InputError(f"{path}: found {found}, allowed are dicts, lists, numbers, texts and truth values")


def with_keys(tables: Tables, changes: dict[str, Any]) -> Tables:
    """A copy with keys replaced: dotted paths, items of lists by number from 0 ("gear_mesh.0.model.kind").

    Raises KeyError for a path through something that is no table or list.
    """
    changed = copy.deepcopy(tables)
    for path, value in changes.items():
        *parents, last = path.split(".")
        place: Any = changed
        for part in parents:
            if isinstance(place, list) and part.isdigit() and int(part) < len(place):
                place = place[int(part)]
            elif isinstance(place, dict):
                place = place.setdefault(part, {})
            else:
                raise KeyError(f"{path}: there is no `{part}`")
        if isinstance(place, list) and last.isdigit() and int(last) < len(place):
            place[int(last)] = value
        elif isinstance(place, dict):
            place[last] = value
        else:
            raise KeyError(f"{path}: there is no `{last}`")
    return changed
