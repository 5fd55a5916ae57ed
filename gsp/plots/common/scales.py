"""Axes of indices: linear or logarithmic, their limits, and the levels of contours."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gsp.geometry.vectors import Array
from gsp.indices import INDICES

# An axis without a bound ends this factor beyond the median: with one pose near a singular posture,
# with a value of 1e16, all other values would be at one end of the axis.
BEYOND_MEDIAN = 1e4
# The same on the side of the best value.
FAR_BETTER = 1e12
# Logarithmic axes end at LARGEST_DRAWN and its inverse: matplotlib fails where double precision
# ends.
LARGEST_DRAWN = 1e200
# Values that differ by less than this share are drawn as one constant.
CONSTANT = 1e-9
# The same for the levels of contours, so that they are close enough where most poses are.
CONTOURED = 1e2
# Positive numbers of designs that span more than this ratio have a logarithmic axis.
LOGARITHMIC_RATIO = 30.0
# About how many levels contours have.
LEVELS = 10


@dataclass(frozen=True)
class Scale:
    """Limits of an axis of values.

    Attributes
    ----------
    low, high : float
        Limits, low < high; both positive on a logarithmic axis.
    log : bool
    constant : bool
        Whether all finite values are equal, to rounding.
    """

    low: float
    high: float
    log: bool = False
    constant: bool = False

    def clipped(self, values: Array) -> Array:
        """Return values, with those that the axis cannot show moved just outside its limits.

        These are infinite values, and on a logarithmic axis those ≤ 0. A line through them then
        ends at the edge of the picture. NaN stays.
        """
        if self.log:
            inside = np.isfinite(values) & (values > 0.0)
            near = np.where(inside, np.clip(values, 1.0 / LARGEST_DRAWN, LARGEST_DRAWN), values)
            return np.clip(near, self.low / 10.0, self.high * 10.0)
        span = self.high - self.low
        return np.clip(values, self.low - span, self.high + span)


def unbounded(name: str) -> bool:
    """Return whether the range of an index has no bound, by its record."""
    index = INDICES[name]
    return bool(np.isinf(index.best) or np.isinf(index.worst))


def spans_much(positive: Array) -> bool:
    """Whether positive numbers of designs span so much that their axis is logarithmic."""
    return bool(positive.size and positive.max() > LOGARITHMIC_RATIO * positive.min())


def scale_of(values: Array, name: str = "", beyond: float = BEYOND_MEDIAN) -> Scale | None:
    """Return the axis for values of an index; None if no value can be drawn on it.

    An index without a bound gets a logarithmic axis, one with bounds a linear axis with both.

    Parameters
    ----------
    values : array of any shape, may hold NaN and inf
    name : str
        In `gsp.indices.INDICES`; "" for values of another kind, on a linear axis.
    beyond : float
        Factor between the median and the ends of an axis without a bound.
    """
    finite = values[np.isfinite(values)]
    if name and not unbounded(name):
        return _bounded(finite, name) if finite.size else None
    shown = finite[finite > 0.0] if name else finite
    if not shown.size:
        return None
    if not name:
        return _linear(shown)
    shown = np.clip(shown, 1.0 / LARGEST_DRAWN, LARGEST_DRAWN)
    middle = float(np.median(shown))
    low, high = float(shown.min()), float(shown.max())
    # The side of the worst value, that of singular poses, is cut near the median.
    lower = INDICES[name].worst > INDICES[name].best
    low = max(low, middle / (FAR_BETTER if lower else beyond))
    high = min(high, middle * (beyond if lower else FAR_BETTER))
    margin = max((high / low) ** 0.05, 1.02) if not _equal(shown) else 2.0
    return Scale(
        low / margin, high * margin, log=True, constant=_equal(shown) and shown.size == finite.size
    )


def _bounded(finite: Array, name: str) -> Scale:
    """Return the axis from the lower bound of an index to the upper one, or to the greatest value.

    The latter where all values lie in the lower half: an axis to 1 would press them together.
    Values outside of the bounds, as λ has with a maximum that is too small, are shown too.
    """
    bounds = INDICES[name].worst, INDICES[name].best
    low, top = min(*bounds, float(finite.min())), float(finite.max())
    half = top > low and top - low < 0.5 * (max(bounds) - low)
    high = top if half else max(*bounds, top)
    return Scale(low, high + 0.05 * (high - low), constant=_equal(finite))


def _linear(shown: Array) -> Scale:
    low, high = float(shown.min()), float(shown.max())
    margin = 0.05 * (high - low) if not _equal(shown) else 0.5 * (abs(high) or 1.0)
    return Scale(low - margin, high + margin, constant=_equal(shown))


def _equal(finite: Array) -> bool:
    return bool(finite.size and np.ptp(finite) <= CONSTANT * np.abs(finite).max())


def levels_of(values: Array, scale: Scale) -> Array:
    """Return increasing round numbers between the values on an axis; at least two.

    For a constant the two levels enclose it.
    """
    from matplotlib.ticker import MaxNLocator

    kept = np.clip(values[np.isfinite(values)], scale.low, scale.high)
    if scale.log:
        middle = float(np.median(kept))
        kept = np.clip(kept, middle / CONTOURED, middle * CONTOURED)
    low, high = float(kept.min()), float(kept.max())
    if _equal(kept):
        width = 1e-6 * (abs(high) or 1.0)
        return np.array([low - width, high + width])
    if scale.log and high > 10.0 * low:
        return _decades(low, high)
    marks = np.asarray(MaxNLocator(LEVELS, steps=[1, 2, 2.5, 5, 10]).tick_values(low, high))
    if scale.log and marks[0] <= 0.0:
        # Steps of about a tenth of the highest value may reach 0, which has no logarithm.
        marks = np.concatenate((_decades(low, low)[:1], marks[marks > 0.0]))
    return marks


def number_format(levels: Array) -> str:
    """Return the format of numbers on an axis: four digits, or as many as show their differences.

    Each is written to a hundredth of its distance from the next.
    """
    marks = np.unique(levels)
    if len(marks) < 2:
        return "%.4g"
    gaps = np.diff(marks)
    near = np.minimum(np.append(gaps, gaps[-1]), np.insert(gaps, 0, gaps[0]))
    for digits in range(4, 17):
        written = np.array([float(f"{mark:.{digits}g}") for mark in marks])
        if (np.abs(written - marks) <= 0.01 * near).all():
            return f"%.{digits}g"
    return "%.17g"


def _decades(low: float, high: float) -> Array:
    """Return 1, 2, 5 times powers of ten around an interval, or of ten alone if those are many."""
    powers = 10.0 ** np.arange(np.floor(np.log10(low)), np.ceil(np.log10(high)) + 1.0)
    fine = np.unique(np.outer(powers, (1.0, 2.0, 5.0)))
    marks = fine if np.sum((fine > low) & (fine < high)) <= LEVELS + 2 else powers
    first = max(int(np.searchsorted(marks, low, side="right")) - 1, 0)
    last = int(np.searchsorted(marks, high, side="left"))
    return np.asarray(marks[first : last + 1])
