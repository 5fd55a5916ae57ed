"""The feasible pose nearest to a given one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gsp.checks import check_integer, check_memory, check_rng, check_type
from gsp.errors import EmptyWorkspace, InvalidInput, apart, expected
from gsp.geometry.copies import ReadOnly, kept_property
from gsp.geometry.frames.changes import about_point
from gsp.geometry.frames.screws import exp3, exp3_rates, log3
from gsp.geometry.pose import Pose
from gsp.geometry.pose.intervals import POSE_BYTES
from gsp.geometry.vectors import Array, norm
from gsp.kinematics.feasible_descent import (
    Functions,
    corrected,
    descended,
    local_minimum,
    restored,
)
from gsp.kinematics.modes import assembly_modes
from gsp.limits.bounds import bounded_quantities
from gsp.limits.centred import CentredLimits, centred_limits, rounded
from gsp.limits.legs import crank_bounds, reaches
from gsp.limits.limits import Limits
from gsp.limits.quantities import DIFFERENCE_STEP
from gsp.model.design import Design
from gsp.progress import Progress, check_progress, meter

# By how much the nearest pose may violate a limit: distances as a share of the size, indices as one
# of their threshold, angles as they are.
LIMIT_TOLERANCE = 1e-9
# The same for the searches, whose lengths are rounded.
SEARCH_TOLERANCE = 1e-6
# How far drives at the base must reach beyond a pose that is found [sizes], and how far the angle
# of a crank that ends at π is from it [rad]: above the tolerance of limits.
LEAST_REACH = 1e-8
# Distance of a given pose from the home pose, or from the centre of the base anchors [sizes] beyond
# which its square has too few digits for the searches.
FARTHEST = 1e3
TURN = 2.0 * np.pi
# Legs whose assembly modes are found in milliseconds.
QUICK_MODES = "D1^6"
# Random steps where nothing else is feasible: their sizes, how many of each, and from how many the
# descents start.
SAMPLED_SIZES, RANDOM_STEPS, NEAREST_SAMPLES = (0.05, 0.15, 0.4, 1.0), 500, 3
# How far a search on exact lengths may move an end, and the steps of Newton's method for it.
LONGEST_CORRECTION, CORRECTION_STEPS = 1e-3, 3
# Most steps of sequential quadratic programming: to a minimum, and next to one. Where functions are
# not smooth it takes all of them.
SEARCH_STEPS, STEPS_TO_MINIMUM = 200, 20


@dataclass(frozen=True, eq=False, kw_only=True)
class Nearest(ReadOnly):
    """Result of `nearest`.

    Attributes
    ----------
    pose : Pose of batch shape ()
    distance : float [1]
        √(|Δp|² / L² + |Δθ|²), L = `design.rms_radius`, Δp of the centre of the platform anchors and
        Δθ the angle between the orientations.
    starts : int
        How many of the searches ended at a feasible pose; the home pose counts if it is one.
    """

    pose: Pose
    distance: float
    starts: int


def nearest(
    design: Design,
    pose: Pose,
    limits: Limits | None = None,
    *,
    starts: int = 8,
    rng: np.random.Generator | int = 0,
    progress: Progress = None,
) -> Nearest:
    """Return the feasible pose nearest to a given one: the best local minimum of several searches.

    The distance is √(|Δp|² / L² + |Δθ|²) with L = `design.rms_radius`, Δp the displacement of the
    centre of the platform anchors and Δθ the angle of the rotation between them, so that it does
    not depend on frames and units. Sequential quadratic programming starts at the pose itself,
    at random ones near it, and at the home pose if that is feasible; the home pose counts as found.
    From each feasible end a descent goes on, all steps of which are feasible; where a search ends
    at no feasible pose, the descent begins at its start or at a feasible pose that is looked for.
    If none is found, assembly modes of joint values within the strokes are tried, for six D1 legs
    or drives, and random poses.
    The nearest end is tested to second order and made exact by Newton's method. That there is no
    nearer pose is not proven. Limits hold to 1e-9 of the size, thresholds to 1e-9 of their value.

    The searches take lengths rounded to nine digits, in units of the size and about the centres of
    the anchors. So the result is the same in every unit and for all origins of the frames, unless
    the limits depend on these, as thresholds on some indices do (docs/conventions.md). Other
    axes of the frames, or another order of the legs, may lead to another local minimum.

    Drives at the base must reach the pose on their branches, beyond it by at least 1e-8 of the
    size: that a drive is singular is a limit as well. Whether a motion from the pose to the nearest
    one passes a singular drive is not examined.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape () [unit of the design]
    limits : Limits or None
        Default: the strokes of the design.
    starts : int
        Number of searches, without that from the home pose.
    rng : numpy.random.Generator or int
        Generator or seed of the random starts.
    progress : function (done, total), bool or None
        Called with the number of searches; see `gsp.evaluate`. They take a second together as a
        rule, half a minute for poses many sizes away; a minute or two may pass where few poses or
        none satisfy thresholds on indices, and with such thresholds for redundant designs or
        drives.

    Returns
    -------
    Nearest

    Raises
    ------
    EmptyWorkspace
        If no search finds a feasible pose.
    MissingParameter
        If nothing limits the design: drives at the base alone do not count.
    InvalidInput
        On other types or shapes, or for a pose that is farther than 1000 sizes from the home pose,
        or from the centre of the base anchors if there is none.

    *Source: ours, by sequential quadratic programming, feasible descent and Newton's method.*

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> found = gsp.nearest(d, d.home, gsp.Limits(strokes=[[100, 150]] * 6))
    >>> bool((d.at(found.pose).joints <= 150 + 1e-6).all()), found.distance < 0.1
    (True, True)
    """
    check_type("design", design, Design)
    check_type("pose", pose, Pose)
    if pose.shape or not np.isfinite(pose.position).all():
        raise InvalidInput(expected("pose", "a single pose", f"{pose!r}"))
    number, generator = check_integer("starts", starts), check_rng("rng", rng)
    check_memory("starts", number, POSE_BYTES, "poses")
    check_progress(progress)
    given = Limits() if limits is None else limits
    bounded_quantities(
        design, given, crossed=True, driven=True
    )  # checks that the limits fit the design
    small = centred_limits(design, given)
    target = small.pose_from(pose)
    exact = _Search(small, target)
    away = float(norm(exact.step_to(small.design.home or Pose(np.zeros(3)))[:3]))
    if away > FARTHEST:
        got, most = apart(away, FARTHEST)
        wanted = f"a pose within {most} sizes (rms_radius) of the home pose or the base"
        raise InvalidInput(expected("pose", wanted, f"one at {got}"))
    if (exact.slacks(np.zeros(6), 0.0) >= 0.0).all():
        return Nearest(pose=pose, distance=0.0, starts=1)
    rough = _Search(small.rounded(), Pose(rounded(target.position), target.rotation))
    begin = [np.zeros(6), *generator.uniform(-0.5, 0.5, (number - 1, 6))]
    home = exact.home()
    if home is not None:
        begin.append(rounded(home))
    ends: list[Array | None] = [home]
    with meter(progress, "nearest") as report:
        for done, start in enumerate(begin, 1):
            ends.append(rough.minimum_from(start))
            report(done, len(begin))
    if all(end is None for end in ends):
        ends = [rough.restored_from(start) for start in begin]
    if all(end is None for end in ends):
        ends = rough.from_modes(number, generator)
    near = sorted((end for end in ends if end is not None), key=norm)
    found = len(near)
    if near:
        near.insert(0, rough.probed(near[0]))
    best = next((end for end in map(exact.polished, near) if exact.allowed(end)), None)
    if best is None:
        near = exact.from_samples(generator)
        best, found = min(near, key=norm, default=None), len(near)
    if best is None:
        raise EmptyWorkspace(
            f"nearest feasible pose: expected one near {pose!r}, received none ({number} searches)"
        )
    return Nearest(pose=small.pose_to(exact.placed(best)), distance=float(norm(best)), starts=found)


class _Search:
    """Searches for the shortest step to a feasible pose, in units of the size of the design.

    A step x = (v, φ) moves the centre of the platform anchors by v and turns the platform by
    exp(φ×), both in base axes.
    """

    def __init__(self, small: CentredLimits, target: Pose) -> None:
        self.bounds = bounded_quantities(
            small.design, small.limits, crossed=True, driven=True, smooth=True
        )
        self.design, self.target = small.design, target
        self.centre = small.design.platform_points.mean(axis=0)
        # Of a step: the size, which is not 1 where the design has kept its own unit.
        self.length = small.design.rms_radius
        drives = [row.constraint.driven for row in self.design.rows]
        self.drives = np.flatnonzero(drives)
        self.cranks = np.flatnonzero(self.design.angular & drives)
        limits = np.stack((self.bounds.low, self.bounds.high), axis=-1)
        # Beyond π the angle of a crank is near −π.
        angles = crank_bounds(limits[self.cranks])
        ends = np.isfinite(angles) * (np.pi - LEAST_REACH)
        limits[self.cranks] = np.where(ends > 0.0, np.clip(angles, -ends, ends), angles)
        self.low, self.high = limits.T
        self.finite = np.isfinite(self.low), np.isfinite(self.high)
        sizes = [self.bounds.sizes[self.finite[0]], self.bounds.sizes[self.finite[1]]]
        self.sizes = np.concatenate((*sizes, np.full(len(self.drives), self.length)))
        # Angles of cranks are counted from the middle of their strokes.
        closed = np.isfinite(angles).all(axis=-1, keepdims=True)
        self.middles = np.where(closed, angles, 0.0).mean(axis=-1)

    def placed(self, x: Array) -> Pose:
        turn = exp3(x[3:]) @ self.target.rotation
        middle = self.target.position + self.target.rotation @ self.centre + self.length * x[:3]
        return Pose(middle - turn @ self.centre, turn)

    def home(self) -> Array | None:
        """Return the step to the home pose if that is feasible."""
        if self.design.home is None:
            return None
        step = self.step_to(self.design.home)
        return step if self.allowed(step) else None

    def step_to(self, pose: Pose) -> Array:
        middles = [p.position + p.rotation @ self.centre for p in (pose, self.target)]
        turn = log3(pose.rotation @ self.target.rotation.T)
        return np.concatenate(((middles[0] - middles[1]) / self.length, turn))

    def slacks(self, x: Array, least_reach: float = LEAST_REACH) -> Array:
        """Return how far the quantities are inside of their bounds, per size; −1e9 if undefined.

        The last ones state how far drives reach beyond the pose. Where one does not, its joint
        value violates nothing.
        """
        at = self.placed(x)
        values = self.bounds.quantities.values(at.position, at.rotation)
        values[self.cranks] -= TURN * np.round((values[self.cranks] - self.middles) / TURN)
        low, high = values - self.low, self.high - values
        lost = self.drives[np.isnan(values[self.drives])]
        low[lost] = high[lost] = 0.0
        reach = reaches(self.design, at.position, at.rotation)[0] - least_reach * self.length
        slacks = np.concatenate((low[self.finite[0]], high[self.finite[1]], reach)) / self.sizes
        return np.asarray(np.nan_to_num(slacks, nan=-1e9))

    def slopes(self, x: Array) -> Array:
        """Return the derivatives of the slacks by x, shape (number of slacks, 6)."""
        at = self.placed(x)
        _, rows = self.bounds.evaluate(at.position, at.rotation)
        n = len(rows)
        own = rows[self.drives]
        rows[self.drives] = np.where(np.isfinite(own), own, 0.0)
        rows = np.concatenate((rows, reaches(self.design, at.position, at.rotation)[1]))
        turns = about_point(rows, at.rotation @ self.centre)[:, 3:] @ exp3_rates(x[3:])
        rates = np.nan_to_num(np.hstack((self.length * rows[:, :3], turns)))
        inner, reach = rates[:n], rates[n:]
        joined = np.concatenate((inner[self.finite[0]], -inner[self.finite[1]], reach))
        return np.asarray(joined / self.sizes[:, None])

    def allowed(self, x: Array, slack: float = LIMIT_TOLERANCE) -> bool:
        inside = np.isfinite(x).all() and norm(x[3:]) <= np.pi
        return bool(inside and self.slacks(x).min() >= -slack)

    @kept_property
    def functions(self) -> Functions:
        """The slacks as functions that must not be negative."""
        return Functions(self.slacks, self.slopes, _shortest, LIMIT_TOLERANCE)

    def minimum_from(self, start: Array) -> Array | None:
        """Return where the search from any step ends if that is feasible, None otherwise."""
        end = _shortest(self.end_from(start))
        for begin in (end, start):
            feasible = corrected(self.functions, begin)
            if feasible is not None:
                return descended(self.functions, feasible)
        if len(self.drives):
            return self.restored_from(end, start)
        return end if self.allowed(end, SEARCH_TOLERANCE) else None

    def restored_from(self, *steps: Array) -> Array | None:
        """Return the end of a descent from the first step that leads to a feasible one."""
        for step in steps:
            feasible = restored(self.functions, step, len(self.drives))
            if feasible is not None:
                return descended(self.functions, feasible)
        return None

    def from_modes(self, number: int, rng: np.random.Generator) -> list[Array | None]:
        """Return ends of descents from poses whose joint values are within the strokes.

        They are the assembly modes, of six D1 legs or drives, where all joint values are in the
        middles of the strokes, else at random values.
        """
        whole = np.where(self.design.angular[:, None], [-np.pi, np.pi], [-np.inf, np.inf])
        n = len(whole)
        low, high = np.clip(np.stack((self.low[:n], self.high[:n])), *whole.T)
        if self.design.mechanism.name != QUICK_MODES or not np.isfinite(high - low).all():
            return []
        for share in (np.full(n, 0.5), *rng.random((number, n))):
            poses = assembly_modes(self.design, low + share * (high - low)).poses
            ends = [self.restored_from(self.step_to(poses[i])) for i in range(len(poses))]
            if any(end is not None for end in ends):
                return ends
        return []

    def from_samples(self, rng: np.random.Generator) -> list[Array]:
        """Return the ends of descents from the nearest feasible ones of random steps."""
        sizes = np.repeat(SAMPLED_SIZES, RANDOM_STEPS)
        steps = sizes[:, None] * rng.normal(size=(len(sizes), 6))
        found = sorted((step for step in map(_shortest, steps) if self.allowed(step)), key=norm)
        return [descended(self.functions, step) for step in found[:NEAREST_SAMPLES]]

    def probed(self, end: Array) -> Array:
        """Return a step that is a local minimum, as far as probes around it show."""
        begin = corrected(self.functions, end)
        return end if begin is None else local_minimum(self.functions, begin, self.end_from)

    def end_from(self, start: Array, accuracy: float = 1e-14, steps: int = SEARCH_STEPS) -> Array:
        """Return where sequential quadratic programming ends."""
        from scipy.optimize import minimize

        solve: Any = minimize
        found = solve(
            lambda x: float(x @ x),
            start,
            jac=lambda x: 2.0 * x,
            method="SLSQP",
            constraints={"type": "ineq", "fun": self.slacks, "jac": self.slopes},
            options={"maxiter": steps, "ftol": accuracy},
        )
        return np.asarray(found.x)

    def polished(self, end: Array) -> Array:
        """Return the minimum next to an end of a search to rounding, or nearly so."""
        better = self._newton(end)
        if not self._next(better, end):
            better = self.end_from(end, 1e-28, STEPS_TO_MINIMUM)
        if self._next(better, end):
            return better
        begin = corrected(self.functions, end)
        if begin is None:  # lengths that are not rounded may be outside by a little more
            begin = restored(self.functions, end, len(self.drives))
        return end if begin is None else descended(self.functions, begin)

    def _next(self, x: Array, end: Array) -> bool:
        return self.allowed(x) and float(norm(x - end)) <= LONGEST_CORRECTION

    def _newton(self, end: Array) -> Array:
        """Return the end of Newton's steps on the conditions of a minimum, NaN without one.

        They are x = Gᵀλ and c(x) = 0, with the slacks c of positive multipliers λ and their
        derivatives G.
        """
        from scipy.optimize import nnls

        solve: Any = nnls
        close = np.flatnonzero(self.slacks(end) < SEARCH_TOLERANCE)
        if not len(close):
            return np.full(6, np.nan)
        active = close[solve(self.slopes(end)[close].T, end)[0] > 0.0]
        x, steps = end, DIFFERENCE_STEP * np.eye(6)
        for _ in range(CORRECTION_STEPS):
            g = self.slopes(x)[active]
            force = np.linalg.lstsq(g.T, x, rcond=None)[0]
            pull = [(self.slopes(x + s) - self.slopes(x - s))[active].T @ force for s in steps]
            bend = np.eye(6) - np.stack(pull, axis=1) / (2.0 * DIFFERENCE_STEP)
            zero = np.zeros((len(active), len(active)))
            right = np.concatenate((g.T @ force - x, -self.slacks(x)[active]))
            x = x + np.linalg.lstsq(np.block([[bend, -g.T], [g, zero]]), right, rcond=None)[0][:6]
        return x


def _shortest(x: Array) -> Array:
    """Return the step to the same pose whose turn is at most π."""
    angle = float(norm(x[3:]))
    if not angle > np.pi:
        return x
    return np.concatenate((x[:3], x[3:] * (1.0 - TURN * np.round(angle / TURN) / angle)))
