"""Commands of the program that have no object of their own here."""

from __future__ import annotations

import csv
import os
import tempfile
from pathlib import Path
from typing import Any, Literal, Sequence

import numpy as np
from numpy.typing import NDArray

from .operations import operate
from .program import program
from .progress import Progress
from .scene import Scene, scene_file
from .toml_text import Tables, from_toml


def accuracy(
    scene: Scene | str | os.PathLike[str],
    columns: Sequence[str] = (),
    *,
    from_s: float = 0.0,
    page: str | os.PathLike[str] | None = None,
    elements: str | os.PathLike[str] | None = None,
    time: Literal["wall", "processor"] = "wall",
    progress: Progress = None,
) -> dict[str, Any]:
    """What accuracy costs in time, for columns of a scene: every knob of it against a reference (docs/accuracy-cost.md).

    columns: those of a study; of series COLUMN:FIGURE; none: deviations, peaks and mesh orders in motion, of pairs at rest
    peak-to-peak, pressure, K_Hbeta and strain. from_s: figures from this time on, of multibody runs. page: also write the page with the picture. elements: folder for models, where the gears' elements and element lengths are varied,
    too. time: what stands for cost. progress: see gearmesh.progress.Progress. Returns what `gearmesh accuracy --json`
    prints: the errors and seconds of each setting and what is advised for 1 %, 0.1 % and interactive work. Takes minutes.
    """
    given = {"columns": columns, "from_s": from_s, "elements": elements, "output": page}
    with scene_file(scene) as path:
        return operate("accuracy", progress, scene=path, by_processor_time=time == "processor", **given)


def check(file: str | os.PathLike[str]) -> dict[str, Any]:
    """What a gear, bearing, bevel pair, scene, study, record, model or result is; under "warnings" what looks odd, such as
    a number of another unit. Raises InputError for what is wrong."""
    return operate("check", file=file)


def doctor() -> dict[str, Any]:
    """What this machine has and lacks for gearmesh. Raises WorkError where something needed is missing."""
    return program("doctor")


def init(kind: Literal["gear", "pair", "gearbox", "planetary", "bevel"], folder: str | os.PathLike[str] = ".") -> list[Path]:
    """Writes commented files to start from; their paths. Raises InputError where a file is there already."""
    return [Path(file) for file in program("init", kind, "-o", folder)["files"]]


def demo(folder: str | os.PathLike[str], *, progress: Progress = None) -> str:
    """Makes gear pairs A and B from definition to report; a minute or two. progress: see gearmesh.progress.Progress."""
    return str(program("demo", "-o", folder, progress=progress))


def import_rexs(
    model: str | os.PathLike[str], folder: str | os.PathLike[str], *, reduced: bool = False, run: bool = True
) -> dict[str, Any]:
    """A gearbox from a REXS file (docs/rexs.md): gear files, scenes and bearings into a folder.

    reduced: scenes with `hybrid` meshes of reduced gears. run: check the files and run the scenes at rest. Returns
    `warnings`, the figures `at_rest`, and what was taken, assumed and not represented, each with its weight.
    """
    return operate("import", model=model, output=folder, reduced=reduced, no_run=not run)


class Record:
    """A reference record's folder (docs/records.md): record.toml and data.csv.

    record["te_um"] is a column of data.csv as an array, in the unit that its name has. Attributes: path, title, kind
    ("measured" or "computed"), tables (record.toml as dicts).
    """

    def __init__(self, folder: str | os.PathLike[str]) -> None:
        self.path = Path(folder)
        text = (self.path / "record.toml").read_text(encoding="utf-8")
        self.tables: Tables = from_toml(text, str(self.path / "record.toml"))
        operate("check", file=self.path)
        self.title, self.kind = str(self.tables.get("title", "")), str(self.tables.get("kind", ""))
        with open(self.path / "data.csv", newline="", encoding="utf-8") as file:
            rows = list(csv.reader(line for line in file if line.strip() and not line.startswith("#")))
        values = np.array(rows[1:], dtype=np.float64)
        self._columns = {head.strip(): values[:, place] for place, head in enumerate(rows[0])}

    def keys(self) -> list[str]:
        """Names of the columns."""
        return list(self._columns)

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name not in self._columns:
            raise KeyError(f"the record has no `{name}`; it has {', '.join(self._columns)}")
        return self._columns[name]

    def __fspath__(self) -> str:
        return str(self.path)

    def __repr__(self) -> str:
        return f"<Record {self.title!r} ({self.kind}): {', '.join(self._columns)}; {self.path}>"


def compliance(model: str | os.PathLike[str], **given: Any) -> dict[str, Any]:
    """Deflection of a tooth of a reduced gear under a line load; arguments of `gearmesh compliance` with underscores.

    compliance(model, tooth=0, radius_mm=[73.5, 75], line_load_N_per_mm=100, half_width_mm=0.1)

    project=True: beside it, as "projected", by forces on single element faces; the gear is meshed and factorised again.
    """
    return operate("compliance", model=model, **given)


def natural_frequencies(
    gear: Any,
    *,
    count: int | None = None,
    up_to_Hz: float | None = None,
    shapes: str | os.PathLike[str] | None = None,
    progress: Progress = None,
) -> dict[str, Any]:
    """Natural frequencies of a gear (a Gear, or its file) held at its bore, with their nodal diameters.

    count: so many, the lowest; or up_to_Hz: all up to there. shapes: mesh file for the shapes. Meshes the gear.
    """
    given = {"count": count, "up_to_Hz": up_to_Hz, "shapes": shapes}
    with tempfile.TemporaryDirectory() as folder:
        return operate("modes", progress, gear=gear_file(gear, folder), **given)


def mesh(
    gear: Any, path: str | os.PathLike[str], *, length_unit: Literal["m", "mm"] = "m", progress: Progress = None
) -> dict[str, Any]:
    """Writes the finite element mesh of a gear (a Gear, or its file); the ending of path names the format."""
    with tempfile.TemporaryDirectory() as folder:
        return operate("mesh", progress, gear=gear_file(gear, folder), output=path, length_unit=length_unit)


def gear_file(gear: Any, folder: str) -> Path:
    """The file of a gear; one in folder where it has none."""
    if isinstance(gear, (str, os.PathLike)):
        return Path(gear)
    path = Path(folder) / "gear.toml"
    gear.write(path)
    return path
