"""Numbers on axes in space, which meet in the corners of the box."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

# How many numbers an axis has at least without those beside a corner.
LEAST_TICKS = 2
# Numbers of so many letters are clear of the marks of their axis; width of a digit, in heights.
SHORT_NUMBER, DIGIT_WIDTH = 3, 0.6


def set_space_ticks(ax: Any, counts: Sequence[int], steps: Sequence[float] | None = None) -> None:
    """Set the numbers of axes in space, at most so many intervals on each; one in each corner.

    Long numbers and the name of their axis are farther from it, as matplotlib centres numbers.
    The formatters of the axes have to be set before.

    In the view of all figures the greatest x meets the least y, and the greatest y the least z. Of
    two numbers there, that of the axis with more of them is left out.

    Parameters
    ----------
    ax : matplotlib Axes in space
        With its limits.
    counts : three int
    steps : sequence of float or None [1]
        Of `matplotlib.ticker.MaxNLocator`.
    """
    from matplotlib.ticker import MaxNLocator

    from gsp.figures.corners import ClearOfCorner

    axes = (ax.xaxis, ax.yaxis, ax.zaxis)
    for axis, count in zip(axes, counts, strict=True):
        axis.set_major_locator(MaxNLocator(count, steps=steps))
    for first, second in ((0, 1), (1, 2)):
        ends = [(axes[first], False), (axes[second], True)]
        away = [_away(axis, low=low) for axis, low in ends]
        if any(left == there for left, there in away):
            continue
        # The axis with more numbers, the first of equal ones.
        k = max((0, 1), key=lambda k: away[k][1])
        axis, low = ends[k]
        if away[k][0] >= LEAST_TICKS:
            axis.set_major_locator(ClearOfCorner(axis.get_major_locator(), low=low))
    for axis in axes:
        _move_away(axis)


def _move_away(axis: Any) -> None:
    """Move numbers of an axis in space by half of what they are too long, and its name by all."""
    from matplotlib import rcParams

    texts = axis.get_major_formatter().format_ticks(axis.get_majorticklocs())
    more = max((len(text) - SHORT_NUMBER for text in texts), default=0)
    if more <= 0:
        return
    size = float(axis.get_ticklabels()[0].get_fontsize())
    step = 0.5 * more * DIGIT_WIDTH * size
    axis.set_tick_params(pad=rcParams["xtick.major.pad"] + step)
    axis.labelpad += 2.0 * step


def _away(axis: Any, *, low: bool) -> tuple[int, int]:
    """Return how many of the numbers of an axis are away from one end of it, and how many are."""
    from gsp.figures.corners import near_end

    least, most = sorted(axis.get_view_interval())
    ticks, room = axis.get_majorticklocs(), 1e-9 * (most - least)
    seen = ticks[(ticks >= least - room) & (ticks <= most + room)]
    return int((~near_end(seen, least, most, low=low)).sum()), len(seen)
