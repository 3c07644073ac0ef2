"""A reduced gear: the compliance of its flanks in one file."""

from __future__ import annotations

import functools
import hashlib
import os
import sys
from pathlib import Path
from typing import Any

import numpy as np

from . import _native
from .gear import Gear
from .pictures import curves, table, titled
from .progress import Bar, Progress
from .toml_text import Tables, from_toml


class ReducedGear:
    """A reduced gear file (.h5). Opening it reads and checks it.

    model["c_hub"] and the other keys are those of gearmesh.read_reduced, NumPy arrays in SI units. Raises
    FileNotFoundError, InputError for a file that is damaged or of another kind.
    """

    def __init__(self, path: str | os.PathLike[str]) -> None:
        self.path = Path(path).absolute()
        self._parts = _native.read_reduced(self.path)

    def __getitem__(self, key: str) -> Any:
        return self._parts[key]

    def keys(self) -> list[str]:
        """Names of the parts."""
        return list(self._parts)

    @property
    def name(self) -> str:
        """Name of the gear."""
        return self._parts["name"]

    @property
    def teeth(self) -> int:
        """Number of teeth."""
        return self._parts["teeth"]

    @property
    def gauges(self) -> list[str]:
        """Names of the strain gauges."""
        return [gauge["name"] for gauge in self._parts["gauges"]]

    @functools.cached_property
    def gear(self) -> Gear:
        """The definition that it was made from."""
        return Gear.from_toml(self._parts["input_toml"], str(self.path))

    def __fspath__(self) -> str:
        return str(self.path)

    def _repr_html_(self) -> str:
        """What a notebook shows: the compliance of a loaded flank over the diameter, and what it was made of."""
        made, z = self["provenance"], len(self["z_m"])
        stations = len(self["roll_angles_rad"])
        diameter_mm = 2e3 * self["base_radius_m"] * np.sqrt(1.0 + np.asarray(self["roll_angles_rad"]) ** 2)
        # Line load over the face: of each station the mean deflection under equal loads at all its places.
        flank = np.asarray(self["c_hub"])[0, 0, 0, 0].reshape(stations, z, stations, z)
        micro = [1e9 * flank[k, :, k, :].mean() for k in range(stations)]
        order = np.argsort(diameter_mm)
        picture = curves(diameter_mm[order], [("loaded flank, bore held", np.asarray(micro)[order])], "diameter, mm", "compliance, um/kN")
        rows = [("teeth", str(self.teeth)), ("degrees of freedom", f"{made['dofs']} ({made['element']})"), ("repeating sectors", str(self["sectors"]))]
        if self.gauges:
            rows.append(("gauges", ", ".join(self.gauges)))
        return titled(self.name, picture, table(rows))

    def __repr__(self) -> str:
        made = self._parts["provenance"]
        gauges = f", gauges {', '.join(self.gauges)}" if self.gauges else ""
        return (
            f"<ReducedGear {self.name!r}: {self.teeth} teeth, {self['sectors']} repeating sectors, from {made['dofs']} "
            f"degrees of freedom ({made['element']}){gauges}; {self.path}>"
        )


def reduce(
    gear: Gear | str | Path | Tables,
    path: str | Path | None = None,
    *,
    error_estimate: bool = True,
    again: bool = False,
    even_if_memory_is_short: bool = False,
    progress: Progress = None,
) -> ReducedGear:
    """Meshes a gear and condenses it to the compliance of its flanks; seconds to minutes.

    gear: a Gear, a gear file or its tables; of a bevel gear its file. path: the model file; without it the file lies in the cache
    (GEARMESH_CACHE, else ~/.cache/gearmesh) under a digest of the gear file's text and the program's version; a gear
    that is there already is not reduced again unless again is true. error_estimate: also solve on a coarser mesh, for
    the mesh error of compliance and gauges. even_if_memory_is_short: begin where the estimate of the memory exceeds what is free.

    Raises InputError, WorkError, MemoryError, OSError; KeyboardInterrupt on Ctrl-C, and no model is written.
    """
    if isinstance(gear, dict):
        gear = Gear(**gear)
    if isinstance(gear, Gear):
        text, file = gear.toml, gear.file
    else:
        text, file = Path(gear).read_text(encoding="utf-8"), str(gear)
    if path is None:
        if others := _native.files_of(text, Path(file).parent):
            raise _native.InputError(f"path: the gear reads another file, {others[0][0]}; name the model that is made of it")
        path = _cache() / f"{_digest(text, error_estimate)}.h5"
        if path.exists() and not again:
            return ReducedGear(path)
        path.parent.mkdir(parents=True, exist_ok=True)
    with Bar(progress, str(from_toml(text, file).get("name", file))) as bar:
        _native.reduce(text, file, Path(path), interpreter(), error_estimate, bar.call, even_if_memory_is_short)
    return ReducedGear(path)


def _cache() -> Path:
    """Folder of the models that nobody has named."""
    named = os.environ.get("GEARMESH_CACHE")
    return Path(named) if named else Path.home() / ".cache" / "gearmesh"


def _digest(gear: str, error_estimate: bool) -> str:
    text = "\0".join([gear, _native.__version__, str(error_estimate)])
    return hashlib.sha256(text.encode()).hexdigest()[:32]


def interpreter() -> Path:
    """A Python with gmsh: the one that is running, unless told otherwise."""
    return Path(os.environ.get("GEARMESH_PYTHON") or sys.executable)
