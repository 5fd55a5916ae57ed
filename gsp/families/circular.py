"""Hexapods with anchors in pairs on two circles: five numbers define the design."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.errors import InvalidInput, apart, brief, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design

ARRANGEMENTS = ("pairs", "zigzag")
# Pairs are 120° apart: at this angle the anchors of neighbouring pairs coincide.
LARGEST_PAIR_ANGLE_DEG = 120.0
LARGEST_PAIR_ANGLE = 2.0 * np.pi / 3.0
# Directions of the pairs of the base, at 0°, 120° and 240°.
PAIR_DIRECTIONS = np.array([[1.0, 0.0], [-0.5, 0.75**0.5], [-0.5, -(0.75**0.5)]])


@arguments.validated(
    base_radius=arguments.size,
    platform_radius=arguments.size,
    height=arguments.size,
    arrangement=arguments.one_of(*ARRANGEMENTS),
    degrees=arguments.flag,
)
def hexapod(
    base_radius: float,
    base_angle: float,
    platform_radius: float,
    platform_angle: float,
    height: float,
    *,
    arrangement: str = "pairs",
    degrees: bool = False,
    strokes: ArrayLike | None = None,
    unit: str = "",
    name: str = "hexapod",
) -> Design:
    """Return a design of six legs with constraint D1 (SPS), with anchors in pairs on two circles.

    Base and platform have three pairs of anchors each, 120° apart, in the planes z = 0 of their
    axes; the origins are the centres of the circles. The angles of the six anchors, with β and α
    for the angles of the pairs of base and platform, are::

        leg                  1            2          3            4          5            6
        base               −β/2         +β/2    120°−β/2     120°+β/2    240°−β/2     240°+β/2
        platform, pairs   −60°+α/2   60°−α/2     60°+α/2    180°−α/2    180°+α/2    300°−α/2
        platform, zigzag   −α/2         +α/2    120°−α/2     120°+α/2    240°−α/2     240°+α/2

    "pairs": the pairs of the platform are between those of the base, and a leg joins each base
    anchor to the nearest platform anchor of the neighbouring pair. 0 and 0 is the octahedral 3-3,
    0 on one side a 3-6, and 60° a regular hexagon.

    "zigzag": the pairs of the platform are above those of the base, and leg i joins anchor i to
    anchor i, so that legs lean to the left and to the right in turn. Angles α, β of this
    arrangement give the design of "pairs" with the angles 120° − α, β: "pairs" describes both
    bodies by the anchors that are close to each other, "zigzag" by the two legs of one pair.

    The design is singular in every pose where both hexagons are similar: "pairs" with angles that
    add up to 120°, "zigzag" with equal angles.

    Parameters
    ----------
    base_radius, platform_radius : float [unit]
        Radii of the circles, > 0.
    base_angle, platform_angle : float [rad]
        Angle between the two anchors of a pair, seen from the centre of the circle, in
        [0, 2π/3]; in degrees, in [0, 120], with `degrees`.
    height : float [unit]
        Of the platform above the base in the home pose, which is not turned; > 0.
    arrangement : "pairs" or "zigzag"
    degrees : bool
        Whether the angles are in degrees.
    strokes : (2,) or (6, 2) array_like or None [unit]
        Least and greatest length ≥ 0, of all legs or of each; NaN for no limit.
    unit, name : str
        Of the design.

    Returns
    -------
    Design
        With the home pose at that height.

    Raises
    ------
    InvalidInput
        On radii or a height ≤ 0, and angles outside of their interval.
    InvalidDesign
        On strokes of which the least value exceeds the greatest.

    Examples
    --------
    >>> import gsp
    >>> lift = gsp.hexapod(2.0, 20.0, 1.0, 20.0, 1.5, degrees=True, unit="m")
    >>> lift.at(lift.home).joints.round(3)
    array([2.046, 2.046, 2.046, 2.046, 2.046, 2.046])

    *Source: none; the anchors are those of the table above.*
    """
    beta = _angle("base_angle", base_angle, degrees)
    alpha = _angle("platform_angle", platform_angle, degrees)
    base = _anchors(base_radius, beta, PAIR_DIRECTIONS)
    if arrangement == "pairs":
        # At 60°, 180° and 300°. The first leg ends at the last of their anchors, 300° + α/2.
        between = -PAIR_DIRECTIONS[[2, 0, 1]]
        platform = _anchors(platform_radius, alpha, between)[[5, 0, 1, 2, 3, 4]]
    else:
        platform = _anchors(platform_radius, alpha, PAIR_DIRECTIONS)
    return Design(
        ["D1"] * 6,
        base,
        platform,
        unit=unit,
        name=name,
        strokes=_strokes(strokes),
        home=Pose([0.0, 0.0, height]),
    )


def _angle(what: str, value: Any, degrees: bool) -> float:
    """Return the angle of a pair in radians, or raise InvalidInput."""
    angle = arguments.number(what, value)
    largest = LARGEST_PAIR_ANGLE_DEG if degrees else LARGEST_PAIR_ANGLE
    if not 0.0 <= angle <= largest:
        wanted = "an angle in [0, 120] degrees" if degrees else "an angle in [0, 2π/3] rad"
        hint = not degrees and LARGEST_PAIR_ANGLE < angle <= LARGEST_PAIR_ANGLE_DEG
        got = apart(angle, largest)[0]
        got += "; angles in degrees need degrees=True" if hint else ""
        raise InvalidInput(expected(what, wanted, got))
    return float(np.deg2rad(angle)) if degrees else angle


def _anchors(radius: float, angle: float, axes: Array) -> Array:
    """Return three pairs of points of a circle, each about one of three axes: (6, 3).

    The anchors of a pair are equal, not only close, where the angle is 0.
    """
    across = axes[:, ::-1] * (-1.0, 1.0)
    cosine, sine = np.cos(0.5 * angle), np.sin(0.5 * angle)
    points = np.zeros((3, 2, 3))
    points[:, 0, :2] = cosine * axes - sine * across
    points[:, 1, :2] = cosine * axes + sine * across
    return radius * points.reshape(6, 3)


def _strokes(value: ArrayLike | None) -> Array | None:
    """Return the strokes of six legs: one pair of numbers holds for all of them."""
    if value is None:
        return None
    limits = arguments.bounded_array("strokes", value, (2,), finite=False)
    if limits.shape not in ((2,), (6, 2)):
        raise InvalidInput(expected("strokes", "shape (2,) or (6, 2)", brief(limits.shape)))
    return np.broadcast_to(limits, (6, 2))
