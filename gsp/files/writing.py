"""Reading and writing files so that nothing is lost: a temporary file first, then a rename."""

from __future__ import annotations

import os
import tempfile
from collections.abc import Callable
from os import PathLike
from pathlib import Path

from gsp.errors import MalformedFile, UnwritableOutput, brief, expected


def read_text(path: str | PathLike[str]) -> str:
    """Return the text of a UTF-8 file, or raise MalformedFile with the reason."""
    try:
        return Path(path).read_text(encoding="utf-8")
    except (OSError, ValueError, TypeError) as error:
        reason = error.strerror if isinstance(error, OSError) else str(error)
        raise MalformedFile(
            f"{path!s}: expected a readable text file, received: {reason}"
        ) from error


def write_file(
    path: str | PathLike[str], fill: Callable[[Path], object], *, overwrite: bool = False
) -> None:
    """Let `fill` write a temporary file beside `path`, then rename it to `path`.

    Raises
    ------
    UnwritableOutput
        If `path` exists and `overwrite` is not set, or the folder cannot be written.
    """
    check_writable(path, overwrite=overwrite)
    target = Path(path)
    temporary = None
    try:
        handle, name = tempfile.mkstemp(dir=target.parent, prefix=".gsp-", suffix=target.suffix)
        os.close(handle)
        temporary = Path(name)
        fill(temporary)
        temporary.chmod(0o666 & ~_umask())
        os.replace(temporary, target)
    except OSError as error:
        raise UnwritableOutput(f"{target}: cannot be written: {error.strerror}") from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def write_text(path: str | PathLike[str], text: str, *, overwrite: bool = False) -> None:
    """Write a UTF-8 text file: see `write_file`."""
    write_file(path, lambda p: p.write_text(text, encoding="utf-8"), overwrite=overwrite)


def check_writable(path: str | PathLike[str], *, overwrite: bool = False) -> None:
    """Raise UnwritableOutput if `path` could not be written, before any work is done for it."""
    try:
        target = Path(path)
    except TypeError as error:
        got = brief(path)
        raise UnwritableOutput(expected("output", "the path of a file", got)) from error
    if "\0" in str(target):
        raise UnwritableOutput(expected("output", "the path of a file", brief(path)))
    try:
        folder, exists = target.is_dir(), target.exists()
    except OSError as error:
        raise UnwritableOutput(f"{target}: cannot be written: {error.strerror}") from error
    if folder:
        raise UnwritableOutput(f"{target}: expected a file name, received a folder")
    if exists and not overwrite:
        raise UnwritableOutput(f"{target}: exists already, and overwriting was not asked for")
    if not target.parent.is_dir():
        raise UnwritableOutput(f"{target}: the folder {target.parent} does not exist")
    if not os.access(target.parent, os.W_OK):
        raise UnwritableOutput(f"{target}: the folder {target.parent} is not writable")


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
