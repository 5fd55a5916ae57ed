"""Progress of long runs: calls of a function, or a bar where there is a terminal."""

from __future__ import annotations

import inspect
import logging
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from threading import Lock
from typing import TYPE_CHECKING, Any

from gsp.errors import InvalidInput, brief, expected

if TYPE_CHECKING:
    from rich.progress import Progress as Bar

# What is called with (done, total).
Report = Callable[[int, int], object]
# What a caller passes: such a function, or whether a bar is drawn; None draws one on a terminal.
Progress = Report | bool | None

# Seconds after which a bar is drawn.
SECONDS_BEFORE_BAR = 1.0
# Runs whose progress is not given to a function, the innermost last.
_running: list[_Counter] = []
# Number of compilations that run: each compiles the functions that it calls.
_compiling = 0
_compiling_lock = Lock()
# The log of compilations, which a terminal shows where it shows a bar.
COMPILATION = "gsp.compilation"


class OnTerminal(logging.Handler):
    """Prints messages as one line on stderr, where that is a terminal, as bars are drawn."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print the message of a record."""
        if sys.stderr.isatty():
            print(f"gsp: {record.getMessage()}", file=sys.stderr)


@contextmanager
def _compilations() -> Iterator[None]:
    """Print that formulas are compiled, unless a command prints what the library logs."""
    log = logging.getLogger(COMPILATION)
    logs = (log, logging.getLogger("gsp"))
    if any(isinstance(handler, OnTerminal) for one in logs for handler in one.handlers):
        yield
        return
    handler, level = OnTerminal(), log.level
    log.addHandler(handler)
    log.setLevel(logging.INFO)
    try:
        yield
    finally:
        log.removeHandler(handler)
        log.setLevel(level)


@dataclass
class Steps:
    """Counts the steps of a run whose end is not known, and reports each of them.

    Attributes
    ----------
    report : function (done, total)
        Called with the number of steps done, and with that plus the number that remains.
    done : int
    ahead : int
        Number of steps that remain, as far as it is known; the run updates it.
    """

    report: Report
    done: int = 0
    ahead: int = 0

    def __call__(self, number: int = 1) -> None:
        """Count steps, and report them."""
        self.done += number
        self.ahead = max(self.ahead - number, 0)
        self.report(self.done, self.done + self.ahead)


def check_progress(progress: Any) -> None:
    """Raise InvalidInput unless `progress` is a function of two numbers, True, False or None."""
    if progress is None or type(progress) is bool:
        return
    if not callable(progress) or not _takes_two(progress):
        wanted = "a function (done, total), True, False or None"
        raise InvalidInput(expected("progress", wanted, brief(progress)))


def _takes_two(function: Callable[..., Any]) -> bool:
    try:
        inspect.signature(function).bind(0, 1)
    except TypeError:
        return False
    except ValueError:  # some functions written in C have no signature
        return True
    except Exception:  # `inspect` compares objects, whose own methods may raise anything
        return False
    return True


@contextmanager
def meter(progress: Progress, label: str) -> Iterator[Report]:
    """Yield a function (done, total): the caller's, or one that draws a bar on a terminal.

    A bar is drawn on standard error, after a second, and only if that is a terminal.

    Parameters
    ----------
    progress : function (done, total), bool or None
        A function to call; False: no output; None or True: a progress bar.
    label : str
        The text beside the bar.

    Yields
    ------
    function (done, total)

    Raises
    ------
    InvalidInput
        If `progress` is none of these.
    """
    check_progress(progress)
    if callable(progress):
        yield progress
        return
    if progress is False:
        yield lambda done, total: None
        return
    terminal = bool(sys.stderr) and sys.stderr.isatty()
    counter = _Bars(label) if terminal else _Counter(label)
    _running.append(counter)
    try:
        with _compilations() if terminal else nullcontext():
            yield counter
    finally:
        _running.remove(counter)
        counter.close()


def compiling(change: int) -> None:
    """Count compilations of numba: 1 where one begins, −1 where it ends."""
    global _compiling
    with _compiling_lock:
        _compiling = max(_compiling + change, 0)


@contextmanager
def during(label: str) -> Iterator[None]:
    """State what a process works on meanwhile, for `running`, where no steps are counted.

    Parameters
    ----------
    label : str
    """
    counter = _Counter(label)
    _running.append(counter)
    try:
        yield
    finally:
        _running.remove(counter)


def running() -> str:
    """Return what of the innermost run in this process is done, in words; "" if none runs.

    It states too that functions are compiled, which is what runs wait for then.
    """
    try:
        run = _running[-1]
    except IndexError:
        done = ""
    else:
        done = f"{run.label}, {run.done} of {run.total}" if run.total else run.label
    return ", ".join(part for part in (done, "formulas are compiled" * (_compiling > 0)) if part)


def drawn() -> bool:
    """Return whether a bar is drawn on the terminal."""
    return any(isinstance(run, _Bars) and run.bar is not None for run in tuple(_running))


class _Counter:
    """What is known of a run."""

    def __init__(self, label: str) -> None:
        self.label, self.done, self.total = label, 0, 0

    def __call__(self, done: int, total: int) -> None:
        self.done, self.total = done, total

    def close(self) -> None:
        """End what is drawn."""


class _Bars(_Counter):
    """A bar that appears when a run takes longer than `SECONDS_BEFORE_BAR`."""

    def __init__(self, label: str) -> None:
        super().__init__(label)
        self.start = time.monotonic()
        self.bar: Bar | None = None

    def __call__(self, done: int, total: int) -> None:
        super().__call__(done, total)
        if self.bar is None and time.monotonic() - self.start > SECONDS_BEFORE_BAR:
            self.bar = self._drawn(total)
        if self.bar is not None:
            # The total is what is known so far: a network of curves grows as it is followed.
            self.bar.update(self.bar.task_ids[0], completed=done, total=total)

    def _drawn(self, total: int) -> Bar:
        from rich.console import Console
        from rich.progress import Progress as RichProgress

        bar = RichProgress(console=Console(stderr=True), transient=True)
        bar.add_task(self.label, total=total)
        bar.start()
        return bar

    def close(self) -> None:
        if self.bar is not None:
            self.bar.stop()
