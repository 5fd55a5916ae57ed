"""Styles of curves by label, which of them are seen, and the legend beside the axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gsp.figures import INK
from gsp.plots.common.labels import settle
from gsp.plots.common.style import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION
from gsp.plots.workspace.notes import LABEL_SIZE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

COLOURS = (BLUE, ORANGE, GREEN, PURPLE, VERMILION, SKY, INK)
DASHES = ("-", (0, (6, 1.5)), (0, (1.5, 1)), (0, (8, 1.5, 1.5, 1.5)), (0, (3, 3)))
# Labels in a column of the legend.
LABELS_PER_COLUMN = 30
# Pixels that are the least to be seen of a curve, at the resolution of the figure.
SEEN_PIXELS = 12
# No entries.
NOTHING: Mapping[str, Any] = MappingProxyType({})


class CurveStyle(NamedTuple):
    """How curves of one label are drawn: their entry in the legend, and their number or ""."""

    colour: str
    dash: Any
    entry: str
    number: str


def curve_styles(labels: Sequence[str]) -> dict[str, CurveStyle]:
    """Return the styles of labels; with numbers where colours alone do not distinguish them."""
    unique = list(dict.fromkeys(labels))
    n = len(COLOURS)
    styles = {}
    for i, text in enumerate(unique):
        number = str(i + 1) if len(unique) > n else ""
        colour, dash = COLOURS[i % n], DASHES[i // n % len(DASHES)]
        styles[text] = CurveStyle(colour, dash, f"{number}  [{text}]".lstrip(), number)
    return styles


def finish_curves(
    ax: Axes,
    drawn: Mapping[str, Sequence[Line2D]],
    before: Mapping[str, Any] = NOTHING,
    after: Mapping[str, Any] = NOTHING,
) -> dict[str, CurveStyle]:
    """Give lines the style of their label, and write the legend; return the styles.

    Labels of which nothing is seen, beneath marks or other curves, are left out with their lines.

    Parameters
    ----------
    drawn : mapping
        The lines of each label, the first of which the legend shows. Limits and marks are there.
    before, after : mappings
        Further entries of the legend.
    """
    left = dict(drawn)
    while True:
        styles = curve_styles(list(left))
        for text, lines in left.items():
            lines[0].set_label(styles[text].entry)
            for line in lines:
                line.set(color=styles[text].colour, linestyle=styles[text].dash)
        own = {look.entry: left[text][0] for text, look in styles.items()}
        _legend(ax, {**before, **own, **after})
        seen = _seen(ax)
        hidden = [text for text, lines in left.items() if not any(seen[line] for line in lines)]
        if not hidden:
            return styles
        for text in hidden:
            for line in left.pop(text):
                line.remove()


def _legend(ax: Axes, handles: Mapping[str, Any]) -> None:
    """Write the legend beside the axes."""
    ax.legend(
        list(handles.values()),
        list(handles),
        loc="upper left",
        bbox_to_anchor=(1.0, 1.0),
        fontsize=LABEL_SIZE,
        handlelength=4.0,  # long enough for the dashes
        ncols=-(-len(handles) // LABELS_PER_COLUMN),
    )


def _seen(ax: Axes) -> dict[Line2D, bool]:
    """Return which lines of axes are seen: each is drawn in a colour of its own, one by one."""
    from matplotlib.backends.backend_agg import RendererAgg

    settle(ax)
    width, height = ax.figure.canvas.get_width_height()
    renderer = RendererAgg(width, height, ax.figure.dpi)  # type: ignore[no-untyped-call]
    lines = sorted(ax.lines, key=lambda line: line.get_zorder())
    for number, line in enumerate(lines, start=1):
        look = {"color": line.get_color(), "alpha": line.get_alpha()}
        smooth = line.get_antialiased()
        line.set(color=f"#{number:06x}", alpha=None, antialiased=False)
        line.draw(renderer)
        line.set(antialiased=smooth, **look)
    shown = np.asarray(renderer.buffer_rgba()).astype(int)  # type: ignore[no-untyped-call]
    numbers = shown[..., :3] @ (1 << 16, 1 << 8, 1)
    counts = np.bincount(numbers[shown[..., 3] > 0], minlength=len(lines) + 1)
    return {line: bool(counts[i] >= SEEN_PIXELS) for i, line in enumerate(lines, start=1)}
