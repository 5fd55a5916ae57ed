"""Bifurcation points: poses in which labelled joints are at their limits, solved to rounding."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_type, reading
from gsp.errors import EmptyWorkspace, InvalidInput, expected
from gsp.geometry.frames import log3
from gsp.geometry.matrices import RESIDUAL_TOLERANCE, newton, solve_least_squares
from gsp.geometry.pose import Pose
from gsp.geometry.rotations import check_rotation
from gsp.geometry.vectors import Array, frozen
from gsp.limits.bounds import bounded_quantities
from gsp.limits.labels import active_from_label, label
from gsp.limits.limits import Limits
from gsp.limits.quantities import BoundedQuantities, moved
from gsp.model.design import Design
from gsp.workspace.boundary.critical import LONGEST_CRITICAL_STEP
from gsp.workspace.boundary.sections import BifurcationPoint

# Steps of Newton's method: many, as equations of symmetric designs may be singular at the solution,
# where it converges linearly.
BIFURCATION_STEPS = 100
# Residual at which they end [share of the scale]: less than what counts as solved, for the same
# reason.
BIFURCATION_RESIDUAL = 0.01 * RESIDUAL_TOLERANCE
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
    guess : Pose of batch shape (), a single pose
    held : mapping from "x", "y", "z" to float, or None [unit of the design]
        Coordinates of the platform origin to hold.
    rotation : (3, 3) array_like or None [1]
        An orientation to hold.
    limits : Limits or None
        Default: the strokes of the design.

    Returns
    -------
    BifurcationPoint

    Raises
    ------
    EmptyWorkspace
        If no pose near the guess satisfies all equations to rounding.
    MissingParameter
        If nothing limits the design.
    InvalidInput
        On a wrong label, unknown coordinates, joints without that limit, fewer than six equations,
        or arguments of other types.
    InvalidRotation
        If `rotation` is not a rotation matrix.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("workspace-6-3")
    >>> top = bifurcation_point(d, "1 1 1 1 1 1", gsp.Pose([0.0, 0.0, 13.0]))
    >>> top.pose.position.round(3) + 0.0
    array([ 0.   ,  0.   , 12.961])

    *Source: Workspace-A, eqs. (A.12), (C.1), which minimise a sum of squares instead*
    """
    check_type("guess", guess, Pose)
    if guess.shape:
        raise InvalidInput(expected("guess", "a single gsp.Pose", repr(guess)))
    bounds = bounded_quantities(design, limits, crossed=True)
    active = active_from_label(text, bounds.joints)
    joints = [i for i, _ in active]
    target = np.array([(bounds.low, bounds.high)[side][i] for i, side in active])
    if not np.isfinite(target).all():
        raise InvalidInput(expected("label", "marks at joints that have that limit", repr(text)))
    axes, places = _held({} if held is None else held)
    fixed = None if rotation is None else check_rotation("rotation", rotation)
    if fixed is not None and fixed.ndim != 2:
        raise InvalidInput(expected("rotation", "a single rotation", f"shape {fixed.shape}"))
    number = len(active) + len(axes) + (0 if fixed is None else 3)
    if number < 6:
        raise InvalidInput(expected("label, held, rotation", "six equations at least", number))
    position, turned = _solve(bounds, joints, target, axes, places, fixed, guess)
    values = bounds.quantities.values(position, turned)
    gap = np.abs(bounds.excess(values)) < 10.0 * RESIDUAL_TOLERANCE * bounds.sizes[:, None]
    found = tuple((int(i), int(side)) for i, side in np.argwhere(gap))
    return BifurcationPoint(
        label(found, bounds.names, bounds.joints), Pose(position, turned), frozen(values)
    )


def _held(held: Mapping[str, float]) -> tuple[list[int], Array]:
    wanted = "a mapping from x, y, z to numbers"
    check_type("held", held, Mapping, wanted)
    with reading("held", wanted, held):
        given = dict(held)
    for name in given:
        if name not in COORDINATES:
            raise InvalidInput(expected("held", "coordinates x, y, z", repr(name)))
    places = np.array([arguments.number(f"held {name}", x) for name, x in given.items()])
    return [COORDINATES[name] for name in given], places


def _solve(
    bounds: BoundedQuantities,
    joints: list[int],
    target: Array,
    axes: list[int],
    places: Array,
    fixed: Array | None,
    guess: Pose,
) -> tuple[Array, Array]:
    scale = bounds.scale

    def equations(pose: tuple[Array, Array]) -> tuple[Array, Array]:
        position, rotation = pose
        values, rows = bounds.evaluate(position, rotation)
        weight = np.repeat([scale, 1.0], 3) / bounds.sizes[joints, None]
        gaps = [
            (values[:, joints] - target) / bounds.sizes[joints],
            (position[:, axes] - places) / scale,
        ]
        matrices = [rows[:, joints] * weight, np.eye(6)[None, axes]]
        if fixed is not None:
            gaps.append(log3(rotation @ fixed.T))
            matrices.append(np.eye(6)[None, 3:])
        residual = np.nan_to_num(np.concatenate(gaps, axis=1), nan=np.inf)
        return residual, np.concatenate(matrices, axis=1)

    def move(pose: tuple[Array, Array], step: Array) -> tuple[Array, Array]:
        return moved(*pose, step, scale)

    (position, rotation), residual = newton(
        (guess.position[None], guess.rotation[None]),
        equations,
        move,
        solve=solve_least_squares,
        longest=LONGEST_CRITICAL_STEP,
        most=BIFURCATION_STEPS,
        rest=BIFURCATION_RESIDUAL,
    )
    if not residual[0] < RESIDUAL_TOLERANCE:
        raise EmptyWorkspace(
            "bifurcation point: expected a pose near the guess that satisfies all equations, "
            f"received a residual of {residual[0]:.3g} sizes of the design"
        )
    return position[0], rotation[0]
