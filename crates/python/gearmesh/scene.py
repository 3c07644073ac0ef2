"""Scenes: what is computed, with which models."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path
from typing import Any, Mapping, Sequence, Union

from . import _native
from .progress import Bar, Progress
from .reduced import ReducedGear
from .result import Result
from .toml_text import Tables, from_toml, to_toml, with_keys

GearModel = Union[ReducedGear, str, "os.PathLike[str]"]


class Scene:
    """A scene of either kind (docs/scene.md), checked: a gear pair at rest, or a multibody system.

    source: a scene file, or its tables as a dict. folder: where files lie that the scene names; that of the file, or
    the working directory. Raises FileNotFoundError, InputError with file, line and key.

    Attributes: kind ("pair" or "system"), title, toml (text of the file), tables (the same as dicts).
    """

    def __init__(self, source: str | os.PathLike[str] | Tables, folder: str | os.PathLike[str] | None = None) -> None:
        if isinstance(source, dict):
            self._take(to_toml(source), "Scene", Path(folder or ".").absolute())
        else:
            file = Path(source)
            self._take(file.read_text(encoding="utf-8"), str(source), Path(folder or file.parent).absolute())

    @classmethod
    def from_toml(cls, text: str, folder: str | os.PathLike[str] = ".", file: str = "scene.toml") -> Scene:
        """The scene of a text; file is its name in complaints."""
        scene = Scene.__new__(cls)
        scene._take(text, file, Path(folder).absolute())
        return scene

    def _take(self, text: str, file: str, folder: Path) -> None:
        self.kind, self.title = _native.check_scene(text, file, folder)
        self.toml, self.file, self.folder = text, file, folder

    @property
    def tables(self) -> Tables:
        """The file as nested dicts; a copy."""
        return from_toml(self.toml, self.file)

    def but(self, changes: Mapping[str, Any]) -> Scene:
        """The same scene with keys changed: dotted paths, items of lists by number, {"run.torques_Nm": [100.0]}.

        Raises KeyError for a path through no table, InputError for what the scene refuses.
        """
        return Scene.from_toml(to_toml(with_keys(self.tables, dict(changes))), self.folder, self.file)

    def plan(self) -> list[str]:
        """What the scene will compute, in lines for people. Raises InputError for what a run would refuse."""
        return _native.plan(self.toml, self.file, self.folder)

    def run(
        self, output: str | os.PathLike[str] | None = None, *, restart: bool = False, progress: Progress = None
    ) -> Result:
        """Runs the scene, in this process, without Python's lock.

        output: the result file. Without it a pair's result stays in memory, and that of a multibody scene lies in a
        temporary folder as long as the Result lives. An unfinished multibody run beside output goes on, unless
        restart. progress: see gearmesh.progress.Progress.

        Raises InputError, WorkError, OSError; KeyboardInterrupt on Ctrl-C (a multibody run writes a checkpoint first).
        """
        folder = None
        path = Path(output) if output is not None else None
        if path is None and self.kind == "system":
            folder = tempfile.TemporaryDirectory(prefix="gearmesh-")
            path = Path(folder.name) / "result.h5"
        with Bar(progress, self.title) as bar:
            native, notes = _native.run(self.toml, self.file, self.folder, path, restart, bar.call)
        return Result(native, path, notes, folder)

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene file. Files that it names relative to folder must be found from there, too."""
        Path(path).write_text(self.toml, encoding="utf-8")

    def __repr__(self) -> str:
        return f"<Scene {self.title!r}: {'gear pair at rest' if self.kind == 'pair' else 'multibody system'}>"


class Pair(Scene):
    """A gear pair at rest, position by position.

    gear_1 drives; the torques are those on gear 2, in N m. pitches: how far gear 1 turns; points_per_pitch: positions
    in a pitch. model: a mesh model's table. gauges: names of the strain gauges to read, of gear 1 and 2; all that the
    models have unless told otherwise. Further keywords are tables of the scene: gear_1_flanks and gear_2_flanks stand
    for [gear_1.microgeometry] and [gear_2.microgeometry], so that a relief is varied without reducing again:

        Pair(pinion, wheel, centre_distance_mm=94.6, torques_Nm=[100],
             gear_1_flanks=dict(tip_relief_um=20, tip_relief_start_diameter_mm=72))
    """

    def __init__(
        self,
        gear_1: GearModel,
        gear_2: GearModel,
        *,
        centre_distance_mm: float,
        torques_Nm: float | Sequence[float],
        pitches: int = 1,
        points_per_pitch: int = 24,
        title: str | None = None,
        model: Tables | None = None,
        gauges: tuple[Sequence[str], Sequence[str]] | None = None,
        gear_1_flanks: Tables | None = None,
        gear_2_flanks: Tables | None = None,
        **tables: Any,
    ) -> None:
        models = [gear if isinstance(gear, ReducedGear) else ReducedGear(gear) for gear in (gear_1, gear_2)]
        torques = [torques_Nm] if isinstance(torques_Nm, (int, float)) else torques_Nm
        scene: Tables = {
            "title": title or f"{models[0].name} and {models[1].name}",
            "pair": {
                "gear_1": models[0].path,
                "gear_2": models[1].path,
                "centre_distance_mm": centre_distance_mm,
            },
            "mesh": {"model": model or {"kind": "hybrid"}},
            "run": {
                "torques_Nm": [float(torque) for torque in torques],
                "pitches": pitches,
                "points_per_pitch": points_per_pitch,
            },
        }
        names = gauges if gauges is not None else (models[0].gauges, models[1].gauges)
        if any(names):
            scene["gauges"] = {f"gear_{k}": list(of) for k, of in enumerate(names, 1) if of}
        for key, flanks in (("gear_1", gear_1_flanks), ("gear_2", gear_2_flanks)):
            if flanks:
                scene[key] = {"microgeometry": flanks}
        for key, value in tables.items():
            merged = isinstance(value, dict) and isinstance(scene.get(key), dict)
            scene[key] = {**scene[key], **value} if merged else value
        super().__init__(scene)


def run(
    scene: Scene | str | os.PathLike[str] | Tables,
    output: str | os.PathLike[str] | None = None,
    *,
    restart: bool = False,
    progress: Progress = None,
) -> Result:
    """Runs a scene, its file or its tables: see Scene.run."""
    scene = scene if isinstance(scene, Scene) else Scene(scene)
    return scene.run(output, restart=restart, progress=progress)
