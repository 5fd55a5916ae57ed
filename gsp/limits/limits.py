"""Limits of the poses of a design, besides its geometry."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import (
    check_array,
    check_items,
    check_positive,
    check_rows,
    check_text,
    check_type,
    has,
    is_a,
)
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.vectors import Array, frozen, norm
from gsp.indices import INDICES, Index, index_name
from gsp.limits.kinds import position_quantities
from gsp.model.design.checks import check_bounds, open_bounds

_THRESHOLD = re.compile(r"^\s*(.+?)\s*(>=|<=|≥|≤)\s*([-+0-9.eE]+)\s*$")
Checked = TypeVar("Checked")


@dataclass(frozen=True, eq=False, kw_only=True)
class Limits(ReadOnly):
    """Limits of the poses of a design, besides its geometry.

    Parameters
    ----------
    strokes : (n, 2) array_like or None [unit of the design, rad]
        Least and greatest value per actuator, those of distances ≥ 0, NaN for none; default the
        strokes of the design.
    base_cone : float, (n_legs,) array_like or None [rad]
        Greatest angle between a leg and the axis of its passive joint on the base, in (0, π/2]:
        the half-angle of the cone of an S joint; for a C joint, whose leg stays perpendicular to
        the line, the greatest turn about the line to either side. NaN for a leg without a cone.
    platform_cone : float, (n_legs,) array_like or None [rad]
        The same on the platform.
    base_axes : (n_legs, 3) array_like or None [any length]
        Axes of the cones on the base, in base axes; default the directions that the legs have in
        the design's home pose. Turns about the line of a C joint are measured from the axis
        projected onto the plane across the line.
    platform_axes : (n_legs, 3) array_like or None [any length]
        Axes of the cones on the platform, in platform axes.
    position : (3, 2) array_like or None [unit of the design]
        Intervals of x, y and z of the platform origin; None or NaN for no bound, also in place of
        a pair.
    leg_radius : float or None [unit of the design]
        Radius of the legs, 1e-100 to 1e100, taken as capsules around the segments between their
        feet; two legs keep a distance of two radii. Legs that share an anchor point are not
        compared.
    indices : str or iterable of str
        Thresholds on indices by name or symbol: "λ >= 0.3", "CTN >= 0.1",
        "condition_number <= 20".
    length : float or None [unit of the design]
        Characteristic length of the indices that need one; default that of the design.
    ellipsoid : Ellipsoid or None
        Operation ellipsoid of the indices that need one; default that of the design.
    maximum : float or None [unit of |det J|]
        Maximum of |det J|, for thresholds on λ.

    Attributes
    ----------
    thresholds : tuple of (Index, float, float) [unit of the index]
        The thresholds as index, least and greatest value.

    Raises
    ------
    InvalidInput
        On arrays of another shape, intervals that cross or, but for strokes, have no width, cones
        outside of (0, π/2], axes of zero, numbers that are not positive, or texts that are not
        thresholds.
    UnknownIndex
        If a threshold names no index.

    Examples
    --------
    >>> Limits(indices=["λ >= 0.3"], maximum=1000.0).thresholds[0][1:]
    (0.3, inf)
    """

    strokes: ArrayLike | None = None
    base_cone: ArrayLike | None = None
    platform_cone: ArrayLike | None = None
    base_axes: ArrayLike | None = None
    platform_axes: ArrayLike | None = None
    position: Iterable[Any] | None = None
    leg_radius: float | None = None
    indices: str | Iterable[str] = ()
    length: float | None = None
    ellipsoid: Ellipsoid | None = None
    maximum: float | None = None
    thresholds: tuple[tuple[Index, float, float], ...] = field(init=False)

    def __post_init__(self) -> None:
        texts = _texts(self.indices)
        clean: dict[str, Any] = {
            "indices": texts,
            "thresholds": tuple(threshold("limits.indices", text) for text in texts),
            "strokes": _checked("strokes", self.strokes, _strokes),
            "position": _checked("position", self.position, _intervals),
        }
        for side in ("base", "platform"):
            clean[f"{side}_cone"] = _checked(f"{side}_cone", getattr(self, f"{side}_cone"), _cone)
            clean[f"{side}_axes"] = _checked(f"{side}_axes", getattr(self, f"{side}_axes"), _axes)
        for name, check in (
            ("leg_radius", arguments.size),
            ("length", arguments.size),
            ("maximum", check_positive),
        ):
            clean[name] = _checked(name, getattr(self, name), check)
        if self.ellipsoid is not None:
            check_type("limits.ellipsoid", self.ellipsoid, Ellipsoid)
        for name, value in clean.items():
            object.__setattr__(self, name, value)


def _checked(name: str, value: Any, check: Callable[[str, Any], Checked]) -> Checked | None:
    return None if value is None else check(f"limits.{name}", value)


def _texts(given: Any) -> tuple[str, ...]:
    wanted = 'texts such as "CTN >= 0.1"'
    if is_a(given, str):
        return (given,)
    if has(given, "keys"):  # a mapping or a table
        raise InvalidInput(expected("limits.indices", wanted, brief(given)))
    texts = check_items("limits.indices", given, wanted)
    return tuple(check_text("limits.indices", text) for text in texts)


def _pairs(what: str, value: Any) -> Array:
    """Bounds (n, 2), ∓inf for NaN."""
    pairs = arguments.bounded_array(what, value, (None, 2), finite=False)
    if pairs.ndim != 2:
        raise InvalidInput(expected(what, "shape (n, 2)", f"shape {pairs.shape}"))
    return frozen(open_bounds(pairs))


def _strokes(what: str, value: Any) -> Array:
    """Bounds (n, 2) of joints; equal ones are refused later, where they leave no region."""
    pairs = _pairs(what, value)
    names = [f"joint {k + 1}" for k in range(len(pairs))]
    check_bounds(pairs[:, 0], pairs[:, 1], names, equal=True)
    return pairs


def _intervals(what: str, value: Any) -> Array:
    """Bounds (3, 2) of positions, from pairs in which None stands for no bound."""
    wanted = "three pairs (least, greatest), None for no bound"
    rows = check_rows(what, value, wanted, 3)
    given = [(None, None) if row is None else check_rows(what, row, wanted, 2) for row in rows]
    bounds = _pairs(what, [[np.nan if x is None else x for x in pair] for pair in given])
    check_bounds(bounds[:, 0], bounds[:, 1], [one.name for one in position_quantities()])
    return bounds


def _cone(what: str, value: Any) -> Array:
    """Half-angles of cones, () or (n_legs,), NaN for none."""
    cone = check_array(what, value, (), finite=False)
    if cone.ndim > 1 or not cone.size:
        raise InvalidInput(expected(what, "one angle, or one per leg", f"shape {cone.shape}"))
    if not (np.isnan(cone) | (cone > 0.0) & (cone <= np.pi / 2.0)).all():
        hint = " (degrees? np.deg2rad converts them)" if (cone > np.pi / 2.0).any() else ""
        raise InvalidInput(
            expected(what, "angles in (0, π/2] [rad]", f"{brief(cone.tolist())}{hint}")
        )
    return frozen(cone)


def _axes(what: str, value: Any) -> Array:
    """Axes of cones, (n_legs, 3)."""
    axes = check_array(what, value, (None, 3))
    if axes.ndim != 2 or not (norm(axes) > 0.0).all():
        raise InvalidInput(expected(what, "one direction other than zero per leg", brief(value)))
    return frozen(axes)


def threshold(what: str, text: str) -> tuple[Index, float, float]:
    """Return index, least and greatest value of a text such as "λ >= 0.3"; `what` names it."""
    match = _THRESHOLD.match(check_text(what, text))
    try:
        value = float(match[3]) if match else np.nan
    except ValueError:
        value = np.nan
    if match is None or np.isnan(value):
        raise InvalidInput(expected(what, 'texts such as "CTN >= 0.1"', brief(text)))
    name = index_name(match[1])
    least = match[2] in (">=", "≥")
    return INDICES[name], value if least else -np.inf, np.inf if least else value
