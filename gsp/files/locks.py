"""Locks of open files, which end with the process that holds them, however it ends."""

from __future__ import annotations

import os
from contextlib import suppress

try:
    import fcntl
except ImportError:  # Windows
    fcntl = None  # type: ignore[assignment]

LOCKABLE = fcntl is not None

# Open files whose locks a child process, made by a fork, would share: it closes them.
_kept: set[int] = set()


def lock(handle: int) -> bool | None:
    """Lock an open file; False if another process or thread holds it, None if none can."""
    if fcntl is None:
        return None
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except (BlockingIOError, PermissionError):
        return False
    except OSError:  # a file system without locks
        return None
    return True


def open_kept(path: str | os.PathLike[str]) -> int:
    """Open a file, made if it does not exist, for a lock that is kept for the time of a run."""
    handle = os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_CLOEXEC", 0), 0o666)
    _kept.add(handle)
    return handle


def close_kept(handle: int) -> None:
    """Close a file of `open_kept`, which ends its lock, unless a fork has closed it."""
    if handle in _kept:
        _kept.discard(handle)
        if fcntl is not None:
            with suppress(OSError):  # a file system without locks
                fcntl.flock(handle, fcntl.LOCK_UN)
        os.close(handle)


def _forget() -> None:
    for handle in list(_kept):
        _kept.discard(handle)
        os.close(handle)


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forget)
