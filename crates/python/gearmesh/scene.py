"""Scenes: what is computed, with which models."""

from __future__ import annotations

import contextlib
import json
import os
import tempfile
import time
import uuid
from pathlib import Path
from typing import Any, Callable, Iterator, Mapping, Sequence, Union

import numpy as np

from . import _native
from .pictures import circles, table, titled
from .progress import Bar, Progress
from .reduced import ReducedGear
from .result import Result
from .toml_text import Tables, from_toml, plain, to_toml, with_keys

GearModel = Union[ReducedGear, str, "os.PathLike[str]"]
Functions = Mapping[str, Callable[..., Any]]
"""Python functions by the names that the scene has for them."""


class SceneTables(dict[str, Any]):
    """The tables of a scene, with the folder where the files lie that it names."""

    folder: Path


class Scene:
    """A scene of either kind (docs/scene.md), checked: a gear pair at rest, or a multibody system.

    source: a scene file, or its tables as a dict. folder: where files lie that the scene names; that of the file or of the
    Scene that the tables are from, or the working directory. functions: the Python functions that the scene names, see "Python functions in a scene" in
    docs/python.md. Raises FileNotFoundError, InputError with file, line and key.

    Tables are read as they are; complaints about them name the path of the key, those about a file its line, too. In place of a path a
    table may have a ReducedGear.

    Attributes: kind ("pair" or "system"), title, toml (text of the file, or what a file of the tables would be), tables (the same as dicts).
    """

    def __init__(
        self,
        source: str | os.PathLike[str] | Tables,
        folder: str | os.PathLike[str] | None = None,
        functions: Functions | None = None,
    ) -> None:
        if isinstance(source, dict):
            beside = folder or getattr(source, "folder", ".")
            self._take(json.dumps(plain(source)), "", Path(beside).absolute(), functions)
        else:
            file, beside = Path(source), Path(folder or Path(source).parent)
            self._take(file.read_text(encoding="utf-8"), str(source), beside.absolute(), functions)

    @classmethod
    def from_toml(
        cls,
        text: str,
        folder: str | os.PathLike[str] = ".",
        file: str = "scene.toml",
        functions: Functions | None = None,
    ) -> Scene:
        """The scene of a text; file is its name in complaints."""
        scene = Scene.__new__(Scene)
        scene._take(text, file or "scene.toml", Path(folder).absolute(), functions)
        return scene

    def _take(self, source: str, file: str, folder: Path, functions: Functions | None = None) -> None:
        """source: the text of a file; the tables as JSON where file is empty."""
        self.kind, self.title = _native.check_scene(source, file, folder)
        self.toml = source if file else _native.toml_from_json(source)
        self._source, self.file, self.folder = source, file, folder
        self.functions = dict(functions or {})
        unused = sorted(set(self.functions) - set(_functions_named(self.tables)))
        if unused:
            problem = f"functions: the scene calls no {', '.join(unused)}; leave it out, or name it in the scene"
            raise _native.InputError(problem)
        # Nobody can compare functions: what was begun with those of one Scene goes on with the same ones only.
        self._identity = uuid.uuid4().hex

    @property
    def tables(self) -> Tables:
        """The file as nested dicts; a copy. It knows the folder of the files that it names: Scene(scene.tables) finds them."""
        tables = SceneTables(from_toml(self.toml, self.file))
        tables.folder = self.folder
        return tables

    def but(self, changes: Mapping[str, Any]) -> Scene:
        """The same scene with keys changed: dotted paths, items of lists by number, {"run.torques_Nm": [100.0]}.

        Raises KeyError for a path through no table, InputError for what the scene refuses.
        """
        return Scene(with_keys(self.tables, dict(changes)), self.folder, self.functions)

    def plan(self) -> list[str]:
        """What the scene will compute, in lines for people. Raises InputError for what a run would refuse."""
        return _native.plan(self._source, self.file, self.folder, self.functions)

    def run(
        self,
        output: str | os.PathLike[str] | None = None,
        *,
        restart: bool = False,
        progress: Progress = None,
        most_result_GB: float = 1.0,
    ) -> Result:
        """Runs the scene, in this process, without Python's lock.

        output: the result file. Without it a pair's result stays in memory, and that of a multibody scene lies in a
        temporary folder as long as the Result lives. An unfinished multibody run beside output goes on, unless
        restart. progress: see gearmesh.progress.Progress. most_result_GB: a result that will be larger is refused before
        anything is computed.

        Raises InputError, WorkError, OSError; KeyboardInterrupt on Ctrl-C (a multibody run writes a checkpoint first).
        """
        folder = None
        path = Path(output) if output is not None else None
        if path is None and self.kind == "system":
            folder = tempfile.TemporaryDirectory(prefix="gearmesh-")
            path = Path(folder.name) / "result.h5"
        begun = time.perf_counter()
        with Bar(progress, self.title) as bar:
            native, notes, cost = _native.run(
                self._source, self.file, self.folder, path, restart, bar.call, self.functions, self._identity, most_result_GB
            )
        took_s = time.perf_counter() - begun
        for name, (calls, seconds) in cost.items():
            notes.append(f"Python function `{name}`: {calls} calls, {seconds:.3g} s of the run's {took_s:.3g} s")
        return Result(native, path, notes, folder, calls={name: calls for name, (calls, _) in cost.items()})

    def write(self, path: str | os.PathLike[str]) -> None:
        """Writes the scene file. Files that it names relative to folder must be found from there, too."""
        _native.write_text(path, self.toml)

    def __repr__(self) -> str:
        return f"<Scene {self.title!r}: {'gear pair at rest' if self.kind == 'pair' else 'multibody system'}>"


