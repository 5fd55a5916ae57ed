"""How far a platform can go along a direction."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_positive, check_type
from gsp.errors import InvalidInput, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.kinematics.newton import reference
from gsp.kinematics.newton.centred import Centred, centred
from gsp.kinematics.newton.control import PROVEN_SHARE
from gsp.kinematics.newton.stages import bend
from gsp.kinematics.travel_paths import TravelPath
from gsp.limits.legs import crank_bounds
from gsp.model.design import Design
from gsp.model.design.checks import check_strokes, open_strokes

# Shortest step, in sizes of the design and rad. Where the limit is crossed, not only touched,
# the result is below the exact one by at most this.
SHORTEST_TRAVEL_STEP = 1e-9
# Least and greatest number that the largest component of a direction may be.
DIRECTION = (1e-100, 1e100)
# By how much a value may pass its bound, in the same units, to count as on it.
ON_BOUND = 1e-12


@dataclass(frozen=True, eq=False, kw_only=True)
class Travel(ReadOnly):
    """Result of `travel`.

    Attributes
    ----------
    distance : float [1]
        Factor of the direction; to its end no limit is violated.
    limit : str
        What ends it: a joint and its bound ("d3 = 140"), a joint and why its drive at the base is
        singular ("d3: the rod is perpendicular to the rail"), "singular" (det J = 0 or an undefined
        leg), or "" if nothing does up to `farthest`.
    pose : Pose of batch shape ()
        At the end.
    farthest : float [1]
        Greatest factor, up to which limits were searched: the argument or its default.
    """

    distance: float
    limit: str
    pose: Pose
    farthest: float


def travel(
    design: Design,
    pose: Pose,
    direction: ArrayLike,
    *,
    strokes: ArrayLike | None = None,
    farthest: float | None = None,
) -> Travel:
    """Return how far a platform can go along a direction, and which limit ends it.

    The platform origin moves by s v and the platform turns by exp(s ω×), as in `Pose.moved`. The
    path is divided into steps. On each the joint values are bounded by their values, rates and
    second derivatives (those of `gsp.variation`), and det J ≠ 0 is proven as in `gsp.forward`; a
    step on which a limit might be violated is halved, down to 1e-9 of the size of the design or
    rad. So no limit is violated up to `distance`, but for rounding of 1e-12 of the size; and
    the stroke that is named is violated beyond it, or missed by about 1e-9 of the size. A
    singular posture is missed by more, 1e-7 to 1e-6 of the size as a rule: the steps end where
    ‖J⁻¹‖ (dimensionless, Frobenius) exceeds 7e6, at which a posture counts as singular in
    double precision.

    Of legs that are driven at the base, that the drive is not singular is proven on each step, so
    that they stay on their branches, and J is that of their rods. Beyond a singular drive lies what
    it does not reach; it is missed by about 1e-9 of the size. The angle of a crank counts
    from −π to π, as in `gsp.feasible`: at π it passes to −π, which violates any bound that not all
    angles satisfy.

    Parameters
    ----------
    design : Design
        With six actuators.
    pose : Pose of batch shape () [unit of the design]
        The start. If it is outside its strokes or singular, the distance is 0.
    direction : (6,) array_like [unit of the design, rad]
        (v, ω), in base axes. Its largest component is between 1e-100 and 1e100.
    strokes : (6, 2) array_like or None [unit of the design, rad]
        Least and greatest joint values, those of distances ≥ 0 but for drives at the base, NaN for
        none; default those of the design.
    farthest : float or None [1]
        Greatest factor; default the one that moves the centre of the anchors by 10 sizes of the
        design, at its speed at the start, or the platform by 10 rad. The default is less for
        turns about a far origin, where the centre moves on a long curve: its way is at most 100
        sizes, by the bound ∫ (|v₀| + 2 |ω| a |sin(|ω| s / 2)|) ds of its length, with v₀ its
        velocity at the start and a its distance from the axis through the platform origin. With a
        given `farthest` the time grows with the way, about 10 to 30 steps per size.

    Returns
    -------
    Travel

    Raises
    ------
    InvalidInput
        On other designs, types, shapes or ranges.

    *Source: ours, with the bounds of `gsp.variation`.*

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> up = gsp.travel(d, d.home, [0, 0, 1, 0, 0, 0], strokes=[[100, 200]] * 6)
    >>> up.limit, bool(up.distance > 0)
    ('d3 = 200', True)
    """
    start, twist, bounds = _check(design, pose, direction, strokes)
    small = centred(design)
    path = TravelPath.of(small, start, twist)
    rate = path.rate
    most = path.default if farthest is None else check_positive("farthest", farthest) * rate
    searched = most / rate if farthest is None else float(farthest)
    done, number = _March(small, path, bounds / small.units[:, None]).go(most)
    distance = searched if done == most else done / rate
    limit = _name(design, number, bounds)
    end = start.moved(twist * distance)
    return Travel(distance=distance, limit=limit, pose=end, farthest=searched)


def _name(design: Design, number: int, bounds: Array) -> str:
    """Name a limit by its number, see `_March`."""
    if number < -2:
        joint = -3 - number
        return f"{design.joint_names[joint]}: {design.rows[joint].constraint.singular}"
    if number < 0:
        return "" if number == -1 else "singular"
    joint, side = divmod(number, 2)
    return f"{design.joint_names[joint]} = {bounds[joint, side]:.6g}"


def _check(
    design: Design, pose: Pose, direction: ArrayLike, strokes: ArrayLike | None
) -> tuple[Pose, Array, Array]:
    check_type("design", design, Design)
    check_type("pose", pose, Pose)
    if pose.shape or not np.isfinite(pose.position).all():
        raise InvalidInput(expected("pose", "a single pose", f"{pose!r}"))
    n = len(design.joint_names)
    if n != 6:
        raise InvalidInput(expected("design", "six actuators", n))
    twist = check_array("direction", direction, (6,))
    if twist.ndim != 1 or not DIRECTION[0] <= np.abs(twist).max() <= DIRECTION[1]:
        wanted = "six numbers, not all zero, the largest between 1e-100 and 1e100"
        raise InvalidInput(expected("direction", wanted, twist.tolist()))
    given = design.strokes if strokes is None else strokes
    bounds = open_strokes(check_strokes(given, design.signed), n)
    cranks = design.angular & [row.constraint.driven for row in design.rows]
    return pose, twist, np.where(cranks[:, None], crank_bounds(bounds), bounds)


class _March:
    """Steps along one path, each proven to violate no limit.

    Limits have numbers: 2 × joint + side; −1 none; −2 a singular posture or an undefined leg;
    −3 − joint a singular drive.
    """

    def __init__(self, design: Centred, path: TravelPath, bounds: Array) -> None:
        self.design, self.path = design, path
        rows = design.design.rows
        self.drives = np.array([row.constraint.driven for row in rows])
        self.cosines = design.design.angular & ~self.drives
        low, high = bounds[:, 0], bounds[:, 1]
        self.names = np.arange(12).reshape(6, 2)
        # Angles are bounded by their cosines. A distance that may be 0 may change its sign.
        free = ~self.cosines & ~self.drives & (low <= 0.0)
        with np.errstate(invalid="ignore"):
            cosines = np.cos(np.clip(bounds[:, ::-1], 0.0, np.pi))
        self.low = np.where(self.cosines, cosines[:, 0], np.where(free, -high, low))
        self.high = np.where(self.cosines, cosines[:, 1], high)
        self.names[self.cosines] = self.names[self.cosines][:, ::-1]
        self.names[free, 0] = self.names[free, 1]

    def go(self, most: float) -> tuple[float, int]:
        """Return how far no limit is violated, and the number of the limit that ends it."""
        done, step = 0.0, 0.125
        with np.errstate(all="ignore"):
            here = self._point(0.0, None)
            bad = self._fault(here)
            if bad == -1:
                bad = self._beyond(*self._values(here, np.zeros(6)), np.zeros(6))
            if bad != -1:
                return 0.0, bad
            grows = False
            while done < most:
                step = min(step, most - done)
                there = self._point(done + step, here.signs)
                bad = self._checked(here, there, done, step)
                if bad == -1:
                    done, here = done + step, there
                    step, grows = (2.0 if grows else 1.0) * step, True
                elif step <= SHORTEST_TRAVEL_STEP:
                    return done, bad
                else:
                    step, grows = 0.5 * step, False
        return done, -1

    def _point(self, distance: float, signs: Array | None) -> reference.Points:
        return reference.points_at(self.design, self.path.pose(distance), np.zeros((1, 6)), signs)

    def _fault(self, point: reference.Points) -> int:
        """Return −1 for a regular posture, else the number of what it is not."""
        square = float((point.inverse**2).sum())
        if point.undefined[0] == 0.0:
            return -1 if np.finfo(float).eps * square <= 0.01 else -2
        posture = self.design.design.at(point.pose)
        # A drive becomes undefined where it is singular.
        lost = self.drives & (posture.drive_is_singular[0] | np.isnan(posture.joints[0]))
        return -3 - int(lost.argmax()) if lost.any() else -2

    def _checked(
        self, here: reference.Points, there: reference.Points, done: float, step: float
    ) -> int:
        """Return −1 if a step violates nothing, else the number of a limit."""
        bad = self._fault(there)
        if bad != -1:
            return bad
        move, curved = step * self.path.velocity(done), step**2 * self.path.curved
        rows, values = reference.jets_of(
            self.design, reference.patch_of(here.pose, move[None], curved)
        )
        seconds = self._numbers([jet.second + 2.0 * jet.slack for jet in values])
        lost = self.drives & ~np.isfinite(seconds)
        if lost.any():
            return -3 - int(lost.argmax())
        bad = self._beyond(*self._values(here, move), seconds)
        if bad >= 0:
            return bad
        bends = self._numbers([bend(row) for row in rows])[None]
        change = there.rows - here.rows
        ends = (reference.change_bound(point, change, bends)[0] for point in (here, there))
        return -1 if max(ends) < PROVEN_SHARE else -2

    def _values(self, point: reference.Points, move: Array) -> tuple[Array, Array]:
        """Return signed distances, cosines and values of drives, and their changes, (6,).

        The changes are those to first order.
        """
        value, change = point.error[0], point.rows[0] @ move / point.scale[0]
        value = np.where(self.cosines, np.cos(value), value)
        sine = np.sin(point.error[0])
        return value, np.where(self.cosines, -sine * change, change)

    def _numbers(self, found: list[Any]) -> Array:
        return np.array([float(np.broadcast_to(x, (1,))[0]) for x in found])

    def _beyond(self, value: Array, change: Array, second: Array) -> int:
        """Return a bound that x + τ x' ± τ² S/2 may pass for 0 ≤ τ ≤ 1; −1 if there is none."""
        # The parabolas are convex and concave: their extremes are at the ends.
        half = 0.5 * second
        most = np.maximum(value, value + change + half)
        least = np.minimum(value, value + change - half)
        above = ~(most <= self.high + ON_BOUND) & np.isfinite(self.high)
        below = ~(least >= self.low - ON_BOUND) & np.isfinite(self.low)
        # The one that is passed by most is named.
        excess = np.stack((self.low - least, most - self.high), axis=-1)
        excess = np.where(np.stack((below, above), axis=-1), np.nan_to_num(excess, nan=1.0), -1.0)
        if not (below.any() or above.any()):
            return -1
        return int(self.names.ravel()[int(np.argmax(excess))])
