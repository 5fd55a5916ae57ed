"""Results on disk while a run lasts: a folder of finished parts, which become one Parquet file.

Each part is a whole Parquet file that appears by a rename, so a run that is killed leaves no file
that cannot be read, and goes on from its parts when it is started again.
"""

from __future__ import annotations

import hashlib
import json
import shutil
from collections.abc import Iterable
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from gsp.errors import InvalidInput, MissingParameter, UnwritableOutput, expected
from gsp.evaluation.settings import Settings, provenance
from gsp.files.writing import check_writable, read_text, write_file, write_text
from gsp.geometry.pose import Pose
from gsp.model.design import Design
from gsp.model.design_toml import toml_from_design
from gsp.version import __version__

if TYPE_CHECKING:
    import pandas as pd

KEY = b"gsp"


def digest(
    jobs: Iterable[tuple[Design, Settings]], pose: Pose, names: Iterable[str], **rest: Any
) -> str:
    """Return a fingerprint of all that a result depends on."""
    total = hashlib.sha256()
    for design, settings in jobs:
        total.update(toml_from_design(design).encode())
        total.update(json.dumps(provenance(settings), sort_keys=True).encode())
    total.update(np.ascontiguousarray(pose.position).tobytes())
    total.update(np.ascontiguousarray(pose.rotation).tobytes())
    total.update(json.dumps([__version__, pose.shape, *names, rest], sort_keys=True).encode())
    return total.hexdigest()


class Parts:
    """The parts of one run.

    Parameters
    ----------
    out : path
        The Parquet file that they will become; they lie beside it in the folder `out` + ".parts".
    job : str
        Fingerprint of the run.
    resume : bool
        Whether to go on from parts that are there.

    Raises
    ------
    UnwritableOutput
        If the file cannot be written or exists, or if parts are there and `resume` is not set.
    InvalidInput
        If the parts, or the finished file, belong to another run.
    MissingParameter
        If pyarrow is not installed.
    """

    def __init__(self, out: str | PathLike[str], job: str, *, resume: bool) -> None:
        self.out, self.job = Path(out), job
        self.folder = self.out.with_name(self.out.name + ".parts")
        _check_parquet(self.out)
        self.finished = resume and self.out.is_file()
        if self.finished:
            self._check_same(_job_of(self.out), self.out)
            return
        check_writable(self.out)
        self._open(resume)

    def _open(self, resume: bool) -> None:
        note = self.folder / "job.json"
        if note.is_file():
            if not resume:
                what = "holds parts of a run that was interrupted; resume it, or delete the folder"
                raise UnwritableOutput(f"{self.folder}: {what}")
            self._check_same(json.loads(read_text(note)).get("job"), self.folder)
        else:
            self.folder.mkdir(exist_ok=True)
            write_text(note, json.dumps({"job": self.job}))

    def _check_same(self, job: str | None, place: Path) -> None:
        if job != self.job:
            wanted = "results of the same designs, poses, indices, settings and version"
            raise InvalidInput(expected(str(place), wanted, "those of another run"))

    def _path(self, number: int) -> Path:
        return self.folder / f"part-{number:08d}.parquet"

    def has(self, number: int) -> bool:
        """Whether a part is on disk."""
        return self._path(number).is_file()

    def read(self, number: int) -> pd.DataFrame:
        """Return a part."""
        import pandas as pd

        return pd.read_parquet(self._path(number))

    def write(self, number: int, frame: pd.DataFrame) -> None:
        """Store a part."""
        write_file(self._path(number), lambda p: frame.to_parquet(p, index=False), overwrite=True)

    def join(self, number: int) -> None:
        """Make one file of the parts 0 … number − 1, a row group each, and remove them."""
        if not self.finished:
            write_file(self.out, lambda path: self._copy(path, number))
            shutil.rmtree(self.folder)

    def _copy(self, path: Path, number: int) -> None:
        import pyarrow.parquet as pq

        schema = pq.read_schema(self._path(0))
        schema = schema.with_metadata({**(schema.metadata or {}), KEY: self.job.encode()})
        with pq.ParquetWriter(path, schema) as writer:
            for i in range(number):
                table = pq.read_table(self._path(i))
                writer.write_table(table.replace_schema_metadata(schema.metadata))

    def finish(self, frame: pd.DataFrame) -> None:
        """Write a table that was made from all the parts in place of them."""
        import pyarrow as pa
        import pyarrow.parquet as pq

        if not self.finished:
            table = pa.Table.from_pandas(frame)
            table = table.replace_schema_metadata({**table.schema.metadata, KEY: self.job.encode()})
            write_file(self.out, lambda path: pq.write_table(table, path))
            shutil.rmtree(self.folder)

    def result(self) -> pd.DataFrame:
        """Return the finished file."""
        import pandas as pd

        return pd.read_parquet(self.out)


def _job_of(path: Path) -> str | None:
    import pyarrow.parquet as pq

    try:
        value = (pq.read_schema(path).metadata or {}).get(KEY)
    except (OSError, ValueError):
        return None
    return None if value is None else str(value, "ascii")


def _check_parquet(path: Path) -> None:
    if path.suffix != ".parquet":
        raise InvalidInput(expected("out", "a file name that ends in .parquet", path.name))
    try:
        import pyarrow  # noqa: F401
    except ImportError as error:
        raise MissingParameter(
            "out: expected pyarrow to be installed, as pip install gsp-mechanisms[parquet] does"
        ) from error
