"""How far long work is: tqdm where it is installed and somebody looks."""

from __future__ import annotations

import sys
from types import TracebackType
from typing import Any, Callable, Optional, Union

Progress = Union[None, bool, Callable[[str, float, float], None]]
"""None: a bar where standard error is a terminal or a notebook shows it; True or False; or a function that is called
with the name of the stage, how much is done, and of how much (0: not known)."""


class Bar:
    """Calls a function, or moves a bar; a context that clears the bar."""

    def __init__(self, wish: Progress, title: str) -> None:
        self.call: Optional[Callable[[str, float, float], None]] = None
        self._bar: Any = None
        self._title = title
        if callable(wish):
            self.call = wish
        elif wish or (wish is None and _is_watched()):
            try:
                from tqdm.auto import tqdm
            except ImportError:
                return
            form = "{desc} {percentage:3.0f}%|{bar}| {elapsed}"
            self._bar = tqdm(desc=title, leave=False, bar_format=form, total=1.0)
            self.call = self._move

    def _move(self, stage: str, done: float, total: float) -> None:
        self._bar.set_description(f"{self._title}: {stage}" if stage else self._title, refresh=False)
        self._bar.n = min(done / total, 1.0) if total > 0.0 else 0.0
        self._bar.refresh()

    def __enter__(self) -> Bar:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.close()


def _is_watched() -> bool:
    return "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())
