"""Orientations from which rays start: feasible ones at the radiating point."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_integer, check_rng
from gsp.errors import EmptyWorkspace, InvalidInput, apart, expected
from gsp.geometry.rotations import check_rotation
from gsp.geometry.vectors import Array
from gsp.limits.quantities import BoundedQuantities
from gsp.model.design import Design

# Random orientations among which feasible ones are sought at the radiating point.
ORIENTATIONS_TRIED = 20_000
# Of these, as many are evaluated at once; an index takes about 0.1 ms per orientation.
ORIENTATIONS_PER_BLOCK = 1000
# Slack that a feasible start needs [share of the size], so that the barrier is finite there.
START_SLACK = 1e-6


def feasible_orientations(
    design: Design,
    bounds: BoundedQuantities,
    origin: Array,
    rotation: ArrayLike | None,
    number: int,
    rng: np.random.Generator | int,
) -> Array:
    """Return orientations that are strictly feasible at a point, shape (≤ number, 3, 3).

    These are the first among the home orientation, the identity and random ones.

    Raises
    ------
    EmptyWorkspace
        If none was found among them.
    """
    from scipy.spatial.transform import Rotation

    number = check_integer("starts", number)
    if rotation is not None:
        chosen = check_rotation("rotation", rotation)[None]
        if chosen.ndim != 3:
            raise InvalidInput(expected("rotation", "a single rotation", f"shape {chosen.shape}"))
    else:
        random = Rotation.random(ORIENTATIONS_TRIED, rng=check_rng("rng", rng)).as_matrix()
        chosen = np.concatenate((_known_orientations(design), random))
    inside = _first_allowed(bounds, origin, chosen, number)
    if not len(inside):
        places = np.broadcast_to(origin, (len(chosen), 3))
        place, closest = np.round(origin, 6).tolist(), _closest(bounds, places, chosen)
        if rotation is not None:
            wanted = f"one that is feasible at the radiating point {place}"
            raise EmptyWorkspace(expected("rotation", wanted, closest))
        wanted = "a radiating point with a feasible orientation"
        got = f"{place}: none was found in {len(chosen)} tries; closest: {closest}"
        raise EmptyWorkspace(expected("position", wanted, got))
    return inside


def _known_orientations(design: Design) -> Array:
    """Return the home orientation, if there is one, and the identity, each once, (k, 3, 3)."""
    identity = np.eye(3)[None]
    if design.home is None or np.array_equal(design.home.rotation, identity[0]):
        return identity
    return np.concatenate((design.home.rotation[None], identity))


def _first_allowed(bounds: BoundedQuantities, origin: Array, chosen: Array, most: int) -> Array:
    """Return the first orientations that are strictly feasible, evaluated until they suffice."""
    found = np.zeros((0, 3, 3))
    for low in range(0, len(chosen), ORIENTATIONS_PER_BLOCK):
        block = chosen[low : low + ORIENTATIONS_PER_BLOCK]
        places = np.broadcast_to(origin, (len(block), 3))
        found = np.concatenate((found, block[bounds.allowed(places, block, -START_SLACK)]))
        if len(found) >= most:
            break
    return found[:most]


def _closest(bounds: BoundedQuantities, position: Array, rotation: Array) -> str:
    excess = bounds.excess(bounds.quantities.values(position, rotation)) / bounds.sizes[:, None]
    with np.errstate(invalid="ignore"):
        worst = np.nan_to_num(excess, nan=np.inf).max(axis=(1, 2))
    best = int(np.argmin(worst))
    i, side = np.unravel_index(int(np.nanargmax(excess[best])), excess[best].shape)
    bound = (bounds.low, bounds.high)[int(side)][i]
    value = bound + (2 * int(side) - 1) * excess[best][i, side] * bounds.sizes[i]
    violated = f" {'<>'[int(side)]} ".join(apart(value, bound))
    return f"{bounds.names[int(i)]} = {violated}"
