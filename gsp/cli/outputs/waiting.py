"""Lines on stderr while a command works for long, where no bar of progress is drawn."""

from __future__ import annotations

import sys
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

from gsp.progress import drawn, running

# Seconds until the first line; each further one comes after twice as many, so that logs stay short.
SECONDS_BEFORE_LINE = 10.0


@contextmanager
def lines(first: float = SECONDS_BEFORE_LINE, command: str = "") -> Iterator[None]:
    """Print meanwhile how long a command works and what is done: after 10 s, 20 s, 40 s and so on.

    Parameters
    ----------
    first : float [s]
    command : str
        What is named where nothing is known of the work, such as "workspace".
    """
    ended = threading.Event()
    thread = threading.Thread(target=_print, args=(ended, first, command), daemon=True)
    try:
        thread.start()
    except RuntimeError:  # no more threads: the lines are no reason to fail
        yield
        return
    try:
        yield
    finally:
        ended.set()
        thread.join()


def _print(ended: threading.Event, first: float, command: str) -> None:
    start, after = time.monotonic(), first
    while not ended.wait(max(start + after - time.monotonic(), 0.0)):
        if not drawn():
            seconds = time.monotonic() - start
            done = running() or command
            print(f"gsp: working for {seconds:.0f} s{done and ': '}{done}", file=sys.stderr)
        after *= 2.0
