"""The allowed pose nearest to a given one."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from gsp.checks import check_integer, check_rng, check_type
from gsp.errors import EmptyWorkspace, InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.limits.bounds import bounded_quantities
from gsp.limits.limits import Limits
from gsp.model.design import Design

# By how much the nearest pose may violate a limit: distances as a share of the size, others as
# they are.
ALLOWED = 1e-9


@dataclass(frozen=True, eq=False, kw_only=True)
class Nearest:
    """Result of `nearest`.

    Attributes
    ----------
    pose : Pose of batch shape ()
    distance : float [1]
        √(|Δp|² / L² + |Δθ|²), L = `design.rms_radius`, Δp of the centre of the platform anchors and
        Δθ the angle between the orientations.
    starts : int
        How many of the searches ended at an allowed pose.
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
) -> Nearest:
    """Return the allowed pose nearest to a given one: the best local minimum of several searches.

    The distance is √(|Δp|² / L² + |Δθ|²) with L = `design.rms_radius`, Δp the displacement of the
    centre of the platform anchors and Δθ the angle of the rotation between them, so that it does
    not depend on frames and units. Sequential quadratic programming starts at the pose itself
    and at random ones near it. That there is no nearer pose is not proven. Limits hold to 1e-9 of
    the size.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape () [unit of the design]
    limits : Limits or None
        Default: the strokes of the design.
    starts : int
        Number of searches.
    rng : numpy.random.Generator or int
        Generator or seed of the random starts.

    Returns
    -------
    Nearest

    Raises
    ------
    EmptyWorkspace
        If no search finds an allowed pose.
    MissingParameter
        If nothing limits the design.
    InvalidInput
        On other types or shapes.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> found = gsp.nearest(d, d.home, gsp.Limits(strokes=[[100, 150]] * 6))
    >>> bool((d.at(found.pose).joints <= 150 + 1e-6).all()), found.distance < 0.1
    (True, True)
    """
    from scipy.optimize import minimize

    solve: Any = minimize
    check_type("design", design, Design)
    check_type("pose", pose, Pose)
    if pose.shape or not np.isfinite(pose.position).all():
        raise InvalidInput(expected("pose", "a single pose", f"{pose!r}"))
    number, generator = check_integer("starts", starts), check_rng("rng", rng)
    bounds = bounded_quantities(design, limits, crossed=True)
    size, centre = bounds.scale, design.platform_points.mean(axis=0)
    finite = np.isfinite(bounds.low), np.isfinite(bounds.high)

    def placed(x: Array) -> Pose:
        moved = Pose(pose.position + pose.rotation @ centre, pose.rotation).moved(
            x * np.repeat([size, 1.0], 3)
        )
        return Pose(moved.position - moved.rotation @ centre, moved.rotation)

    def slacks(x: Array) -> Array:
        at = placed(x)
        values = np.nan_to_num(bounds.quantities.values(at.position, at.rotation), nan=1e9)
        unit = np.where(np.arange(len(values)) < bounds.joints, size, 1.0)
        low, high = (values - bounds.low) / unit, (bounds.high - values) / unit
        return np.concatenate((low[finite[0]], high[finite[1]]))

    found = []
    for i in range(number):
        start = np.zeros(6) if i == 0 else generator.uniform(-0.5, 0.5, 6)
        if i == 0 and (slacks(start) >= 0.0).all():
            return Nearest(pose=pose, distance=0.0, starts=1)
        end = solve(
            lambda x: float(x @ x),
            start,
            jac=lambda x: 2.0 * x,
            method="SLSQP",
            constraints={"type": "ineq", "fun": slacks},
            options={"maxiter": 200, "ftol": 1e-14},
        ).x
        inside = np.isfinite(end).all() and norm(end[3:]) <= np.pi
        if inside and slacks(end).min() >= -ALLOWED:
            found.append(end)
    if not found:
        raise EmptyWorkspace(
            f"nearest allowed pose: expected one near {pose!r}, received none ({number} searches)"
        )
    best = min(found, key=lambda x: float(x @ x))
    return Nearest(pose=placed(best), distance=float(norm(best)), starts=len(found))
