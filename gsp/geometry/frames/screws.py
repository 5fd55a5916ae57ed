"""Screw motions: exponentials and logarithms of rotations and placements, and interpolation.

Functions have Pinocchio's names. Its objects are computed by Pinocchio and returned as such;
arrays of any batch shape are computed here, and tests compare both element by element. For NaN,
an undefined element, the result is NaN.
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
    common_shape,
    is_motion,
    is_placement,
    placement_of,
    se3,
    vectors_of,
)
from gsp.geometry.frames.software import import_pinocchio
from gsp.geometry.rotations import check_rotation, known_rotations
from gsp.geometry.vectors import Array, cross, dot, skew

# Below this angle [rad] the differences (θ − sin θ) / θ³ and 1 − (θ/2) cot(θ/2) are taken from
# their series, whose first omitted term is below 1e-15 of the sum there; above it, cancellation
# costs two digits of a term that is a thousandth of the result.
SERIES_ANGLE = 0.1


def exp3(vector: ArrayLike) -> Array:
    """Return the rotations exp([ω]×) of rotation vectors.

    Parameters
    ----------
    vector : (..., 3) array_like [rad]
        ω, axis × angle.

    Returns
    -------
    (..., 3, 3) array [1]
        NaN where the vector is NaN.

    Raises
    ------
    InvalidInput
        On a wrong shape.

    *Source: Murray1994, chapter 2: the exponential of a rotation.*

    Examples
    --------
    >>> exp3([0.0, 0.0, np.pi / 2]).round(3)[0]
    array([ 0., -1.,  0.])
    """
    from scipy.spatial.transform import Rotation

    values = check_array("vector", vector, (3,), finite=False)
    # A copy, as scipy raises an error for read-only arrays here.
    turn = Rotation.from_rotvec(np.array(values).reshape(-1, 3))
    return np.asarray(turn.as_matrix(), dtype=np.float64).reshape(*values.shape, 3)


def log3(rotation: ArrayLike) -> Array:
    """Return the rotation vectors of rotations, of angles in [0, π].

    Parameters
    ----------
    rotation : (..., 3, 3) array_like [1]

    Returns
    -------
    (..., 3) array [rad]
        NaN where the rotation is NaN. At an angle of π either sign of the axis is right.

    Raises
    ------
    InvalidInput, InvalidRotation
        On a wrong shape, or matrices that are not rotations.

    *Source: Murray1994, chapter 2: the inverse of the exponential of a rotation.*
    """
    matrix = check_rotation("rotation", rotation, finite=False)
    turn, known = known_rotations(matrix)
    vector = np.where(known[:, None], turn.as_rotvec(), np.nan)
    return np.asarray(vector, dtype=np.float64).reshape(matrix.shape[:-1])


def exp3_rates(vector: Array) -> Array:
    """Return the matrices from rates of rotation vectors to angular velocities in base axes.

    ω = V φ̇ with V = I + (1 − cos θ)/θ² [φ]× + (θ − sin θ)/θ³ [φ]×², θ = |φ|: the left Jacobian
    of `exp3`, which is singular at θ = 2π, 4π, ….

    Parameters
    ----------
    vector : (..., 3) array [rad]
        φ, axis × angle, of any angle.

    Returns
    -------
    (..., 3, 3) array [1]
        NaN where the vector is NaN.
    """
    square = dot(vector, vector)[..., None, None]
    angle = np.sqrt(square)
    # (1 − cos θ)/θ² by the half angle, as the difference would lose half of the digits.
    first = 0.5 * np.sinc(0.5 * angle / np.pi) ** 2
    with np.errstate(invalid="ignore", divide="ignore"):
        direct = (1.0 - np.sinc(angle / np.pi)) / square
    series = 1 / 6 - square / 120 + square**2 / 5040 - square**3 / 362880
    second = np.where(angle < SERIES_ANGLE, series, direct)
    across = skew(vector)
    return np.asarray(np.eye(3) + first * across + second * (across @ across))


def exp6(twist: TwistLike) -> Any:
    """Return the placements that a constant twist in the moving frame reaches in unit time.

    p = V v with V = `exp3_rates(ω)`, and R = exp([ω]×).

    Parameters
    ----------
    twist : (..., 6) array_like, or pinocchio.Motion [length, rad]
        (v, ω), taken over unit time.

    Returns
    -------
    Placement of batch shape (...) [length], or pinocchio.SE3 for a pinocchio.Motion
        NaN where the twist is NaN.

    Raises
    ------
    InvalidInput
        On a wrong shape.

    *Source: Murray1994, chapter 2: the exponential of a twist (v, ω).*
    """
    if is_motion(twist):
        pin = import_pinocchio()
        return pin.exp6(twist)
    values = vectors_of("twist", twist)
    v, omega = values[..., :3], values[..., 3:]
    return Placement((exp3_rates(omega) @ v[..., None])[..., 0], exp3(omega))


def log6(placement: PlacementLike) -> Any:
    """Return the twists that reach placements in unit time: the inverse of `exp6`.

    Parameters
    ----------
    placement : Pose or Placement of batch shape (...), pinocchio.SE3 or pinocchio.Frame

    Returns
    -------
    (..., 6) array [length, rad], or pinocchio.Motion for an object of Pinocchio
        (v, ω) in the axes of the frame, angles in [0, π]; NaN where the placement is NaN.

    Raises
    ------
    InvalidInput, InvalidRotation
        If it is not a placement.

    *Source: Murray1994, chapter 2: the inverse of the exponential of a twist (v, ω).*
    """
    if is_placement(placement):
        pin = import_pinocchio()
        return pin.log6(se3(placement))
    position, rotation = placement_of(placement)
    omega = log3(rotation)
    return np.concatenate((screw_velocity(omega, position), omega), axis=-1)


def screw_velocity(vector: Array, displacement: Array) -> Array:
    """Return the velocities v of screw motions that displace the moving origin in unit time.

    v = V⁻¹ p with V = `exp3_rates(ω)`: p − ½ ω × p + (1 − (θ/2) cot(θ/2))/θ² ω × (ω × p), θ = |ω|.

    Parameters
    ----------
    vector : (..., 3) array [rad]
        ω, rotation vectors of angles below 2π.
    displacement : (..., 3) array [length]
        p, in axes of the frame at the start.

    Returns
    -------
    (..., 3) array [length]
        In axes of the frame; NaN where either is NaN.

    *Source: Murray1994, chapter 2: the inverse of the exponential of a twist (v, ω).*
    """
    square = dot(vector, vector)[..., None]
    angle = np.sqrt(square)
    half = 0.5 * angle
    with np.errstate(invalid="ignore", divide="ignore"):
        direct = (1.0 - half / np.tan(half)) / square
    series = 1 / 12 + square / 720 + square**2 / 30240 + square**3 / 1209600
    second = np.where(angle < SERIES_ANGLE, series, direct)
    across = cross(vector, displacement)
    return np.asarray(displacement - 0.5 * across + second * cross(vector, across))


def interpolate(start: PlacementLike, end: PlacementLike, share: ArrayLike) -> Any:
    """Return placements on the screw motion from one placement to another.

    T = T_start exp6(share · log6(T_start⁻¹ T_end)): one rotation about and one translation along
    one axis, at constant rates.

    Parameters
    ----------
    start, end : Pose or Placement of batch shape (...), pinocchio.SE3 or pinocchio.Frame
    share : (...) array_like [1]
        0 at the start, 1 at the end; beyond them the motion continues. Batch shapes broadcast.

    Returns
    -------
    Placement of batch shape (...) [length], or pinocchio.SE3 for two objects of Pinocchio

    Raises
    ------
    InvalidInput, InvalidRotation
        If one is not a placement, or the shapes do not broadcast.

    *Source: Murray1994, chapter 2: a screw motion is the exponential of a multiple of one twist.*
    """
    t = check_array("share", share, ())
    if is_placement(start) and is_placement(end) and t.ndim == 0:
        pin = import_pinocchio()
        return pin.SE3.Interpolate(se3(start), se3(end), float(t))
    one, two = placement_of(start), placement_of(end)
    common_shape("start, end, share", one.position.shape[:-1], two.position.shape[:-1], t.shape)
    moved = log6(compose(inverse(one), two))
    return compose(one, exp6(t[..., None] * moved))


def compose(outer: PlacementLike, inner: PlacementLike) -> Placement:
    """Return placements T_outer T_inner.

    Parameters
    ----------
    outer, inner : Pose or Placement of batch shape (...), pinocchio.SE3 or pinocchio.Frame
        The batch shapes broadcast.

    Returns
    -------
    Placement of batch shape (...)

    Raises
    ------
    InvalidInput, InvalidRotation
        If one is not a placement, or the shapes do not broadcast.

    *Source: Murray1994, chapter 2: products of rigid motions.*
    """
    (p, r), (q, s) = placement_of(outer), placement_of(inner)
    common_shape("outer, inner", p.shape[:-1], q.shape[:-1])
    return Placement(p + (r @ q[..., None])[..., 0], r @ s)


def inverse(placement: PlacementLike) -> Placement:
    """Return the placements of the outer frame in the inner one.

    Parameters
    ----------
    placement : Pose or Placement of batch shape (...), pinocchio.SE3 or pinocchio.Frame

    Returns
    -------
    Placement of batch shape (...)

    Raises
    ------
    InvalidInput, InvalidRotation
        If it is not a placement.

    *Source: Murray1994, chapter 2: the inverse of a rigid motion.*
    """
    position, rotation = placement_of(placement)
    back = np.swapaxes(rotation, -1, -2)
    return Placement(-(back @ position[..., None])[..., 0], back)
