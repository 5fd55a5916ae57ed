"""Reading and writing files so that nothing is lost: a temporary file first, then its name."""

from __future__ import annotations

import hashlib
import os
import signal
import tempfile
import threading
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from os import PathLike
from pathlib import Path

from gsp.checks import plain_text
from gsp.errors import MalformedFile, UnwritableOutput, brief, expected
from gsp.files.locks import LOCKABLE, lock

# Signals that end a process: from `kill` and `timeout`, and from a terminal that is closed.
TERMINATION = [getattr(signal, name) for name in ("SIGTERM", "SIGHUP") if hasattr(signal, name)]


def read_text(path: str | PathLike[str], *, most: int | None = None) -> str:
    """Return the text of a UTF-8 file, without the byte-order mark that some editors put first.

    Parameters
    ----------
    path : path
    most : int or None [bytes]
        The longest file that is read; default any length.

    Returns
    -------
    str

    Raises
    ------
    MalformedFile
        If there is no such file, it is not a regular file, cannot be read, is longer than `most`,
        or is not in UTF-8.
    """
    file = check_readable(path)
    try:
        size = file.stat().st_size
        if most is not None and size > most:
            wanted = f"a text file of at most {most} bytes"
            raise MalformedFile(expected(str(file), wanted, f"one of {size}"))
        return file.read_text(encoding="utf-8-sig")
    except MalformedFile:
        raise
    except (OSError, ValueError) as error:
        raise MalformedFile(
            expected(str(file), "a readable text file", _unreadable(error))
        ) from error


def _unreadable(error: Exception) -> str:
    if isinstance(error, UnicodeDecodeError):
        return f"one that is not in UTF-8 (byte 0x{error.object[error.start]:02x})"
    return f"none: {error.strerror if isinstance(error, OSError) else error}"


def check_readable(path: str | PathLike[str]) -> Path:
    """Return a path; MalformedFile for none, or that of a pipe or a device that would wait."""
    try:
        file = Path(plain_text(path))
    except Exception as error:  # TypeError, and what an object's own `__fspath__` raises
        raise MalformedFile(expected(brief(path), "a readable text file", "no path")) from error
    try:
        waits = file.exists() and not (file.is_file() or file.is_dir())
    except (OSError, ValueError):  # reported when it is opened
        return file
    if waits:
        raise MalformedFile(expected(str(file), "a regular file", "a pipe or device"))
    return file


def write_file(
    path: str | PathLike[str], fill: Callable[[Path], object], *, overwrite: bool = False
) -> None:
    """Fill a temporary file beside `path`, and give it that name once it is whole.

    The temporary file is named after its target, ".NAME.gsp-partial-…". It is removed if the
    process is terminated. A run that is killed leaves it behind; the next one that writes the same
    target removes it.

    Parameters
    ----------
    path : path
    fill : function of a Path
        Writes the temporary file, whose suffix is that of `path`.
    overwrite : bool
        Whether a file that exists may be replaced, of a symbolic link the file to which it points;
        otherwise one that appears meanwhile stays, too.

    Raises
    ------
    UnwritableOutput
        If `path` exists and `overwrite` is not set, is a pipe or device, or a symbolic link that
        leads to one or to no name, or the folder cannot be written.
    """
    given = _check_free(path, overwrite=overwrite)
    target = followed(given)
    try:
        _remove_stale(target)
        with _temporary(target) as temporary:
            fill(temporary)
            temporary.chmod(0o666 & ~_umask())
            if overwrite:
                os.replace(temporary, target)
            else:
                _name_new(temporary, target)
    except FileExistsError as error:
        raise UnwritableOutput(_exists(given)) from error
    except OSError as error:
        raise UnwritableOutput(f"{given}: cannot be written: {error.strerror}") from error


@contextmanager
def _temporary(target: Path) -> Iterator[Path]:
    """Make a temporary file of a target, locked while it is in use, and remove it afterwards."""
    names: list[str] = []
    with _removed_at_termination(names):
        handle, name = tempfile.mkstemp(
            dir=target.parent, prefix=_prefix(target), suffix=target.suffix
        )
        names.append(name)
        try:
            if not LOCKABLE:
                os.close(handle)  # Windows renames no file that is open
            else:
                lock(handle)
            yield Path(name)
        finally:
            Path(name).unlink(missing_ok=True)
            if LOCKABLE:
                os.close(handle)


@contextmanager
def _removed_at_termination(names: Sequence[str]) -> Iterator[None]:
    """Remove files if the process is terminated meanwhile, which still ends it by the signal.

    Only where the signal would end the process, and in the main thread, as no other may do this.
    """

    def end(number: int, _: object) -> None:
        for name in names:
            with suppress(OSError):
                os.unlink(name)
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)

    main = threading.current_thread() is threading.main_thread()
    caught = [n for n in TERMINATION if main and signal.getsignal(n) is signal.SIG_DFL]
    for number in caught:
        signal.signal(number, end)
    try:
        yield
    finally:
        for number in caught:
            signal.signal(number, signal.SIG_DFL)


