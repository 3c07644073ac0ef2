"""How far long work is: tqdm where it is installed, a plain line otherwise, where somebody looks."""

from __future__ import annotations

import sys
import time
from types import TracebackType
from typing import Any, Callable, Optional, Union

Progress = Union[None, bool, Callable[[str, float, float], object]]
"""None: a bar where standard error is a terminal or a notebook shows it; True or False; or a function that is called
with the name of the stage, how much is done, and of how much (0: not known)."""


class Bar:
    """Calls a function, or moves a bar; a context that clears the bar."""

    def __init__(self, wish: Progress, title: str) -> None:
        self.call: Optional[Callable[[str, float, float], object]] = None
        self._bar: Any = None
        self._title = title
        if callable(wish):
            self.call = wish
        elif wish or (wish is None and _is_watched()):
            self._bar = _tqdm(title) or _Line(title)
            self.call = self._bar.move

    def tell(self, stage: str, done: float, total: float) -> None:
        """Says how far the work is."""
        if self.call is not None:
            self.call(stage, done, total)

    def __enter__(self) -> Bar:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.close()


class _Tqdm:
    """tqdm's bar, in notebooks and terminals."""

    def __init__(self, bar: Any, title: str) -> None:
        self._bar, self._title = bar, title

    def move(self, stage: str, done: float, total: float) -> None:
        self._bar.set_description(f"{self._title}: {stage}" if stage else self._title, refresh=False)
        self._bar.n = min(done / total, 1.0) if total > 0.0 else 0.0
        self._bar.refresh()

    def close(self) -> None:
        self._bar.close()


def _tqdm(title: str) -> Optional[_Tqdm]:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    form = "{desc} {percentage:3.0f}%|{bar}| {elapsed}<{remaining}"
    return _Tqdm(tqdm(desc=title, leave=False, bar_format=form, total=1.0), title)


class _Line:
    """A line that is written anew: title, stage, share, time to go."""

    def __init__(self, title: str) -> None:
        self._title, self._begun, self._stage, self._widest = title, time.monotonic(), "", 0

    def move(self, stage: str, done: float, total: float) -> None:
        if stage != self._stage:
            self._stage, self._begun = stage, time.monotonic()
        text = f"{self._title}: {stage}"
        if total > 0.0:
            text += f" {100.0 * done / total:3.0f} %"
            if done > 0.0:
                text += f", {(time.monotonic() - self._begun) * (total / done - 1.0):.0f} s to go"
        self._write(text)

    def _write(self, text: str) -> None:
        self._widest = max(self._widest, len(text))
        print(f"\r{text:{self._widest}}", end="", file=sys.stderr, flush=True)

    def close(self) -> None:
        self._write("")
        print("\r", end="", file=sys.stderr, flush=True)


def _is_watched() -> bool:
    return "ipykernel" in sys.modules or (sys.stderr is not None and sys.stderr.isatty())
