"""Studies on a Dask cluster: the table is that of this machine, whatever is killed meanwhile; nothing is computed twice."""

import contextlib
import json
import os
import signal
import socket
import subprocess
import sys
import threading
import time
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import pytest

import gearmesh as gm

distributed = pytest.importorskip("distributed")
from gearmesh import cluster, cluster_worker  # noqa: E402  (needs dask)

PENDULUM = gm.Scene("fe_models/scene_pendulum.toml")


def study_of(folder: Path, count: int, step_s: float) -> Path:
    """A study of pendulums with different masses, as a file."""
    scene = PENDULUM.but({"solver.step_s": step_s, "run.end_s": 1.0, "output.interval_s": 0.01})
    scene.write(folder / "scene.toml")
    column = next(name for name in scene.run().keys() if name != "time_s")
    masses = ", ".join(f"{1.0 + 0.01 * k:.2f}" for k in range(count))
    path = folder / "study.toml"
    path.write_text(
        f'title = "masses"\nscene = "scene.toml"\ndesign = "grid"\ncolumns = ["{column}"]\n'
        f'[[parameter]]\nname = "mass"\nkeys = ["body.0.mass_kg"]\nvalues = [{masses}]\n'
    )
    return path


@pytest.fixture(scope="module")
def threads():
    """Two workers in this process."""
    with distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=False, dashboard_address=None
    ) as local, distributed.Client(local) as client:
        yield client


@pytest.fixture(scope="module")
def few(tmp_path_factory):
    """A study of four quick cases, and its table as this process makes it."""
    folder = tmp_path_factory.mktemp("few")
    path = study_of(folder, 4, 0.005)
    gm.study(path, folder / "here", progress=False)
    return path, (folder / "here" / "study.csv").read_text().replace(str(folder / "here"), "")


def table(folder: Path) -> str:
    return (folder / "study.csv").read_text().replace(str(folder), "")


@pytest.mark.parametrize("is_shared", [True, False])
def test_a_cluster_gives_the_table_of_this_machine(few, threads, tmp_path, monkeypatch, is_shared):
    path, expected = few
    if not is_shared:
        monkeypatch.setattr(cluster, "_token", lambda out: contextlib.nullcontext("a file that is not there"))
    found = gm.study(path, tmp_path / "out", client=threads)
    assert len(found.cases) == 4
    assert table(tmp_path / "out") == expected
    log = (tmp_path / "out" / cluster_worker.LOG).read_text().splitlines()
    assert len(log) == 4
    # Files were sent to each of the two workers once. Again: all of it is there.
    assert len(cluster_worker.received) == 2
    gm.study(path, tmp_path / "out", client=threads)
    assert len(cluster_worker.received) == 2
    assert (tmp_path / "out" / cluster_worker.LOG).read_text().splitlines() == log


def test_a_failed_case_is_told_and_the_others_are_kept(few, threads, tmp_path, monkeypatch):
    run = cluster_worker._runner.run
    sent = []

    def broken(case, *rest):
        sent.append(case[0])
        if case[0] == sent[0]:
            raise gm.WorkError("no equilibrium")
        return run(case, *rest)

    monkeypatch.setattr(cluster_worker, "_runner", SimpleNamespace(run=broken))
    with pytest.raises(gm.WorkError, match="1 of 4 cases failed.*The first: no equilibrium"):
        gm.study(few[0], tmp_path / "out", client=threads)
    assert "no equilibrium" in (tmp_path / "out" / "study.csv").read_text()
    assert len(list((tmp_path / "out").glob("*.h5"))) == 3


@dataclass
class Folder:
    """Stands for a worker."""

    local_directory: str


def test_models_lie_where_the_worker_can_read_them(tmp_path):
    model = tmp_path / "a" / "model.h5"
    cluster_worker.store(model, b"content")
    files = cluster_worker.Files({str(model): []})
    worker = Folder(str(tmp_path / "worker"))
    files.setup(worker)
    # It sees the same file.
    assert cluster_worker.places_of[files.name] == {str(model): str(model)}
    model.write_bytes(b"another")
    files.setup(worker)
    place = Path(cluster_worker.places_of[files.name][str(model)])
    assert place.read_bytes() == b"content" and place.is_relative_to(tmp_path / "worker")


