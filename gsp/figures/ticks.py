"""Numbers on axes in space, which meet in the corners of the box."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

# How many numbers an axis has at least without those beside a corner.
LEAST_TICKS = 2


def set_space_ticks(ax: Any, counts: Sequence[int], steps: Sequence[float] | None = None) -> None:
    """Set the numbers of axes in space, at most so many intervals on each; one in each corner.

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


def _away(axis: Any, *, low: bool) -> tuple[int, int]:
    """Return how many of the numbers of an axis are away from one end of it, and how many are."""
    from gsp.figures.corners import near_end

    least, most = sorted(axis.get_view_interval())
    ticks, room = axis.get_majorticklocs(), 1e-9 * (most - least)
    seen = ticks[(ticks >= least - room) & (ticks <= most + room)]
    return int((~near_end(seen, least, most, low=low)).sum()), len(seen)
