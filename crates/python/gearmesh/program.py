"""The program `gearmesh` beside this package: whatever has no function of its own here."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import sys
import sysconfig
import threading
from pathlib import Path
from typing import Any, Mapping

from ._native import InputError, WorkError
from .progress import Bar, Progress

_END_S = 60.0
"""So long the program may take to end on Ctrl-C: it finishes a file, or a run that it has begun."""


def program(*arguments: str | os.PathLike[str] | float, progress: Progress = False) -> Any:
    """Runs `gearmesh ARGUMENTS --json` and returns what it prints, parsed; a text where it prints none.

        gearmesh.program("bearing", "6206.toml", "--load-N", "0,0,500")["stiffness_SI"]

    progress: see gearmesh.progress.Progress; none unless told otherwise.

    Raises InputError (exit code 2) or WorkError (1) with the program's message, KeyboardInterrupt on Ctrl-C, which is
    passed on to the program; FileNotFoundError where there is no program: it is installed with the wheel, or named by GEARMESH_PROGRAM.
    """
    words = [str(os.fspath(a)) if isinstance(a, os.PathLike) else str(a) for a in arguments]
    # Notebooks ask for colours, which would stand in the messages.
    asks = ("FORCE_COLOR", "CLICOLOR_FORCE")
    environment = {name: value for name, value in os.environ.items() if name not in asks}
    environment["NO_COLOR"] = "1"
    environment["GEARMESH_PROGRESS"] = "lines"
    environment.setdefault("GEARMESH_PYTHON", sys.executable)
    with Bar(progress, words[0]) as bar:
        answer = _call([*words, "--json"], environment, bar)
        if answer.returncode == 2 and "unexpected argument '--json'" in answer.stderr:
            answer = _call(words, environment, bar)
    if answer.returncode != 0:
        message = _message(answer.stderr)
        if answer.returncode == 130:
            raise KeyboardInterrupt(message)
        raise (InputError if answer.returncode == 2 else WorkError)(message)
    try:
        return json.loads(answer.stdout)
    except json.JSONDecodeError:
        return answer.stdout


def options(given: Mapping[str, Any]) -> list[str]:
    """Keywords as the program's options: `speed_rpm=100` is `--speed-rpm=100`, True a switch, None nothing, a list its items
    with commas."""
    words: list[str] = []
    for name, value in given.items():
        if value is None or value is False:
            continue
        if isinstance(value, (list, tuple)):
            value = ",".join(str(part) for part in value)
        option = f"--{name.replace('_', '-')}"
        words.append(option if value is True else f"{option}={value}")
    return words


def _call(words: list[str], environment: dict[str, str], bar: Bar) -> subprocess.CompletedProcess[str]:
    """Runs the program; on Ctrl-C, and where the bar's function raises, it is told and waited for."""
    pipe = subprocess.PIPE
    # In a session of its own: Ctrl-C reaches it once, from here, and not from the terminal as well.
    with subprocess.Popen(
        [_path(), *words], stdin=subprocess.DEVNULL, stdout=pipe, stderr=pipe, text=True, env=environment, start_new_session=True
    ) as process:
        assert process.stdout is not None and process.stderr is not None
        data, said = process.stdout, list[str]()
        printed: list[str] = []
        reader = threading.Thread(target=lambda: printed.append(data.read()), daemon=True)
        reader.start()
        try:
            for line in process.stderr:
                told = _told(line)
                if told is None:
                    said.append(line)
                else:
                    bar.tell(*told)
        except BaseException:
            process.send_signal(signal.SIGINT)
            try:
                process.wait(_END_S)
            except subprocess.TimeoutExpired:
                process.kill()
            raise
        reader.join()
    return subprocess.CompletedProcess(process.args, process.returncode, "".join(printed), "".join(said))


def _told(line: str) -> tuple[str, float, float] | None:
    """Stage, done, of how much: a line of progress."""
    if not line.startswith('{"progress":'):
        return None
    told = json.loads(line)["progress"]
    return told["stage"], told["done"], told["total"]


def _message(stderr: str) -> str:
    """What is said behind `error: `; notes and warnings before it are left out."""
    lines = stderr.strip().splitlines()
    first = next((place for place, line in enumerate(lines) if line.startswith("error: ")), None)
    return stderr.strip() if first is None else "\n".join(lines[first:]).removeprefix("error: ")


def _path() -> Path:
    named = os.environ.get("GEARMESH_PROGRAM")
    if named:
        return Path(named)
    for scripts in (Path(sysconfig.get_path("scripts")), Path(sys.executable).parent):
        if (scripts / "gearmesh").is_file():
            return scripts / "gearmesh"
    found = shutil.which("gearmesh")
    if found is None:
        raise FileNotFoundError(
            "the program gearmesh is neither beside this Python nor on PATH; install the wheel, or name it in "
            "GEARMESH_PROGRAM"
        )
    return Path(found)