def test_files_that_files_name_go_with_them(tmp_path):
    """A pair's text names a table of points, beside it and by its whole path: both are the worker's own."""
    pair, points, other = tmp_path / "a" / "pair.toml", tmp_path / "a" / "points.csv", tmp_path / "b" / "other.csv"
    cluster_worker.store(points, b"1,2\n")
    cluster_worker.store(other, b"3,4\n")
    cluster_worker.store(pair, f'[gear]\nconcave_points = "points.csv"\nconvex_points = "{other}"\n'.encode())
    named = cluster._with_named({str(pair)})
    assert set(named) == {str(pair), str(points), str(other)}
    files, worker = cluster_worker.Files(named), Folder(str(tmp_path / "worker"))
    # The worker's machine has the text at the same place, but not the same points.
    points.write_bytes(b"5,6\n")
    other.unlink()
    files.setup(worker)
    places = cluster_worker.places_of[files.name]
    gear = cluster_worker._native.json_from_toml(Path(places[str(pair)]).read_text(), "pair")
    assert json.loads(gear)["gear"] == {"concave_points": places[str(points)], "convex_points": places[str(other)]}
    assert Path(places[str(points)]).read_bytes() == b"1,2\n" and Path(places[str(other)]).read_bytes() == b"3,4\n"


def test_what_is_wrong_is_told_before_a_worker_is_asked(few, tmp_path):
    wrong = tmp_path / "study.toml"
    wrong.write_text(few[0].read_text().replace("body.0", "body.7").replace("scene.toml", str(few[0].parent / "scene.toml")))
    with pytest.raises(gm.InputError, match="body.7"):
        gm.study(wrong, tmp_path / "out", client="tcp://127.0.0.1:1")
    assert not (tmp_path / "out").exists()


def test_a_scheduler_that_is_not_there_is_told(few, tmp_path, monkeypatch):
    monkeypatch.setattr(cluster, "CONNECT_S", 0.5)
    with pytest.raises(gm.InputError, match="no scheduler answers at 'tcp://127.0.0.1:1'"):
        gm.study(few[0], tmp_path / "out", client="tcp://127.0.0.1:1")


@pytest.mark.parametrize("content", ["garbage", "[]", "{}", '{"address": 3}'])
def test_a_file_that_is_no_scheduler_file_is_told(few, tmp_path, monkeypatch, content):
    monkeypatch.setattr(cluster, "CONNECT_S", 0.5)
    file = tmp_path / "scheduler.json"
    file.write_text(content)
    with pytest.raises(gm.InputError, match="--scheduler: .*scheduler.json.*give the address of a running dask scheduler"):
        gm.study(few[0], tmp_path / "out", client=str(file))


@pytest.mark.parametrize("says", [None, b"HTTP/1.1 400 Bad Request\r\n\r\n"])
def test_what_listens_and_is_no_scheduler_is_told(few, tmp_path, monkeypatch, says):
    monkeypatch.setattr(cluster, "CONNECT_S", 0.5)
    with socket.socket() as other:
        other.bind(("127.0.0.1", 0))
        other.listen()

        def answer():
            with contextlib.suppress(OSError):
                while True:
                    heard, _ = other.accept()
                    heard.sendall(says)
                    heard.close()

        if says:
            threading.Thread(target=answer, daemon=True).start()
        address = f"tcp://127.0.0.1:{other.getsockname()[1]}"
        with pytest.raises(gm.InputError, match="no scheduler answers at"):
            gm.study(few[0], tmp_path / "out", client=address)


def test_a_client_that_fails_is_closed_at_once(monkeypatch):
    """Not with the garbage, where dask may wait for itself."""
    made = []

    def failing(self, *_, **keywords):
        made.append(self)
        start(self, *_, **keywords)

    async def broken(self, *_, **__):
        # As where the scheduler file names none: connected to nothing, and not closed by dask.
        self.status = "connecting"
        raise KeyError("address")

    start = distributed.Client.__init__
    monkeypatch.setattr(distributed.Client, "__init__", failing)
    monkeypatch.setattr(distributed.Client, "_start", broken)
    with pytest.raises(KeyError):
        cluster._client_of("tcp://127.0.0.1:1", 0.5)
    assert [client.status for client in made] == ["closed"]


