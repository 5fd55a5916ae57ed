"""Output whose reader has closed it, as `| head -1` does: the rest is discarded."""

from __future__ import annotations

import os
from contextlib import suppress
from typing import TextIO

_closed = False


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
