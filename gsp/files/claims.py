"""The folder of a run, which one run at a time may use."""

from __future__ import annotations

import json
import os
from contextlib import suppress
from pathlib import Path
from typing import Any

from gsp.errors import InvalidInput, UnwritableOutput, expected
from gsp.files.locks import LOCKABLE, close_kept, lock, open_kept
from gsp.files.writing import read_text, write_text

RECORD, LOCK = "job.json", "lock"
PART = "part-" + 8 * "[0-9]" + ".*"
ATTEMPTS = 50


class InUse(UnwritableOutput):
    """A folder in which another run stores its parts."""


class Claim(os.PathLike[str]):
    """A folder that this run alone uses until it is released, or the process ends.

    A locked file in it states that a run is in progress; where the file system has no locks, only
    the run that makes the folder is distinguished from others.

    Parameters
    ----------
    folder : Path
        Made if it does not exist.

    Raises
    ------
    InUse
        If another process or thread uses it.
    UnwritableOutput
        If it cannot be made or written.
    """

    def __init__(self, folder: Path) -> None:
        self.folder, self.locked = folder, False
        self._handle: int | None = None
        # Whether no other run can have begun there.
        self._own = False
        try:
            # A folder that another run has deleted meanwhile is made again.
            if not any(self._taken() for _ in range(ATTEMPTS)):
                raise UnwritableOutput(f"{folder}: cannot be written")
        except FileExistsError as error:
            raise UnwritableOutput(f"{folder}: expected a folder, received a file") from error
        except OSError as error:
            if isinstance(error, UnwritableOutput):
                raise
            what = "written" if os.path.isdir(folder) else "made"
            raise UnwritableOutput(f"{folder}: cannot be {what}: {error.strerror}") from error

    def __fspath__(self) -> str:
        return os.fspath(self.folder)

    def _taken(self) -> bool:
        made = not self.folder.is_dir()
        if made:
            try:
                self.folder.mkdir()
            except FileExistsError:
                if not self.folder.is_dir():
                    raise
                made = False
        self._own = made
        if not LOCKABLE:
            return True
        try:
            self._handle = open_kept(self.folder / LOCK)
        except FileNotFoundError:
            return False
        try:
            found = lock(self._handle)
            if found is False:
                what = "another process or thread is writing there; wait for it, or give another"
                raise InUse(f"{self.folder}: {what} name")
            same = os.path.samestat(os.fstat(self._handle), os.stat(self.folder / LOCK))
        except FileNotFoundError:
            same = False
        except BaseException:
            self._close()
            raise
        self.locked = bool(found)
        if not same:
            self._close()
        return same

    def has_begun(self) -> bool:
        """Return whether a run has recorded there that it began."""
        return (self.folder / RECORD).is_file()

    def record(self) -> dict[str, Any] | None:
        """Return what a run recorded when it began; None if none did.

        Raises
        ------
        InvalidInput
            If the record is damaged.
        """
        return read_json(self.folder / RECORD) if self.has_begun() else None

    def begin(self, job: str) -> None:
        """Record the checksum of a run."""
        write_text(self.folder / RECORD, json.dumps({"job": job}))

    def clear(self) -> None:
        """Delete what runs have stored there, and nothing else."""
        for name in (PART, f".{PART}gsp-partial-*", f".{RECORD}.gsp-partial-*", RECORD):
            for file in self.folder.glob(name):
                file.unlink(missing_ok=True)
        self._own = True

    def count(self) -> int:
        """Return how many parts are stored there."""
        return len(list(self.folder.glob(PART)))

    def release(self) -> None:
        """Let others use the folder; it is deleted if nothing is stored there."""
        if self._handle is None and LOCKABLE:
            return
        if not self.has_begun() and (self.locked or self._own):
            with suppress(OSError):
                (self.folder / LOCK).unlink(missing_ok=True)
                self.folder.rmdir()
        self._close()

    def _close(self) -> None:
        if self._handle is not None:
            close_kept(self._handle)
            self._handle = None

    __del__ = _close


def read_json(path: Path) -> dict[str, Any]:
    """Return the content of a file of a run; InvalidInput if it is damaged."""
    try:
        content = json.loads(read_text(path))
    except (ValueError, RecursionError) as error:
        wanted = "a part of an earlier run"
        got = "a damaged file; delete it, and it is computed again"
        raise InvalidInput(expected(str(path), wanted, got)) from error
    return content if isinstance(content, dict) else {}
