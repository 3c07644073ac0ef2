"""The studio from a notebook: a pair or a result in the browser."""

from __future__ import annotations

import atexit
import html
import os
import subprocess
import sys
import tempfile
import weakref
from pathlib import Path

from . import _native
from .program import _path
from .result import Result
from .scene import Scene, with_whole_paths

_END_S = 5.0
"""So long the server may take to end."""


class Studio:
    """A server of the studio. It ends with close(), with the last reference to it, and with Python.

    url is its address, for the browser of this machine; a notebook shows a link to it. The page is not shown inside the
    notebook: it refuses to stand in the frame of another page.
    """

    def __init__(self, file: Path | None, title: str, folder: tempfile.TemporaryDirectory[str] | None, open_browser: bool) -> None:
        words = [str(_path()), "studio", *([str(file)] if file else []), *([] if open_browser else ["--no-open"])]
        environment = {"GEARMESH_PYTHON": sys.executable, **os.environ, "NO_COLOR": "1"}
        process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment, start_new_session=True)
        assert process.stdout is not None and process.stderr is not None
        url = process.stdout.readline().strip()
        if not url.startswith("http://127.0.0.1:"):
            message = process.stderr.read().strip().removeprefix("error: ")
            _end(process, folder)
            raise (_native.InputError if process.returncode == 2 else _native.WorkError)(message)
        self.url, self.title = url, title
        self._finish = weakref.finalize(self, _end, process, folder)
        atexit.register(self._finish)

    def close(self) -> None:
        """Ends the server."""
        self._finish()

    @property
    def is_open(self) -> bool:
        """Whether the server was not closed."""
        return self._finish.alive

    def __enter__(self) -> Studio:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<Studio of {self.title!r}: {self.url if self.is_open else 'closed'}>"

    def _repr_html_(self) -> str:
        if not self.is_open:
            return html.escape(repr(self))
        return f'<a href="{html.escape(self.url)}" target="_blank" rel="noopener">{html.escape(self.title)} in the studio</a>'


def studio(of: Scene | Result | str | os.PathLike[str] | None = None, *, open_browser: bool = False) -> Studio:
    """Opens a pair, a result or a file of either in the studio (docs/studio.md); without any a page for something new.

    of: a Pair, a Scene of a pair, a Result, or a path. open_browser: open the address at once; otherwise the notebook's link, or
    Studio.url, leads there. Raises InputError for what the studio does not show.
    """
    if of is None:
        return Studio(None, "something new", None, open_browser)
    if not isinstance(of, (Scene, Result)):
        return Studio(Path(of), str(of), None, open_browser)
    folder = tempfile.TemporaryDirectory(prefix="gearmesh-")
    if isinstance(of, Result):
        file = of._file(folder.name)
    else:
        file = Path(folder.name) / "pair.toml"
        _native.write_text(file, with_whole_paths(of))
    return Studio(file, of.title, folder, open_browser)


def _end(process: subprocess.Popen[str], folder: tempfile.TemporaryDirectory[str] | None) -> None:
    process.terminate()
    try:
        process.wait(_END_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
    for stream in (process.stdout, process.stderr):
        if stream is not None:
            stream.close()
    if folder is not None:
        folder.cleanup()
