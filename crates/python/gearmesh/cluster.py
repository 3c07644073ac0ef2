"""Studies on many machines: the cases run on a Dask cluster (docs/cluster.md).

Each case is named by a digest of all that it depends on. Where the study's folder is the same on workers and here, a worker
stores what it has finished itself; elsewhere it sends the file, and it is stored here. So a worker, the scheduler or this
process may be killed: what was stored is not computed again.
"""

from __future__ import annotations

import argparse
import contextlib
import functools
import json
import logging
import os
import socket
import sys
import threading
import time
import uuid
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Iterator, Sequence, Union

from . import _native
from .progress import Bar, Progress

if TYPE_CHECKING:
    from distributed import Client

    from ._native import Sent

Cluster = Union["Client", str]
"""A dask.distributed.Client, the address or file of a scheduler, or "local": workers of this machine, one a processor."""

CONNECT_S = 10.0
"""So long an answer of the scheduler is waited for at the start."""

_MOST_A_TASK = 16
"""Cases of a gear pair take milliseconds, as long as it takes to send a task: so many go together."""

_MOST_LOSSES = 20
"""A scheduler that is lost more often has another trouble."""

Named = dict[str, list[tuple[str, str]]]
"""Files, each with the files that it names: (name in its text, file)."""

_runner = _native.NativeCaseRunner()


class _Lost(Exception):
    """The scheduler is gone."""


def run_cases(
    study: str | os.PathLike[str],
    folder: str | os.PathLike[str],
    cluster: Cluster = "local",
    *,
    patience_s: float = 600.0,
    progress: Progress = None,
    most_result_GB: float = 1.0,
) -> dict[str, str]:
    """Runs all cases of a study file into a folder; why cases have failed, by the names of their files.

    A scheduler that is lost is waited for, at its address, for patience_s; the cases that are not stored are then sent again.

    Raises InputError before the first case where the study is wrong or a worker has no such version of gearmesh, WorkError
    where the scheduler does not come back, ImportError without dask.distributed.
    """
    path, out = Path(study).absolute(), Path(folder).absolute()
    with contextlib.ExitStack() as stack:
        # What is wrong with the study is reported before a cluster is asked for.
        gears = _native.study_gears(path, out, most_result_GB)
        out.mkdir(parents=True, exist_ok=True)
        token = stack.enter_context(_token(out))
        bar = stack.enter_context(Bar(progress, "study"))
        connection = stack.enter_context(_Connection(cluster, patience_s))
        from .cluster_worker import LOG

        if (out / LOG).is_symlink():
            raise _native.InputError(f"{out / LOG} is a symbolic link, and nothing is written through links; remove it")
        if gears:
            connection.until_done(functools.partial(_reduce_gears, gears, token=out / token, bar=bar))
        cases: list[Sent] = _native.study_cases(path, out, most_result_GB)
        batch = _MOST_A_TASK if cases and cases[0][0].endswith(".csv") else 1
        files = _with_named({str(place) for case in cases for _, place in case[4]})
        work = _Work(cases, out, token, files, batch, bar)
        connection.until_done(work.go_on)
        return work.failures


