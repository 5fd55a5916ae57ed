"""The formulas of legs of fixed length that are driven at the base, by a slider or a crank.

A rod of fixed length ℓ joins a tip, which the drive moves, to the platform anchor. With the vector
ℓ n from tip to anchor, the condition |ℓ n| = ℓ differentiated is

    n · (v + ω × r) = (n · ∂tip/∂q) q̇,

so the row of the joint value q is that of a distance along n, over the scale n · ∂tip/∂q. The two
values of q at a pose differ in the sign of this scale, the branch. Where the scale is zero the
drive is singular: its rate has no bound. It is the first kind of singularity of Gosselin and
Angeles (1990), IEEE Trans. Robotics Autom. 6.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from gsp.geometry.scalars import (
    Scalar,
    Vector,
    choose,
    cross,
    dot,
    full_arc,
    less,
    minus,
    norm,
    plus,
    root,
    times,
)
from gsp.geometry.vectors import Array
from gsp.model.drives import Crank, Slider
from gsp.model.formulas import (
    ZERO,
    PassiveRate,
    Placement,
    Segment,
    line_row,
    normals,
    spin_row,
)

UNBOUNDED = float("inf")


class Driven(NamedTuple):
    """What a drive adds to the segment of its rod.

    Attributes
    ----------
    joint : scalar [length, rad]
        Travel of the slider, or angle of the crank in (−π, π].
    slope : three scalars [1, length]
        Velocity of the tip per rate of the joint, ∂tip/∂q.
    spin : three scalars [0, 1]
        Angular velocity of the tip's body per rate of the joint: zero, or the axis.
    scale : scalar [1, length]
        n · ∂tip/∂q.
    regular : condition
        False where the scale is zero up to rounding.
    """

    joint: Scalar
    slope: Vector
    spin: Vector
    scale: Scalar
    regular: Any


def slider(at: Placement) -> Segment:
    """Return the rod of a leg with a slider: from its tip on the rail to the anchor.

    With c = (d × s) × s, from the anchor to its foot on the rail, q = s·d − b sqrt(ℓ² − c²), where
    b is the branch, and the tip is a + q s.

    *Source: docs/drives.md; ours*
    """
    # Lists of components: a dual number times an array of them would be neither.
    s, (rod, branch) = list(at.s), at.drive
    across = cross(s, cross(at.d, s))
    gap, regular, defined = _gap(norm(across), rod, ZERO * (at.scale + rod))
    joint = dot(at.d, s) - branch * gap
    rod_vector = plus(across, times(branch * gap, s))
    driven = Driven(joint, s, [0.0, 0.0, 0.0], branch * gap / rod, regular)
    return _rod(at, rod_vector, rod, defined, driven)


def crank(at: Placement) -> Segment:
    """Return the rod of a leg with a crank: from the tip of the crank to the platform anchor.

    With the arm x across the axis and y = s × x, the tip is x cos q + y sin q. So X cos q +
    Y sin q = C with X = d·x, Y = d·y, C = (d² + x² − ℓ²)/2, and q is the angle of (X, Y) less
    b arccos(C/h), where h = sqrt(X² + Y²) and b is the branch.

    *Source: docs/drives.md; ours*
    """
    s, (rod, branch, *arm) = list(at.s), at.drive
    axial, x, y = arm_axes(arm, s)
    d = minus(at.d, axial)
    along, aside = dot(d, x), dot(d, y)
    square = dot(x, x)
    total = dot(d, d) + square - rod * rod
    level = total * 0.5
    radius = norm([along, aside])
    rounding = ZERO * (at.scale * (norm(x) + norm(d)) + square + rod * rod)
    gap, regular, defined = _gap(choose(less(level, 0.0), -level, level), radius, rounding)
    # On the axis no angle differs from another.
    defined = less(0.0, choose(less(rounding, radius), choose(defined, 1.0, 0.0), 0.0))
    turn = branch * gap
    sine, cosine = aside * level - turn * along, along * level + turn * aside
    joint = full_arc(sine, cosine)
    per = 1.0 / (radius * radius)
    sine, cosine = sine * per, cosine * per
    tip, slope = turned_arm(x, y, cosine, sine)
    driven = Driven(joint, slope, s, turn / rod, regular)
    return _rod(at, minus(d, tip), rod, defined, driven)


def arm_axes(arm: Vector, s: Vector) -> tuple[Vector, Vector, Vector]:
    """Return the part of an arm along its axis s, the part x across it, and y = s × x [length]."""
    axial = times(dot(arm, s), s)
    x = minus(arm, axial)
    return axial, x, cross(s, x)


def turned_arm(x: Any, y: Any, cosine: Any, sine: Any) -> tuple[Any, Any]:
    """Return x cos q + y sin q, and its derivative by q; both as `plus` returns them."""
    return (
        plus(times(cosine, x), times(sine, y)),
        minus(times(cosine, y), times(sine, x)),
    )


def _gap(low: Scalar, high: Scalar, rounding: Scalar) -> tuple[Scalar, object, object]:
    """Return sqrt(high² − low²), whether it is more than rounding, and whether it is real."""
    margin = high - low
    regular = less(rounding, margin)
    gap = root(choose(regular, margin * (high + low), 0.0 * margin))
    return gap, regular, less(-rounding, margin)


def _rod(at: Placement, vector: Vector, rod: Scalar, defined: object, driven: Driven) -> Segment:
    return Segment(at.s, [], times(1.0 / rod, vector), rod, at.arm, defined, driven=driven)


def joint_value(segment: Segment) -> Scalar:
    """Value of a driven leg: travel [length] or angle [rad].

    *Source: docs/drives.md; ours*
    """
    return segment.driven.joint


def driven_row(segment: Segment, weight: Scalar) -> Vector:
    """Row of a driven leg: the gradient of its joint value for the twist (v, ω), six scalars.

    All of them are infinite where the drive is singular.

    Parameters
    ----------
    segment : Segment
    weight : scalar
        1.0 for a rate in rad; a length L for the speed L q̇ that the rate of a crank counts as.

    *Source: docs/drives.md; ours*
    """
    driven = segment.driven
    per_scale = weight / driven.scale
    row = line_row(segment.direction, segment.arm)
    return [choose(driven.regular, per_scale * x, UNBOUNDED) for x in row]


def slider_row(segment: Segment, weight: Scalar) -> Vector:
    """Row of a leg with a slider, whose travel is a length: `weight` is not used.

    *Source: docs/drives.md; ours*
    """
    return driven_row(segment, 1.0)


def driven_rates(segment: Segment, length: Scalar) -> list[PassiveRate]:
    """Passive rates of a driven leg: two turns of its rod seen from the tip's body and platform.

    The tip's body is the carriage or the crank. `length` is not used.

    *Source: ours, after Nawratil, eqs. (18)–(20)*
    """
    driven, u, rates = segment.driven, segment.direction, []
    joint = driven_row(segment, 1.0)
    per_length = 1.0 / segment.length
    for e in normals(u):
        tip = minus(line_row(e, segment.arm), times(dot(e, driven.slope), joint))
        rate = times(per_length, tip)
        turned = cross(u, e)
        base = minus(rate, times(dot(turned, driven.spin), joint))
        rates += [PassiveRate("base", base)]
        rates += [PassiveRate("platform", minus(rate, spin_row(turned)))]
    return rates


def tip_of_slider(drive: Slider, point: Array, line: Array, joint: float) -> tuple[Array, Array]:
    """Return the tip (3,) at a travel, and its velocity per rate of the joint.

    Parameters
    ----------
    drive : Slider
    point, line : (3,) arrays [length, 1]
        Base point and unit base direction of the leg.
    joint : float [length]
    """
    return point + joint * line, line


def tip_of_crank(drive: Crank, point: Array, line: Array, joint: float) -> tuple[Array, Array]:
    """Return the tip (3,) at an angle, and its velocity per rate of the joint.

    Parameters
    ----------
    drive : Crank
    point, line : (3,) arrays [length, 1]
        Base point and unit base direction of the leg.
    joint : float [rad]
    """
    axial, x, y = arm_axes(list(drive.arm), line.tolist())
    arm, slope = turned_arm(x, y, math.cos(joint), math.sin(joint))
    return point + np.array(plus(axial, arm)), np.array(slope)


def share_of_carriage(drive: Slider, line: Array, distance: float) -> float:
    """Return the velocity of a carriage over that of its tip: 1, whatever its centre.

    Parameters
    ----------
    drive : Slider
    line : (3,) array [1]
        Unit base direction of the leg; not used.
    distance : float [length]
        Not used.
    """
    return 1.0


def share_of_crank(drive: Crank, line: Array, distance: float) -> float:
    """Return the velocity of a point of a crank over that of its tip.

    Parameters
    ----------
    drive : Crank
    line : (3,) array [1]
        Unit base direction of the leg.
    distance : float [length]
        Of the point from the axis, towards the tip.
    """
    _, x, _ = arm_axes(list(drive.arm), line.tolist())
    return distance / float(norm(x))


TIPS: MappingProxyType[type[Any], Callable[..., tuple[Array, Array]]] = MappingProxyType(
    {Slider: tip_of_slider, Crank: tip_of_crank}
)
SHARES: MappingProxyType[type[Any], Callable[..., float]] = MappingProxyType(
    {Slider: share_of_carriage, Crank: share_of_crank}
)
