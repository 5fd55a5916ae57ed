"""The arrays of the compiled search: numbers of a design, and space for those of a box."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gsp.geometry.vectors import Array


class Tables(NamedTuple):
    """What is the same for all boxes of one chart.

    Attributes
    ----------
    anchors : (2, 6, 3) array
    coefficients : (19, 84, 20) array
        Of P and its cofactors.
    majorants : (19, 4) array
        Sums of the magnitudes of the coefficients of each degree in the position.
    images : (m, 4) array
        Quaternions of the images of one rotation.
    facts : (4,) array
        See `lengths.py`; the first is written for each box.
    order, x_steps, p_steps, rotation, position : int arrays
        See `expansions.py`.
    """

    anchors: Array
    coefficients: Array
    majorants: Array
    images: Array
    facts: Array
    order: Array
    x_steps: Array
    p_steps: Array
    rotation: Array
    position: Array


class Space(NamedTuple):
    """Space for the numbers of a box; `ready` states which cofactors are expanded."""

    q: Array
    x: Array
    p: Array
    width: Array
    table: Array
    start: Array
    tails: Array
    ready: Array
    leg_starts: Array
    leg_tails: Array
    values: Array
    rests: Array
    leg_values: Array
    leg_rests: Array
    total: Array
    both: Array
    single: Array
    quaternions: Array
    work: Array
    parts: Array
    others: Array


def space_of() -> Space:
    """Return new space."""
    return Space(
        q=np.zeros(4), x=np.zeros(3), p=np.zeros(3), width=np.zeros(6),
        table=np.zeros((84, 20)), start=np.zeros((20, 10)), tails=np.zeros(20),
        ready=np.zeros(6, np.int64), leg_starts=np.zeros((6, 20, 30)), leg_tails=np.zeros((6, 60)),
        values=np.zeros((20, 10)), rests=np.zeros(1), leg_values=np.zeros((20, 30)),
        leg_rests=np.zeros(3), total=np.zeros((9, 6)), both=np.zeros((9, 6)),
        single=np.zeros((2, 9, 6)), quaternions=np.zeros((16, 4)), work=np.zeros((27, 6)),
        parts=np.zeros(6), others=np.zeros(6),
    )  # fmt: skip
