"""Studies: a scene again and again with some of its keys changed."""

from __future__ import annotations

import csv
import json
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from . import _native
from .optional import demanded
from .progress import Bar, Progress
from .reduced import interpreter
from .scene import Scene, with_whole_paths
from .toml_text import Tables, from_toml, to_toml

if TYPE_CHECKING:
    import pandas

    from .cluster import Cluster


class StudyResult:
    """What a study came to: cases, a dict each, and the rows of its table study.csv (docs/results.md)."""

    def __init__(self, title: str, cases: list[dict[str, Any]], folder: Path) -> None:
        self.title, self.cases, self.folder = title, cases, folder

    @property
    def rows(self) -> list[dict[str, str]]:
        """The lines of study.csv: parameters, column, its figures, file or failure; texts as they stand there."""
        with open(self.folder / "study.csv", newline="", encoding="utf-8") as file:
            return list(csv.DictReader(file))

    def to_pandas(self) -> pandas.DataFrame:
        """study.csv as a data frame. Needs pandas."""
        return demanded("pandas", "tables").read_csv(self.folder / "study.csv")

    def __repr__(self) -> str:
        failed = sum(case.get("failure") is not None for case in self.cases)
        return f"<StudyResult {self.title!r}: {len(self.cases)} cases, {failed} failed; {self.folder}>"


class Study:
    """A study file (docs/reference/study.md): a path, or its tables with a Scene or the path of one under "scene".

    The result of a case is stored by a digest of all that it depends on: a study that is run again computes what is
    new only.
    """

    def __init__(self, source: str | os.PathLike[str] | Tables) -> None:
        self._folder: tempfile.TemporaryDirectory[str] | None = None
        if not isinstance(source, dict):
            self.path = Path(source)
        else:
            self._folder = tempfile.TemporaryDirectory(prefix="gearmesh-study-")
            self.path = written(source, Path(self._folder.name), "study.toml")

    @property
    def tables(self) -> Tables:
        """The file as nested dicts; a copy."""
        return from_toml(self.path.read_text(encoding="utf-8"), str(self.path))

    def run(self, folder: str | os.PathLike[str], **options: Any) -> StudyResult:
        """Runs all cases into a folder. See gearmesh.study."""
        return study(self, folder, **options)

    def __repr__(self) -> str:
        return f"<Study {self.tables.get('title')!r}: {self.path}>"


def study(
    source: Study | str | os.PathLike[str] | Tables,
    folder: str | os.PathLike[str],
    *,
    client: Cluster | None = None,
    patience_s: float = 600.0,
    progress: Progress = None,
    most_result_GB: float = 1.0,
) -> StudyResult:
    """Runs a study into a folder and returns its figures.

    client: None for this process, as many cases at a time as there are processors; a dask.distributed.Client, the address
    or file of a scheduler, or "local" for a cluster of this machine (docs/cluster.md), where a scheduler that is lost is
    waited for patience_s. progress: see gearmesh.progress.Progress. most_result_GB: results that together will be larger are
    refused before the first case.

    Raises InputError before the first case where the study or one of its scenes is wrong, WorkError where cases failed
    (study.csv says why), KeyboardInterrupt on Ctrl-C. Stopped or killed, the same call goes on.
    """
    it = source if isinstance(source, Study) else Study(source)
    if client is None:
        with Bar(progress, "study") as bar:
            found = json.loads(_native.study(it.path, Path(folder), interpreter(), bar.call, most_result_GB))
    else:
        from .cluster import run_cases

        failures = run_cases(
            it.path, folder, client, patience_s=patience_s, progress=progress, most_result_GB=most_result_GB
        )
        found = json.loads(_native.gather_study(it.path, Path(folder), failures))
    result = StudyResult(found["title"], found["cases"], Path(folder))
    failures = [case["failure"] for case in result.cases if case["failure"] is not None]
    if failures:
        raise _native.WorkError(
            f"{len(failures)} of {len(result.cases)} cases failed; {Path(folder) / 'study.csv'} says why. The first: {failures[0]}"
        )
    return result


def written(source: Tables, folder: Path, name: str) -> Path:
    """Writes the tables of a study or an optimisation with a Scene, or the path of one, under "scene"."""
    tables, scene = dict(source), source["scene"]
    if isinstance(scene, Scene):
        tables["scene"] = folder / "scene.toml"
        tables["scene"].write_text(with_whole_paths(scene), encoding="utf-8")
    else:
        tables["scene"] = Path(scene).absolute()
    path = folder / name
    path.write_text(to_toml(tables), encoding="utf-8")
    return path
