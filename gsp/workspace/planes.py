"""Planes of sections: a point and orthonormal directions."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.arguments import bounded_array
from gsp.checks import check_array, is_a, reading
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.vectors import Array, cross, norm, unit

# Sine of the angle between two directions below which they span no plane [1].
DEPENDENT_SINE = 1e-12


def plane_frame(
    origin: ArrayLike, axes: ArrayLike, names: tuple[str, str] = ("origin", "axes")
) -> tuple[Array, Array]:
    """Return a point of a plane, and orthonormal axes: two in the plane, then its normal.

    Parameters
    ----------
    origin : (3,) array_like [length]
    axes : (2, 3) array_like [any length]
        Two directions of the plane; the first is kept. Their lengths do not matter.
    names : pair of str
        What messages name the two.

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
    start = bounded_array(names[0], origin, (3,))
    given = check_array(names[1], axes, (2, 3))
    if start.ndim != 1 or given.ndim != 2:
        raise InvalidInput(expected(", ".join(names), "one point, two directions", "a batch"))
    # Divided by their largest components, as products of large or small ones are not numbers.
    largest = np.abs(given).max(axis=1, keepdims=True)
    one, two = given / np.where(largest > 0.0, largest, 1.0)
    normal = cross(one, two)
    if not norm(normal) > DEPENDENT_SINE * norm(one) * norm(two):
        raise InvalidInput(expected(names[1], "two independent directions", brief(given.tolist())))
    first, third = unit(one), unit(normal)
    return start, np.stack((first, cross(third, first), third))


def plane_of(plane: Any) -> tuple[Array, Array]:
    """Return the point and the frame of a plane that is given as one argument, a pair of both.

    Raises
    ------
    InvalidInput
        If it is no pair, and as for `plane_frame`; messages name `plane`.
    """
    wanted = "a pair: a point, and two directions"
    if is_a(plane, str):
        raise InvalidInput(expected("plane", wanted, brief(plane)))
    with reading("plane", wanted, plane):
        origin, axes = plane
    return plane_frame(origin, axes, ("plane[0] (the point)", "plane[1] (the directions)"))
