"""Standard streams that are closed, or that cannot take what is written."""

from __future__ import annotations

import errno
import io
import os
import sys
from contextlib import suppress
from pathlib import Path
from typing import Any, TextIO

_closed = False


class _Lossy(io.FileIO):
    """A file that takes everything: what cannot be written is lost, and is no error."""

    def write(self, data: Any, /) -> int:
        try:
            return super().write(data)
        except OSError:
            return memoryview(data).nbytes


class _Absent(io.FileIO):
    """A standard output that the caller closed: what is written is an error, until `drop`."""

    def write(self, data: Any, /) -> int:
        if not _closed:
            raise OSError(errno.EBADF, os.strerror(errno.EBADF))
        return memoryview(data).nbytes


def open_streams(*, own: bool) -> None:
    """Replace standard streams that the caller closed, and those that would fail on "λ".

    With `own`, in a process that is the command only, a full disk or a closed pipe behind stderr
    changes neither the result of a command nor its status, and results for a closed stdout are an
    error, as those for a full disk.
    """
    absent = own and sys.stdout is None
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:
            setattr(sys, name, Path(os.devnull).open(mode, encoding="utf-8"))
    if absent:
        nowhere = _Absent(os.dup(sys.stdout.fileno()), "w")
        sys.stdout = io.TextIOWrapper(io.BufferedWriter(nowhere), "utf-8")
    if own and sys.stderr is sys.__stderr__ and isinstance(sys.stderr, io.TextIOWrapper):
        raw = _Lossy(sys.stderr.fileno(), "w", closefd=False)
        encoding = sys.stderr.encoding
        sys.stderr = io.TextIOWrapper(io.BufferedWriter(raw), encoding, line_buffering=True)
    for stream in (sys.stdout, sys.stderr):  # an old terminal shows "?" instead
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")


def drop(stream: TextIO | None) -> None:
    """Redirect a stream to the null device, so that the interpreter can flush it at exit."""
    global _closed
    _closed = True
    with suppress(OSError, ValueError, AttributeError):
        null = os.open(os.devnull, os.O_WRONLY)
        os.dup2(null, stream.fileno())  # type: ignore[union-attr]
        os.close(null)


def closed() -> bool:
    """Return whether a stream was redirected."""
    return _closed
