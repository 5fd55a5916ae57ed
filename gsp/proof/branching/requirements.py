"""Limits as bounds of the quantities of a search: rounded inward, angles by their cosines."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np

from gsp import determinant
from gsp.errors import InvalidInput, expected
from gsp.geometry.vectors import EPS, Array
from gsp.indices import INDICES
from gsp.indices.table import MAXIMUM_SHARES
from gsp.limits import Limits
from gsp.limits.bounds import bounded_quantities
from gsp.limits.kinds import Quantity
from gsp.model.design import Design
from gsp.proof.tolerances import Tolerances
from gsp.variation.layout import INDEX_ORDER

# Rounding of cosines of bounds.
COSINE_ROUNDING = 4.0 * EPS
# Above every cosine.
ABOVE_COSINES = 2.0


def is_empty(design: Design, limits: Limits) -> bool:
    """Whether limits, with the strokes of the design, require nothing."""
    given = (
        design.strokes if limits.strokes is None else limits.strokes,
        limits.base_cone,
        limits.platform_cone,
        limits.position,
        limits.leg_radius,
    )
    return all(x is None for x in given) and not limits.thresholds


def write_bounds(
    design: Design,
    limits: Limits,
    tolerances: Tolerances,
    named: tuple[Quantity, ...],
    bounds: Array,
) -> dict[str, list[float | None]]:
    """Write the bounds of limits; return what is claimed, angles as angles."""
    limits = with_maximum(design, limits)
    for index, _, _ in limits.thresholds:  # before a parameter that it misses
        _check_known(named, index.name)
    given = bounded_quantities(design, limits, crossed=True)
    spare = np.zeros(len(given.named))
    spare[: given.joints] = tolerances.of_joints(design)
    claims: dict[str, list[float | None]] = {}
    for quantity, least, most, off in zip(given.named, given.low, given.high, spare, strict=True):
        name = bounded_by(quantity.name)
        if name != quantity.name:
            least, most = _times(limits.maximum, least, most)
        place = _place(design, named, name)
        for row, change in ((0, off), (2, 0.0)):
            low, high = least + change, most - change
            if quantity.angular:
                low, high = cosines(low, high)
            bounds[row, place] = max(bounds[row, place], low)
            bounds[row + 1, place] = min(bounds[row + 1, place], high)
        if np.isfinite([least, most]).any():
            before = claims.get(name, [None, None])
            claims[name] = [
                _stricter(max, before[0], least + off),
                _stricter(min, before[1], most - off),
            ]
    return claims


def _stricter(choice: Any, before: float | None, bound: float) -> float | None:
    if not np.isfinite(bound):
        return before
    return float(bound if before is None else choice(before, bound))


def bounded_by(name: str) -> str:
    """Return the name of the quantity that bounds a quantity: |det J| for λ, which is its share."""
    return (INDICES[name].share_of if name in INDICES else "") or name


def with_maximum(design: Design, limits: Limits) -> Limits:
    """Return limits with the maximum of |det J| that bounds of λ are measured by."""
    shares = any(index.share_of for index, _, _ in limits.thresholds)
    if limits.maximum is not None or not shares:
        return limits
    found = determinant.reference(design).value
    if not found > 0.0:
        raise InvalidInput(expected("limits on λ", "a design that is not singular everywhere", 0))
    return replace(limits, maximum=found)


def _times(maximum: float | None, least: float, most: float) -> tuple[float, float]:
    """Bounds of |det J| from those of λ, rounded inward."""
    factor = 1.0 if maximum is None else maximum
    low, high = least * factor, most * factor
    return (
        low + abs(low) * EPS if np.isfinite(low) else low,
        high - abs(high) * EPS if np.isfinite(high) else high,
    )


def _place(design: Design, named: tuple[Quantity, ...], name: str) -> int:
    """Return the number of a quantity that limits name."""
    _check_known(named, name)
    check_commensurable(design, name)
    return [quantity.name for quantity in named].index(name)


def _check_known(named: tuple[Quantity, ...], name: str) -> None:
    if bounded_by(name) not in [quantity.name for quantity in named]:
        indices = ", ".join(quantity.name for quantity in named if quantity.kind == "index")
        known = ", ".join((indices, *MAXIMUM_SHARES))
        raise InvalidInput(expected("limits.indices", f"one of {known}", name))


def has_bounds(design: Design, name: str) -> bool:
    """Whether an index of a design has bounds over boxes."""
    return bounded_by(name) in INDEX_ORDER and _is_commensurable(design, name)


def _is_commensurable(design: Design, name: str) -> bool:
    """Whether it is not |det J| of a design where that adds values of unlike units."""
    index = INDICES.get(name)
    return index is None or not index.of_determinant or design.determinant_has_unit


def check_commensurable(design: Design, name: str) -> None:
    """Raise InvalidInput for |det J| of designs where it adds values of unlike units."""
    if not _is_commensurable(design, name):
        wanted = "|det J| and λ of designs with six actuators, or without angular ones"
        raise InvalidInput(expected("bounds of |det J|", wanted, design.name or "another design"))


def cosines(least: float, most: float) -> tuple[float, float]:
    """Bounds of the cosine of an angle in [0, π] within bounds, rounded inward.

    Bounds of the angle below 0 or above π hold always or never; never is a cosine beyond ±1.
    """
    low = (
        -np.inf
        if most >= np.pi
        else ABOVE_COSINES
        if most < 0.0
        else np.cos(most) + COSINE_ROUNDING
    )
    high = (
        np.inf
        if least <= 0.0
        else -ABOVE_COSINES
        if least > np.pi
        else np.cos(least) - COSINE_ROUNDING
    )
    return float(low), float(high)
