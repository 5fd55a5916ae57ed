"""The characteristic length, chosen in one of three ways."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal, get_args

import numpy as np

from gsp import arguments
from gsp.checks import check_positive, check_type
from gsp.errors import InvalidInput, MissingParameter, expected
from gsp.geometry.matrices import condition, singular_values
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import norm
from gsp.model.design import Design

Method = Literal["condition", "sphere", "anchors"]

# Two condition numbers are the same within SAME_CONDITION of each other; a minimum that is the
# same over more than FLAT_RANGE of ln L is an interval, while a parabola's is narrower.
SAME_CONDITION = 1e-12
FLAT_RANGE = 1e-4


@dataclass(frozen=True)
class CharacteristicLength:
    """A characteristic length, and how far the choice is unique.

    Attributes
    ----------
    length : float [unit of the design]
        The geometric mean of the interval where there is one.
    low, high : float [unit of the design]
        All lengths between them are as good; both are `length` where the choice is unique.
    condition_number : float or None [1]
        The mean of CDN_CL over the poses with it, for the method that minimises it.
    poses : int
        The number of poses that counted: defined and not singular ones.
    method : str
    """

    length: float
    low: float
    high: float
    condition_number: float | None
    poses: int
    method: str

    @property
    def unique(self) -> bool:
        """Whether only one length is best."""
        return self.low == self.high

    def __float__(self) -> float:
        return self.length


@arguments.validated(method=arguments.text)
def characteristic_length(
    design: Design,
    pose: Pose | None = None,
    method: Method = "condition",
    *,
    radius: float | None = None,
) -> CharacteristicLength:
    """Choose the length that makes the Jacobian of a design homogeneous.

    Parameters
    ----------
    design : Design
    pose : Pose, batch shape (...), or None
        For "condition": the poses over which the mean of the condition number is minimised;
        default the design's home.
    method : "condition", "sphere" or "anchors"
        "condition" minimises the condition number CDN_CL. ln CDN_CL is a convex function of ln L,
        so there is one minimum, at one length or over an interval, which is then given whole. Some
        designs have none (rows D4^3 A1^3): CDN_CL falls with every longer length.
        "sphere" is sqrt(2/3) × the radius of an operation sphere about the platform origin, which
        makes CDN_CL equal to CDN_OE. "anchors" is the root-mean-square distance of the platform
        anchors from the platform origin.
    radius : float or None [unit of the design]
        For "sphere"; default the radius of the design's operation ellipsoid, if it is a sphere
        about the platform origin.

    Returns
    -------
    CharacteristicLength

    Raises
    ------
    MissingParameter
        If there is neither a pose nor a home; or neither a radius nor an operation sphere.
    InvalidInput
        On wrong types; if no pose is defined and not singular, CDN_CL has no minimum over lengths,
        the method is unknown, the radius
        is not a positive number, or all anchors lie at the platform origin.

    Examples
    --------
    >>> from gsp.families import nawratil
    >>> design = nawratil.isotropic(3, p=1.0)
    >>> round(characteristic_length(design).length, 6)
    0.816497

    *Source: Nawratil, §2.1.1 (after Tandirci, Angeles and Ranjbaran) for "condition", the
    paragraph after Theorem 3 for "sphere"; "anchors" is ours. The mean over several poses and the
    interval are ours.*
    """
    check_type("design", design, Design)
    if pose is not None:
        check_type("pose", pose, Pose, "a gsp.Pose or None")
    if method not in get_args(Method):
        raise InvalidInput(expected("method", " or ".join(get_args(Method)), repr(method)))
    if method == "sphere":
        return _fixed(np.sqrt(2.0 / 3.0) * _sphere_radius(design, radius), method)
    if method == "anchors":
        squares = norm(design.platform_points) ** 2
        return _fixed(check_positive("radius of the anchors", np.sqrt(squares.mean())), method)
    poses = design.home if pose is None else pose
    if poses is None:
        raise MissingParameter("characteristic_length: expected a pose or a home, received none")
    return _of_least_condition(design, poses)


def _fixed(length: float, method: str) -> CharacteristicLength:
    value = float(length)
    return CharacteristicLength(value, value, value, None, 0, method)


def _sphere_radius(design: Design, radius: float | None) -> float:
    if radius is not None:
        return check_positive("radius", radius)
    e = design.ellipsoid
    if e is None or np.ptp(e.semi_axes) > 0.0 or e.center.any():
        got = "none" if e is None else "an ellipsoid that is not a sphere about the platform origin"
        raise MissingParameter(expected("characteristic_length", "a radius", got))
    return float(e.semi_axes[0])


def _of_least_condition(design: Design, pose: Pose) -> CharacteristicLength:
    poses = pose.reshape(pose.size)
    posture = design.at(poses)
    keep = posture.defined & ~posture.singular()
    if not keep.any():
        got = f"{pose.size} undefined or singular ones" if pose.size else "no poses"
        raise InvalidInput(expected("pose", "a pose that is neither undefined nor singular", got))
    regular, scale = design.at(poses[keep]), design.rms_radius

    def mean_condition(x: float) -> float:
        # Not by `singular_values`, which would keep those of every length that is tried.
        rows = regular.homogeneous(float(scale * np.exp(x)))
        return float(condition(singular_values(rows)).mean())

    low, middle, high, least = _flat_minimum(mean_condition)
    if low == -np.inf or high == np.inf:
        got = f"one where it falls toward a length of {0 if low == -np.inf else 'infinity'}"
        raise InvalidInput(expected("pose", "a pose where CDN_CL is least at some length", got))
    if high - low <= FLAT_RANGE:
        low = high = middle
    length, shortest, longest = (float(scale * np.exp(x)) for x in ((low + high) / 2.0, low, high))
    return CharacteristicLength(length, shortest, longest, least, int(keep.sum()), "condition")


def _flat_minimum(f: Callable[[float], float]) -> tuple[float, float, float, float]:
    """Return the ends of the minimum of a function whose logarithm is convex, its middle, and f."""
    from scipy.optimize import minimize_scalar

    reach = 2.0
    while min(f(-reach), f(reach)) <= f(0.0) * (1.0 + 1e-6) and reach < 64.0:
        reach *= 2.0
    with np.errstate(invalid="ignore"):  # infinite values far from the minimum
        best = minimize_scalar(
            f, bounds=(-reach, reach), method="bounded", options={"xatol": 1e-10, "maxiter": 500}
        )
    x, least = float(best.x), float(best.fun)

    def above(y: float) -> float:
        return f(y) / least - 1.0 - SAME_CONDITION

    low, high = (_crossing(above, x, end) for end in (-reach, reach))
    return low, x, high, least


def _crossing(above: Callable[[float], float], inside: float, outside: float) -> float:
    """Return where a function becomes positive between two numbers; ±inf if it does not."""
    from scipy.optimize import brentq

    if above(inside) >= 0.0:
        return inside
    if above(outside) <= 0.0:
        return float(np.copysign(np.inf, outside))
    return float(brentq(above, inside, outside, xtol=1e-12))
