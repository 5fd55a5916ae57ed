"""Ctrl-C on the command line: one line and exit status 130, at any moment.

Before a command begins there is nothing to save, and an exception raised while modules are imported
can be replaced or suppressed by them: the process ends at once. While a command runs, Ctrl-C raises
KeyboardInterrupt, so that a command can keep what it has computed; that it was pressed is
remembered, as some searches return their result so far. A second Ctrl-C ends the process at once.

While numba compiles, the first one does: LLVM calls back functions of Python whose exceptions are
printed and lost, and there is no result yet.

Only modules that the interpreter has loaded already are imported here.
"""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from types import FrameType
from typing import Any, NoReturn

# Exit status of a command that was stopped by Ctrl-C.
INTERRUPTED = 130
LINE = "gsp: stopped\n"

# Packages in whose code an exception may be lost.
COMPILERS = ("numba", "llvmlite")

_handled = False
_pressed = False
_conclude: Callable[[], object] | None = None


def end_at_once() -> None:
    """From now on Ctrl-C prints the line and ends the process.

    Nothing is done where Ctrl-C is ignored, as in a job that a shell started in the background.
    """
    global _handled
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        _handled = True
        signal.signal(signal.SIGINT, _end)


def raise_in_command() -> None:
    """From now on the first Ctrl-C raises KeyboardInterrupt."""
    if _handled:
        signal.signal(signal.SIGINT, _raise)


def end_after_command() -> None:
    """From now on Ctrl-C ends the process again: nothing is computed any more."""
    if _handled:
        signal.signal(signal.SIGINT, _end)


def ignore() -> None:
    """From now on Ctrl-C does nothing: everything is written, and the process ends."""
    if _handled:
        signal.signal(signal.SIGINT, signal.SIG_IGN)


def pressed() -> bool:
    """Return whether Ctrl-C was pressed while the command ran."""
    return _pressed


@contextmanager
def concluded_by(conclude: Callable[[], object]) -> Iterator[None]:
    """Meanwhile a process that ends at once by the first Ctrl-C calls a function, not the line."""
    global _conclude
    _conclude = conclude
    try:
        yield
    finally:
        _conclude = None


def _raise(_: int, frame: FrameType | None) -> NoReturn:
    global _pressed
    _pressed = True
    signal.signal(signal.SIGINT, _end)
    if not _compiles(frame):
        raise KeyboardInterrupt
    if _conclude is None:
        _end()
    with suppress(Exception):
        _conclude()
    stop(printed=True)


def _compiles(frame: FrameType | None) -> bool:
    """Return whether the main thread is in code of numba, also of functions that it calls."""
    while frame is not None:
        if str(frame.f_globals.get("__name__")).partition(".")[0] in COMPILERS:
            return True
        frame = frame.f_back
    return False


def _end(*_: Any) -> NoReturn:
    with suppress(OSError):
        os.write(2, LINE.encode())
    os._exit(INTERRUPTED)


def stop(printed: bool) -> NoReturn:
    """End an interrupted process, after the line unless a command has printed one.

    A process of ours ends without the interpreter: it would wait for threads, and return −SIGINT
    if the exception has passed through some extension modules.
    """
    ignore()
    if not printed:
        print(LINE, end="", file=sys.stderr)
    if _handled:
        with suppress(OSError, ValueError):
            sys.stdout.flush()
            sys.stderr.flush()
        os._exit(INTERRUPTED)
    sys.exit(INTERRUPTED)
