"""Titles of figures: long lines are wrapped, and the figure becomes higher by as much."""

from __future__ import annotations

from textwrap import wrap
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from matplotlib.axes import Axes

# Letters of a line of a title: of 9 points they are about as wide as a figure. Lines of a text that
# is longer; what is longer still, as names of 200 letters, ends in "…".
LINE_LETTERS, TITLE_LINES = 60, 2
# Height of a line over the size of its letters.
LINE_HEIGHT = 1.2


def wrapped(text: str) -> str:
    """Return a text whose long lines are wrapped onto two, in which no dollar sign is a formula.

    Parameters
    ----------
    text : str
        Its lines are wrapped one by one.

    Examples
    --------
    >>> wrapped("short"), len(wrapped("x" * 61).split()[0])
    ('short', 60)
    """
    lines = []
    for line in text.split("\n"):
        parts = wrap(line, LINE_LETTERS, max_lines=TITLE_LINES, placeholder="…")
        lines += parts or [""]
    return "\n".join(lines).replace("$", r"\$")


def write_title(ax: Axes, text: str, usual: int = 1, **look: Any) -> None:
    """Set the title of axes; a figure of its own is made higher by the lines beyond the usual ones.

    So a name of any length leaves the axes their size. Figures with other axes but for a colour bar
    keep their size.

    Parameters
    ----------
    ax : matplotlib Axes
    text : str
        The lines, wrapped.
    usual : int
        Number of lines for which the figure has room.
    **look : any
        Of `Axes.set_title`.
    """
    title = ax.set_title(text, **look)
    more = text.count("\n") + 1 - usual
    if more > 0 and all(other is ax for other in ax.figure.axes):
        high = LINE_HEIGHT * float(title.get_fontsize()) / 72.0
        figure = ax.figure.figure
        figure.set_figheight(figure.get_figheight() + more * high)
