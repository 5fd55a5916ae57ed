"""Pages that need no other file and no network: shown by notebooks, and written to files."""

from __future__ import annotations

import base64
import gzip
import json
import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cache
from html import escape
from importlib.util import find_spec
from os import PathLike
from pathlib import Path
from typing import Any, ClassVar

from gsp import arguments
from gsp.errors import InvalidInput, expected
from gsp.files.writing import write_text

WEB = Path(__file__).parent / "web"
# Scripts of the scene by the names under which they import each other.
SCRIPTS = {
    "gsp-scene": "index.js",
    "gsp-scene/film.js": "film.js",
    "gsp-scene/gif.js": "gif.js",
}


@dataclass(frozen=True, kw_only=True)
class PageFigure:
    """A figure that is a whole HTML page.

    Attributes
    ----------
    title : str
    html : str
        The whole page.
    """

    # Height in a notebook [pixels of the page].
    HEIGHT: ClassVar[int] = 480

    title: str
    html: str

    def _repr_html_(self) -> str:
        """Return the page in a frame of its own, for notebooks."""
        return (
            f'<iframe title="{escape(self.title)}" srcdoc="{escape(self.html)}" '
            f'style="width:100%;height:{self.HEIGHT}px;border:0" loading="lazy"></iframe>'
        )

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.title!r})"

    def write(self, path: str | PathLike[str], *, overwrite: bool = False) -> None:
        """Write the page to an .html file.

        Parameters
        ----------
        path : str or path
        overwrite : bool
            Whether an existing file is replaced.

        Raises
        ------
        InvalidInput
            If it is no path whose name ends in .html.
        FileExists
        """
        path, overwrite = arguments.path("path", path), arguments.flag("overwrite", overwrite)
        if Path(path).suffix.lower() != ".html":
            raise InvalidInput(expected("path", "a name that ends in .html", repr(str(path))))
        write_text(path, self.html, overwrite=overwrite)


def filled(template: str, parts: Mapping[str, str]) -> str:
    """Return a page with its parts, such as that named "title" at "@title@".

    What stands in a part is not searched, so names may contain "@".

    Examples
    --------
    >>> filled("<p>@title@</p>", {"title": "@facts@", "facts": ""})
    '<p>@facts@</p>'
    """
    names = "|".join(map(re.escape, parts))
    return re.sub(f"@({names})@", lambda found: parts[found[1]], template)


def script_text(value: Any) -> str:
    """Return a value as JSON for the inside of a script, which ends at the first "<"."""
    return json.dumps(value, allow_nan=False).replace("<", "\\u003c")


def packed(source: bytes) -> str:
    """Return bytes, compressed, as a text."""
    return base64.b64encode(gzip.compress(source, 9, mtime=0)).decode("ascii")


def scene_sources() -> dict[str, str]:
    """Return the scripts of the scene, packed, by the names under which they are imported."""
    own = {name: packed((WEB / file).read_bytes()) for name, file in SCRIPTS.items()}
    return {"nicegui-scene": _three(), **own}


def scene_style() -> str:
    """Return the style of the scene and its labels."""
    return (WEB / "scene.css").read_text(encoding="utf-8")


@cache
def _three() -> str:
    """Return three.js, which is part of NiceGUI; the framework is not imported."""
    found = find_spec("nicegui")
    folder = Path(str(found.origin if found else "")).parent
    return packed((folder / "elements" / "scene" / "dist" / "index.js").read_bytes())
