"""Bifurcation points: poses in which labelled joints are at their limits, solved to rounding."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array
from gsp.errors import EmptyWorkspace, InvalidInput, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, frozen
from gsp.limits.bounds import bounded_quantities
from gsp.limits.labels import active_from_label, label
from gsp.limits.limits import Limits
from gsp.limits.quantities import BoundedQuantities, moved
from gsp.model.design import Design
from gsp.workspace.boundary.sections import BifurcationPoint

STEPS = 100
SOLVED = 1e-12
COORDINATES: Mapping[str, int] = {"x": 0, "y": 1, "z": 2}


def bifurcation_point(
    design: Design,
    text: str,
    guess: Pose,
    *,
    held: Mapping[str, float] | None = None,
    rotation: ArrayLike | None = None,
    limits: Limits | None = None,
) -> BifurcationPoint:
    """Return the pose near a guess in which the joints of a label are at their limits.

    The joints, the held coordinates and the fixed orientation are solved together as equations,
    not as a penalty, by Gauss–Newton, which is Newton's method where there are six of them. There
    may be more than six if they agree, as those of symmetric designs do.

    Parameters
    ----------
    design : Design
    text : str
        "0 1 - - 1 0" or "[01−−10]": 0 least, 1 greatest, - free.
    guess : Pose of shape ()
    held : mapping from "x", "y", "z" to float, or None
        Coordinates of the platform origin to hold.
    rotation : (3, 3) array_like or None
        An orientation to hold.
    limits : Limits or None

    Raises
    ------
    EmptyWorkspace
        If no pose near the guess satisfies all equations to rounding.
    InvalidInput
        On a wrong label, unknown coordinates, joints without that limit, or fewer than six
        equations.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("workspace-6-3")
    >>> top = bifurcation_point(d, "1 1 1 1 1 1", gsp.Pose([0.0, 0.0, 13.0]))
    >>> top.pose.position.round(3) + 0.0
    array([ 0.   ,  0.   , 12.961])

    *Source: Workspace-A, eqs. (A.12), (C.1), which minimise a sum of squares instead*
    """
    if not isinstance(guess, Pose) or guess.shape:
        raise InvalidInput(expected("guess", "a single gsp.Pose", repr(guess)))
    bounds = bounded_quantities(design, limits, crossed=True)
    active = active_from_label(text, bounds.joints)
    joints = [i for i, _ in active]
    target = np.array([(bounds.low, bounds.high)[side][i] for i, side in active])
    if not np.isfinite(target).all():
        raise InvalidInput(expected("label", "marks at joints that have that limit", repr(text)))
    axes, places = _held({} if held is None else held)
    fixed = None if rotation is None else check_array("rotation", rotation, (3, 3))
    number = len(active) + len(axes) + (0 if fixed is None else 3)
    if number < 6:
        raise InvalidInput(expected("label, held, rotation", "six equations at least", number))
    position, turned = _solve(bounds, joints, target, axes, places, fixed, guess)
    values = bounds.quantities.values(position, turned)
    gap = np.abs(bounds.excess(values)) < 10.0 * SOLVED * bounds.scale
    found = tuple((int(i), int(side)) for i, side in np.argwhere(gap))
    return BifurcationPoint(
        label(found, bounds.names, bounds.joints), Pose(position, turned), frozen(values)
    )


def _held(held: Mapping[str, float]) -> tuple[list[int], Array]:
    for name in held:
        if name not in COORDINATES:
            raise InvalidInput(expected("held", "coordinates x, y, z", repr(name)))
    places = np.array([float(value) for value in held.values()])
    return [COORDINATES[name] for name in held], check_array("held", places, (None,))


def _solve(
    bounds: BoundedQuantities, joints: list[int], target: Array, axes: list[int], places: Array,
    fixed: Array | None, guess: Pose,
) -> tuple[Array, Array]:  # fmt: skip
    position, rotation, size = guess.position, guess.rotation, bounds.scale
    scale = np.repeat([size, 1.0], 3)
    residual = np.full(1, np.inf)
    for _ in range(STEPS):
        values, rows = bounds.evaluate(position, rotation)
        parts = [values[joints] - target, position[axes] - places]
        matrices = [rows[joints] * scale, np.eye(6)[axes] * size]
        if fixed is not None:
            parts.append(size * _turn_from(fixed, rotation))
            matrices.append(size * np.eye(6)[3:])
        residual = np.nan_to_num(np.concatenate(parts) / size, nan=np.inf)
        if not np.isfinite(residual).all() or np.abs(residual).max() < 0.01 * SOLVED:
            break
        step = -np.linalg.lstsq(np.concatenate(matrices) / size, residual, rcond=1e-12)[0]
        step *= min(1.0, 0.3 / max(float(np.abs(step).max()), 1e-300))
        position, rotation = moved(position, rotation, step, size)
    if not np.abs(residual).max() < SOLVED:
        raise EmptyWorkspace(
            "bifurcation point: expected a pose near the guess that satisfies all equations, "
            f"received a residual of {np.abs(residual).max() * size:.3g}"
        )
    return position, rotation


def _turn_from(one: Array, other: Array) -> Array:
    """Rotation vector that turns the first rotation into the second, in base axes."""
    from scipy.spatial.transform import Rotation

    return np.asarray(Rotation.from_matrix(other @ one.T).as_rotvec(), dtype=np.float64)
