"""How many independent motions a chain of joints has."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from gsp.bridges.reading.mechanism.linkages import Freedom
from gsp.geometry.frames.screws import exp3
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, cross, norm

# Least share of the largest singular value that counts: axes that differ by less count as parallel.
RANK_TOLERANCE = 1e-4
# Steps of the joints, in rad and in sizes of the chain, to configurations where none of the axes of
# a chain lie on each other by chance: any numbers of about 0.3 to 1 that are not multiples.
STEPS = ((0.0,), (0.37, 0.59, 0.83, 0.43, 0.71), (-0.67, 0.41, -0.53, 0.79, -0.31, 0.61, 0.47))


def rank(freedoms: Sequence[Freedom], size: float) -> int:
    """Return the number of independent motions of the last body of a chain, at most six.

    It is the rank of the screws of the joints, the largest of that in the configuration of the file
    and in two others: at a single one a universal joint may be in a singular position.

    Parameters
    ----------
    freedoms : sequence of Freedom
        From the first body to the last.
    size : float [m]
        Of the mechanism; taken for that of the chain if its joints are at one point.
    """
    points = np.array([x.point for x in freedoms])
    if not len(points):
        return 0
    centre = points.mean(axis=0)
    span = float(norm(points - centre).max())
    span = span if span > RANK_TOLERANCE * size else size or 1.0
    found = 0
    for steps in STEPS:
        screws = _screws(freedoms, centre, span, steps)
        values = np.linalg.svd(screws, compute_uv=False)
        found = max(found, int((values > RANK_TOLERANCE * values[0]).sum()))
    return found


def _screws(
    freedoms: Sequence[Freedom], centre: Array, span: float, steps: tuple[float, ...]
) -> Array:
    """Return the twists (k, 6) of the joints after some steps; velocities in spans."""
    moved = Pose(np.zeros(3))
    screws, number = [], 0
    for freedom in freedoms:
        ball = freedom.kind == "ball"
        axes = np.eye(3) if ball else freedom.axis[None]
        for axis in axes:
            step = steps[number % len(steps)]
            number += 1
            now = moved.rotation @ axis
            point = moved.position + moved.rotation @ freedom.point
            if freedom.kind == "slide":
                screws.append(np.concatenate((now, np.zeros(3))))
                moved = Pose(step * span * now).compose(moved)
            else:
                screws.append(np.concatenate((cross(now, centre - point) / span, now)))
                moved = _turn(now, point, step).compose(moved)
    return np.array(screws)


def _turn(axis: Array, point: Array, angle: float) -> Pose:
    rotation = exp3(angle * axis)
    return Pose(point - rotation @ point, rotation)
