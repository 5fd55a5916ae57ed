"""The explorer as a figure: one HTML text that needs nothing else."""

from __future__ import annotations

import base64
import gzip
from collections.abc import Sequence
from functools import cache
from html import escape
from pathlib import Path
from typing import Any, ClassVar

import pandas as pd

from gsp import arguments
from gsp.app.explorer.content import check_numbers, content, default_columns
from gsp.app.explorer.spaces import chosen_rows, designs_of_rows, packed_spaces
from gsp.app.scene.pages import PageFigure, filled, scene_sources, scene_style, script_text
from gsp.checks import check_type, is_a
from gsp.errors import InvalidInput, expected
from gsp.exploration.sides import Objectives, better_sides
from gsp.exploration.space import Space
from gsp.geometry.pose import Pose
from gsp.installed import check_installed
from gsp.model.design import Design
from gsp.plots.common.style import BLUE, GREY, VERMILION
from gsp.plots.common.tables import check_frame

WEB = Path(__file__).parent / "web"
SCRIPTS = ("parallel.js", "explorer.js")
# zlib's: the best one takes twice the time, and saves half a percent.
PLOTLY_LEVEL = 5


class ExplorerFigure(PageFigure):
    """A table of designs as an HTML page that needs no other file and no network.

    Jupyter shows it.

    Attributes
    ----------
    title : str
    html : str
        The whole page.
    """

    HEIGHT: ClassVar[int] = 1000


def explorer_figure(
    table: pd.DataFrame,
    objectives: Objectives,
    *,
    designs: Space | Sequence[Design] | None,
    columns: Sequence[str] | None,
    by: str | None,
    pose: Pose | None,
    most: int,
) -> ExplorerFigure:
    """Return the page; `gsp.plots.explorer` has the arguments and their defaults."""
    check_frame("table", table)
    sides = better_sides(table, objectives)
    by = arguments.text("by", by) if by is not None else _shades(table, sides)
    check_numbers(table, by)
    for name in sides:
        check_numbers(table, name)
    space = designs if is_a(designs, Space) else None
    if columns is None:
        columns = default_columns(table, space, objectives, by)
    if pose is not None:
        check_type("pose", pose, Pose)
        if pose.shape:
            raise InvalidInput(expected("pose", "a single pose", f"batch shape {pose.shape}"))
    most = arguments.integer(1)("most", most)
    check_installed("plotly", "an interactive figure", "plots")
    shown = content(table, objectives, columns, by)
    drawn, count, sources = "", 0, {}
    if designs is not None:
        check_installed("nicegui", "designs in space beside a table", "app")
        found = designs_of_rows(table, designs)
        rows = chosen_rows(found, shown["front"], most)
        drawn, count = packed_spaces(found, rows, pose)
        sources = scene_sources()
    number = f"{len(table)} design{'s' if len(table) > 1 else ''}"
    title = f"{number}, {len(shown['front'])} on the front"
    return ExplorerFigure(title=title, html=_page(title, shown, drawn, count, sources))


def _shades(table: pd.DataFrame, sides: dict[str, str]) -> str:
    return "score" if "score" in table else next(iter(sides))


def _page(
    title: str, shown: dict[str, Any], drawn: str, count: int, sources: dict[str, str]
) -> str:
    from plotly.colors import sequential

    spec = {
        **shown,
        "title": title,
        "drawn": count,
        "scale": list(sequential.Viridis),
        "colours": {"front": BLUE, "knee": VERMILION, "grey": GREY},
    }
    parts = {
        "style": scene_style() + (WEB / "explorer.css").read_text(encoding="utf-8"),
        "code": "".join((WEB / name).read_text(encoding="utf-8") for name in SCRIPTS),
        "sources": script_text({"plotly": _plotly(), "spaces": drawn, "scene": sources}),
        "spec": script_text(spec),
        "title": escape(title),
    }
    return filled((WEB / "explorer.html").read_text(encoding="utf-8"), parts)


@cache
def _plotly() -> str:
    """Return plotly's script, compressed: a third of its size."""
    from plotly.offline import get_plotlyjs

    code = gzip.compress(get_plotlyjs().encode(), PLOTLY_LEVEL, mtime=0)
    return base64.b64encode(code).decode("ascii")
