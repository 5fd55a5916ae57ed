"""Where the text files of the catalogue and of the published numbers are."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from gsp.checks import is_a, plain_text
from gsp.errors import UnknownDesign, brief

_PACKAGE = Path(__file__).parent.parent


def knowledge(*parts: str) -> Path:
    """Return the path of a data file or folder: knowledge("catalogue", "designs").

    In an installed wheel the folders lie inside the package, in a checkout beside it.
    """
    inside = _PACKAGE / "data"
    return (inside if inside.is_dir() else _PACKAGE.parent).joinpath(*parts)


def design_files(*folder: str) -> dict[str, Path]:
    """Return the design files of a folder by their names, sorted."""
    files = {path.stem: path for path in knowledge(*folder).glob("*.toml")}
    return dict(sorted(files.items()))


def design_file(what: str, name: Any, *folder: str) -> Path:
    """Return the design file of a name.

    Parameters
    ----------
    what : str
        What the message calls a design of this folder.
    name : str
    folder : str
        As in `knowledge`.

    Raises
    ------
    UnknownDesign
        With the nearest names.
    """
    files = design_files(*folder)
    name = plain_text(name)
    if not is_a(name, str) or name not in files:
        raise UnknownDesign(what, name if is_a(name, str) else brief(name), tuple(files))
    return files[name]
