"""Colours that colour-blind readers can distinguish, axes, texts and files of figures."""

from __future__ import annotations

from os import PathLike
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, cast

import numpy as np

from gsp.checks import has, is_a, plain_text
from gsp.errors import InvalidInput, brief, expected
from gsp.figures import new_axes, require_matplotlib, style
from gsp.files.writing import check_writable, write_file
from gsp.indices import INDICES
from gsp.model.mechanism import read_mechanism

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.axis import Axis
    from matplotlib.figure import Figure
    from mpl_toolkits.mplot3d import Axes3D

# The palette of Okabe and Ito (2008).
BLUE, ORANGE, GREEN, PURPLE = "#0072B2", "#E69F00", "#009E73", "#CC79A7"
VERMILION, SKY, GREY = "#D55E00", "#56B4E9", "#8A8F98"
# Ours, for legs that are driven at the base.
BROWN, DARK = "#7A5C00", "#3D3D3D"

# Colour and marker of each class: no class is marked by its colour alone.
CLASSES = MappingProxyType(
    {"6D": (BLUE, "o"), "5D1A": (ORANGE, "s"), "4D2A": (GREEN, "^"), "3D3A": (PURPLE, "D")}
)
LEGS = MappingProxyType(
    {
        "D1": BLUE,
        "D2": SKY,
        "D3": GREEN,
        "D4": ORANGE,
        "A1": VERMILION,
        "D4 A1": PURPLE,
        "PSS": BROWN,
        "RSS": DARK,
    }
)

# Width of a figure [inches] below which its title is cut.
MIN_WIDTH = 6.0
# Most intervals between the numbers on an axis of a plane.
MOST_MARKS = 4
# Most letters in a line of a title: of 10 points they are about as wide as a figure. Of the name of
# a design, if other words follow it.
TITLE_LETTERS, SHORT_NAME = 60, 30
# Formats of pictures, and the entry of each that would differ from run to run.
STAMPS = MappingProxyType({".png": "Software", ".pdf": "CreationDate", ".svg": "Date"})


def axes_or_new(ax: Axes | None, width: float, height: float) -> Axes:
    """Return the given axes, or those of a new figure of that size [inches].

    Raises
    ------
    InvalidInput
        If `ax` is neither None nor plane matplotlib Axes.
    """
    from matplotlib.axes import Axes as PlaneAxes

    if ax is None:
        return new_axes(width, height)
    if not is_a(ax, PlaneAxes) or ax.name == "3d":
        raise InvalidInput(expected("ax", "plane matplotlib Axes, or None", brief(ax)))
    return ax


def space_or_new(ax: Axes3D | None, width: float, height: float) -> Axes3D:
    """Return the given axes in space, or those of a new figure of that size [inches].

    Raises
    ------
    InvalidInput
        If `ax` is neither None nor matplotlib Axes with `projection="3d"`.
    """
    if ax is None:
        return cast("Axes3D", new_axes(width, height, projection="3d"))
    if not has(ax, "name") or ax.name != "3d":
        wanted = 'matplotlib Axes with projection="3d", or None'
        raise InvalidInput(expected("ax", wanted, brief(ax)))
    return ax


def log_ticks(axis: Axis, low: float, high: float) -> None:
    """Set short numbers that do not overlap on a logarithmic axis.

    Parameters
    ----------
    low, high : float
        The limits of the axis.
    """
    from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter, StrMethodFormatter

    axis.set_minor_formatter(NullFormatter())
    if high < 10.0 * low:
        # Numbers with an exponent are twice as long.
        axis.set_major_locator(MaxNLocator(4 if 1e-4 <= low and high < 1e5 else 2))
        axis.set_major_formatter(StrMethodFormatter("{x:.5g}"))
        axis.set_minor_locator(MaxNLocator(20))
    elif (steps := np.floor(np.log10(high)) - np.ceil(np.log10(low))) < 2.0:
        # One power of ten or none, or two of them.
        axis.set_major_locator(LogLocator(subs=(1.0, 2.0, 5.0) if steps < 1.0 else (1.0, 3.0)))
        axis.set_major_formatter(StrMethodFormatter("{x:.5g}"))
    else:
        axis.set_major_locator(LogLocator(numticks=6))


def few_marks(ax: Axes) -> None:
    """Set few numbers on the axes of a plane, so that numbers such as -0.015 stay apart."""
    from matplotlib.ticker import MaxNLocator

    for axis in (ax.xaxis, ax.yaxis):
        axis.set_major_locator(MaxNLocator(MOST_MARKS, steps=[1, 2, 2.5, 5, 10]))


