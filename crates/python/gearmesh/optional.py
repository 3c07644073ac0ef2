"""Packages that only some functions need: what to install is said where one is missing."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from types import ModuleType


def demanded(name: str, extra: str) -> ModuleType:
    """A package that an extra of gearmesh brings. Raises ImportError with the line that installs it."""
    import importlib

    try:
        return importlib.import_module(name)
    except ImportError as cause:
        raise ImportError(f"this needs {name}: pip install 'gearmesh[{extra}]', or {name} by itself") from cause
