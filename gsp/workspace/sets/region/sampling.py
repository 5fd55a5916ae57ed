"""Points that are drawn evenly from the undecided parts of cells."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gsp.geometry.vectors import Array
from gsp.workspace.sets.codes import UNDECIDED
from gsp.workspace.sets.tree.cuts import sides

# Draws for one point, at most, before the cell of it counts as it is drawn last.
DRAWS_PER_POINT = 10_000


@dataclass(frozen=True)
class Estimate:
    """A number that was sampled.

    Attributes
    ----------
    value : float [length² or length³, or rad³]
    error : float [as the value]
        One standard error; half of what samples that stayed undecided may add is included.
    samples : int
    """

    value: float
    error: float
    samples: int


def drawn(
    low: Array,
    high: Array,
    cuts: Array,
    sizes: Array,
    samples: int,
    generator: np.random.Generator,
    turning: bool,
) -> Array:
    """Return points of the undecided parts of cells, evenly by volume, shape (samples, d).

    Parameters
    ----------
    low, high : (n, d) arrays
    cuts : (n, 8) array
    sizes : (n,) array
        The volumes of the undecided parts.
    samples : int
    generator : numpy.random.Generator
    turning : bool
        Whether coordinates are angles, whose volume is that among the rotations.
    """
    # Stratified: the mean has no more variance than that of independent points.
    place = (np.arange(samples) + generator.random(samples)) / samples
    share = np.cumsum(sizes) / sizes.sum()
    cell = np.minimum(np.searchsorted(share, place), len(low) - 1)
    points = np.empty((samples, low.shape[1]))
    left = np.arange(samples)
    for _ in range(DRAWS_PER_POINT):
        if not left.size:
            break
        at = cell[left]
        inner = generator.random((len(left), low.shape[1]))
        found = low[at] + inner * (high - low)[at]
        if turning:
            found[:, 1] = even_pitch(low[at, 1], high[at, 1], inner[:, 1])
        points[left] = found
        left = left[sides(found, low[at], high[at], cuts[at]) != UNDECIDED]
    return points


def even_pitch(low: Array, high: Array, share: Array) -> Array:
    """Return middle angles at shares of the measure of the rotations between two of them [rad]."""
    s, t = np.sin(low), np.sin(high)
    return np.asarray(np.arcsin(np.clip(s + share * (t - s), -1.0, 1.0)))


def share_error(hits: Array) -> float:
    """Return the standard error of the mean of hits from 0 to 1, (n,).

    That with one more hit and one more miss: samples that agree do not prove the rest.
    """
    return float(np.append(hits, (0.0, 1.0)).std(ddof=1) / np.sqrt(len(hits)))
