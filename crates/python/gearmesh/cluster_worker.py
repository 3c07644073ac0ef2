"""The workers' side of studies on a cluster: what dask calls there. Needs dask.distributed."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import socket
import tempfile
import time
import uuid
from pathlib import Path
from typing import TYPE_CHECKING, Mapping, Protocol, Sequence

from distributed import WorkerPlugin, get_worker

from . import _native
from .gear import Gear
from .reduced import reduce

if TYPE_CHECKING:
    from ._native import Sent


class HasFolder(Protocol):
    """What of a dask worker is looked at."""

    local_directory: str


Outcome = tuple[str, "str | None", "bytes | None", "str | None"]
"""Of a case: its file; why it failed; where the study's folder is not to be seen from the worker, content and line in the log."""

LOG = "cluster.log"
"""In the study's folder: a line for each case that was computed, with begin and end in seconds, worker and file."""

_runner = _native.NativeCaseRunner()
places_of: dict[str, dict[str, str]] = {}
"""Where files lie on this worker, by the name of the plugin that brought them."""
received: list[str] = []
"""Names of the plugins that have reached this worker, as often as they have."""


def store(path: Path, content: bytes) -> None:
    """Writes a file whole or not at all; a link of its name is refused, as by every command."""
    if path.is_symlink():
        raise _native.InputError(f"{path} is a symbolic link, and nothing is written through links; name the file itself")
    path.parent.mkdir(parents=True, exist_ok=True)
    beside = path.with_name(f".{path.name}.{uuid.uuid4().hex}")
    beside.write_bytes(content)
    os.replace(beside, path)


def log(out: Path, line: str) -> None:
    # A link of this name is not followed: what it points to is not ours.
    flags = os.O_WRONLY | os.O_APPEND | os.O_CREAT | getattr(os, "O_NOFOLLOW", 0)
    with open(os.open(out / LOG, flags, 0o666), "a", encoding="utf-8") as file:
        file.write(line)


def check_version(wanted: str) -> None:
    if _native.__version__ != wanted:
        raise _native.InputError(
            f"the worker on {socket.gethostname()} has gearmesh {_native.__version__}, this study is run with {wanted}; install the same"
        )


class Files(WorkerPlugin):
    """The files that the scenes name: sent to each worker once, to those that join later, too.

    Sent as a plugin of dask's workers (its name is a digest of the files, so a second study with the same ones sends nothing).
    """

    idempotent = True

    def __init__(self, files: Mapping[str, Sequence[tuple[str, str]]]) -> None:
        """files: paths, and of a text among them what it names: (name, path); these are among the files, too."""
        self.named = {path: list(named) for path, named in files.items()}
        self.contents = {path: Path(path).read_bytes() for path in files}
        self.digests = {path: hashlib.sha256(content).hexdigest() for path, content in self.contents.items()}
        self.name = f"gearmesh-{hashlib.sha256(json.dumps(self.digests, sort_keys=True).encode()).hexdigest()[:16]}"

    def setup(self, worker: HasFolder) -> None:
        """Lays the files below the worker's own folder, unless they are where the scenes look for them."""
        root = Path(worker.local_directory) / "gearmesh" / self.name
        there = self._there()
        places: dict[str, str] = {}
        for path in self.contents:
            whole = Path(path)
            places[path] = path if path in there else str(root / whole.relative_to(whole.anchor))
        for path, content in self.contents.items():
            if path in there:
                continue
            if self.named[path]:
                # What it names may lie elsewhere, or be named by its whole path, which is not the one here.
                names = {name: places[file] for name, file in self.named[path]}
                content = _native.with_files(content.decode("utf-8"), names).encode("utf-8")
            store(Path(places[path]), content)
        places_of[self.name] = places
        received.append(self.name)

    def _there(self) -> set[str]:
        """Files that this machine has at the same place, with all that they name."""
        there: set[str] = set()
        for path, digest in self.digests.items():
            with contextlib.suppress(OSError):
                if hashlib.sha256(Path(path).read_bytes()).hexdigest() == digest:
                    there.add(path)
        while lacking := {path for path in there if any(file not in there for _, file in self.named[path])}:
            there -= lacking
        return there

    def teardown(self, worker: HasFolder) -> None:
        """The worker's folder goes with it."""


def compute(cases: list[Sent], place: tuple[str, str, str]) -> list[Outcome]:
    """Runs cases. place: the study's folder, the name of a file that is in it while it runs, the plugin with its files."""
    worker = get_worker()
    out, token, files = place
    is_shared = (Path(out) / token).exists()
    outcomes: list[Outcome] = []
    for case in cases:
        folder = Path(out) if is_shared else Path(worker.local_directory) / "gearmesh" / "results"
        begun = time.time()
        try:
            computed = _runner.run(case, places_of[files], folder)
        except (_native.InputError, _native.WorkError, OSError, MemoryError) as error:
            outcomes.append((case[0], str(error), None, None))
            continue
        line = f"{begun:.3f} {time.time():.3f} {worker.address} {case[0]}\n" if computed else None
        if is_shared:
            if line is not None:
                log(Path(out), line)
            outcomes.append((case[0], None, None, None))
        else:
            file = folder / case[0]
            outcomes.append((case[0], None, file.read_bytes(), line))
            file.unlink()
    return outcomes


def reduce_gear(text: str, model: str, token: str) -> bytes | None:
    """Reduces a gear; the model, where the study's folder is not to be seen from here."""
    gear = Gear.from_toml(text)
    if Path(token).exists():
        Path(model).parent.mkdir(parents=True, exist_ok=True)
        reduce(gear, model, progress=False)
        return None
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "model.h5"
        reduce(gear, path, progress=False)
        return path.read_bytes()
