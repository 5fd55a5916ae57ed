"""Planes of sections: a point and orthonormal directions."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gsp.arguments import bounded_array
from gsp.checks import check_array
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.vectors import Array, cross, norm, unit

# Sine of the angle between two directions below which they span no plane [1].
DEPENDENT_SINE = 1e-12


def plane_frame(origin: ArrayLike, axes: ArrayLike) -> tuple[Array, Array]:
    """Return a point of a plane, and orthonormal axes: two in the plane, then its normal.

    Parameters
    ----------
    origin : (3,) array_like [length]
    axes : (2, 3) array_like [any length]
        Two directions of the plane; the first is kept. Their lengths do not matter.

    Returns
    -------
    origin : (3,) array [length]
    frame : (3, 3) array [1]
        Its rows are the axes.

    Raises
    ------
    InvalidInput
        On wrong shapes, coordinates beyond 1e100, or dependent directions.
    """
    start = bounded_array("origin", origin, (3,))
    given = check_array("axes", axes, (2, 3))
    if start.ndim != 1 or given.ndim != 2:
        raise InvalidInput(expected("origin, axes", "one point, two directions", "a batch"))
    # Divided by their largest components, as products of large or small ones are not numbers.
    largest = np.abs(given).max(axis=1, keepdims=True)
    given = given / np.where(largest > 0.0, largest, 1.0)
    normal = cross(given[0], given[1])
    if not norm(normal) > DEPENDENT_SINE * norm(given[0]) * norm(given[1]):
        raise InvalidInput(expected("axes", "two independent directions", brief(given.tolist())))
    first, third = unit(given[0]), unit(normal)
    return start, np.stack((first, cross(third, first), third))
