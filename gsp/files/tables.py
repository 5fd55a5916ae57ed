"""Tables as files: CSV, Parquet, Markdown or LaTeX by suffix, with a sidecar of metadata."""

from __future__ import annotations

import importlib.util
import json
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from gsp.errors import MissingSoftware, UnwritableOutput, expected
from gsp.files.writing import check_writable, write_file, write_text
from gsp.version import __version__

if TYPE_CHECKING:
    import pandas as pd


@dataclass(frozen=True)
class Format:
    """A file format of tables.

    Attributes
    ----------
    suffix : str
        With its dot.
    write : DataFrame, Path -> None
    package : str
        What pandas needs to write it, "" for nothing.
    extra : str
        The extra of this distribution that brings the package.
    """

    suffix: str
    write: Callable[[pd.DataFrame, Path], object]
    package: str = ""
    extra: str = ""


_FORMATS = (
    Format(".csv", lambda frame, path: frame.to_csv(path, index=False)),
    Format(
        ".parquet", lambda frame, path: frame.to_parquet(path, index=False), "pyarrow", "tables"
    ),
    Format(".md", lambda frame, path: frame.to_markdown(path, index=False), "tabulate", "tables"),
    Format(".tex", lambda frame, path: _to_latex(frame, path), "jinja2", "tables"),
)

FORMATS = MappingProxyType({form.suffix: form for form in _FORMATS})


def sidecar(path: str | PathLike[str]) -> Path:
    """Return the path of the metadata of a table: its own name with ".json" appended."""
    target = Path(path)
    return target.with_name(target.name + ".json")


def check_table(path: str | PathLike[str], *, overwrite: bool = False) -> None:
    """Raise if a table and its metadata could not be written to `path`, before any work is done.

    Raises
    ------
    UnwritableOutput
        If the suffix is unknown, a file exists and `overwrite` is not set, or the folder cannot
        be written.
    MissingSoftware
        If the format needs a package that is not installed.
    """
    form = FORMATS.get(Path(path).suffix.lower())
    if form is None:
        raise UnwritableOutput(expected(str(path), "a name ending in " + ", ".join(FORMATS), path))
    if form.package and importlib.util.find_spec(form.package) is None:
        raise MissingSoftware(form.package, f"a {form.suffix} table", form.extra)
    for file in (Path(path), sidecar(path)):
        check_writable(file, overwrite=overwrite)


def write_table(
    frame: pd.DataFrame,
    path: str | PathLike[str],
    metadata: Mapping[str, Any] | None = None,
    *,
    overwrite: bool = False,
) -> None:
    """Write a table in the format of its suffix, and its metadata beside it as JSON.

    Parameters
    ----------
    frame : pandas.DataFrame
        Its index is not written.
    path : path
        Ending in .csv, .parquet, .md or .tex.
    metadata : mapping or None
        What JSON can hold; default `frame.attrs`. The version of the library is added.

    Raises
    ------
    UnwritableOutput, MissingSoftware
        See `check_table`.

    Examples
    --------
    >>> from tempfile import mkdtemp
    >>> write_table(pd.DataFrame({"x": [1.0]}), Path(mkdtemp(), "x.csv"), {"units": {"x": "mm"}})
    """
    check_table(path, overwrite=overwrite)
    facts: dict[Any, Any] = {"library": f"gsp {__version__}"}
    facts |= frame.attrs if metadata is None else dict(metadata)
    text = json.dumps(facts, indent=2, ensure_ascii=False) + "\n"
    form = FORMATS[Path(path).suffix.lower()]
    write_file(path, lambda temporary: form.write(frame, temporary), overwrite=overwrite)
    write_text(sidecar(path), text, overwrite=overwrite)


def _to_latex(frame: pd.DataFrame, path: Path) -> None:
    frame.style.hide(axis="index").format(escape="latex", precision=6).format_index(
        escape="latex", axis="columns"
    ).to_latex(path, hrules=True, encoding="utf-8")
