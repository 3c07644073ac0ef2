"""Bevel pairs: blank, machine settings, tooth contact."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .program import options, program


class BevelPair:
    """The file of a bevel pair (docs/reference/bevel.md). Computed by the program: its messages, its figures."""

    def __init__(self, file: str | Path) -> None:
        self.file = Path(file)

    def design(self) -> dict[str, Any]:
        """Blank, machine settings and checks of every flank."""
        return program("bevel", self.file)

    def tca(self, report: str | Path | None = None, **given: Any) -> dict[str, Any]:
        """Tooth contact: path, transmission error, ellipses, ease-off, edges, sensitivity to the assembly.

        report: also write the page with the pictures. Further options of `gearmesh tca` with underscores: stress=True draws the bodies of
        reduced members under load, field_gear=2, field_output="gear.vtu" writes a whole field.
        """
        return program("tca", self.file, *([] if report is None else ["--report", report]), *options(given))

    def __repr__(self) -> str:
        return f"<BevelPair {self.file}>"
