"""Results: data sets as NumPy arrays, tables, pictures."""

from __future__ import annotations

import difflib
import html
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _native
from .operations import operate
from .optional import demanded
from .pictures import curves
from .program import options, program

if TYPE_CHECKING:
    import matplotlib.axes
    import pandas
    import xarray

# Columns of a pair's table that a notebook shows: head, factor.
_SHOWN = {
    "torque_Nm": ("torque N m", 1.0),
    "te_mean_m": ("TE mean um", 1e6),
    "te_peak_to_peak_m": ("TE pk-pk um", 1e6),
    "k_h_beta": ("K<sub>H&beta;</sub>", 1.0),
}

# Names of axes in files as those of coordinates, and the data sets that hold these.
_DIMENSIONS = {
    "driver angle": "angle",
    "contact line": "line",
    "position between": "position",
    "contact line between": "line_between",
}
_COORDINATES = {"torque": "torque_Nm", "angle": "angle_rad"}


class Result:
    """What a scene came to. result["te_m"] is a data set as an array, in SI units with the unit in the name.

    Of a pair: te_m, stiffness_tangent_N_per_m and so on have the axes (torque, angle), force_N and pressure_Pa (torque,
    angle, line, slice); docs/reference/pair-result.md lists all. Of a multibody scene: one array (rows,) a column, read
    from the file when it is asked for.

    Attributes: kind ("pair", "transient", "static", "speed-sweep", "eigen"), title, path (None in memory), notes and
    warnings (what a user should know about the scene and the run), scene_toml, calls (how often the run has called each
    Python function of the scene).
    """

    def __init__(
        self,
        native: _native.NativeResult,
        path: Path | None = None,
        notes: list[str] | None = None,
        folder: tempfile.TemporaryDirectory[str] | None = None,
        calls: dict[str, int] | None = None,
    ) -> None:
        self._native, self.path, self.notes, self._folder = native, path, notes or [], folder
        self.kind, self.title, self.scene_toml = native.kind, native.title, native.scene_toml
        self.warnings = native.warnings
        self.calls = calls or {}
        self._sets = native.data_sets()
        self._tables: dict[str, dict[str, Any]] | None = None

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> Result:
        """A result file of either kind. Raises FileNotFoundError, InputError for a file that is none."""
        return cls(_native.open_result(Path(path)), Path(path))

    def keys(self) -> list[str]:
        """Names of the data sets."""
        return list(self._sets) if self.kind == "pair" else self._native.names()

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self._set(name)[0]

    def __contains__(self, name: str) -> bool:
        return name in self.keys()

    def unit(self, name: str) -> str:
        """Unit of a data set."""
        return self._set(name)[2]

    def describe(self, name: str) -> str:
        """What a data set is, with its sign."""
        return self._set(name)[3]

    def axes(self, name: str) -> tuple[str, ...]:
        """Names of the axes of a data set."""
        return tuple(_DIMENSIONS.get(axis, axis) for axis in self._set(name)[1])

    def _set(self, name: str) -> tuple[NDArray[Any], list[str], str, str]:
        if name not in self._sets:
            if name not in self.keys():
                near = difflib.get_close_matches(name, self.keys(), n=3)
                hint = f"did you mean {' or '.join(near)}? " if near else ""
                raise KeyError(f"the result has no `{name}`; {hint}it has {', '.join(self.keys())}")
            self._sets[name] = self._native.column(name)
        return self._sets[name]

    def tables(self) -> dict[str, dict[str, Any]]:
        """The tables of `gearmesh export` (docs/results.md), the most wanted first: {table: {column: values}}."""
        if self._tables is None:
            self._tables = self._native.tables()
        return self._tables

    def to_pandas(self, table: str | None = None) -> pandas.DataFrame:
        """A table as a data frame: curves of a pair, rows of a run in time, windows of a sweep, modes. Needs pandas."""
        pandas = demanded("pandas", "tables")
        tables = self.tables()
        name = next(iter(tables)) if table is None else table
        if name not in tables:
            raise KeyError(f"the result has no table `{name}`; it has {', '.join(tables)}")
        return pandas.DataFrame(tables[name])

    def to_xarray(self) -> xarray.Dataset:
        """All arrays with named axes, coordinates, units and descriptions; they share the memory. Needs xarray."""
        xarray = demanded("xarray", "tables")
        names = [name for name in self.keys() if self.axes(name)]
        if self.kind == "pair":
            # Texts and lists of the gears have axes of their own, which no curve shares.
            names = [name for name in names if name.split("/")[0] not in ("gear_1", "gear_2", "ratings", "seconds")]
        variables = {}
        for name in names:
            values, _, unit, description = self._set(name)
            variables[name] = (self.axes(name), values, {"units": unit, "long_name": description})
        coordinates = _COORDINATES if self.kind == "pair" else {"row": "time_s"}
        data = xarray.Dataset(variables, attrs={"title": self.title, "scene_toml": self.scene_toml})
        for axis, name in coordinates.items():
            if name in data:
                data = data.swap_dims({axis: name}).set_coords(name)
        return data

    def plot(self, name: str | None = None, ax: matplotlib.axes.Axes | None = None) -> matplotlib.axes.Axes:
        """Draws a data set over the driver angle (a curve a torque), over time, or the Campbell map of natural modes.

        name: te_m of a pair unless told otherwise; a column of a multibody result. Lengths are drawn in um, angles in
        degrees. Returns matplotlib's axes. Needs matplotlib; raises KeyError for a name that is not there, InputError
        for one that is no curve.
        """
        import matplotlib.pyplot as plt

        if ax is None:
            ax = plt.figure(figsize=(7.0, 4.0), layout="constrained").add_subplot()
        if self.kind == "eigen":
            self._plot_modes(ax)
        else:
            self._plot_curve("te_m" if name is None and self.kind == "pair" else name, ax)
        ax.set_title(self.title)
        ax.grid(alpha=0.3)
        return ax

    def _plot_curve(self, name: str | None, ax: matplotlib.axes.Axes) -> None:
        if name is None:
            raise _native.InputError(f"name: the result has many columns; name one of {', '.join(self.keys())}")
        values, unit = self[name], self.unit(name)
        scale, unit = (1e6, "um") if unit == "m" else (1.0, unit)
        label = f"{name.rsplit('_', 1)[0] if unit == 'um' else name} [{unit}]" if unit not in ("", "1") else name
        if self.kind != "pair":
            across = "time_s" if "time_s" in self else None
            x = self[across] if across else np.arange(len(values))
            ax.plot(x, scale * values)
            ax.set(xlabel="time [s]" if across else "row", ylabel=label)
            return
        if self.axes(name)[-1:] != ("angle",):
            raise _native.InputError(f"{name} has the axes {self.axes(name)}; a curve goes over angle")
        angle_deg = np.degrees(self["angle_rad"])
        for row, torque in zip(np.atleast_2d(values), self["torque_Nm"]):
            ax.plot(angle_deg, scale * row, label=f"{torque:g} N m")
        ax.set(xlabel="angle of gear 1 [deg]", ylabel=label)
        if values.ndim == 2:
            ax.legend(title="torque on gear 2", fontsize="small")

    def _plot_modes(self, ax: matplotlib.axes.Axes) -> None:
        modes = self.tables()["modes"]
        # A map is read by the amount of the speed, whichever way the shaft turns.
        speed_rpm = np.abs(np.asarray(modes["speed_rad_per_s"]) * 30.0 / np.pi)
        across, head = (speed_rpm, "speed [rpm]")
        if np.isnan(speed_rpm).any():
            across, head = np.asarray(modes["load_factor"]), "load factor"
        number = np.asarray(modes["mode"])
        for mode in np.unique(number):
            chosen = number == mode
            points = sorted(zip(across[chosen], np.asarray(modes["frequency_Hz"])[chosen]))
            ax.plot(*zip(*points), ".-", markersize=3)
        ax.set(xlabel=head, ylabel="natural frequency [Hz]")

    def save(self, path: str | os.PathLike[str]) -> Result:
        """Writes a pair's result to a file; that of a multibody scene is one already, and is copied."""
        if self.kind == "pair":
            self._native.write(Path(path))
        else:
            import shutil

            shutil.copyfile(str(self.path), path)
        return Result.open(path)

    def _file(self, folder: str) -> Path:
        """The file of this result; one in folder where it has none."""
        if self.path is not None:
            return self.path
        path = Path(folder) / "result.h5"
        self._native.write(path)
        return path

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled as the bytes of its file, so that processes can hand it on."""
        with tempfile.TemporaryDirectory() as folder:
            content = self._file(folder).read_bytes()
        return _unpickled, (content, self.notes, self.calls)

    def report(self, path: str | os.PathLike[str], **given: Any) -> None:
        """Writes the report page (HTML).

        Further options of `gearmesh report` with underscores: report("page.html", stress=True) adds the stress of the gears.
        """
        with tempfile.TemporaryDirectory() as folder:
            operate("report", results=self._file(folder), output=path, **given)

    def export(self, path: str | os.PathLike[str], table: str | None = None, **given: Any) -> None:
        """Writes a table for other programs; the ending chooses the format: .csv, .parquet, .mat, .uff; .pvd writes gears that move.

        Further options of `gearmesh export` with underscores: export("drive.pvd", stress=True, moments=50).
        """
        with tempfile.TemporaryDirectory() as folder:
            operate("export", result=self._file(folder), output=path, table=table, **given)

    def recover(self, path: str | os.PathLike[str], **given: Any) -> dict[str, Any]:
        """Writes the strain of all gauges to a file; options of `gearmesh recover` with underscores.

        recover("strain.h5", field_gear=1, field_angle_deg=0, field_output="field.vtu") also writes a whole stress field.
        """
        with tempfile.TemporaryDirectory() as folder:
            return operate("recover", result=self._file(folder), output=path, **given)

    def signal(self, analysis: str, column: str | None = None, **given: Any) -> dict[str, Any]:
        """What `gearmesh signal` finds in a column of a run in time; options with underscores.

        analysis: "spectrum", "sidebands", "envelope", "average", "map", "statistics" or "columns" (without a column).
        result.signal("spectrum", "gear_mesh/force_N", shaft="pinion", output="orders.csv")
        """
        if self.kind == "pair":
            told = "a pair at rest has positions, no rows in time; signal is for runs in time, te_m over angle_rad for NumPy's Fourier transform"
            raise _native.InputError(told)
        with tempfile.TemporaryDirectory() as folder:
            words = [] if column is None else [column]
            return program("signal", analysis, self._file(folder), *words, *options(given))

    def _repr_html_(self) -> str:
        """What a notebook shows: the title, and of a pair its transmission error and a line of figures for each torque."""
        title = html.escape(self.title)
        if self.kind != "pair":
            return f"<b>{title}</b><br>{html.escape(repr(self))}"
        table = self._native.torque_figures()
        shown = {name: head for name, head in _SHOWN.items() if name in table}
        heads = "".join(f"<th>{head}</th>" for head, _ in shown.values())
        rows = ""
        for row in range(len(table["torque_Nm"])):
            cells = "".join(f"<td>{scale * table[name][row]:.5g}</td>" for name, (_, scale) in shown.items())
            rows += f"<tr>{cells}</tr>"
        over = [(f"{torque:g} N m", 1e6 * row) for torque, row in zip(table["torque_Nm"], np.atleast_2d(self["te_m"]))]
        picture = curves(np.degrees(self["angle_rad"]), over[:6], "angle of gear 1, deg", "transmission error, um")
        return f"<b>{title}</b>{picture}<table><tr>{heads}</tr>{rows}</table>"

    def __repr__(self) -> str:
        if self.kind != "pair":
            count, what = len(self.keys()), "columns"
            if self.kind == "eigen":
                count, what = len(self.tables()["modes"]["frequency_Hz"]), "natural frequencies"
            head = f"{self.kind}, {count} {what}"
            calls = "".join(f", `{name}` called {calls} times" for name, calls in self.calls.items())
            return f"<Result {self.title!r}: {head}{calls}>"
        lines = [f"<Result {self.title!r}: {len(self['angle_rad'])} positions at each torque"]
        figures = self._native.torque_figures()
        for torque, mean_m, range_m in zip(*(figures[name] for name in ("torque_Nm", "te_mean_m", "te_peak_to_peak_m"))):
            lines.append(f"  {torque:g} N m: TE mean {1e6 * mean_m:.3f} um, peak to peak {1e6 * range_m:.3f} um")
        if len(lines) > 7:
            lines[6:] = [f"  ... {len(lines) - 6} torques more"]
        return "\n".join(lines) + ">"


def _unpickled(content: bytes, notes: list[str], calls: dict[str, int]) -> Result:
    """A result from the bytes of its file, in a folder that lasts as long as it does."""
    folder = tempfile.TemporaryDirectory(prefix="gearmesh-")
    path = Path(folder.name) / "result.h5"
    path.write_bytes(content)
    return Result(_native.open_result(path), path, notes, folder, calls)


def compare(result: Result | str | os.PathLike[str], record: str | os.PathLike[str], **given: Any) -> dict[str, Any]:
    """A result beside a reference record's folder (docs/records.md), both through the rig pipeline.

    record: a Record or its folder. Options are those of `gearmesh compare` with underscores; column is a dict, column of the
    record to column of the result. Returns what it prints: record, kind, shaft, revolutions, comparisons.
    """
    with tempfile.TemporaryDirectory() as folder:
        path = result._file(folder) if isinstance(result, Result) else result
        return operate("compare", result=path, reference=record, **given)
