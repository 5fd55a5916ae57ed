"""Whether critical points are local maxima along rays, up to rounding."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array, Mask, dot
from gsp.limits.labels import Active
from gsp.workspace.boundary.climb import ray_curvature
from gsp.workspace.boundary.critical import Chart, Jet, Points

# How far beyond its bound a quantity may be [share of the scale]: rounding of solved points.
EXCESS_TOLERANCE = 1e-9
# Multipliers of the active constraints, and the outward normal that they add up to, count as zero
# below this [1]; the multipliers have norm one.
WEIGHT_TOLERANCE = 1e-9
# Negative curvature [1] that counts as zero: rounding over the square of `SECOND_DIFFERENCE_STEP`
# is some 2e-8.
CURVATURE_TOLERANCE = 1e-7
# The check that an end fails with too few active constraints.
VIOLATED = "another constraint is violated"


def why_not_maximal(
    chart: Chart, points: Points, jet: Jet, active: Active, direction: Array, solved: Mask
) -> list[str]:
    """Return the reason why a point is not a local maximum along its ray, "" where it is one."""
    points = points.upright()
    outward = dot(chart.normal(points, jet, active), direction)
    with np.errstate(invalid="ignore"):
        checks = (
            (solved, "the end could not be solved to rounding"),
            ((jet.excess <= EXCESS_TOLERANCE).all(axis=(1, 2)), VIOLATED),
            ((points.weight >= -WEIGHT_TOLERANCE).all(axis=1), "a multiplier is negative"),
            (outward > WEIGHT_TOLERANCE, "the ray does not leave there"),
            (second_order(chart, points, active, direction), "the second-order condition fails"),
        )
    reasons = np.full(len(points.position), "", dtype=object)
    for ok, text in reversed(checks):
        reasons[~np.asarray(ok)] = text
    return list(reasons)


def second_order(chart: Chart, points: Points, active: Active, direction: Array) -> Mask:
    """Whether Σ λ g bends outward on all moves that keep the active constraints, along the ray.

    Along a flat direction it may not bend: there the maxima are not isolated.
    """
    k = len(chart.turns)
    if len(active) >= k + 1:
        return np.ones(len(points.position), dtype=bool)
    gradient = chart.jet(points.position, points.rotation).of(active)[1]
    along = (gradient[..., :3] @ direction[..., None])[..., 0]
    line = np.concatenate((along[..., None], gradient[..., 3:]), axis=-1)
    free = np.linalg.svd(line)[2][:, len(active) :]
    net = chart.net(points.weight, active)
    bend = chart.bounds.curvature(points.position, points.rotation, net)
    reduced = free @ ray_curvature(bend, direction, chart.turns) @ np.swapaxes(free, -1, -2)
    curvature = np.linalg.eigvalsh(0.5 * (reduced + np.swapaxes(reduced, -1, -2)))
    return np.asarray(curvature[:, 0] > -CURVATURE_TOLERANCE)
