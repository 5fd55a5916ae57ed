"""Places of numbers on an axis in space, without those beside a corner of the box."""

from __future__ import annotations

from typing import Any

from matplotlib.ticker import Locator

# Numbers nearer to a corner than this share of an axis stand beside those of the other axis there.
CORNER_SHARE = 0.06


class ClearOfCorner(Locator):
    """The places of another locator, but for those near one end, also after the view has changed.

    Parameters
    ----------
    places : matplotlib Locator
    low : bool
        Whether that is the low end.
    """

    def __init__(self, places: Locator, *, low: bool) -> None:
        self.places, self.low = places, low

    def __call__(self) -> Any:
        """Return the places for the limits of the axis."""
        return self.tick_values(*sorted(self.axis.get_view_interval()))  # type: ignore[union-attr]

    def tick_values(self, vmin: float, vmax: float) -> Any:
        """Return the places for limits."""
        ticks: Any = self.places.tick_values(vmin, vmax)
        return ticks[~near_end(ticks, vmin, vmax, low=self.low)]


def near_end(ticks: Any, least: float, most: float, *, low: bool) -> Any:
    """Return which of some places are near the low or the high end of an interval."""
    share = (ticks - least) / (most - least)
    return share < CORNER_SHARE if low else share > 1.0 - CORNER_SHARE
