"""Styles of curves by label, and which of them are seen."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from types import MappingProxyType
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from gsp.figures import INK
from gsp.geometry.vectors import Array, Mask, norm
from gsp.plots.common.labels import settle
from gsp.plots.common.style import BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION
from gsp.plots.workspace.legends import write_legend

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.lines import Line2D

    from gsp.workspace.boundary.sections import Curve

COLOURS = (BLUE, ORANGE, GREEN, PURPLE, VERMILION, SKY, INK)
DASHES = ("-", (0, (6, 1.5)), (0, (1.5, 1)), (0, (8, 1.5, 1.5, 1.5)), (0, (3, 3)))
# Pixels that are the least to be seen of a curve, at the resolution of the figure; how many labels
# of curves that coincide an entry of the legend names.
SEEN_PIXELS, MOST_NAMES = 12, 4
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


def curve_styles(
    labels: Sequence[str], covered: Mapping[str, Sequence[str]] = NOTHING
) -> dict[str, CurveStyle]:
    """Return the styles of labels; with numbers where colours alone do not distinguish them.

    Entries of the legend also name the labels that each label covers.
    """
    unique = list(dict.fromkeys(labels))
    n = len(COLOURS)
    styles = {}
    for i, text in enumerate(unique):
        number = str(i + 1) if len(unique) > n else ""
        colour, dash = COLOURS[i % n], DASHES[i // n % len(DASHES)]
        names = _names((text, *covered.get(text, ())))
        styles[text] = CurveStyle(colour, dash, f"{number}  {names}".lstrip(), number)
    return styles


def _names(labels: Sequence[str]) -> str:
    names = ", ".join(f"[{text}]" for text in labels[:MOST_NAMES])
    return f"{names} and {len(labels) - MOST_NAMES} more" if len(labels) > MOST_NAMES else names


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

    Labels of which nothing is seen are left out with their lines. Where curves of another label
    cover most of them, both labels are in the entry of that one.

    Parameters
    ----------
    drawn : mapping
        The lines of each label, the first of which the legend shows. Limits and marks are there.
    before, after : mappings
        Further entries of the legend.
    """
    left = dict(drawn)
    covered: dict[str, list[str]] = {}
    while True:
        styles = curve_styles(list(left), covered)
        for text, lines in left.items():
            lines[0].set_label(styles[text].entry)
            for line in lines:
                line.set(color=styles[text].colour, linestyle=styles[text].dash)
        write_legend(ax, before, {styles[text].entry: left[text][0] for text in left}, after)
        settle(ax)
        shown = _numbers(ax, ax.lines)
        seen = [text for text, lines in left.items() if _seen(ax, shown, lines)]
        hidden = [text for text in left if text not in seen]
        if not hidden:
            return styles
        above = {text: _cover(ax, shown, left, text, seen) for text in hidden}
        for text, other in above.items():
            names = [text, *covered.pop(text, [])]
            if other is not None:
                covered.setdefault(other, []).extend(names)
            for line in left.pop(text):
                line.remove()


def _numbers(ax: Axes, lines: Iterable[Line2D]) -> Array:
    """Return which of some lines each pixel shows: 1, 2 … in the order of `ax.lines`, 0 for none.

    Each line is drawn in a colour of its own, one by one.
    """
    from matplotlib.backends.backend_agg import RendererAgg

    width, height = ax.figure.canvas.get_width_height()
    renderer = RendererAgg(width, height, ax.figure.dpi)  # type: ignore[no-untyped-call]
    number = {line: i for i, line in enumerate(ax.lines, start=1)}
    for line in sorted(lines, key=lambda line: line.get_zorder()):
        look = {"color": line.get_color(), "alpha": line.get_alpha()}
        smooth = line.get_antialiased()
        line.set(color=f"#{number[line]:06x}", alpha=None, antialiased=False)
        line.draw(renderer)
        line.set(antialiased=smooth, **look)
    shown = np.asarray(renderer.buffer_rgba()).astype(int)  # type: ignore[no-untyped-call]
    return np.where(shown[..., 3] > 0, shown[..., :3] @ (1 << 16, 1 << 8, 1), 0)


def _counts(ax: Axes, numbers: Array, lines: Iterable[Line2D]) -> list[int]:
    """Return how many pixels show each of some lines, from the numbers of `_numbers`."""
    counts = np.bincount(numbers.ravel(), minlength=len(ax.lines) + 1)
    chosen = set(lines)
    return [int(counts[i]) for i, line in enumerate(ax.lines, start=1) if line in chosen]


def _seen(ax: Axes, shown: Array, lines: Iterable[Line2D]) -> bool:
    """Return whether one of some lines has enough pixels."""
    return max(_counts(ax, shown, lines)) >= SEEN_PIXELS


def _cover(
    ax: Axes, shown: Array, drawn: Mapping[str, Sequence[Line2D]], text: str, seen: Iterable[str]
) -> str | None:
    """Return the label among those seen that covers most pixels of the curves of one, if any."""
    alone = _numbers(ax, drawn[text]) > 0
    pixels = {other: sum(_counts(ax, shown[alone], drawn[other])) for other in seen}
    most = max(pixels, key=lambda other: pixels[other], default=None)
    return most if most is not None and 2 * pixels[most] > alone.sum() else None
