"""A gear as its file describes it."""

from __future__ import annotations

import difflib
import functools
import json
from pathlib import Path
from typing import Any

from . import _native
from .toml_text import Tables, from_toml, to_toml

STEEL: Tables = {"young_GPa": 206.0, "poisson": 0.3, "density_kg_per_m3": 7850.0}
"""Steel for the keyword material."""


class Gear:
    """The definition of a gear: what is in a gear file (docs/reference/gear.md), checked.

    Keywords are the tables and keys of the file. Keys of [tooth], [blank] and [material] may be given without their
    table:

        Gear("pinion", teeth=23, module_mm=3, face_width_mm=20, bore_diameter_mm=25, material=STEEL,
             gauge=[dict(name="root", tooth=0, side="right", tangent_deg=30, length_mm=0.6, width_mm=3)])

    blank["kind"] is "solid" unless told otherwise. Raises TypeError for a keyword that no gear file knows, InputError
    for a gear that cannot exist.

    Attributes: name, teeth, tip_radius_m, reference_radius_m, root_radius_m, base_radius_m, toml (text of the file),
    tables (the same as dicts), notes (numbers that look like those of another unit).
    """

    def __init__(self, name: str, **keywords: Any) -> None:
        tables: Tables = {"name": name, "blank": {"kind": "solid"}}
        _put(tables, keywords)
        self._take(to_toml(tables), f"Gear({name!r})")

    @classmethod
    def from_file(cls, path: str | Path) -> Gear:
        """The gear of a file. Raises FileNotFoundError, InputError with file, line and key."""
        return cls.from_toml(Path(path).read_text(encoding="utf-8"), str(path))

    @classmethod
    def from_toml(cls, text: str, file: str = "gear.toml") -> Gear:
        """The gear of a text; file is its name in complaints, and files that it names are beside it."""
        gear = cls.__new__(cls)
        gear._take(text, file)
        return gear

    def _take(self, text: str, file: str) -> None:
        self.name, self.teeth, radii_m, self.notes = _native.check_gear(text, file)
        self.tip_radius_m, self.reference_radius_m, self.root_radius_m, self.base_radius_m = radii_m
        self.toml, self.file = text, file

    @property
    def tables(self) -> Tables:
        """The file as nested dicts; a copy."""
        return from_toml(self.toml, self.file)

    def but(self, **keywords: Any) -> Gear:
        """The same gear with some keywords changed; None takes a key away."""
        tables = self.tables
        _put(tables, keywords)
        return Gear.from_toml(to_toml(tables), self.file)

    def write(self, path: str | Path) -> None:
        """Writes the gear file."""
        _native.write_text(path, self.toml)

    def reduce(self, path: str | Path | None = None, **options: Any):
        """The reduced gear: see gearmesh.reduce."""
        from .reduced import reduce

        return reduce(self, path, **options)

    def __repr__(self) -> str:
        return (
            f"<Gear {self.name!r}: {self.teeth} teeth, tip diameter {2e3 * self.tip_radius_m:.4g} mm, "
            f"root diameter {2e3 * self.root_radius_m:.4g} mm>"
        )


def _put(tables: Tables, keywords: dict[str, Any]) -> None:
    """Puts keywords where the file has them: whole tables, or keys of the tables that may be left out."""
    whole, flat = _places()
    for key, value in keywords.items():
        if key in whole:
            given = isinstance(value, dict) and isinstance(tables.get(key), dict)
            tables[key] = {**tables[key], **value} if given else value
        elif key in flat:
            tables.setdefault(flat[key], {})[key] = value
        else:
            near = difflib.get_close_matches(key, [*whole, *flat], n=3)
            hint = f"; near are {', '.join(near)}" if near else ""
            raise TypeError(f"a gear file has no key `{key}`{hint}. docs/reference/gear.md lists all keys")


@functools.cache
def _places() -> tuple[frozenset[str], dict[str, str]]:
    """Tables of the file, and the table of each key that may be given without it; from the program's own schema."""
    schema = json.loads(_native.schema("gear"))
    flat: dict[str, str] = {}
    for table in ("tooth", "blank", "material"):
        definition = schema["$defs"][schema["properties"][table]["$ref"].rsplit("/", 1)[1]]
        for kind in [definition, *definition.get("oneOf", []), *definition.get("anyOf", [])]:
            flat.update(dict.fromkeys(kind.get("properties", ()), table))
    return frozenset(schema["properties"]), flat
