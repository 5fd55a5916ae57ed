"""The scene as a figure: one HTML text that needs nothing else, for notebooks and files."""

from __future__ import annotations

import base64
import gzip
import json
from dataclasses import dataclass
from functools import cache
from html import escape
from importlib.util import find_spec
from os import PathLike
from pathlib import Path
from typing import Any

import numpy as np

from gsp.app.scene.drawing import drawing, merit_colour, placement
from gsp.app.state.reading import Reading, powers, read
from gsp.app.state.session import Session, started
from gsp.checks import check_installed, check_type
from gsp.errors import InvalidInput, expected
from gsp.files.writing import write_text
from gsp.geometry.pose import Pose
from gsp.model.design import Design, check_undriven

WEB = Path(__file__).parent / "web"
# Scripts of the scene by the names under which they import each other.
SCRIPTS = {
    "gsp-scene": "index.js",
    "gsp-scene/film.js": "film.js",
    "gsp-scene/gif.js": "gif.js",
}
# Height of the figure in a notebook, in pixels of the page.
HEIGHT = 480
# The index that colours the platform.
COLOUR_BY = "control_number"


@dataclass(frozen=True, kw_only=True)
class SceneFigure:
    """A mechanism in space, as an HTML page that needs no other file and no network.

    Jupyter shows it. It is turned by the mouse, two fingers or the arrow keys.

    Attributes
    ----------
    title : str
    html : str
        The whole page.
    """

    title: str
    html: str

    def _repr_html_(self) -> str:
        """Return the page in a frame of its own, for notebooks."""
        return (
            f'<iframe title="{escape(self.title)}" srcdoc="{escape(self.html)}" '
            f'style="width:100%;height:{HEIGHT}px;border:0" loading="lazy"></iframe>'
        )

    def __repr__(self) -> str:
        return f"SceneFigure({self.title!r})"

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
            If the name does not end in .html.
        FileExists
        """
        if Path(path).suffix.lower() != ".html":
            raise InvalidInput(expected("path", "a name that ends in .html", repr(str(path))))
        write_text(path, self.html, overwrite=overwrite)


def figure(design: Design, pose: Pose | None = None) -> SceneFigure:
    """Return the scene of a design at a pose as a figure that can be turned.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape (), or None [unit of the design]
        Default: the home pose of the design.

    Raises
    ------
    InvalidInput
        On other types, or several poses.
    MissingSoftware
        Without the extra `app`, which contains three.js.

    Examples
    --------
    >>> import gsp
    >>> figure(gsp.catalogue.design("lee-2000-3-3"))
    SceneFigure('lee-2000-3-3: platform at 0, 0, 1')
    """
    check_undriven("design", design)
    if pose is not None:
        check_type("pose", pose, Pose)
        if pose.shape:
            raise InvalidInput(expected("pose", "a single pose", f"batch shape {pose.shape}"))
    check_installed("nicegui", "a turnable figure of a design", "app")
    state = started(design, pose)
    reading = read(state)
    place = ", ".join(f"{x:.4g}" for x in state.pose.position)
    unit = f" {design.unit}" if design.unit else ""
    title = f"{design.name or 'design'}: platform at {place}{unit}"
    # The title and what follows from names come last: they may contain "@".
    parts = {
        "@style@": (WEB / "scene.css").read_text(encoding="utf-8"),
        "@sources@": _script({"nicegui-scene": _three(), **_sources()}),
        "@scene@": _script(_scene(state, reading)),
        "@facts@": escape(_facts(reading)),
        "@title@": escape(title),
    }
    html = (WEB / "figure.html").read_text(encoding="utf-8")
    for name, text in parts.items():
        html = html.replace(name, text)
    return SceneFigure(title=title, html=html)


def _scene(state: Session, reading: Reading) -> dict[str, Any]:
    colour = merit_colour(reading.index(COLOUR_BY).gauge)
    return {"drawing": drawing(state), "place": placement(state, reading, colour)}


def _facts(reading: Reading) -> str:
    """Return det J, of redundant designs |det J|, and the index that colours the platform."""
    found, shown = reading.index("manipulability"), reading.index(COLOUR_BY)
    unit, name, value = found.unit, "det J", reading.determinant
    if np.isnan(value):
        name, value = found.index.symbol, found.value
    power = "" if unit in ("1", "mixed") else f" {powers(unit)}"
    values = [f"{name} = {value:.7g}{power}", f"{shown.index.symbol} = {shown.value:.5g}"]
    return " · ".join(text for text, x in zip(values, (value, shown.value), strict=True) if x == x)


def _script(value: Any) -> str:
    """Return a value as JSON for the inside of a script, which ends at the first "<"."""
    return json.dumps(value, allow_nan=False).replace("<", "\\u003c")


def _packed(source: bytes) -> str:
    return base64.b64encode(gzip.compress(source, 9, mtime=0)).decode("ascii")


def _sources() -> dict[str, str]:
    return {name: _packed((WEB / file).read_bytes()) for name, file in SCRIPTS.items()}


@cache
def _three() -> str:
    """Return three.js, which is part of NiceGUI; the framework is not imported."""
    found = find_spec("nicegui")
    folder = Path(str(found.origin if found else "")).parent
    return _packed((folder / "elements" / "scene" / "dist" / "index.js").read_bytes())
