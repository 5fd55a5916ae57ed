"""Results on disk while a run lasts, so that a run that was interrupted can be resumed.

Each finished part is a file that is written under a temporary name and then renamed, so that a run
that is killed leaves no damaged file.
"""

from __future__ import annotations

import hashlib
import json
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp import arguments
from gsp.errors import InvalidInput, UnwritableOutput, expected
from gsp.evaluation.settings import Job, provenance
from gsp.files.claims import Claim, read_json
from gsp.files.writing import check_writable, write_file, write_text
from gsp.geometry.pose import Pose
from gsp.installed import optional
from gsp.model.design import toml_from_design
from gsp.version import __version__

if TYPE_CHECKING:
    import pandas as pd

KEY = b"gsp"
# The key under which pandas writes and reads the attributes of a table.
ATTRIBUTES = b"PANDAS_ATTRS"


def digest(jobs: Iterable[Job], pose: Pose, names: Iterable[str], **rest: Any) -> str:
    """Return a checksum of all data that a result depends on."""
    total = hashlib.sha256()
    for design, settings in jobs:
        total.update(toml_from_design(design).encode())
        total.update(json.dumps(provenance(settings), sort_keys=True).encode())
    total.update(np.ascontiguousarray(pose.position).tobytes())
    total.update(np.ascontiguousarray(pose.rotation).tobytes())
    total.update(json.dumps([__version__, pose.shape, *names, rest], sort_keys=True).encode())
    return total.hexdigest()


class Parts:
    """A folder with the finished parts of one run.

    Parameters
    ----------
    folder : path or Claim
        Made if it does not exist; a claim is released by its owner.
    job : str
        Checksum of the run: see `digest`.
    suffix : str
        Of the files: ".parquet" for blocks of columns, ".json" for rows.
    resume : bool
        Whether to use parts that are in the folder.

    Raises
    ------
    UnwritableOutput
        If there are parts and `resume` is not set, another run uses the folder, or it cannot be
        made.
    InvalidInput
        If the parts belong to another run.
    """

    def __init__(
        self, folder: str | PathLike[str] | Claim, job: str, suffix: str, *, resume: bool
    ) -> None:
        self.suffix, self._kept = suffix, isinstance(folder, Claim)
        self.claim = (
            folder if isinstance(folder, Claim) else Claim(Path(arguments.path("parts", folder)))
        )
        self.folder = self.claim.folder
        try:
            if not check_parts(self.claim, job, resume=resume):
                self.claim.begin(job)
        except BaseException:
            self._released()
            raise

    def path(self, number: int) -> Path:
        """Return the path of a part."""
        return self.folder / f"part-{number:08d}{self.suffix}"

    def has(self, number: int) -> bool:
        """Whether a part is on disk."""
        return self.path(number).is_file()

    def read(self, number: int) -> pd.DataFrame:
        """Return a block of columns."""
        import pandas as pd

        return pd.read_parquet(self.path(number))

    def write(self, number: int, frame: pd.DataFrame) -> None:
        """Store a block of columns."""
        write_file(self.path(number), lambda p: frame.to_parquet(p, index=False), overwrite=True)

    def read_row(self, number: int) -> dict[str, Any]:
        """Return a row; its numbers are those that were stored, to the last bit."""
        return read_json(self.path(number))

    def write_row(self, number: int, row: dict[str, Any]) -> None:
        """Store a row of texts and numbers."""
        write_text(self.path(number), json.dumps(row), overwrite=True)

    @contextmanager
    def removed(self) -> Iterator[None]:
        """Delete the parts after what runs meanwhile, or keep them if it is stopped.

        A folder in which no part is stored is always deleted.
        """
        try:
            yield
            self.claim.clear()
        except BaseException:
            if not self.claim.count():
                self.claim.clear()
            raise
        finally:
            self._released()

    def _released(self) -> None:
        if not self._kept:
            self.claim.release()


def check_parts(claim: Claim, job: str, *, resume: bool) -> bool:
    """Return whether a folder holds parts of this run; nothing is written.

    Parameters
    ----------
    claim, job, resume :
        See `Parts`.

    Raises
    ------
    UnwritableOutput, InvalidInput
        See `Parts`.
    """
    record = claim.record()
    if record is None:
        return False
    if not resume:
        since = "was interrupted" if claim.locked else "was interrupted or is in progress"
        what = f"holds parts of a run that {since}; resume it, or delete the folder"
        raise UnwritableOutput(f"{claim.folder}: {what}")
    check_same_job(record.get("job"), job, claim.folder)
    return True


class Output:
    """The Parquet file that a run writes at its end, marked with the checksum of the run.

    Parameters
    ----------
    out : path
        Ends in .parquet. While the run lasts, its parts are in the folder `out` + ".parts".
    job : str
    resume : bool
        Whether a file of the same run is accepted as the result.

    Raises
    ------
    UnwritableOutput
        If the file cannot be written, or exists and `resume` is not set.
    InvalidInput
        If a file of another run exists and `resume` is set.
    MissingSoftware
        If pyarrow is not installed.
    """

    def __init__(self, out: str | PathLike[str], job: str, *, resume: bool) -> None:
        self.out, self.job = _check_parquet(out), job
        self.folder = self.out.with_name(self.out.name + ".parts")
        # Of a name that is too long, which the check below refuses, `Path.is_file` raises.
        self.finished = resume and os.path.isfile(self.out)
        if self.finished:
            check_same_job(_job_of(self.out), job, self.out)
        else:
            check_writable(self.out)

    def result(self) -> pd.DataFrame:
        """Return the finished file."""
        import pandas as pd

        return pd.read_parquet(self.out)

    def write(self, frame: pd.DataFrame, rows: int | None = None) -> None:
        """Write a table with its index and attributes.

        Parameters
        ----------
        frame : pandas.DataFrame
            With `attrs` that JSON can hold; `pandas.read_parquet` restores them.
        rows : int or None
            Number of rows of a row group; default one group.
        """
        import pyarrow as pa
        import pyarrow.parquet as pq

        table = pa.Table.from_pandas(frame)
        marks = {KEY: self.job.encode(), ATTRIBUTES: json.dumps(frame.attrs).encode()}
        table = table.replace_schema_metadata({**table.schema.metadata, **marks})
        write_file(self.out, lambda path: pq.write_table(table, path, row_group_size=rows))


def check_same_job(found: Any, job: str, place: Path) -> None:
    """Raise InvalidInput if a checksum that was found is not that of this run."""
    if found != job:
        wanted = "results of the same designs, poses, indices, settings and version"
        raise InvalidInput(expected(str(place), wanted, "those of another run"))


def _job_of(path: Path) -> str | None:
    import pyarrow.parquet as pq

    try:
        value = (pq.read_schema(path).metadata or {}).get(KEY)
    except (OSError, ValueError):
        return None
    return None if value is None else str(value, "ascii")


def _check_parquet(out: str | PathLike[str]) -> Path:
    path = Path(arguments.path("out", out))
    if path.suffix != ".parquet":
        raise InvalidInput(expected("out", "a file name that ends in .parquet", path.name))
    with optional("pyarrow", "out", "tables"):
        import pyarrow  # noqa: F401
    return path
