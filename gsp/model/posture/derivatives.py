"""Derivatives of the rows of the Jacobian: the formulas of the legs on dual numbers."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from gsp.geometry.duals import Dual
from gsp.geometry.scalars import components
from gsp.geometry.vectors import Array, norm, skew
from gsp.model.posture.assembly import POSES_PER_ASSEMBLY, Group, Part, part_of, put
from gsp.model.posture.postures import Posture

# Translations and rotations of the six unit twists at the platform origin.
SHIFTS, TURNS = np.hsplit(np.eye(6), 2)


def rows_and_derivatives(posture: Posture) -> tuple[Array, Array]:
    """Return J (..., n, 6) and ∂J/∂x (..., n, 6, 6) by steps x = (v, ω) as in `Pose.moved`.

    The last axis of the derivatives is that of x. NaN where a row is undefined.

    Parameters
    ----------
    posture : Posture of batch shape (...)
    """
    groups, n = posture.design.groups, len(posture.joint_names)
    return derivatives_of_rows(groups, n, posture.pose.position, posture.pose.rotation)


def derivatives_of_rows(
    groups: Sequence[Group], n_joints: int, position: Array, rotation: Array
) -> tuple[Array, Array]:
    """Return what `rows_and_derivatives` does, of groups of legs at poses.

    Parameters
    ----------
    groups : sequence of Group
    n_joints : int
        Number n of actuated joints.
    position, rotation : (..., 3) and (..., 3, 3) arrays
        Poses of one batch shape.
    """
    shape = position.shape[:-1]
    rows = np.empty((position.size // 3, n_joints, 6))
    slopes = np.empty((*rows.shape, 6))
    with np.errstate(all="ignore"):
        for _, part in moving_parts(groups, position, rotation):
            for constraint, places in zip(
                part.group.kind.constraints, part.group.rows, strict=True
            ):
                row = constraint.row(part.segment, 1.0)
                values = [x.real if isinstance(x, Dual) else x for x in row]
                rates = [x.slope if isinstance(x, Dual) else 0.0 for x in row]
                put(rows, part.poses, places, values, part.undefined)
                put(slopes, part.poses, places, rates, part.undefined)
    return rows.reshape(*shape, n_joints, 6), slopes.reshape(*shape, n_joints, 6, 6)


def moving_parts(
    groups: Sequence[Group], position: Array, rotation: Array
) -> Iterator[tuple[list[Dual], Part]]:
    """Yield p and the legs of one kind at some poses, with derivatives along the six unit twists.

    Slopes have the axes (twist, leg, pose).

    Parameters
    ----------
    groups : sequence of Group
    position, rotation : (..., 3) and (..., 3, 3) arrays
        Poses of one batch shape.
    """
    positions, rotations = position.reshape(-1, 3), rotation.reshape(-1, 3, 3)
    for start in range(0, len(positions), POSES_PER_ASSEMBLY // 6):
        poses = slice(start, min(start + POSES_PER_ASSEMBLY // 6, len(positions)))
        p, r = _moving(positions[poses], rotations[poses])
        distance = norm(positions[poses])
        with np.errstate(all="ignore"):
            evaluated = [part_of(group, poses, p, r, distance) for group in groups]
        yield from ((p, part) for part in evaluated)


def _moving(position: Array, rotation: Array) -> tuple[list[Dual], list[Dual]]:
    """Return p and R with their derivatives; a slope has the axes (twist, leg, pose)."""
    rates = (skew(TURNS)[:, None] @ rotation).reshape(6, -1, 9)
    places = zip(components(position), SHIFTS.T[..., None, None], strict=True)
    entries = zip(components(rotation.reshape(-1, 9)), np.moveaxis(rates, -1, 0), strict=True)
    return [Dual(*pair) for pair in places], [Dual(x, rate[:, None]) for x, rate in entries]
