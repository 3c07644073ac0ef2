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

    def tca(self, report: str | Path | None = None) -> dict[str, Any]:
        """Tooth contact without load: path, transmission error, ellipses, ease-off, edges, sensitivity to the assembly.

        report: also write the page with the pictures. Under the torques of its [load] a pair is run as a scene: `gm.run(file)`.
        """
        return operate("tca", pair=self.file, report=report)

    def __repr__(self) -> str:
        return f"<BevelPair {self.file}>"
