"""Where the text files of the catalogue and of the published numbers are."""

from __future__ import annotations

from pathlib import Path

_PACKAGE = Path(__file__).parent.parent


def knowledge(*parts: str) -> Path:
    """Return the path of a data file or folder: knowledge("catalogue", "designs").

    In an installed wheel the folders lie inside the package, in a checkout beside it.
    """
    inside = _PACKAGE / "data"
    return (inside if inside.is_dir() else _PACKAGE.parent).joinpath(*parts)