class _Work:
    """The cases of a study, and what has become of them."""

    def __init__(
        self, cases: list[Sent], out: Path, token: str, files: Named, batch: int, bar: Bar
    ) -> None:
        self.count, self.out, self.token, self.batch, self.bar = len(cases), out, token, batch, bar
        self.failures: dict[str, str] = {}
        self.pending = {case[0]: case for case in cases}
        self.sent_files = files
        self._begun = False

    def go_on(self, client: Client) -> None:
        """Sends what is not stored and takes what comes back."""
        from distributed import as_completed

        from . import cluster_worker as worker

        stored = [name for name, case in self.pending.items() if _runner.is_there(case, self.out)]
        for name in stored:
            del self.pending[name]
        self._tell()
        if not self.pending:
            return
        _demand_version(client)
        plugin = worker.Files(self.sent_files)
        client.register_plugin(plugin, name=plugin.name)
        workers = max(len(client.scheduler_info(n_workers=-1)["workers"]), 1)
        size = max(1, min(self.batch, len(self.pending) // (4 * workers)))
        waiting = list(self.pending.values())
        batches = [waiting[first : first + size] for first in range(0, len(waiting), size)]
        place = (str(self.out), self.token, plugin.name)
        futures = [client.submit(worker.compute, batch, place, key=f"gearmesh-{uuid.uuid4().hex}") for batch in batches]
        sent = dict(zip((future.key for future in futures), batches))
        queue = as_completed(futures, loop=client.loop)
        for future in queue:
            if future.status == "finished":
                for outcome in future.result():
                    self._take(*outcome)
            elif future.status == "error":
                batch = sent[future.key]
                if len(batch) == 1:
                    self._take(batch[0][0], f"its worker failed: {future.exception()}")
                else:
                    # One of them may have taken the others down with it: each by itself.
                    for case in batch:
                        again = client.submit(worker.compute, [case], place, key=f"gearmesh-{uuid.uuid4().hex}")
                        sent[again.key] = [case]
                        queue.add(again)
            else:
                raise _Lost
            self._tell()

    def _take(self, name: str, failure: str | None, content: bytes | None = None, line: str | None = None) -> None:
        if failure is not None:
            self.failures[name] = failure
        elif content is not None:
            from .cluster_worker import log, store

            store(self.out / name, content)
            if line is not None:
                log(self.out, line)
        self.pending.pop(name, None)

    def _tell(self) -> None:
        self.bar.tell("cases", self.count - len(self.pending), self.count)


class _Connection:
    """A client of the cluster, made anew where the scheduler was lost."""

    def __init__(self, cluster: Cluster, patience_s: float) -> None:
        self._cluster, self._patience_s = cluster, patience_s
        self._own: list[Any] = []
        self._client: Client | None = None
        self._address: str | None = None
        self._losses = 0

    def __enter__(self) -> _Connection:
        try:
            from distributed import Client, LocalCluster
        except ImportError as cause:
            raise ImportError("studies on a cluster need dask.distributed: pip install 'gearmesh[dask]'") from cause
        # It tells each try to reconnect with a traceback; what matters is reported here.
        self._logger = logging.getLogger("distributed.client")
        self._level = self._logger.level
        self._logger.setLevel(logging.CRITICAL)
        if not isinstance(self._cluster, str):
            self._client = self._cluster
        elif self._cluster == "local":
            local = LocalCluster(threads_per_worker=1, n_workers=os.cpu_count() or 1, dashboard_address="127.0.0.1:0")
            self._own.append(local)
            self._client = Client(local)
            self._own.append(self._client)
        else:
            self._address = self._cluster
            self._client = self._connect(CONNECT_S)
        if self._address is None and self._cluster != "local":
            self._address = self._client.scheduler.address if self._client.scheduler else None
        return self

    def _connect(self, timeout_s: float) -> Client:
        given = str(self._address)
        try:
            address = _address_of(given)
            _await_answer(address, timeout_s)
            client = _client_of(address, timeout_s)
        except Exception as cause:
            # Whatever dask makes of what is no scheduler: out of memory, where the first bytes are read as a length.
            raise _native.InputError(
                f"--scheduler: no scheduler answers at {given!r} ({str(cause) or type(cause).__name__}); give the address of a running dask scheduler, as "
                "tcp://HOST:8786, its scheduler file, or local"
            ) from cause
        self._own.append(client)
        return client

    def until_done(self, work: Callable[[Client], None]) -> None:
        """Does some work with the client, again from the start where the scheduler was lost meanwhile."""
        from distributed import CancelledError
        from distributed.comm.core import CommClosedError

        while True:
            client = self._client
            assert client is not None
            try:
                if client.status != "running":
                    raise _Lost
                self._await_worker(client)
                return work(client)
            except (_native.InputError, _native.WorkError):
                raise
            except (_Lost, CancelledError, CommClosedError) as cause:
                # Even where one answers by now: another scheduler, which knows nothing of what the first one was given.
                self._recover(cause)
            except (OSError, TimeoutError, RuntimeError) as cause:
                if client.status == "running" and _answers(client):
                    # Not the scheduler's end: some other fault.
                    raise
                self._recover(cause)

    def _await_worker(self, client: Client) -> None:
        if client.scheduler_info(n_workers=-1)["workers"]:
            return
        print("note: the scheduler has no worker yet; waiting for one", file=sys.stderr)
        from distributed import TimeoutError as NoWorker

        try:
            client.wait_for_workers(1, timeout=self._patience_s)
        except NoWorker as cause:
            raise _native.WorkError(
                f"the scheduler had no worker for {self._patience_s:g} s; start workers, then the same call goes on from here"
            ) from cause

    def _recover(self, cause: BaseException) -> None:
        if self._address is None:
            raise _native.WorkError(f"the cluster is gone ({cause}); the same call goes on from here") from cause
        self._losses += 1
        if self._losses > _MOST_LOSSES:
            raise _native.WorkError(
                f"the scheduler {self._address} was lost {_MOST_LOSSES} times; the same call goes on from here"
            ) from cause
        print(f"note: the scheduler {self._address} is lost; waiting for it", file=sys.stderr)
        give_up = time.monotonic() + self._patience_s
        while self._own:
            with contextlib.suppress(Exception):
                self._own.pop().close(timeout=2)
        while True:
            try:
                self._client = self._connect(5.0)
                return
            except _native.InputError:
                if time.monotonic() > give_up:
                    raise _native.WorkError(
                        f"the scheduler {self._address} did not come back within {self._patience_s:g} s; the same call goes on from here"
                    ) from cause
                time.sleep(1.0)

    def __exit__(self, *_: object) -> None:
        while self._own:
            with contextlib.suppress(Exception):
                self._own.pop().close(timeout=5)
        self._logger.setLevel(self._level)


def _address_of(given: str) -> str:
    """The scheduler's address: as given, or as its scheduler file names it."""
    if not Path(given).is_file():
        return given
    try:
        address = json.loads(Path(given).read_text(encoding="utf-8"))["address"]
    except (ValueError, TypeError, KeyError):
        address = None
    if not isinstance(address, str):
        raise ValueError("it names none")
    return address


def _host_and_port(address: str) -> tuple[str, int]:
    host, port = address.rsplit("://", 1)[-1].rsplit(":", 1)
    return host.strip("[]"), int(port)


def _await_answer(address: str, timeout_s: float) -> None:
    """Waits until something listens there. OSError where nothing does in time, ValueError for what is no address."""
    place = _host_and_port(address)
    give_up = time.monotonic() + timeout_s
    while True:
        try:
            with socket.create_connection(place, timeout=timeout_s):
                return
        except OSError:
            if time.monotonic() > give_up:
                raise
            time.sleep(0.1)


def _client_of(address: str, timeout_s: float) -> Client:
    """A client of the scheduler there. OSError where what listens there says nothing, other errors as dask raises them.

    One that fails is closed here: dask would close it with the garbage, maybe while it holds the lock of its loops to start
    another client, and would wait for itself without end. One that hears nothing at all waits on, on its thread.
    """
    from distributed import Client

    client = Client.__new__(Client)
    failed: list[BaseException] = []

    def begin() -> None:
        try:
            client.__init__(address, timeout=timeout_s, set_as_default=False)
        except BaseException as error:
            with contextlib.suppress(Exception):
                client.close(timeout=2)
            failed.append(error)

    beginning = threading.Thread(target=begin, daemon=True, name="gearmesh connects")
    beginning.start()
    beginning.join(2.0 * timeout_s + 2.0)
    if beginning.is_alive():
        raise OSError("what listens there says nothing")
    if failed:
        raise failed[0]
    return client


def _answers(client: Client) -> bool:
    """Whether the scheduler is still there."""
    scheduler = client.scheduler
    try:
        with socket.create_connection(_host_and_port(str(scheduler.address if scheduler else "")), timeout=5.0):
            return client.status == "running"
    except (OSError, ValueError):
        # No address of a host: a scheduler inside this process, which is there.
        return scheduler is not None and str(scheduler.address).startswith("inproc")


def _demand_version(client: Client) -> None:
    """All workers have this version. One that does not answer is the scheduler's matter."""
    from . import cluster_worker as worker

    answers: Any = client.run(worker.check_version, _native.__version__, on_error="return")
    for address, answer in answers.items():
        if isinstance(answer, _native.InputError):
            raise answer
        if isinstance(answer, ImportError):
            raise _native.InputError(f"the worker {address} has no gearmesh: {answer}")


def _with_named(files: set[str]) -> Named:
    """The files, and those that texts among them name, and so on; of each what it names: (name, file)."""
    found: Named = {}
    waiting = list(files)
    while waiting:
        file = waiting.pop()
        if file in found:
            continue
        path, found[file] = Path(file), []
        if path.suffix == ".toml":
            text = path.read_text(encoding="utf-8")
            found[file] = [(name, str(place.absolute())) for name, place in _native.files_of(text, path.parent)]
            waiting += [place for _, place in found[file]]
    return found


@contextlib.contextmanager
def _token(out: Path) -> Iterator[str]:
    """A file in the study's folder while it runs: a worker that sees it has the same folder."""
    name = f".cluster-{uuid.uuid4().hex}"
    (out / name).touch()
    try:
        yield name
    finally:
        (out / name).unlink(missing_ok=True)


def _reduce_gears(gears: list[tuple[Path, str]], client: Client, *, token: Path, bar: Bar) -> None:
    """Reduces the gears that cases need and that are not there yet, each once, on the workers."""
    from distributed import as_completed

    from .cluster_worker import reduce_gear, store

    missing = [(model, text) for model, text in gears if not model.exists()]
    futures = {client.submit(reduce_gear, text, str(model), str(token)): model for model, text in missing}
    for done, future in enumerate(as_completed(futures, loop=client.loop), 1):
        if future.status in ("cancelled", "lost"):
            raise _Lost
        content = future.result()
        if content is not None:
            store(futures[future], content)
        bar.tell("gears", done, len(futures))


def main(arguments: Sequence[str] | None = None) -> int:
    """`python -m gearmesh.cluster`, which `gearmesh study --scheduler` runs: the cases only, without the table."""
    parser = argparse.ArgumentParser(prog="gearmesh.cluster", description="Runs the cases of a study on a Dask cluster")
    parser.add_argument("study", type=Path)
    parser.add_argument("-o", "--output", type=Path, required=True)
    parser.add_argument("--scheduler", required=True)
    parser.add_argument("--most-result-GB", type=float, default=1.0, help="largest size of all results together")
    parser.add_argument("--failures", type=Path, required=True, help="file for the list of failed cases")
    given = parser.parse_args(arguments)
    try:
        failures = run_cases(given.study, given.output, given.scheduler, most_result_GB=given.most_result_GB)
    except KeyboardInterrupt:
        return 130
    except (_native.InputError, FileNotFoundError, ImportError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    except (_native.WorkError, OSError, MemoryError) as error:
        print(f"error: {error}", file=sys.stderr)
        return 1
    given.failures.write_text(json.dumps(failures), encoding="utf-8")
    return 0


if __name__ == "__main__":
    # Workers find what they are sent under the module's own name.
    from gearmesh.cluster import main as of_package

    sys.exit(of_package())
