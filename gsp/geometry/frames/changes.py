"""Changes of frame and of reference point: twists, wrenches, inverse Jacobians.

Conventions are Pinocchio's: twists are (v, ω) and wrenches (f, m), linear part first, and a
placement takes coordinates of its own frame to those of the outer one. Pinocchio's `Motion` and
`Force` are computed by Pinocchio and returned as such; arrays of any batch shape are computed
here, and tests compare both element by element.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array
from gsp.geometry.frames.placements import (
    Placement,
    PlacementLike,
    TwistLike,
    WrenchLike,
    common_shape,
    is_force,
    is_motion,
    placement_of,
    se3,
    vectors_of,
)
from gsp.geometry.vectors import Array, cross, skew

# Components of a twist (v, ω), so the columns of an inverse Jacobian.
TWIST_NAMES = ("v_x", "v_y", "v_z", "omega_x", "omega_y", "omega_z")


def action_matrix(placement: PlacementLike) -> Array:
    """Return the matrices that take twists from the axes and origin of a frame to the outer ones.

    [[R, [p]× R], [0, R]]: v' = R v + p × R ω and ω' = R ω.

    Parameters
    ----------
    placement : Pose or Placement of batch shape (...), pinocchio.SE3 or pinocchio.Frame

    Returns
    -------
    (..., 6, 6) array [1, length]

    Raises
    ------
    InvalidInput, InvalidRotation
        If it is not a placement.

    *Source: Murray1994, chapter 2: the adjoint transformation of twists (v, ω).*
    """
    return _block_matrix(placement, (slice(0, 3), slice(3, 6)))


def dual_action_matrix(placement: PlacementLike) -> Array:
    """Return the matrices that take wrenches from the axes and origin of a frame to the outer ones.

    [[R, 0], [[p]× R, R]]: f' = R f and m' = R m + p × R f. It is the inverse transpose of
    `action_matrix`, so that the power of a wrench on a twist stays.

    Parameters
    ----------
    placement : Pose or Placement of batch shape (...), pinocchio.SE3 or pinocchio.Frame

    Returns
    -------
    (..., 6, 6) array [1, length]

    Raises
    ------
    InvalidInput, InvalidRotation
        If it is not a placement.

    *Source: Murray1994, chapter 2: the transformation of wrenches (f, m).*
    """
    return _block_matrix(placement, (slice(3, 6), slice(0, 3)))


def act_twist(placement: PlacementLike, twist: TwistLike) -> Any:
    """Return twists in the axes and about the origin of the outer frame.

    Parameters
    ----------
    placement : Pose or Placement of batch shape (...), pinocchio.SE3 or pinocchio.Frame
    twist : (..., 6) array_like, or pinocchio.Motion [length, rad, per time]
        (v, ω) in the axes and about the origin of the frame. Batch shapes broadcast.

    Returns
    -------
    (..., 6) array, or pinocchio.Motion for a pinocchio.Motion [length, rad, per time]

    Raises
    ------
    InvalidInput, InvalidRotation
        On a wrong shape, or if `placement` is not a placement.

    *Source: Murray1994, chapter 2: the adjoint transformation of twists (v, ω).*
    """
    if is_motion(twist):
        return se3(placement).act(twist)
    values = vectors_of("twist", twist)
    omega, v = _acted(placement, "twist", values[..., 3:], values[..., :3])
    return np.concatenate((v, omega), axis=-1)


def act_wrench(placement: PlacementLike, wrench: WrenchLike) -> Any:
    """Return wrenches in the axes and about the origin of the outer frame.

    Parameters
    ----------
    placement : Pose or Placement of batch shape (...), pinocchio.SE3 or pinocchio.Frame
    wrench : (..., 6) array_like, or pinocchio.Force [force, force · length]
        (f, m) in the axes and about the origin of the frame. Batch shapes broadcast.

    Returns
    -------
    (..., 6) array, or pinocchio.Force for a pinocchio.Force [force, force · length]

    Raises
    ------
    InvalidInput, InvalidRotation
        On a wrong shape, or if `placement` is not a placement.

    *Source: Murray1994, chapter 2: the transformation of wrenches (f, m).*
    """
    if is_force(wrench):
        return se3(placement).act(wrench)
    values = vectors_of("wrench", wrench)
    force, moment = _acted(placement, "wrench", values[..., :3], values[..., 3:])
    return np.concatenate((force, moment), axis=-1)


def act_jacobian(placement: PlacementLike, jacobian: ArrayLike) -> Array:
    """Return inverse Jacobians for twists in the axes and about the origin of the outer frame.

    Rows are wrenches of unit actuator forces, so each is taken as `act_wrench` takes it: the
    rates that belong to a motion stay.

    Parameters
    ----------
    placement : Pose or Placement of batch shape (...), pinocchio.SE3 or pinocchio.Frame
    jacobian : (..., n, 6) array_like [1, length]
        Rows for twists (v, ω) in the axes and about the origin of the frame.

    Returns
    -------
    (..., n, 6) array [1, length]

    Raises
    ------
    InvalidInput, InvalidRotation
        On a wrong shape, or if `placement` is not a placement.

    *Source: ours; each row as by `act_wrench`.*
    """
    rows = check_array("jacobian", jacobian, (None, 6), finite=False)
    position, rotation = placement_of(placement)
    common_shape("placement, jacobian", position.shape[:-1], rows.shape[:-2])
    each = Placement(position[..., None, :], rotation[..., None, :, :])
    return np.asarray(act_wrench(each, rows))


def twist_at(twist: TwistLike, point: ArrayLike) -> Any:
    """Return twists about another reference point: v + ω × r, ω.

    Parameters
    ----------
    twist : (..., 6) array_like, or pinocchio.Motion [length, rad, per time]
        (v, ω), with the velocity v of the present reference point.
    point : (..., 3) array_like [length]
        r, from the present reference point to the other, in the axes of the twist. Batch shapes
        broadcast.

    Returns
    -------
    (..., 6) array, or pinocchio.Motion for a pinocchio.Motion [length, rad, per time]

    Raises
    ------
    InvalidInput
        On wrong shapes.

    *Source: Murray1994, chapter 2: the adjoint transformation with R = 1 and p = −r.*

    Examples
    --------
    >>> twist_at([0.0, 0.0, 0.0, 0.0, 0.0, 1.0], [2.0, 0.0, 0.0])
    array([0., 2., 0., 0., 0., 1.])
    """
    r = check_array("point", point, (3,), finite=False)
    if is_motion(twist):
        return se3(_shifted(r)).act(twist)
    values = vectors_of("twist", twist)
    common_shape("twist, point", values.shape[:-1], r.shape[:-1])
    return twists_about_point(values, r)


def wrench_at(wrench: WrenchLike, point: ArrayLike) -> Any:
    """Return wrenches about another reference point: f, m − r × f.

    Parameters
    ----------
    wrench : (..., 6) array_like, or pinocchio.Force [force, force · length]
        (f, m), with the moment m about the present reference point.
    point : (..., 3) array_like [length]
        r, from the present reference point to the other, in the axes of the wrench. Batch shapes
        broadcast.

    Returns
    -------
    (..., 6) array, or pinocchio.Force for a pinocchio.Force [force, force · length]

    Raises
    ------
    InvalidInput
        On wrong shapes.

    *Source: Murray1994, chapter 2: the transformation of wrenches with R = 1 and p = −r.*

    Examples
    --------
    >>> wrench_at([0.0, 1.0, 0.0, 0.0, 0.0, 0.0], [2.0, 0.0, 0.0])
    array([ 0.,  1.,  0.,  0.,  0., -2.])
    """
    r = check_array("point", point, (3,), finite=False)
    if is_force(wrench):
        return se3(_shifted(r)).act(wrench)
    values = vectors_of("wrench", wrench)
    common_shape("wrench, point", values.shape[:-1], r.shape[:-1])
    return about_point(values, r)


def jacobian_at(jacobian: ArrayLike, point: ArrayLike) -> Array:
    """Return inverse Jacobians for twists about another reference point, with the same rates.

    Each row (f, m) becomes (f, m − r × f). (A Jacobian whose columns are twists changes by
    `twist_at`.)

    Parameters
    ----------
    jacobian : (..., n, 6) array_like [1, length]
        Rows for twists (v, ω), with the velocity v of the present reference point.
    point : (..., 3) array_like [length]
        r, from the present reference point to the other, in the axes of the twists. Batch shapes
        broadcast.

    Returns
    -------
    (..., n, 6) array [1, length]

    Raises
    ------
    InvalidInput
        On wrong shapes.

    *Source: ours; each row as by `wrench_at`.*

    Examples
    --------
    >>> jacobian_at([[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]], [2.0, 0.0, 0.0])
    array([[ 0.,  1.,  0.,  0.,  0., -2.]])
    """
    rows = check_array("jacobian", jacobian, (None, 6), finite=False)
    r = check_array("point", point, (3,), finite=False)
    common_shape("jacobian, point", rows.shape[:-2], r.shape[:-1])
    return about_point(rows, r[..., None, :])


def about_point(rows: Array, r: Array) -> Array:
    """Return rows or wrenches (f, m) about other reference points, (f, m − r × f); unchecked.

    Rows are (..., 6) and r (..., 3) in space, (..., 3) and (..., 2) in the plane. They broadcast.
    """
    n = r.shape[-1]
    return np.concatenate(_moved(r, rows[..., :n], rows[..., n:]), axis=-1)


def twists_about_point(twists: Array, r: Array) -> Array:
    """Return twists (v, ω) about other reference points, (v + ω × r, ω); unchecked.

    Twists are (..., 6) and r (..., 3). They broadcast.
    """
    omega, v = _moved(r, twists[..., 3:], twists[..., :3])
    return np.concatenate((v, omega), axis=-1)


def _shifted(r: Array) -> Placement:
    """Return the placement of the present reference point, seen from another at r."""
    return Placement(-r, np.broadcast_to(np.eye(3), (*r.shape, 3)))


def _block_matrix(placement: PlacementLike, coupling: tuple[slice, slice]) -> Array:
    """Return [[R, 0], [0, R]] with [p]× R in the block `coupling`, shape (..., 6, 6)."""
    position, rotation = placement_of(placement)
    matrix = np.zeros((*rotation.shape[:-2], 6, 6))
    matrix[..., :3, :3] = matrix[..., 3:, 3:] = rotation
    matrix[..., *coupling] = skew(position) @ rotation
    return matrix


# A twist and a wrench are each a free vector (ω, f) and a moment (v, m), which depends on the
# reference point: m' = m + p × f is v' = v + p × ω. Both change by the same two formulas.


def _acted(placement: PlacementLike, what: str, free: Array, moment: Array) -> tuple[Array, Array]:
    """Return free vectors and moments in the outer frame, of the same shape."""
    position, rotation = placement_of(placement)
    common_shape(f"placement, {what}", position.shape[:-1], free.shape[:-1])
    outer = _turned(rotation, free)
    moved = _turned(rotation, moment) + cross(position, outer)
    return np.broadcast_to(outer, moved.shape), moved


def _moved(r: Array, free: Array, moment: Array) -> tuple[Array, Array]:
    """Return free vectors and moments about the point r, with the same batch shape."""
    if r.shape[-1] == 3:
        moved = moment - cross(r, free)
    else:  # in the plane a moment has one component
        moved = moment - (r[..., :1] * free[..., 1:] - r[..., 1:] * free[..., :1])
    return np.broadcast_to(free, (*moved.shape[:-1], r.shape[-1])), moved


def _turned(rotation: Array, vector: Array) -> Array:
    return np.asarray((rotation @ vector[..., None])[..., 0])
