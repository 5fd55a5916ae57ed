"""Weights of platform, payload and legs, and the actuator forces that hold them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.arguments import bounded_array
from gsp.checks import check_type
from gsp.errors import InvalidInput, apart, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.frames.changes import about_point
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.model.posture.assembly import Part
from gsp.model.posture.derivatives import moving_parts
from gsp.model.rods import SHARES

# Acceleration of free fall [m/s²], along −z.
GRAVITY = (0.0, 0.0, -9.81)


@dataclass(frozen=True, init=False, eq=False)
class Masses(ReadOnly):
    """Masses of the bodies of a mechanism, and where their centres are.

    Each leg has a lower link that ends in the joint on the base, and an upper one that ends in the
    joint on the platform. Their centres are on the line between the two feet of the leg. Of a leg
    that is driven at the base they are its carriage or crank, and its rod.

    Parameters
    ----------
    platform : float [kg]
        Of the platform with all that is fixed to it, ≥ 0.
    centre : (3,) array_like [unit of the design]
        Centre of that mass, in platform axes.
    lower, upper : float or (n_legs,) array_like [kg]
        Of the links of the legs, ≥ 0.
    lower_centre, upper_centre : float or (n_legs,) array_like [unit of the design]
        Distance of the centre of a lower link from the base foot, towards the platform foot, and of
        an upper link from the platform foot, towards the base foot. Of a crank the distance from
        its axis, towards its tip, negative for a counterweight; of a carriage it is not used.

    Raises
    ------
    InvalidInput
        On other types or shapes, negative masses, or numbers beyond 1e100.

    Examples
    --------
    >>> Masses(platform=10.0).carrying(5.0, [0.0, 0.0, 0.3]).centre
    array([0. , 0. , 0.1])
    """

    platform: float
    centre: Array
    lower: Array
    lower_centre: Array
    upper: Array
    upper_centre: Array

    def __init__(
        self,
        platform: float = 0.0,
        centre: ArrayLike = (0.0, 0.0, 0.0),
        lower: ArrayLike = 0.0,
        lower_centre: ArrayLike = 0.0,
        upper: ArrayLike = 0.0,
        upper_centre: ArrayLike = 0.0,
    ) -> None:
        numbers = {
            "lower": lower,
            "lower_centre": lower_centre,
            "upper": upper,
            "upper_centre": upper_centre,
        }
        object.__setattr__(self, "platform", _mass("masses.platform", platform))
        object.__setattr__(self, "centre", _vector("masses.centre", centre))
        for name, value in numbers.items():
            given = np.array(bounded_array(f"masses.{name}", value, ()))
            if given.ndim > 1:
                wanted = "one number, or shape (n_legs,)"
                raise InvalidInput(expected(f"masses.{name}", wanted, f"shape {given.shape}"))
            if name in ("lower", "upper") and given.min(initial=0.0) < 0.0:
                raise InvalidInput(expected(f"masses.{name}", "numbers ≥ 0", f"{given.min():g}"))
            given.flags.writeable = False
            object.__setattr__(self, name, given)

    def carrying(self, mass: float, centre: ArrayLike = (0.0, 0.0, 0.0)) -> Masses:
        """Return these masses with a payload on the platform.

        Parameters
        ----------
        mass : float [kg]
            ≥ 0.
        centre : (3,) array_like [unit of the design]
            Its centre, in platform axes.

        Raises
        ------
        InvalidInput
            On other types or shapes, or a negative mass.

        *Source: the centre of mass of two bodies.*
        """
        payload, at = _mass("mass", mass), _vector("centre", centre)
        total = self.platform + payload
        share = payload / total if total > 0.0 else 0.0
        middle = (1.0 - share) * self.centre + share * at
        legs = (self.lower, self.lower_centre, self.upper, self.upper_centre)
        return Masses(total, middle, *legs)


def _of_legs(masses: Masses, n_legs: int) -> dict[str, Array]:
    """Return the numbers of the links as arrays of shape (n_legs,), by name."""
    found = {}
    for name in ("lower", "lower_centre", "upper", "upper_centre"):
        value = getattr(masses, name)
        if value.ndim and len(value) != n_legs:
            wanted = f"one number, or {n_legs}"
            raise InvalidInput(expected(f"masses.{name}", wanted, f"{len(value)}"))
        found[name] = np.broadcast_to(value, n_legs)
    return found


def _mass(what: str, value: float) -> float:
    number = arguments.number(what, value)
    if not 0.0 <= number <= arguments.LARGEST_NUMBER:
        got, most = apart(number, arguments.LARGEST_NUMBER)
        raise InvalidInput(expected(what, f"a number from 0 to {most}", got))
    return float(number)


def _vector(what: str, value: ArrayLike) -> Array:
    given = np.array(bounded_array(what, value, ()))
    if given.shape != (3,):
        raise InvalidInput(expected(what, "three numbers, shape (3,)", f"shape {given.shape}"))
    given.flags.writeable = False
    return given


def gravity_wrench(
    design: Design, pose: Pose, masses: Masses, gravity: ArrayLike = GRAVITY
) -> Array:
    """Return the wrench on the platform that does the same work as all weights.

    The weights of the links of the legs count by virtual work: the wrench is the derivative of the
    work of all weights along (v, ω), by the derivatives of the formulas of the legs. A carriage or
    crank moves with the tip of its rod, a point of a crank by its share of the distance from the
    axis.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape (...) [unit of the design]
    masses : Masses
    gravity : (3,) array_like [m/s²]
        Acceleration of free fall, in base axes.

    Returns
    -------
    (..., 6) array [N, N · unit of the design]
        About the platform origin, in base axes. NaN where a leg with mass is undefined, or its
        drive at the base is singular.

    Raises
    ------
    InvalidInput
        On other types or shapes.

    *Source: the principle of virtual work; ours.*

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> gravity_wrench(d, d.home, Masses(platform=2.0)).round(9) + 0.0
    array([  0.  ,   0.  , -19.62,   0.  ,   0.  ,   0.  ])
    """
    check_type("design", design, Design)
    check_type("pose", pose, Pose)
    check_type("masses", masses, Masses, "a gsp.statics.Masses")
    down, legs = _vector("gravity", gravity), _of_legs(masses, design.n_legs)
    weight = masses.platform * down
    # From the centre of mass to the platform origin.
    arm = -(pose.rotation @ masses.centre)
    wrench = about_point(np.concatenate((weight, np.zeros(3))), arm)
    if not (legs["lower"].any() or legs["upper"].any()):
        return wrench
    result = np.array(wrench.reshape(-1, 6))
    for p, part in moving_parts(design.groups, pose.position, pose.rotation):
        own = {name: value[part.group.legs, None] for name, value in legs.items()}
        for mass, distance, share in (
            (own["upper"], own["upper_centre"], 1.0),
            (own["lower"], *_lower_link(design, part, own["lower_centre"])),
        ):
            with np.errstate(all="ignore"):
                slopes = _slopes(down, p, part.segment, distance) * share * mass
            slopes = np.where(_without_slopes(part), np.nan, slopes)
            result[part.poses] += np.where(mass > 0.0, slopes, 0.0).sum(axis=1).T
    return result.reshape(wrench.shape)


def _lower_link(design: Design, part: Part, centre: Array) -> tuple[Any, Any]:
    """Return a point of a group of legs, and the velocity of their lower links over its velocity.

    The point is given by its distance from the platform foot.
    """
    length = part.segment.length
    legs = np.arange(design.n_legs)[part.group.legs]
    drives = [design.drives[i] for i in legs]
    shares = [
        SHARES[type(drive)](drive, design.base_directions[i], float(distance))
        for drive, i, distance in zip(drives, legs, centre[:, 0], strict=True)
        if drive is not None
    ]
    if not shares:
        return length - centre, 1.0
    return length, np.array(shares)[:, None]


def _without_slopes(part: Part) -> Any:
    """Return where points of legs have no derivatives: (k, poses), or False for nowhere."""
    undefined = False if part.undefined is None else part.undefined
    driven = part.segment.driven
    return undefined if driven is None else undefined | ~np.asarray(driven.regular)


def _slopes(down: Array, p: Any, segment: Any, distance: Any) -> Array:
    """Return the derivatives of gravity times a point of the leg, axes (twist, leg, pose).

    The point is at a distance from the platform foot, towards the base foot.
    """
    heights = [
        g * (x + arm - distance * u)
        for g, x, arm, u in zip(down, p, segment.arm, segment.direction, strict=True)
    ]
    return np.asarray(sum(height.slope for height in heights))


def holding_forces(
    design: Design, pose: Pose, masses: Masses, gravity: ArrayLike = GRAVITY
) -> Array:
    """Return the actuator forces that hold all weights at rest.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape (...) [unit of the design]
    masses : Masses
    gravity : (3,) array_like [m/s²]
        Acceleration of free fall, in base axes.

    Returns
    -------
    (..., n) array [N; N · unit of the design for A1 actuators]
        Positive where an actuator pushes its joint value up. Of redundant designs the forces with
        the least sum of squares (see `Posture.actuator_forces`). NaN where the posture is undefined
        or singular.

    Raises
    ------
    InvalidInput
        On other types or shapes.

    *Source: ours; the forces balance `gravity_wrench`.*

    Examples
    --------
    >>> import gsp
    >>> d = gsp.hexapod(1.0, 0.4, 0.6, 0.4, 1.2)
    >>> forces = holding_forces(d, d.home, Masses(platform=60.0))
    >>> round(float(forces[0] * 6 * 1.2 / d.at(d.home).joints[0]), 9) == 60 * 9.81
    True
    """
    wrench = gravity_wrench(design, pose, masses, gravity)
    return design.at(pose).actuator_forces(wrench)
