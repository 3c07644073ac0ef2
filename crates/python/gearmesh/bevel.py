"""Bevel pairs: blank, machine settings, tooth contact."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from .program import program


class BevelPair:
    """The file of a bevel pair (docs/reference/bevel.md). Computed by the program: its messages, its figures."""

    def __init__(self, file: str | Path) -> None:
        self.file = Path(file)

    def design(self) -> dict[str, Any]:
        """Blank, machine settings and checks of every flank."""
        return program("bevel", self.file)

    def tca(self, report: str | Path | None = None) -> dict[str, Any]:
        """Tooth contact: path, transmission error, ellipses, ease-off, edges, sensitivity to the assembly.

        report: also write the page with the pictures.
        """
        return program("tca", self.file, *([] if report is None else ["--report", report]))

    def __repr__(self) -> str:
        return f"<BevelPair {self.file}>"
