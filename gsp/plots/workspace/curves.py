"""Styles of curves by label, which of them are seen, and the legend beside the axes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gsp.figures import INK
from gsp.geometry.vectors import Array, Mask, norm
from gsp.plots.common.labels import settle
from gsp.plots.common.style import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION
from gsp.plots.workspace.notes import LABEL_SIZE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

    from gsp.workspace.boundary.sections import Curve

COLOURS = (BLUE, ORANGE, GREEN, PURPLE, VERMILION, SKY, INK)
DASHES = ("-", (0, (6, 1.5)), (0, (1.5, 1)), (0, (8, 1.5, 1.5, 1.5)), (0, (3, 3)))
# Labels in a column of the legend.
LABELS_PER_COLUMN = 30
# Pixels that are the least to be seen of a curve, at the resolution of the figure.
SEEN_PIXELS = 12
# Chords that are drawn from one point of a curve to the next; steps that are left out, as a share
# of the curve or in rad; how far a spline may be from a chord as a share of it.
CHORDS_PER_STEP, LEAST_SHARE, CHORD_SHARE = 8, 1e-9, 0.2
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


def smooth(curve: Curve, flat: Array, chosen: Mask) -> tuple[Array, Array]:
    """Return points (M, 2) along a curve that is drawn, and those with NaN where none is chosen.

    Points of curves are up to 0.08 sizes apart, so chords between them have visible corners. The
    points between are those of a cubic spline over the way of the pose, on which the curve is
    smooth, also where its position turns back.

    Parameters
    ----------
    curve : Curve
    flat : (N, 2) array [length]
        Its points as they are drawn.
    chosen : (N,) bool array
    """
    from scipy.interpolate import CubicSpline

    size = max(float(np.ptp(flat, axis=0).max()), 1e-300)
    turn = np.linalg.norm(np.diff(curve.pose.rotation, axis=0), axis=(1, 2))
    step = norm(np.diff(flat, axis=0)) / size + turn
    kept = np.concatenate(([True], step > LEAST_SHARE))
    flat, chosen = flat[kept], chosen[kept]
    if len(flat) < 3:
        return flat, np.where(chosen[:, None], flat, np.nan)
    way = np.concatenate(([0.0], np.cumsum(step[kept[1:]])))
    share = np.arange(CHORDS_PER_STEP) / CHORDS_PER_STEP
    dense = CubicSpline(way, flat)(way[:-1, None] + share * np.diff(way)[:, None])
    chord = flat[:-1, None] + share[:, None] * np.diff(flat, axis=0)[:, None]
    away = norm(dense - chord).max(axis=1) > CHORD_SHARE * norm(np.diff(flat, axis=0))
    dense[away] = chord[away]
    both = np.repeat(chosen[:-1] & chosen[1:], CHORDS_PER_STEP)
    both[::CHORDS_PER_STEP] = chosen[:-1]
    line = np.concatenate((dense.reshape(-1, 2), flat[-1:]))
    return line, np.where(np.append(both, chosen[-1])[:, None], line, np.nan)


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
