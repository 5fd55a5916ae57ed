"""What limits of legs bound: angles from the axes of cones, distances, and drives at the base.

For cones and distances a leg is a segment from its base foot to its platform foot.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import combinations
from types import MappingProxyType
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array
from gsp.errors import InvalidInput, MissingParameter, brief, expected
from gsp.geometry.vectors import Array, cross, dot, norm
from gsp.model.design import Design
from gsp.model.drives import Crank, Slider
from gsp.model.posture import Posture
from gsp.model.rods import arm_axes

# Squared sine of the angle of two lines [1] up to which rounding decides where they are nearest,
# so that only ends of the segments are compared: an angle of 1e-7.
PARALLEL_SINE_SQUARED = 1e-14
# Sine of the least angle between the axis of a cone and the line of a C joint.
LEAST_CONE_SINE = 1e-9


def segment_distance(p: Array, u: Array, q: Array, v: Array) -> Array:
    """Distance of the segments p + [0, 1] u and q + [0, 1] v: (..., 3) to (...).

    The closest points of the lines if they lie on both segments, else the best of the four
    distances from an end to the other segment.
    """
    w = p - q
    a, b, c, d, e = dot(u, u), dot(u, v), dot(v, v), dot(u, w), dot(v, w)
    n = a * c - b * b
    with np.errstate(divide="ignore", invalid="ignore"):
        s, t = (b * e - c * d) / n, (a * e - b * d) / n
    crossing = (
        (n > PARALLEL_SINE_SQUARED * a * c) & (s >= 0.0) & (s <= 1.0) & (t >= 0.0) & (t <= 1.0)
    )
    s, t = np.where(crossing, s, 0.0), np.where(crossing, t, 0.0)
    middle = np.where(crossing, norm(w + s[..., None] * u - t[..., None] * v), np.inf)
    ends = (
        _to_segment(p, q, v),
        _to_segment(p + u, q, v),
        _to_segment(q, p, u),
        _to_segment(q + v, p, u),
    )
    return np.asarray(np.minimum.reduce([middle, *ends]))


def _to_segment(point: Array, start: Array, along: Array) -> Array:
    square = dot(along, along)
    share = dot(point - start, along) / np.where(square > 0.0, square, 1.0)
    return norm(point - start - np.clip(share, 0.0, 1.0)[..., None] * along)


def leg_pairs(design: Design) -> tuple[tuple[int, int], ...]:
    """Pairs of legs that can collide: those that do not meet in a common anchor point."""
    return tuple(
        (i, j) for i, j in combinations(range(design.n_legs), 2) if not _common_anchor(design, i, j)
    )


def _common_anchor(design: Design, i: int, j: int) -> bool:
    return bool(
        (design.base_points[i] == design.base_points[j]).all()
        or (design.platform_points[i] == design.platform_points[j]).all()
    )


def clearances(posture: Posture, pairs: tuple[tuple[int, int], ...]) -> Array:
    """Distances between the segments of pairs of legs, shape (..., number of pairs)."""
    start = posture.segments.base_feet
    along = posture.segments.along
    one, two = [i for i, _ in pairs], [j for _, j in pairs]
    return segment_distance(
        start[..., one, :], along[..., one, :], start[..., two, :], along[..., two, :]
    )


def all_cone_angles(sides: Sequence[tuple[str, Array]], posture: Posture) -> Array:
    """Return the angles from the axes of one side or both, side by side: (..., m)."""
    return np.concatenate([_cone_angles(posture, side, axes) for side, axes in sides], axis=-1)


def greatest_angles(what: str, cone: ArrayLike, n: int) -> Array:
    """Return the greatest angle of each leg: infinite for NaN, which stands for no cone."""
    angles = np.asarray(cone, dtype=np.float64)
    if angles.shape not in ((), (n,)):
        got = f"shape {angles.shape}"
        raise InvalidInput(expected(what, f"one angle, or {n}, one per leg", got))
    return np.broadcast_to(np.where(np.isnan(angles), np.inf, angles), (n,))


def _leg_directions(posture: Posture, side: str) -> Array:
    along = posture.segments.along
    if side == "platform":
        along = np.asarray(along @ posture.pose.rotation)
    return along


def _cone_angles(posture: Posture, side: str, axes: Array) -> Array:
    """Angles between legs and axes, accurate for small angles too: shape (..., n_legs)."""
    along = _leg_directions(posture, side)
    across = norm(cross(along, np.broadcast_to(axes, along.shape)))
    return np.arctan2(across, dot(along, axes))


def cone_axes(design: Design, side: str, given: ArrayLike | None) -> Array:
    """Return the axes of the cones on "base" or "platform": given, or those of the home pose.

    A leg stays perpendicular to the line of a C joint. So the angle from the given axis, projected
    onto the plane across the line, is the turn about the line.

    Parameters
    ----------
    design : Design
    side : "base" or "platform"
    given : (n_legs, 3) array_like or None

    Returns
    -------
    (n_legs, 3) array
        In the axes of that side, of any length.

    Raises
    ------
    MissingParameter
        If none are given and the design has no home pose.
    InvalidInput
        On a wrong shape, or an axis along the line of a C joint.
    """
    if given is not None:
        what = f"limits.{side}_axes"
        return _across_lines(design, side, what, check_array(what, given, (design.n_legs, 3)))
    if design.home is None:
        raise MissingParameter(
            f"limits.{side}_cone: expected {side}_axes, or a design with a home pose, received none"
        )
    axes = _leg_directions(design.at(design.home), side)
    return check_array(f"{side} axes from the home pose", axes, (design.n_legs, 3))


def _across_lines(design: Design, side: str, what: str, axes: Array) -> Array:
    lines = np.array([getattr(leg, f"{side}_line") for leg in design.legs])
    directions = getattr(design, f"{side}_directions")[lines]
    along = dot(axes[lines], directions)
    across = axes[lines] - along[:, None] * directions
    bad = norm(across) < LEAST_CONE_SINE * norm(axes[lines])
    if bad.any():
        i = int(np.flatnonzero(lines)[bad][0])
        wanted = "an axis that is not along the line of the leg, about which it turns"
        raise InvalidInput(expected(f"{what}[{i}]", wanted, brief(axes[i].tolist())))
    result = axes.copy()
    result[lines] = across
    return result


def crank_bounds(bounds: Array) -> Array:
    """Return bounds (n, 2) of angles of cranks that turn continuously [rad].

    The angle is in (−π, π], so a crank that turns beyond π has one near −π, which violates other
    bounds. Bounds that all angles satisfy become infinite.

    Parameters
    ----------
    bounds : (n, 2) array [rad]
        Least and greatest angles, ∓inf where there is none.
    """
    inner = np.clip(bounds, -np.pi, np.pi)
    limited = (inner[:, 0] > -np.pi) | (inner[:, 1] < np.pi)
    return np.where(limited[:, None], inner, [-np.inf, np.inf])


def reaches(design: Design, position: Array, rotation: Array) -> tuple[Array, Array]:
    """Return how far anchors are inside of what their drives reach, and the derivatives.

    With d from the base point to the anchor, in the notation of `gsp.model.rods`, these are
    (ℓ² − c²) / 2ℓ for a slider and (h² − C²) / 2 ℓ x² for a crank: positive where the two values of
    the drive are real and differ, and zero where the drive is singular. They are defined at all
    poses.

    Parameters
    ----------
    design : Design
    position, rotation : (3,) and (3, 3) arrays

    Returns
    -------
    values : (k,) array [length]
        Of the k legs that are driven at the base, in their order.
    rows : (k, 6) array [1, length]
        For the twist (v, ω).

    *Source: docs/drives.md; ours*
    """
    values: list[float] = []
    rows: list[Array] = []
    for leg, drive in enumerate(design.drives):
        if drive is None:
            continue
        arm = rotation @ design.platform_points[leg]
        d, s = position + arm - design.base_points[leg], design.base_directions[leg]
        value, slope = _REACHES[type(drive)](drive, d, s)
        values.append(value)
        rows.append(np.concatenate((slope, cross(arm, slope))))
    return np.array(values), np.array(rows).reshape(-1, 6)


def _of_slider(drive: Slider, d: Array, s: Array) -> tuple[float, Array]:
    across = d - (d @ s) * s
    return float(drive.rod**2 - across @ across) / (2.0 * drive.rod), -across / drive.rod


def _of_crank(drive: Crank, d: Array, s: Array) -> tuple[float, Array]:
    axial, x, _ = (np.array(vector) for vector in arm_axes(list(drive.arm), s.tolist()))
    d, square = d - axial, float(x @ x)
    across = d - (d @ s) * s
    level = 0.5 * (float(d @ d) + square - drive.rod**2)
    per = 1.0 / (2.0 * drive.rod * square)
    value = per * (square * float(across @ across) - level**2)
    return value, 2.0 * per * (square * across - level * d)


_REACHES: MappingProxyType[type[Any], Callable[..., tuple[float, Array]]] = MappingProxyType(
    {Slider: _of_slider, Crank: _of_crank}
)
