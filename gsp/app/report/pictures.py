"""Pictures of a report: figures of matplotlib as part of the page."""

from __future__ import annotations

import base64
from collections.abc import Callable
from html import escape
from io import BytesIO
from typing import Any

from gsp.app.report.study import Study
from gsp.figures import style
from gsp.plots import mechanism, plan_view


def in_space(study: Study) -> str:
    """Return the design in space, for paper, where nothing turns."""
    return _picture("the design in space", lambda: mechanism(study.state.design, study.state.pose))


def from_above(study: Study) -> str:
    """Return the plan view of the design."""
    return _picture("plan view", lambda: plan_view(study.state.design, study.state.pose))


def of_section(study: Study, name: str) -> str:
    """Return the section of the workspace with a plane through the pose, which is marked."""

    def draw() -> Any:
        axes = study.sections[name].plot()
        axes.plot(0.0, 0.0, "+", color="#D55E00", markersize=11, markeredgewidth=2.0)
        axes.set_title(f"{name} plane through the platform origin (+)", fontsize="medium")
        if (legend := axes.get_legend()) is not None:
            legend.remove()
        return axes

    return _picture(f"section of the workspace with the {name} plane", draw)


def _picture(alternative: str, draw: Callable[[], Any]) -> str:
    """Return a figure as an image of vectors inside the page."""
    import matplotlib.pyplot as plt

    with style():
        figure = draw().figure
        data = BytesIO()
        figure.savefig(data, format="svg", bbox_inches="tight", metadata={"Date": None})
    plt.close(figure)
    text = base64.b64encode(data.getvalue()).decode("ascii")
    return f'<img alt="{escape(alternative)}" src="data:image/svg+xml;base64,{text}">'
