"""Ctrl-C at a chosen moment of a run, however fast the machine is."""

import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager


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


@contextmanager
def interruption(give_up_s: float = 60.0) -> Iterator[Callable[[], None]]:
    """Gives a function that sends Ctrl-C, the first time it is called, and returns when the main thread has heard it.

    For work on another thread, which cannot end in the meantime.
    """
    heard = threading.Event()

    def hear(number, frame):
        heard.set()
        signal.default_int_handler(number, frame)

    def interrupt() -> None:
        if not heard.is_set():
            os.kill(os.getpid(), signal.SIGINT)
            assert heard.wait(give_up_s), "nobody has heard Ctrl-C"

    before = signal.signal(signal.SIGINT, hear)
    try:
        yield interrupt
    finally:
        signal.signal(signal.SIGINT, before)
