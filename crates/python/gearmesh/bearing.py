"""Rolling bearings at rest."""

from __future__ import annotations

import tempfile
from pathlib import Path
from typing import Any, Sequence

from .pictures import rolling_elements, table, titled
from .program import options, program
from .toml_text import Tables, from_toml, to_toml


class Bearing:
    """A bearing file (docs/reference/bearing.md): a path, or its tables as a dict.

    Computed by the program: raises InputError and WorkError with its messages.
    """

    def __init__(self, file: str | Path | Tables) -> None:
        self._file = file

    def rest(self, load_N: Sequence[float], **given: Any) -> dict[str, Any]:
        """Where the inner ring comes to rest under load_N (x, y, z), and what every ball or roller carries.

        Options are those of `gearmesh bearing` with underscores: speed_rpm, outer_speed_rpm, control, moment_Nm ...
        Returns what the program prints: displacement_um (3,), tilt_mrad (2,), stiffness_SI (5, 5), rows (loads,
        contact angles, pressures of each element), ratings, life.
        """
        return self._ask("bearing", "--load-N", ",".join(repr(float(part)) for part in load_N), **given)

    def frequencies(self, **given: Any) -> dict[str, Any]:
        """Frequencies of cage, elements and passing of the races; options of `gearmesh bearing-frequencies`."""
        return self._ask("bearing-frequencies", **given)

    def _repr_html_(self) -> str:
        """What a notebook shows: its rolling elements where the file states them, and the keys of the file."""
        tables = self._file if isinstance(self._file, dict) else from_toml(Path(self._file).read_text(encoding="utf-8"), str(self._file))
        rows = [(key, str(value)) for key, value in tables.items() if not isinstance(value, (dict, list)) and key != "name"]
        element = next((word for word in ("ball", "roller") if f"{word}s" in tables), None)
        picture = ""
        if element and {"pitch_diameter_mm", f"{element}_diameter_mm"} <= tables.keys():
            picture = rolling_elements(tables["pitch_diameter_mm"], tables[f"{element}_diameter_mm"], tables[f"{element}s"])
        return titled(str(tables.get("name", "bearing")), picture, table(rows))

    def _ask(self, command: str, *words: str, **given: Any) -> dict[str, Any]:
        if not isinstance(self._file, dict):
            return program(command, self._file, *words, *options(given))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "bearing.toml"
            path.write_text(to_toml(self._file), encoding="utf-8")
            return program(command, path, *words, *options(given))

    def __repr__(self) -> str:
        return f"<Bearing {'of a dict' if isinstance(self._file, dict) else self._file}>"