@pytest.mark.parametrize("wrong", ["nonsense", "tcp://127.0.0.1:port", "tcp://127.0.0.1:99999999"])
def test_what_is_no_address_is_told(few, tmp_path, wrong):
    with pytest.raises(gm.InputError, match="no scheduler answers at"):
        gm.study(few[0], tmp_path / "out", client=wrong)


def test_a_link_is_not_replaced_by_what_a_worker_sends(tmp_path):
    target, link = tmp_path / "mine.txt", tmp_path / "case.h5"
    target.write_text("mine")
    link.symlink_to(target)
    with pytest.raises(gm.InputError, match="case.h5 is a symbolic link"):
        cluster_worker.store(link, b"theirs")
    assert link.is_symlink() and target.read_text() == "mine"


class Processes:
    """A scheduler and its workers as processes, which a test kills."""

    def __init__(self, folder: Path) -> None:
        self.folder, self.running = folder, []
        with socket.socket() as free:
            free.bind(("127.0.0.1", 0))
            self.port = free.getsockname()[1]
        self.address = f"tcp://127.0.0.1:{self.port}"

    def start(self, kind: str, *words: str) -> subprocess.Popen:
        command = [sys.executable, "-m", f"distributed.cli.dask_{kind}", *words, "--no-dashboard"]
        with open(self.folder / f"{kind}.log", "a") as log:
            process = subprocess.Popen(command, stdout=log, stderr=log, cwd=self.folder)
        self.running.append(process)
        return process

    def scheduler(self) -> subprocess.Popen:
        return self.start("scheduler", "--host", "127.0.0.1", "--port", str(self.port))

    def worker(self) -> subprocess.Popen:
        options = ["--nthreads", "1", "--no-nanny", "--local-directory", str(self.folder)]
        return self.start("worker", self.address, *options)

    def kill(self, process: subprocess.Popen) -> None:
        process.send_signal(signal.SIGKILL)
        process.wait()

    def end(self) -> None:
        for process in self.running:
            process.kill()
            process.wait()


def wait_for(count: int, out: Path, study: subprocess.Popen) -> None:
    give_up = time.monotonic() + 180.0
    while (found := len(list(out.glob("*.h5")))) < count:
        assert study.poll() is None, study.communicate()
        assert time.monotonic() < give_up, f"{found} of {count} results"
        time.sleep(0.02)


def test_killed_workers_and_a_killed_scheduler_lose_nothing(tmp_path):
    count = 20
    path, out = study_of(tmp_path, count, 2e-5), tmp_path / "out"
    processes = Processes(tmp_path)
    try:
        scheduler, workers = processes.scheduler(), [processes.worker(), processes.worker()]
        program = os.environ["GEARMESH_PROGRAM"]
        command = [program, "study", path, "-o", out, "--scheduler", processes.address]
        study = subprocess.Popen(
            command, env={**os.environ, "GEARMESH_PYTHON": sys.executable}, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        processes.running.append(study)
        wait_for(4, out, study)
        processes.kill(workers[0])
        wait_for(8, out, study)
        processes.kill(scheduler)
        before = {file.name: file.stat().st_mtime_ns for file in out.glob("*.h5")}
        processes.scheduler()
        for _ in range(2):
            processes.worker()
        told, notes = study.communicate(timeout=240)
    finally:
        processes.end()
    assert study.returncode == 0, notes
    assert "is lost; waiting for it" in notes
    assert len([line for line in told.splitlines() if line.startswith("mass = ")]) == count
    assert len((out / "study.csv").read_text().splitlines()) == 1 + count
    # What was stored is as it was, and no case was computed twice. A worker that is killed between a file and its line in
    # the log leaves no line.
    assert {name: (out / name).stat().st_mtime_ns for name in before} == before
    lines = [line.split() for line in (out / cluster_worker.LOG).read_text().splitlines()]
    stored = {}
    for begun, ended, _, name in sorted(lines, key=lambda line: float(line[1])):
        assert name not in stored, (name, stored[name], begun)
        stored[name] = float(ended)
    assert len(list(out.glob("*.h5"))) == count >= len(stored) >= count - 3
