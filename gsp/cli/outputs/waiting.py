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
SHORTEST_WAIT = 0.05  # seconds


class _Questions:
    """How long questions have waited for answers."""

    def __init__(self) -> None:
        self._closed = 0.0
        self._opened: list[float] = []

    def seconds(self) -> float:
        """Return the time of all questions, also of one that is open."""
        return self._closed + sum(time.monotonic() - since for since in self._opened)

    @contextmanager
    def open(self) -> Iterator[None]:
        """Count the time of one question."""
        self._opened.append(time.monotonic())
        try:
            yield
        finally:
            self._closed = self.seconds()  # before the other: never less than was waited
            self._opened.clear()


_questions = _Questions()
question = _questions.open  # a context in which a command waits for an answer, and does not work


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
    start, after = time.monotonic() - _questions.seconds(), first

    def worked() -> float:
        return time.monotonic() - _questions.seconds() - start

    while not ended.wait(max(after - worked(), SHORTEST_WAIT)):
        seconds = worked()
        if seconds < after:  # a question was asked meanwhile
            continue
        if not drawn():
            done = running() or command
            print(f"gsp: working for {seconds:.0f} s{done and ': '}{done}", file=sys.stderr)
        after *= 2.0
