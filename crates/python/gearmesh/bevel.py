"""Bevel pairs: blank, machine settings, tooth contact."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .operations import operate


class BevelPair:
    """The file of a bevel pair (docs/reference/bevel.md). The figures are those of the program with --json."""

    def __init__(self, file: str | Path) -> None:
        self.file = Path(file)

    def design(self) -> dict[str, Any]:
        """Blank, machine settings and checks of every flank."""
        return operate("bevel", pair=self.file)

    def tca(self, report: str | Path | None = None, **given: Any) -> dict[str, Any]:
        """Tooth contact: path, transmission error, ellipses, ease-off, edges, sensitivity to the assembly.

        report: also write the page with the pictures. Further options of `gearmesh tca` with underscores: stress=True draws the bodies of
        reduced members under load, field_gear=2, field_output="gear.vtu" writes a whole field.
        """
        return operate("tca", pair=self.file, report=report, **given)

    def __repr__(self) -> str:
        return f"<BevelPair {self.file}>"
