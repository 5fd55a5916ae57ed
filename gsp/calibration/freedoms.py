"""What measurements do not determine, in words: motions of frames, points of lines and of A1."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gsp.geometry.vectors import Array, Mask, cross
from gsp.model.design import Design
from gsp.model.dimensions import ANCHORS, Dimensions
from gsp.model.posture.slopes import ANCHOR_DIRECTIONS

# A direction with a smaller part in what is not determined is determined, and a combination with a
# larger one is not: both differ from 0 and 1 by rounding only.
PART_UNDETERMINED = 1e-6
ANGLE_POINTS = "of points of A1 legs, whose angles depend on the directions of their lines only"


def identified(undetermined: Array) -> Mask:
    """Return which coordinates (p,) have no part in combinations (m, p) that are not determined."""
    return np.asarray(np.abs(undetermined).max(axis=0, initial=0.0) < PART_UNDETERMINED)


def in_words(dimensions: Dimensions, design: Design, undetermined: Array) -> tuple[str, ...]:
    """Return what orthonormal combinations (m, p) that are not determined consist of.

    Parameters
    ----------
    dimensions : Dimensions
    design : Design
        The one that was found.
    undetermined : (m, p) array
        In sizes of the design and in rad.
    """
    kinds = {
        ("motion", "of the base frame"): _motions(dimensions, design, 0),
        ("motion", "of the platform frame"): _motions(dimensions, design, 1),
        ("coordinate", ANGLE_POINTS): _angle_points(dimensions, design),
        ("slide", "of points along lines"): _slides(dimensions, design),
    }
    found, held = [], np.zeros((0, len(dimensions)))
    for (what, where), moves in kinds.items():
        inside = _within(moves, undetermined)
        held = _basis(np.vstack((held, inside)))
        if len(inside):
            found.append(f"{_number(len(inside), what)} {where}")
    others = len(undetermined) - len(held)
    if others:
        names = _names(dimensions, undetermined, held)
        found.append(f"{_number(others, 'other combination')} of {names}")
    return tuple(found)


def _number(number: int, noun: str) -> str:
    return f"{number} {noun}{'s' if number > 1 else ''}"


def _motions(dimensions: Dimensions, design: Design, side: int) -> Array:
    """Return the coordinates (6, p) that change where one body moves in its frame."""
    turns, points = np.eye(3), getattr(design, ANCHORS[side])
    lines = np.nan_to_num(getattr(design, ANCHORS[side + 2]))
    rates = np.zeros((6, design.n_legs, ANCHOR_DIRECTIONS))
    rates[:3, :, 3 * side : 3 * side + 3] = np.eye(3)[:, None]
    centre = points.mean(axis=0)
    rates[3:, :, 3 * side : 3 * side + 3] = cross(turns[:, None], (points - centre)[None])
    rates[3:, :, 3 * side + 6 : 3 * side + 9] = cross(turns[:, None], lines[None])
    return _coordinates(dimensions, design, rates)


def _has_distance(design: Design) -> Mask:
    """Return which legs have an actuated distance, and not an angle only, (n_legs,)."""
    return np.array([any(c.quantity == "distance" for c in leg.constraints) for leg in design.legs])


def _angle_points(dimensions: Dimensions, design: Design) -> Array:
    """Return the coordinates of both points of legs with an angle only."""
    found = [
        _of_leg(design, int(leg), np.eye(ANCHOR_DIRECTIONS)[i])
        for leg in np.flatnonzero(~_has_distance(design))
        for i in range(6)
    ]
    return _coordinates(dimensions, design, _stacked(design, found))


def _slides(dimensions: Dimensions, design: Design) -> Array:
    """Return the coordinates that change where points that matter slide along their lines."""
    found = []
    for side in (0, 1):
        lines = getattr(design, ANCHORS[side + 2])
        for leg in np.flatnonzero(np.isfinite(lines).all(axis=1) & _has_distance(design)):
            along = np.zeros(ANCHOR_DIRECTIONS)
            along[3 * side : 3 * side + 3] = lines[leg]
            found.append(_of_leg(design, int(leg), along))
    return _coordinates(dimensions, design, _stacked(design, found))


def _of_leg(design: Design, leg: int, rates: Array) -> Array:
    """Return rates (n_legs, 12) of which one leg has these (12,), and the others none."""
    found = np.zeros((design.n_legs, ANCHOR_DIRECTIONS))
    found[leg] = rates
    return found


def _stacked(design: Design, rates: Sequence[Array]) -> Array:
    return np.array(rates).reshape(-1, design.n_legs, ANCHOR_DIRECTIONS)


def _coordinates(dimensions: Dimensions, design: Design, rates: Array) -> Array:
    """Return what rates of anchors and lines (m, n_legs, 12) are in scaled coordinates (m, p).

    Those that the coordinates cannot follow are left out.
    """
    basis = dimensions.directions(design).anchors * dimensions.sizes[:, None, None]
    # Turns of lines are tangent: along a line of the design there is no coordinate.
    flat = basis.copy()
    for part in (2, 3):
        lines = np.nan_to_num(getattr(design, ANCHORS[part]))
        across = slice(3 * part, 3 * part + 3)
        along = (flat[:, :, across] * lines).sum(axis=-1, keepdims=True)
        flat[:, :, across] -= along * lines
    matrix, wanted = (x.reshape(len(x), design.n_legs * ANCHOR_DIRECTIONS).T for x in (flat, rates))
    found = np.linalg.lstsq(matrix, wanted)[0]
    error = np.abs(matrix @ found - wanted).max(axis=0, initial=0.0)
    largest = np.abs(rates).max(axis=(1, 2), initial=0.0)
    return np.asarray(found.T[error <= PART_UNDETERMINED * largest])


def _basis(rows: Array) -> Array:
    """Return an orthonormal basis of the span of rows."""
    _, values, right = np.linalg.svd(rows, full_matrices=False)
    return np.asarray(right[values > PART_UNDETERMINED * values.max(initial=0.0)])


def _within(moves: Array, undetermined: Array) -> Array:
    """Return an orthonormal basis of the moves that are in the span of others."""
    basis = _basis(moves)
    left, values, _ = np.linalg.svd(basis @ undetermined.T, full_matrices=False)
    return np.asarray(left[:, values > 1.0 - PART_UNDETERMINED].T @ basis)


def _names(dimensions: Dimensions, undetermined: Array, held: Array) -> str:
    """Return the names that occur in combinations besides those that are held."""
    rest = undetermined - undetermined @ held.T @ held
    there = np.abs(rest).max(axis=0, initial=0.0) > PART_UNDETERMINED
    return _few([name for name, one in zip(dimensions.names, there, strict=True) if one])


def _few(names: Sequence[str], most: int = 12) -> str:
    return ", ".join(names[:most]) + (", …" if len(names) > most else "")
