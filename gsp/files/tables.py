"""Tables as files: CSV, Parquet, Excel, Markdown or LaTeX by suffix, with a sidecar of metadata."""

from __future__ import annotations

import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from gsp.errors import UnknownName
from gsp.files.writing import check_writable, followed, write_file, write_text
from gsp.installed import check_installed
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
    write : DataFrame, Path, headings of columns in LaTeX -> None
    package : str
        The package that pandas needs to write it, "" for none.
    extra : str
        The extra of this distribution that installs the package.
    """

    suffix: str
    write: Callable[[pd.DataFrame, Path, Mapping[str, str]], object]
    package: str = ""
    extra: str = ""


_FORMATS = (
    Format(".csv", lambda frame, path, _: frame.to_csv(path, index=False)),
    Format(
        ".parquet", lambda frame, path, _: frame.to_parquet(path, index=False), "pyarrow", "tables"
    ),
    Format(".xlsx", lambda frame, path, _: _to_excel(frame, path), "openpyxl", "tables"),
    Format(".md", lambda frame, path, _: _to_markdown(frame, path), "tabulate", "tables"),
    Format(".tex", lambda *parts: _to_latex(*parts), "jinja2", "tables"),
)

# The name of a mechanism, such as "D1^2 D2 D4 A1^2".
_JOINT = re.compile(r"(d|theta)(\d+)")
_MECHANISM = re.compile(r"[DA]\d(\^\d)?( [DA]\d(\^\d)?)*")

FORMATS = MappingProxyType({form.suffix: form for form in _FORMATS})


def sidecar(path: str | PathLike[str]) -> Path:
    """Return the path of the metadata of a table: its own name with ".json" appended.

    Of a symbolic link it is that of the file to which the link leads.
    """
    target = followed(Path(path))
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
    check_writable(path, overwrite=overwrite, suffixes=FORMATS)
    form = FORMATS[Path(path).suffix.lower()]
    if form.package:
        check_installed(form.package, f"a {form.suffix} table", form.extra)
    check_writable(sidecar(path), overwrite=overwrite)


def write_table(
    frame: pd.DataFrame,
    path: str | PathLike[str],
    metadata: Mapping[str, Any] | None = None,
    *,
    columns: Sequence[str] | None = None,
    headings: Mapping[str, str] | None = None,
    overwrite: bool = False,
) -> None:
    r"""Write a table in the format of its suffix, and its metadata beside it as JSON.

    Parameters
    ----------
    frame : pandas.DataFrame
        Its index is not written.
    path : path
        Ending in .csv, .parquet, .xlsx, .md or .tex. In LaTeX the names of mechanisms are set as
        formulas, `$D_1^{6}$`, infinite numbers as `$\infty$`, and NaN as a dash.
    metadata : mapping or None
        What JSON can hold; default `frame.attrs`. The version of the library is added.
    columns : sequence of str or None
        The columns to write, in this order, each once; default all.
    headings : mapping or None
        Headings of columns in LaTeX, by their names; default the names. Other formats have the
        names.
    overwrite : bool
        Whether files that exist may be replaced.

    Raises
    ------
    UnknownName
        If there is no such column.
    UnwritableOutput, MissingSoftware
        See `check_table`.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> import pandas as pd
    >>> write_table(pd.DataFrame({"x": [1.0]}), Path(mkdtemp(), "x.csv"), {"units": {"x": "mm"}})
    """
    check_table(path, overwrite=overwrite)
    for name in columns or ():
        if name not in frame:
            raise UnknownName("column", str(name), map(str, frame.columns))
    chosen = frame if columns is None else frame[list(dict.fromkeys(columns))]
    facts: dict[Any, Any] = {"library": f"gsp {__version__}"}
    facts |= frame.attrs if metadata is None else dict(metadata)
    text = json.dumps(facts, indent=2, ensure_ascii=False) + "\n"
    form = FORMATS[Path(path).suffix.lower()]
    named = headings or {}
    write_file(path, lambda temporary: form.write(chosen, temporary, named), overwrite=overwrite)
    write_text(sidecar(path), text, overwrite=overwrite)


def _to_excel(frame: pd.DataFrame, path: Path) -> None:
    import pandas as pd

    with pd.ExcelWriter(path, engine="openpyxl") as book:
        frame.to_excel(book, index=False)
        for row in book.book.active.iter_rows():
            for cell in row:  # a name that begins with "=" is a text, no formula
                if cell.data_type == "f":
                    cell.data_type = "s"


def _to_markdown(frame: pd.DataFrame, path: Path) -> None:
    shown = frame.set_axis([_one_cell(str(column)) for column in frame], axis="columns")
    for column in shown:
        if shown[column].dtype.kind not in "iufb":
            shown[column] = [_one_cell(value) for value in shown[column]]
    shown.to_markdown(path, index=False)


def _one_cell(value: Any) -> Any:
    r"""Return a value of a Markdown table; in a text, bars would end the cell and lines the row.

    >>> print(_one_cell("|det J|"))
    \|det J\|
    """
    return " ".join(value.split()).replace("|", "\\|") if isinstance(value, str) else value


def _to_latex(frame: pd.DataFrame, path: Path, headings: Mapping[str, str]) -> None:
    """Write a table, whose columns have given headings in LaTeX or else their names."""
    names = [headings.get(str(column), escaped(str(column))) for column in frame]
    shown = frame.astype(object).set_axis(range(len(names)), axis="columns")
    shown = shown.map(_latex).set_axis(names, axis="columns")
    right = "".join("r" if frame[column].dtype.kind in "iuf" else "l" for column in frame)
    styled = shown.style.hide(axis="index")
    styled.to_latex(path, hrules=True, column_format=right, encoding="utf-8")


def _latex(value: Any) -> str:
    r"""Return a cell: the name of a mechanism or joint, or a number, as a formula, or a text.

    >>> print(_latex("D1^6"), _latex("D2 A1^2"), _latex("toz_2016"), _latex(1 / 3), _latex("d1"))
    $D_1^{6}$ $D_2\,A_1^{2}$ toz\_2016 0.3333333 $d_{1}$
    """
    if isinstance(value, float):
        return _number(value)
    text = str(value)
    if _JOINT.fullmatch(text):
        return joint_symbol(text)
    if not _MECHANISM.fullmatch(text):
        return escaped(text)
    parts = [part.partition("^") for part in text.split()]
    powers = [f"{name[0]}_{name[1:]}" + (f"^{{{n}}}" if n else "") for name, _, n in parts]
    return "$" + r"\,".join(powers) + "$"


def joint_symbol(name: str) -> str:
    r"""Return the name of a joint variable as a formula in LaTeX.

    >>> print(joint_symbol("d1"), joint_symbol("theta12"))
    $d_{1}$ $\theta_{12}$
    """
    stem, number = _JOINT.fullmatch(name).groups()  # type: ignore[union-attr]
    symbol = r"\theta" if stem == "theta" else stem
    return f"${symbol}_{{{number}}}$"


def _number(value: float) -> str:
    """Return seven significant digits: |det J| of a small design is 1e-20 and not 0."""
    if math.isnan(value):
        return "--"
    if math.isinf(value):
        return r"$\infty$" if value > 0.0 else r"$-\infty$"
    return f"{value:.7g}"


def escaped(text: str) -> str:
    """Return a text with the characters that LaTeX takes for commands escaped."""
    special = {"\\": r"\textbackslash{}", "~": r"\textasciitilde{}", "^": r"\textasciicircum{}"}
    return "".join(special.get(c, f"\\{c}" if c in "&%$#_{}" else c) for c in text)
