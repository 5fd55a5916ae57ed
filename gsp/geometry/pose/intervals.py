"""Intervals of the six coordinates of a pose, and points in them."""

from __future__ import annotations

from collections.abc import Sequence
from math import prod
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import (
    check_array,
    check_integer,
    check_items,
    check_memory,
    check_rng,
    check_rows,
    has_axes,
    is_a,
    plain_text,
)
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.rotations import angle_set
from gsp.geometry.vectors import Array

# Memory for each pose of a batch [bytes], measured: 350 of a sample or turn, 300 of a grid.
POSE_BYTES = 300


def check_bounds(
    position: Sequence[Any], angles: Sequence[Any], *, degrees: bool = False
) -> tuple[Array, Array]:
    """Return the least and the greatest coordinates of a box of poses, (6,) each [length, rad].

    Parameters
    ----------
    position : three numbers or pairs (low, high) [length]
        A single number stands for an interval of no width.
    angles : three numbers or pairs (low, high) [rad, or degrees]
    degrees : bool
        Whether the angles are in degrees.

    Raises
    ------
    InvalidInput
        On intervals that cross, numbers that are not finite, or positions beyond 1e100.
    """
    places = arguments.bounded_array("box.position", _intervals("box.position", position), (3, 2))
    turns = _intervals("box.angles", angles)
    degrees = arguments.flag("degrees", degrees)
    bounds = np.concatenate((places, np.deg2rad(turns) if degrees else turns))
    return bounds[:, 0], bounds[:, 1]


def grid_points(low: Array, high: Array, counts: int | Sequence[int]) -> Array:
    """Return the product grid of six intervals with their end points, shape (*counts, 6).

    Parameters
    ----------
    low, high : (6,) arrays
    counts : one or six integers ≥ 1
        Points per coordinate; a coordinate with one point takes the middle of its interval.

    Raises
    ------
    InvalidInput
        If `counts` are not such integers, or so many poses do not fit into the memory.
    """
    wanted = "one or six integers ≥ 1"
    try:
        given = check_items("counts", counts, wanted, 6) if has_axes(counts) else (counts,) * 6
        number = [check_integer("counts", n) for n in given]
    except InvalidInput as error:
        raise InvalidInput(expected("counts", wanted, brief(counts))) from error
    check_memory("counts", prod(number), POSE_BYTES, "poses")
    axes = [
        np.linspace(least, most, n) if n > 1 else np.array([(least + most) / 2.0])
        for least, most, n in zip(low, high, number, strict=True)
    ]
    return np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1)


def sample_points(
    low: Array, high: Array, n: int, rng: np.random.Generator | int, method: str
) -> Array:
    """Return a low-discrepancy sample of m intervals, shape (n, m).

    Parameters
    ----------
    low, high : (m,) arrays
    n : int
        Number of points, ≥ 1.
    rng : numpy.random.Generator or int
        Generator or seed.
    method : "halton" or "sobol"

    Raises
    ------
    InvalidInput
        On a generator or method that cannot be used, or a number of poses that does not fit into
        the memory.
    """
    n = check_memory("n", check_integer("n", n), POSE_BYTES, "poses")
    method = plain_text(method)
    from scipy.stats import qmc  # a second of import time, for those who sample

    generator = check_rng("rng", rng)
    if is_a(method, str) and method == "halton":
        points = qmc.Halton(d=len(low), rng=generator).random(n)
    elif is_a(method, str) and method == "sobol":
        exponent = int(np.ceil(np.log2(n)))
        points = qmc.Sobol(d=len(low), rng=generator).random_base2(exponent)[:n]
    else:
        raise InvalidInput(expected("method", '"halton" or "sobol"', brief(method)))
    return np.asarray(low + points * (high - low))


def _intervals(what: str, value: Sequence[Any]) -> Array:
    wanted = "three numbers or pairs (low ≤ high)"
    given = check_rows(what, value, wanted, 3)
    try:
        pairs = [np.broadcast_to(check_array(what, v, ()), (2,)) for v in given]
        array = np.array(pairs).reshape(3, 2)
    except ValueError as error:  # InvalidInput is one
        raise InvalidInput(expected(what, wanted, brief(value))) from error
    if (array[:, 0] > array[:, 1]).any():
        raise InvalidInput(expected(what, wanted, brief(value)))
    return array


def middle_measure(low: ArrayLike, high: ArrayLike, order: str = "rpy") -> Array:
    """Return the measure of the rotations over intervals of the second angle about moving axes.

    The invariant (Haar) measure is |cos β| dα dβ dγ with that angle β, and |sin β| dα dβ dγ where
    the first and the third axis are the same; this is its integral over β.

    Parameters
    ----------
    low, high : (...) array_like [rad]
    order : str
        See `rotation_from_angles`.

    Returns
    -------
    (...) array [1]
        2 for half a turn from one singularity of the angles to the next.
    """
    sequence, _ = angle_set(order)
    same = sequence[0].lower() == sequence[2].lower()
    ends = np.stack(np.broadcast_arrays(low, high)) - (0.5 * np.pi if same else 0.0)
    half_turns = np.rint(ends / np.pi)
    total = 2.0 * half_turns + np.sin(ends - np.pi * half_turns)
    return np.asarray(total[1] - total[0])