def _name_new(temporary: Path, target: Path) -> None:
    """Give a file a name that is not taken: it is checked and taken in one step."""
    try:
        os.link(temporary, target)
    except FileExistsError:
        raise
    except (OSError, NotImplementedError):
        # A file system without hard links: the name is reserved first.
        with target.open("xb"):
            pass
        os.replace(temporary, target)


def _remove_stale(target: Path) -> None:
    """Remove temporary files of this target that no running process has locked."""
    prefix = _prefix(target)
    for entry in os.scandir(target.parent) if LOCKABLE else ():
        if entry.name.startswith(prefix) and entry.is_file(follow_symlinks=False):
            with suppress(OSError):  # already removed, or of another user
                handle = os.open(entry.path, os.O_RDWR)
                try:
                    if lock(handle):
                        os.unlink(entry.path)
                finally:
                    os.close(handle)


def _prefix(target: Path) -> str:
    """Return how the temporary files of a target begin; of no other in its folder.

    A long name is cut, so a digest of the whole name follows it.
    """
    digest = hashlib.blake2s(target.name.encode(errors="surrogateescape"), digest_size=6)
    return f".{target.name[:40]}.gsp-partial-{digest.hexdigest()}-"


def _exists(target: Path) -> str:
    return f"{target}: exists already, and may not be overwritten"


def write_text(path: str | PathLike[str], text: str, *, overwrite: bool = False) -> None:
    """Write a UTF-8 text file.

    Parameters
    ----------
    path : path
    text : str
    overwrite : bool
        See `write_file`.

    Raises
    ------
    UnwritableOutput
        See `write_file`.
    """
    write_file(path, lambda p: p.write_text(text, encoding="utf-8"), overwrite=overwrite)


def check_writable(
    path: str | PathLike[str], *, overwrite: bool = False, suffixes: Iterable[str] = ()
) -> None:
    """Raise an error if `path` could not be written, before any work is done for it.

    Parameters
    ----------
    path : path
    overwrite : bool
        Whether a file that exists may be replaced.
    suffixes : iterable of str
        How the name has to end, in any case: ".csv" …; nothing for any name.

    Raises
    ------
    UnwritableOutput
        If it exists and may not, is a folder or no path, or a symbolic link that leads to no name,
        ends otherwise, or the folder cannot be written.
    """
    given = _check_free(path, overwrite=overwrite, suffixes=suffixes)
    target = followed(given)
    try:  # permissions are not sufficient: in /proc, or on a volume that is mounted read-only
        with _temporary(target):
            pass
    except OSError as error:
        what = f"the folder {target.parent} is not writable: {error.strerror}"
        raise UnwritableOutput(f"{given}: {what}") from error


def _check_free(
    path: str | PathLike[str], *, overwrite: bool, suffixes: Iterable[str] = ()
) -> Path:
    """Return a path whose name and folder allow a file; whether it can be written is not tried."""
    try:
        path = plain_text(path)
        target = Path(path)
        encoded = os.fsencode(target)
    except Exception as error:  # TypeError, and what an object's own `__fspath__` raises
        raise UnwritableOutput(expected("output", "the path of a file", brief(path))) from error
    # The path of an empty text has no name.
    if b"\0" in encoded or not target.name:
        raise UnwritableOutput(expected("output", "the path of a file", brief(str(path))))
    ends = tuple(suffixes)
    if ends and target.suffix.lower() not in ends:
        wanted = "a name ending in " + ", ".join(ends)
        raise UnwritableOutput(expected(str(path), wanted, target.suffix or "no suffix"))
    try:
        folder, exists = target.is_dir(), os.path.lexists(target)
    except OSError as error:
        raise UnwritableOutput(f"{target}: cannot be written: {error.strerror}") from error
    if folder:
        raise UnwritableOutput(f"{target}: expected a file name, received a folder")
    if followed(target).is_symlink():
        raise UnwritableOutput(expected(str(target), "a file name", "a link that leads to itself"))
    if exists and not followed(target).is_file() and followed(target).exists():
        raise UnwritableOutput(expected(str(target), "a regular file", "a pipe or device"))
    if exists and not overwrite:
        raise UnwritableOutput(_exists(target))
    if not target.parent.is_dir():
        raise UnwritableOutput(f"{target}: the folder {target.parent} does not exist")
    return target


def followed(path: Path) -> Path:
    """Return the path to which a symbolic link leads, any other as it is."""
    return Path(os.path.realpath(path)) if path.is_symlink() else path


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
