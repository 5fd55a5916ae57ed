"""Settings and new axes of all figures of the library."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

from gsp.installed import check_installed

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Colour of texts and of lines without a meaning of their own.
INK = "#1A1A1A"

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
    """Raise MissingSoftware if there is no matplotlib.

    Raises
    ------
    MissingSoftware
    """
    check_installed("matplotlib", "a picture", "plots")


@contextmanager
def style() -> Iterator[None]:
    """Return the context in which figures of the library are drawn.

    It sets and restores only the settings of the style. `matplotlib.rc_context` restores all of
    them; in Jupyter that undoes what the backend sets when the first figure is made, and no later
    figure is shown.

    Raises
    ------
    MissingSoftware
        Without matplotlib.
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
    """Return the axes of a new figure of that size.

    Parameters
    ----------
    width, height : float [inches]
    **options : any
        Of `Figure.add_subplot`, such as `projection`.

    Returns
    -------
    matplotlib.axes.Axes
    """
    import matplotlib.pyplot as plt

    from gsp.figures.shown import ShownOnce

    size = (width, height)
    figure = plt.figure(figsize=size, layout="constrained", FigureClass=ShownOnce)
    axes: Axes = figure.add_subplot(**options)
    return axes
