"""Quantities of §3 of `Nawratil`: values of its figures 2–7, and statements about its indices."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike
from scipy.optimize import minimize_scalar

from gsp.errors import InvalidInput, expected
from gsp.families import nawratil as family
from gsp.families.nawratil.motion import (
    INTERVALS,
    Axis,
    compare_screws,
    singular_angle,
    turned,
)
from gsp.geometry.matrices import singular_values
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.indices import (
    INDICES,
    complex_deviation_translation,
    rigidity_rate,
)
from gsp.indices.motion import instantaneous_motion
from gsp.model.posture import Posture

# Angles of an interval that are evaluated; none of them is the singular one.
FIGURE_SAMPLES = 2000
# Rates of a motion below this share of the best are 0, and a rigidity rate that changes by more
# than CHANGED_ANGLE [rad] is another one. The posture is K+ turned by FIGURE_TURN [rad] about the
# x-axis, and anchors are moved by the share SLIDE of the leg.
ZERO_RATE, CHANGED_ANGLE, FIGURE_TURN, SLIDE = 1e-10, 1e-3, 0.5, 0.3


def _posture(alpha: float, h: float) -> Posture:
    return family.example_design(alpha).at(family.example_pose(h))


def singular_postures(alpha_deg: float, h: float) -> int:
    """1 for a singular posture of the example set, 0 for another."""
    return int(_posture(np.deg2rad(alpha_deg), h).singular())


def rigidity(alpha_deg: float, h: float) -> float:
    """Rigidity rate [rad] in the example set."""
    return float(rigidity_rate(_posture(np.deg2rad(alpha_deg), h)))


def rigidity_depends_on(change: str) -> int:
    """1 if the rigidity rate of a general posture is another one after a change, 0 if not.

    "base" and "platform" move the anchors of a body along the legs; "exchange" exchanges the
    bodies.
    """
    posture = turned("x", FIGURE_TURN)
    design, pose = posture.design, posture.pose
    legs = pose.position + posture.lines.arm - design.base_points
    other = {
        "base": design.replace(base_points=design.base_points + SLIDE * legs),
        "platform": design.replace(
            platform_points=design.platform_points + SLIDE * legs @ pose.rotation
        ),
        "exchange": design.exchanged(),
    }
    if change not in other:
        raise InvalidInput(expected("change", "one of " + ", ".join(other), repr(change)))
    there = other[change].at(pose.inverse() if change == "exchange" else pose)
    return int(abs(float(rigidity_rate(there) - rigidity_rate(posture))) > CHANGED_ANGLE)


def infinite_eigenvalues(alpha_deg: float, h: float) -> int:
    """Count the infinite eigenvalues of T with respect to N in the example set."""
    rates = instantaneous_motion(_posture(np.deg2rad(alpha_deg), h), length=1.0).rates
    return int((rates <= ZERO_RATE * rates.max()).sum())


def defect(alpha_deg: float, h: float) -> int:
    """6 − rank J in the example set."""
    values = singular_values(_posture(np.deg2rad(alpha_deg), h).homogeneous(1.0))
    return int((values <= ZERO_RATE * values.max()).sum())


def _best_height(index: Callable[[Posture], Array], alpha: float) -> tuple[float, float]:
    found = minimize_scalar(
        lambda x: -float(index(_posture(alpha, float(np.exp(x))))),
        bounds=(-6.0, 2.0),
        method="bounded",
        options={"xatol": 1e-9},
    )
    return float(np.exp(found.x)), -float(found.fun)


def growth_of_the_best(index: str, alpha_deg: float, next_deg: float) -> int:
    """1 if the best of an index over h is greater at the second α, and at a lower h; else 0."""
    if index not in INDICES:
        raise InvalidInput(expected("index", "one of " + ", ".join(INDICES), repr(index)))
    (h, value), (next_h, next_value) = (
        _best_height(INDICES[index].function, np.deg2rad(a)) for a in (alpha_deg, next_deg)
    )
    return int(next_value > value and next_h < h)


def best_translation_deviation(alpha_deg: float) -> float:
    """Greatest σ_t over the heights of one α."""
    return _best_height(complex_deviation_translation, float(np.deg2rad(alpha_deg)))[1]


def length_exponent(index: str) -> float:
    """Power of the length with which an index of K+ changes in a similarity."""
    posture, factor = _posture(family.BEST_ALPHA, family.BEST_H), 10.0
    bigger = posture.design.scaled(factor).at(
        Pose(posture.pose.position * factor, posture.pose.rotation)
    )
    function = INDICES[index].function
    return float(np.log10(function(bigger) / function(posture)))


def singular_turn(axis: str) -> float:
    """Return γ ("x") or δ ("y") of the singular posture inside the interval of the source."""
    return singular_angle(_axis(axis))


def _axis(axis: str) -> Axis:
    if axis == "x":
        return "x"
    if axis == "y":
        return "y"
    raise InvalidInput(expected("axis", '"x" or "y"', repr(axis)))


def singular_pitch(axis: str) -> float:
    """Absolute pitch of the uncontrolled motion at the singular posture."""
    name = _axis(axis)
    return float(abs(instantaneous_motion(turned(name, singular_angle(name))).pitch))


def tilt_of_singular_axis(axis: str) -> float:
    """Sine of the angle between the axis of that motion and the coordinate axis."""
    name = _axis(axis)
    direction = instantaneous_motion(turned(name, singular_angle(name))).axis[:3]
    return float(np.linalg.norm(np.delete(direction, "xy".index(name))))


def _interval(axis: str) -> Array:
    low, high = INTERVALS[_axis(axis)]
    return low + (high - low) * (np.arange(FIGURE_SAMPLES) + 0.5) / FIGURE_SAMPLES


def greatest_pitch(axis: str) -> float:
    """Greatest absolute pitch of both methods over the interval."""
    table = compare_screws(_axis(axis), _interval(axis))
    return float(np.abs(table[["pitch_c", "pitch_p"]].to_numpy()).max())


def greatest_tilt(axis: str) -> float:
    """Greatest angle [rad] between the axes of both methods and that of the singular posture."""
    table = compare_screws(_axis(axis), _interval(axis))
    return float(table[["angle_c", "angle_p"]].to_numpy().max())


def share_where_better(axis: str, criterion: str) -> float:
    """Share [%] of the interval where the control number gives the better screw than Pottmann's.

    The criterion is "distance", "angle" or "pitch_error".
    """
    table = compare_screws(_axis(axis), _interval(axis))
    if f"{criterion}_c" not in table:
        raise InvalidInput(expected("criterion", "distance, angle, pitch_error", criterion))
    return float(100.0 * (table[f"{criterion}_c"] < table[f"{criterion}_p"]).mean())


QUANTITIES: Mapping[str, Callable[..., ArrayLike]] = MappingProxyType(
    {
        "singular_postures": singular_postures,
        "rigidity": rigidity,
        "rigidity_depends_on": rigidity_depends_on,
        "infinite_eigenvalues": infinite_eigenvalues,
        "defect": defect,
        "growth_of_the_best": growth_of_the_best,
        "best_translation_deviation": best_translation_deviation,
        "length_exponent": length_exponent,
        "singular_turn": singular_turn,
        "singular_pitch": singular_pitch,
        "tilt_of_singular_axis": tilt_of_singular_axis,
        "greatest_pitch": greatest_pitch,
        "greatest_tilt": greatest_tilt,
        "share_where_better": share_where_better,
    }
)
