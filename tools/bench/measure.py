"""Runs one program and prints its time and memory as JSON: measure.py TIMEOUT_S PROGRAM ARGS...

A process of its own, so that what the kernel tells of the finished child (wait4) is of that child and its own
children only, and so that a case that is killed for lack of memory takes nothing else with it.
"""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time

TAIL = 2000  # characters of standard error that are kept


def main() -> None:
    timeout_s, command = int(sys.argv[1]), sys.argv[2:]
    timed_out = False
    with tempfile.TemporaryFile("w+") as out, tempfile.TemporaryFile("w+") as err:
        start = time.monotonic()
        try:
            child = subprocess.Popen(
                command, stdin=subprocess.DEVNULL, stdout=out, stderr=err, start_new_session=True
            )
        except OSError as error:
            print(json.dumps({"exit": None, "error": str(error)}))
            return

        def stop(number, _frame):
            nonlocal timed_out
            timed_out = number == signal.SIGALRM
            os.killpg(child.pid, signal.SIGKILL)
            if not timed_out:
                sys.exit(128 + number)

        for number in (signal.SIGALRM, signal.SIGINT, signal.SIGTERM):
            signal.signal(number, stop)
        signal.alarm(timeout_s)
        try:  # When memory runs out, the kernel shall take the case and not its neighbours.
            with open(f"/proc/{child.pid}/oom_score_adj", "w") as file:
                file.write("1000")
        except OSError:
            pass
        _, status, usage = os.wait4(child.pid, 0)
        wall_s = time.monotonic() - start
        signal.alarm(0)
        for file in (out, err):
            file.seek(0)
        print(
            json.dumps(
                {
                    "exit": os.waitstatus_to_exitcode(status),
                    "timed_out": timed_out,
                    "wall_s": wall_s,
                    "cpu_s": usage.ru_utime + usage.ru_stime,
                    "peak_bytes": usage.ru_maxrss * 1024,  # Linux counts in KiB
                    "stdout": out.read(),
                    "stderr": err.read()[-TAIL:],
                }
            )
        )


if __name__ == "__main__":
    main()
