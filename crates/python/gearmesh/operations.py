"""Operations of the compiled module: what a command of the program does, without the program."""

from __future__ import annotations

import json
from typing import Any

from . import _native
from .progress import Bar, Progress
from .reduced import interpreter
from .toml_text import plain


def operate(name: str, progress: Progress = False, **request: Any) -> dict[str, Any]:
    """Does what the command of this name does, and returns what it prints with --json.

    request: its arguments, as docs/python.md has them. progress: see gearmesh.progress.Progress; none unless told otherwise.
    Raises InputError, WorkError with the command's messages, KeyboardInterrupt on Ctrl-C.
    """
    with Bar(progress, name) as bar:
        return json.loads(_native.operate(name, json.dumps(plain(request)), interpreter(), bar.call))
