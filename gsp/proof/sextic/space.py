"""The arrays of the compiled search: numbers of a design, and space for those of a box."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gsp.geometry.vectors import Array

# Most legs that may have any direction at the same time.
MOST_FREE_LEGS = 3


class Tables(NamedTuple):
    """What is the same for all boxes of one chart.

    Attributes
    ----------
    anchors : (2, 6, 3) array
    coefficients : (m, 84, 20) array
        Of P and its cofactors.
    places : (64,) int array
        Number of the first cofactor of some legs, by the sum of 2^i of their numbers i, the others
        follow; −1 for legs whose cofactors are not there.
    majorants : (m, 4) array
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
    places: Array
    majorants: Array
    images: Array
    facts: Array
    order: Array
    x_steps: Array
    p_steps: Array
    rotation: Array
    position: Array


class Space(NamedTuple):
    """Space for the numbers of a box; `ready` states which polynomials are expanded.

    Arrays with numbers of polynomials are flat, those of one polynomial after those of another.
    """

    q: Array
    x: Array
    p: Array
    width: Array
    table: Array
    starts: Array
    tails: Array
    ready: Array
    order: Array
    values: Array
    rests: Array
    totals: Array
    single: Array
    quaternions: Array
    work: Array
    parts: Array
    others: Array


def space_of(polynomials: int) -> Space:
    """Return new space for some number of polynomials."""
    most = 3**MOST_FREE_LEGS
    return Space(
        q=np.zeros(4),
        x=np.zeros(3),
        p=np.zeros(3),
        width=np.zeros(6),
        table=np.zeros((84, 20)),
        starts=np.zeros(200 * polynomials),
        tails=np.zeros(20 * polynomials),
        ready=np.zeros(64, np.int64),
        order=np.zeros(6, np.int64),
        values=np.zeros(200 * most),
        rests=np.zeros(most),
        totals=np.zeros((1 + MOST_FREE_LEGS, 9, 6)),
        single=np.zeros((7, 9, 6)),
        quaternions=np.zeros((16, 4)),
        work=np.zeros((27, 6)),
        parts=np.zeros(6),
        others=np.zeros(6),
    )
