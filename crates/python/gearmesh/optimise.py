"""Optimisation: keys of a pair's scene that make its objectives least."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from .operations import operate
from .optional import demanded
from .progress import Progress
from .study import written
from .toml_text import Tables

if TYPE_CHECKING:
    import matplotlib.axes
    import pandas


class Optimum:
    """What an optimisation came to.

    Attributes: title, front (the choices that no other one beats, a dict each with "variables" and "objectives"), best
    (the first of them: with one objective the best), tried (how many choices), before (objectives of the scene as it is),
    folder with front.csv, tried.csv and the page optimise.html.
    """

    def __init__(self, found: dict[str, Any], folder: Path) -> None:
        self.title: str = found["title"]
        self.front: list[dict[str, dict[str, float]]] = found["front"]
        self.tried: int = found["tried"]
        self.before: list[float] | None = found["as_it_is"]
        self.folder = folder

    @property
    def best(self) -> dict[str, dict[str, float]]:
        """The first choice of the front."""
        return self.front[0]

    def to_pandas(self, table: str = "front") -> pandas.DataFrame:
        """The front, or with "tried" all choices, as a data frame: variables, then objectives. Needs pandas."""
        return demanded("pandas", "tables").read_csv(self.folder / f"{table}.csv")

    def plot(self, ax: matplotlib.axes.Axes | None = None) -> matplotlib.axes.Axes:
        """Draws the front over the first two objectives; with one objective, that over the first variable of all tried."""
        import csv

        import matplotlib.pyplot as plt

        if ax is None:
            ax = plt.figure(figsize=(6.0, 4.0), layout="constrained").add_subplot()
        first = self.front[0]
        with open(self.folder / "front.csv", newline="", encoding="utf-8") as file:
            heads = next(csv.reader(file))
        names = [head for head in heads if head in first["objectives"]]
        across, up = names[:2] if len(names) > 1 else (heads[0], names[0])
        for table, style, colour in (("tried", ".", "0.75"), ("front", "o-", "C0")):
            with open(self.folder / f"{table}.csv", newline="", encoding="utf-8") as file:
                rows = list(csv.DictReader(file))
            points = sorted((float(row[across]), float(row[up])) for row in rows)
            ax.plot([x for x, _ in points], [y for _, y in points], style, color=colour, label=table)
        ax.set(xlabel=across, ylabel=up, title=self.title)
        ax.grid(alpha=0.3)
        ax.legend(fontsize="small")
        return ax

    def __repr__(self) -> str:
        return f"<Optimum {self.title!r}: {len(self.front)} choices of {self.tried} tried; {self.folder}>"


def optimise(
    source: str | os.PathLike[str] | Tables,
    folder: str | os.PathLike[str],
    *,
    progress: Progress = None,
    most_result_GB: float = 1.0,
) -> Optimum:
    """Seeks the relief, crowning or other keys that make the objectives of a pair least (docs/reference/optimise.md).

    source: the file, or its tables with a Scene or the path of one under "scene". progress: see
    gearmesh.progress.Progress. most_result_GB: a multibody scene whose result will be larger is refused. Raises InputError, WorkError; KeyboardInterrupt on Ctrl-C, when folder has what was tried until then.
    """
    with tempfile.TemporaryDirectory(prefix="gearmesh-optimise-") as beside:
        path = written(source, Path(beside), "optimise.toml") if isinstance(source, dict) else Path(source)
        return Optimum(operate("optimise", progress, file=path, output=folder, most_result_GB=most_result_GB), Path(folder))