def new_panels(count: int, width: float, height: float, columns: int) -> tuple[Figure, list[Axes]]:
    """Return a new figure with so many panels of that size [inches], row by row.

    Four panels are two by two where there are three columns.
    """
    columns = 2 if (count, columns) == (4, 3) else min(columns, count)
    rows = -(-count // columns)
    figure = _new_figure(width * columns, height * rows + 0.4)
    return figure, [figure.add_subplot(rows, columns, i + 1) for i in range(count)]


def space_panels(count: int, side: float, columns: int) -> tuple[Figure, list[Axes3D]]:
    """Return a new figure with so many square panels in space, of that side [inches]."""
    columns = min(columns, count)
    rows = -(-count // columns)
    figure = _new_figure(max(side * columns, MIN_WIDTH), side * rows + 0.8)
    places = range(1, count + 1)
    panels = [figure.add_subplot(rows, columns, i, projection="3d") for i in places]
    return figure, panels


def film_panels(count: int, *, flat: bool = False) -> tuple[Figure, Axes, list[Axes]]:
    """Return a new figure with axes in space, and that many panels in a column beside them.

    With `flat` these axes are for a picture.
    """
    projection = None if flat else "3d"
    if not count:
        figure = _new_figure(6.4, 5.6)
        return figure, figure.add_subplot(projection=projection), []
    figure = _new_figure(10.4, 5.6)
    # An empty column keeps the label of the vertical axis, which is outside of the axes in space,
    # away from those of the panels.
    grid = figure.add_gridspec(count, 3, width_ratios=[30, 3, 20])
    space = figure.add_subplot(grid[:, 0], projection=projection)
    return figure, space, [figure.add_subplot(grid[row, 2]) for row in range(count)]


def _new_figure(width: float, height: float) -> Figure:
    """Return a figure of pyplot that Jupyter shows once."""
    import matplotlib.pyplot as plt

    from gsp.figures.shown import ShownOnce

    return plt.figure(figsize=(width, height), layout="constrained", FigureClass=ShownOnce)


def symbol_text(name: str) -> str:
    """Return the symbol of an index for a label, with its subscript set as one."""
    stem, _, foot = INDICES[name].symbol.partition("_")
    return rf"{stem}$_\mathrm{{{foot}}}$" if foot else stem


def plain(text: str) -> str:
    """Return a text for a label in which no dollar sign starts a formula."""
    return text.replace("$", r"\$")


def title_text(text: str, letters: int = TITLE_LETTERS) -> str:
    """Return a text for a title, whose lines have at most so many letters; longer ones end in "…".

    So a name of any length leaves the axes their size.
    """
    lines = [
        line if len(line) <= letters else line[: letters - 1].rstrip() + "…"
        for line in text.split("\n")
    ]
    return plain("\n".join(lines))


def design_label(name: str) -> str:
    """Return the name of a design for a label, as a formula if it is that of a mechanism.

    A design may have a name that is read as that of a mechanism, such as "d3".
    """
    try:
        mechanism = read_mechanism(name)
    except InvalidInput:
        return plain(name)
    return f"${mechanism.latex}$" if mechanism.name == name else plain(name)


def save(figure: Figure | Axes, path: str | PathLike[str], *, overwrite: bool = False) -> None:
    """Write a figure as PNG, PDF or SVG, by the suffix of the name.

    The file is written under a temporary name and then renamed. The same figure gives the same
    bytes.

    Parameters
    ----------
    figure : matplotlib Figure or Axes
        As the functions of `gsp.plots` return it.
    path : str or path
        Ending in .png, .pdf or .svg.
    overwrite : bool
        Whether a file of this name may be replaced.

    Raises
    ------
    InvalidInput
        On another suffix, or if `figure` is not a figure.
    UnwritableOutput
        If the file exists and `overwrite` is not set, or it cannot be written.
    MissingSoftware
        Without matplotlib.

    Examples
    --------
    >>> import gsp
    >>> axes = gsp.plots.mechanism(gsp.catalogue.design("nawratil-k-plus"))
    >>> from tempfile import mkdtemp
    >>> gsp.plots.save(axes, mkdtemp() + "/k-plus.pdf")
    """
    if not is_a(overwrite, bool):
        raise InvalidInput(expected("overwrite", "True or False", brief(overwrite)))
    path = plain_text(path)
    check_picture(path, overwrite=overwrite)
    from matplotlib.figure import Figure

    axes = not is_a(figure, Figure) and has(figure, "figure")
    drawn = figure.figure if axes else figure
    if not is_a(drawn, Figure):
        wanted = "a matplotlib Figure or Axes"
        raise InvalidInput(expected("figure", wanted, brief(figure)))
    suffix = Path(path).suffix
    write_file(path, lambda temporary: save_figure(drawn, temporary, suffix), overwrite=overwrite)


def check_picture(path: str | PathLike[str], *, overwrite: bool = False) -> None:
    """Raise an error if a picture could not be written to `path`, before any work is done for it.

    Raises
    ------
    InvalidInput, UnwritableOutput, MissingSoftware
    """
    require_matplotlib()
    check_writable(path, overwrite=True)
    if Path(path).suffix.lower() not in STAMPS:
        raise InvalidInput(expected("picture", "a name ending in " + ", ".join(STAMPS), str(path)))
    check_writable(path, overwrite=overwrite)


def save_figure(figure: Figure, path: Path, suffix: str | None = None) -> None:
    """Write a figure to a file in the format of a suffix, by default its own, without the date.

    The file to which a link leads may have another name than the link.
    """
    suffix = (path.suffix if suffix is None else suffix).lower()
    with style():
        figure.savefig(
            path, dpi=150, bbox_inches="tight", metadata={STAMPS[suffix]: None}, format=suffix[1:]
        )
