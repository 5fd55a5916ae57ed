"""The scene as a figure: one HTML text that needs nothing else, for notebooks and files."""

from __future__ import annotations

from html import escape
from typing import Any

import numpy as np

from gsp.app.scene.drawing import drawing, merit_colour, placement
from gsp.app.scene.pages import WEB, PageFigure, filled, scene_sources, scene_style, script_text
from gsp.app.state.reading import Reading, powers, read
from gsp.app.state.session import Session, started
from gsp.checks import check_type
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.installed import check_installed
from gsp.model.design import Design, check_undriven

# The index that colours the platform.
COLOUR_BY = "control_number"


class SceneFigure(PageFigure):
    """A mechanism in space, as an HTML page that needs no other file and no network.

    Jupyter shows it. It is turned by the mouse, two fingers or the arrow keys.

    Attributes
    ----------
    title : str
    html : str
        The whole page.
    """


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
    parts = {
        "style": scene_style(),
        "sources": script_text(scene_sources()),
        "scene": script_text(_scene(state, reading)),
        "facts": escape(_facts(reading)),
        "title": escape(title),
    }
    template = (WEB / "figure.html").read_text(encoding="utf-8")
    return SceneFigure(title=title, html=filled(template, parts))


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
