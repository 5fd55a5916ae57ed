"""How all figures look: colours that colour-blind readers can tell apart, fonts, files."""

from __future__ import annotations

import importlib.util
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from gsp.errors import MissingSoftware

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

# The palette of Okabe and Ito (2008).
BLUE, ORANGE, GREEN, PURPLE = "#0072B2", "#E69F00", "#009E73", "#CC79A7"
VERMILION, SKY, YELLOW, INK, GREY = "#D55E00", "#56B4E9", "#F0E442", "#1A1A1A", "#8A8F98"

# Colour and marker of each class: no class is told by its colour alone.
CLASSES = MappingProxyType(
    {"6D": (BLUE, "o"), "5D1A": (ORANGE, "s"), "4D2A": (GREEN, "^"), "3D3A": (PURPLE, "D")}
)
LEGS = MappingProxyType(
    {
        "D1": BLUE, "D2": SKY, "D3": GREEN, "D4": ORANGE, "A1": VERMILION, "D4 A1": PURPLE,
    }
)  # fmt: skip

_RC: dict[Any, Any] = {
    "font.size": 9.0,
    "axes.edgecolor": "#B5BAC2",
    "axes.linewidth": 0.8,
    "axes.labelcolor": INK,
    "axes.titleweight": "bold",
    "xtick.color": "#5B616B",
    "ytick.color": "#5B616B",
    "grid.color": "#E8EAED",
    "grid.linewidth": 0.7,
    "legend.frameon": False,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
    "svg.hashsalt": "gsp",
}


def require_matplotlib() -> None:
    """Raise MissingSoftware if there is no matplotlib."""
    if importlib.util.find_spec("matplotlib") is None:
        raise MissingSoftware("matplotlib", "a picture", "plots")


@contextmanager
def style() -> Iterator[None]:
    """Return the context in which figures of the library are drawn.

    It sets and restores only the settings of the style. `matplotlib.rc_context` restores all of
    them; in Jupyter that undoes what the backend sets when the first figure is made, and no later
    figure is shown.
    """
    require_matplotlib()
    import matplotlib as mpl

    before = {key: mpl.rcParams[key] for key in _RC}
    mpl.rcParams.update(_RC)
    try:
        yield
    finally:
        mpl.rcParams.update(before)


def new_axes(width: float = 6.4, height: float = 4.8, **options: Any) -> Axes:
    """Return the axes of a new figure of that size [inches]."""
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(width, height), layout="constrained")
    axes: Axes = figure.add_subplot(**options)
    return axes


def save_figure(figure: Figure, path: Path) -> None:
    """Write a figure in the format of its suffix, and close it."""
    import matplotlib.pyplot as plt

    stamps = {".png": "Software", ".pdf": "CreationDate", ".svg": "Date"}
    with style():
        figure.savefig(
            path, dpi=150, bbox_inches="tight", metadata={stamps[path.suffix.lower()]: None}
        )
    plt.close(figure)
