"""Makes a throw-away environment: solver_venv.py DIR [PACKAGE==VERSION MODULE]. Prints its interpreter.

It sees the packages of the Python that runs this (numpy, scipy, scikit-fem) and adds what another program needs and the project itself does
not use: PyPardiso with Intel's MKL, a direct solver, where no other is named. A stamp, written last, tells a finished environment from a half-made one.
"""

import shutil
import subprocess
import sys
import sysconfig
import venv
from pathlib import Path

PARDISO = ["pypardiso==0.4.7", "pypardiso"]


def main() -> None:
    directory = Path(sys.argv[1])
    package, module = sys.argv[2:4] or PARDISO
    python = directory / "bin/python"
    seen = sysconfig.get_path("purelib")
    stamp, wanted = directory / "stamp", f"{package} {sys.version} {seen}"
    if not (stamp.is_file() and stamp.read_text() == wanted):
        shutil.rmtree(directory, ignore_errors=True)
        venv.create(directory, with_pip=True)
        packages = directory / "lib" / f"python{sys.version_info[0]}.{sys.version_info[1]}" / "site-packages"
        (packages / "project.pth").write_text(seen + "\n")
        options = ["--quiet", "--no-input", "--disable-pip-version-check", "--only-binary=:all:"]
        subprocess.run([python, "-m", "pip", "install", *options, package], check=True, stdout=sys.stderr)
        subprocess.run([python, "-c", f"import {module}"], check=True)
        stamp.write_text(wanted)
    print(python)


if __name__ == "__main__":
    main()