def with_whole_paths(scene: Scene) -> str:
    """The scene's text with the files that it names as absolute paths: it may lie anywhere."""
    files = {name: str(path) for name, path in _native.files_of(scene.toml, scene.folder)}

    def whole(value: Any) -> Any:
        if isinstance(value, dict):
            return {key: whole(item) for key, item in value.items()}
        if isinstance(value, list):
            return [whole(item) for item in value]
        return files.get(value, value) if isinstance(value, str) else value

    return to_toml(whole(scene.tables))


@contextlib.contextmanager
def scene_file(scene: Scene | str | os.PathLike[str]) -> Iterator[Path]:
    """The file of a scene, for the program; that of a Scene as long as the context lasts."""
    if not isinstance(scene, Scene):
        yield Path(scene)
        return
    with tempfile.TemporaryDirectory(prefix="gearmesh-") as folder:
        path = Path(folder) / "scene.toml"
        path.write_text(with_whole_paths(scene), encoding="utf-8")
        yield path


def _functions_named(value: Any) -> Iterator[str]:
    """Names of Python functions in the tables of a scene."""
    if isinstance(value, list):
        for item in value:
            yield from _functions_named(item)
    elif isinstance(value, dict):
        if isinstance(value.get("python"), str):
            yield value["python"]
        for element in value.get("python_element", ()):
            yield element.get("function", "")
        for item in value.values():
            yield from _functions_named(item)


def refuse_wrong_hand(gear_1: Any, gear_2: Any) -> None:
    """Helical gears on parallel axes have opposite hands, a ring and its planet equal ones: said before minutes go into reducing them."""

    def tooth(gear: Any) -> dict[str, Any]:
        tables = getattr(gear, "tables", None)
        return tables.get("tooth", {}) if isinstance(tables, dict) else {}

    teeth = [tooth(gear) for gear in (gear_1, gear_2)]
    first, second = (of.get("hand") for of in teeth)
    with_ring = any(of.get("teeth", 1) < 0 for of in teeth)
    if first is not None and second is not None and (first == second) != with_ring:
        found = f"gear_2: tooth.hand is {second!r}, gear_1's {first!r}"
        rule = "a ring and the gear in it have the same hand" if with_ring else "gears on parallel axes have opposite hands"
        raise _native.InputError(f"{found}: {rule}; change one of them")


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
        refuse_wrong_hand(gear_1, gear_2)
        for place, gear in enumerate((gear_1, gear_2), 1):
            if callable(getattr(gear, "reduce", None)):
                raise TypeError(f"gear_{place}: a Gear is not reduced yet; give its model, gear_{place}.reduce()")
        models = [gear if isinstance(gear, ReducedGear) else ReducedGear(gear) for gear in (gear_1, gear_2)]
        torques = np.atleast_1d(torques_Nm)
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

    def _repr_html_(self) -> str:
        """What a notebook shows: both gears as their circles (tip, reference, root), and what is run."""
        distance_mm = self.tables["pair"]["centre_distance_mm"]
        folder = Path(self.folder or "")
        gears = [ReducedGear(folder / self.tables["pair"][key]).gear for key in ("gear_1", "gear_2")]
        drawn = [(place, [1e3 * gear.tip_radius_m, 1e3 * gear.reference_radius_m, 1e3 * gear.root_radius_m], gear.teeth) for place, gear in zip((0.0, distance_mm), gears)]
        torques = ", ".join(f"{torque:g}" for torque in self.tables["run"]["torques_Nm"])
        rows = [("gears", " and ".join(gear.name for gear in gears)), ("centre distance", f"{distance_mm:g} mm"), ("torques", f"{torques} N m")]
        return titled(self.title, circles(drawn, "both gears along their axes"), table(rows))


def run(
    scene: Scene | str | os.PathLike[str] | Tables,
    output: str | os.PathLike[str] | None = None,
    *,
    functions: Functions | None = None,
    restart: bool = False,
    progress: Progress = None,
    most_result_GB: float = 1.0,
) -> Result:
    """Runs a scene, its file or its tables, with the Python functions that it names: see Scene and Scene.run."""
    if not isinstance(scene, Scene):
        scene = Scene(scene, functions=functions)
    elif functions is not None:
        raise TypeError("functions: the Scene has those that it was made with; give them to Scene")
    return scene.run(output, restart=restart, progress=progress, most_result_GB=most_result_GB)
