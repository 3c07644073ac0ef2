"""Ctrl-C at a chosen moment of a run, however fast the machine is."""

import os
import signal
import threading
import time
from collections.abc import Callable


def interrupt_once(condition: Callable[[], bool], give_up_s: float = 60.0) -> None:
    """Sends Ctrl-C to this process as soon as the condition holds; never, if it does not hold in time."""

    def watch() -> None:
        end = time.monotonic() + give_up_s
        while time.monotonic() < end:
            if condition():
                os.kill(os.getpid(), signal.SIGINT)
                return
            time.sleep(0.01)

    threading.Thread(target=watch, daemon=True).start()
