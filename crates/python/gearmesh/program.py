"""The program `gearmesh` beside this package: whatever has no function of its own here."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path
from typing import Any, Mapping

from ._native import InputError, WorkError


def program(*arguments: str | os.PathLike[str] | float) -> Any:
    """Runs `gearmesh ARGUMENTS --json` and returns what it prints, parsed; a text where it prints none.

        gearmesh.program("bearing", "6206.toml", "--load-N", "0,0,500")["stiffness_SI"]

    Raises InputError (exit code 2) or WorkError (1) with the program's message, KeyboardInterrupt (130),
    FileNotFoundError where there is no program: it is installed with the wheel, or named by GEARMESH_PROGRAM.
    """
    words = [str(os.fspath(a)) if isinstance(a, os.PathLike) else str(a) for a in arguments]
    # Notebooks ask for colours, which would stand in the messages.
    asks = ("FORCE_COLOR", "CLICOLOR_FORCE")
    environment = {name: value for name, value in os.environ.items() if name not in asks}
    environment["NO_COLOR"] = "1"
    environment.setdefault("GEARMESH_PYTHON", sys.executable)
    answer = _call([*words, "--json"], environment)
    if answer.returncode == 2 and "unexpected argument '--json'" in answer.stderr:
        answer = _call(words, environment)
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


def _call(words: list[str], environment: dict[str, str]) -> subprocess.CompletedProcess[str]:
    return subprocess.run([_path(), *words], capture_output=True, text=True, env=environment, check=False)


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
