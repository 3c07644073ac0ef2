"""Studies: a scene again and again with some of its keys changed."""

from __future__ import annotations

import csv
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any, Sequence

from .program import program
from .scene import Scene
from .toml_text import Tables, from_toml, to_toml

if TYPE_CHECKING:
    import pandas


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
        import pandas

        return pandas.read_csv(self.folder / "study.csv")

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
            tables, self.path = dict(source), Path(self._folder.name) / "study.toml"
            scene = tables["scene"]
            if isinstance(scene, Scene):
                tables["scene"] = Path(self._folder.name) / "scene.toml"
                tables["scene"].write_text(_with_whole_paths(scene), encoding="utf-8")
            else:
                tables["scene"] = Path(scene).absolute()
            self.path.write_text(to_toml(tables), encoding="utf-8")

    @property
    def tables(self) -> Tables:
        """The file as nested dicts; a copy."""
        return from_toml(self.path.read_text(encoding="utf-8"), str(self.path))

    def run(self, folder: str | os.PathLike[str]) -> StudyResult:
        """Runs all cases into a folder. See gearmesh.study."""
        return study(self, folder)

    def __repr__(self) -> str:
        return f"<Study {self.tables.get('title')!r}: {self.path}>"


def study(
    source: Study | str | os.PathLike[str] | Tables,
    folder: str | os.PathLike[str],
    *,
    options: Sequence[str] = (),
) -> StudyResult:
    """Runs a study into a folder, as many cases at a time as there are processors, and returns its figures.

    Computed by the program: raises InputError before the first case where the study or one of its scenes is wrong,
    WorkError where cases failed (study.csv says why). Stopped or killed, the same call goes on.
    """
    it = source if isinstance(source, Study) else Study(source)
    found = program("study", it.path, "-o", folder, *options)
    return StudyResult(found["title"], found["cases"], Path(folder))


def _with_whole_paths(scene: Scene) -> str:
    """The scene's text with the files that it names as absolute paths."""
    from . import _native

    files = {name: str(path) for name, path in _native.files_of(scene.toml, scene.folder)}

    def whole(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: whole(item) for key, item in value.items()}
        if isinstance(value, list):
            return [whole(item) for item in value]
        return files.get(value, value) if isinstance(value, str) else value

    return to_toml(whole(scene.tables))
