"""Stiffness and compliance of a platform whose actuators are springs."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from gsp.arguments import LARGEST_NUMBER, bounded_array
from gsp.checks import check_type
from gsp.errors import InvalidInput, apart, expected
from gsp.geometry.frames.changes import twists_about_point
from gsp.geometry.frames.placements import common_shape
from gsp.geometry.matrices import defined_matrices, full_rank, log_and_inverse, singular_values
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design
from gsp.model.posture import Posture
from gsp.model.posture.assembled import finite_rows
from gsp.model.posture.derivatives import rows_and_derivatives
from gsp.model.posture.evaluated import arm_of_centre
from gsp.model.posture.statics import forces_or_nan


def stiffness(
    design: Design, pose: Pose, k: ArrayLike, *, preload: ArrayLike | None = None
) -> Array:
    """Return the Cartesian stiffness matrix for the stiffness of the actuators, Jᵀ diag(k) J.

    It is the change of the external wrench per small displacement (δ, θ) of the platform, as in
    `Pose.moved`. With `preload` the change of Jᵀ under the actuator forces f that balance that
    wrench is added, −Σ fᵢ ∂Jᵢ/∂x; the matrix is not symmetric then, as the axes of the wrench are
    those of the base.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape (...) [unit of the design]
    k : float, or (n,) or (..., n) array_like [force/unit of the design; force · unit/rad for A1]
        Stiffness of the actuators, > 0.
    preload : (..., 6) array_like or None [force, force · unit of the design]
        External force and moment about the platform origin, in base axes.

    Returns
    -------
    (..., 6, 6) array [force/unit, force, force · unit]
        About the platform origin, in base axes. NaN where the posture is undefined, a drive at the
        base is singular, or with `preload` the posture is.

    Raises
    ------
    InvalidInput
        On other types or shapes, or stiffnesses that are not positive.

    *Source: Gosselin (1990), IEEE Trans. Robotics Autom. 6, without preload; with it ours.*

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> gsp.stiffness(d, d.home, 1000.0).shape
    (6, 6)
    """
    check_type("design", design, Design)
    check_type("pose", pose, Pose)
    posture = design.at(pose)
    return _stiffness(posture, per_actuator("k", k, posture), preload)


def compliance(
    design: Design, pose: Pose, k: ArrayLike, *, preload: ArrayLike | None = None
) -> Array:
    """Return the compliance matrix: small displacements (δ, θ) per external wrench.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape (...) [unit of the design]
    k : float, or (n,) or (..., n) array_like [force/unit of the design; force · unit/rad for A1]
        Stiffness of the actuators, > 0.
    preload : (..., 6) array_like or None [force, force · unit of the design]
        See `stiffness`.

    Returns
    -------
    (..., 6, 6) array [unit/force, 1/force, 1/(force · unit)]
        NaN where the posture is undefined or singular (see `Posture.singular`), or where the
        preload makes the stiffness singular.

    Raises
    ------
    InvalidInput
        On other types or shapes, or stiffnesses that are not positive.

    *Source: the inverse of `stiffness`.*

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> (gsp.statics.compliance(d, d.home, 10.0) @ gsp.stiffness(d, d.home, 10.0)).round(9)[0] + 0.0
    array([1., 0., 0., 0., 0., 0.])
    """
    check_type("design", design, Design)
    check_type("pose", pose, Pose)
    posture = design.at(pose)
    root = weighted_inverse(posture, np.sqrt(per_actuator("k", k, posture)))
    if preload is None:
        return np.asarray(root @ np.swapaxes(root, -1, -2))
    # With R = (W J)⁺ and H = Σ fᵢ ∂Jᵢ/∂x: (JᵀW²J − H)⁻¹ = R (1 − RᵀHR)⁻¹ Rᵀ, where nothing is
    # inverted that has a unit, or the square of the condition of W J.
    relative = np.swapaxes(root, -1, -2) @ _change_by_preload(posture, preload) @ root
    inner = _inverse(np.eye(root.shape[-1]) - relative)
    return np.asarray(root @ inner @ np.swapaxes(root, -1, -2))


def directional_stiffness(
    design: Design,
    pose: Pose,
    k: ArrayLike,
    direction: ArrayLike,
    *,
    preload: ArrayLike | None = None,
) -> Array:
    """Return the stiffness along a direction, 1/(nᵀ K⁻¹ n).

    A force of unit size along n through the platform origin displaces that point by nᵀ K⁻¹ n along
    n, while the platform is free to move across n and to turn. A direction of six numbers is a
    wrench (force, moment) about the platform origin; it is divided by the size of its force, or of
    its moment where there is no force, and the displacement is the one on which it does work.

    Parameters
    ----------
    design : Design
    pose : Pose of batch shape (...) [unit of the design]
    k : float, or (n,) or (..., n) array_like [force/unit of the design; force · unit/rad for A1]
        Stiffness of the actuators, > 0.
    direction : (3,), (6,), (..., 3) or (..., 6) array_like [1, the moment in units of length]
        In base axes; not zero. Its size does not matter.
    preload : (..., 6) array_like or None [force, force · unit of the design]
        See `stiffness`.

    Returns
    -------
    (...) array [force/unit; force · unit/rad for a moment without a force]
        Positive without `preload`. NaN where `compliance` is.

    Raises
    ------
    InvalidInput
        On other types or shapes, stiffnesses that are not positive, or a direction of zeros.

    *Source: the definition; the compliance is that of `compliance`.*

    Examples
    --------
    >>> import gsp
    >>> d = gsp.hexapod(1.0, 0.4, 0.6, 0.4, 1.2)
    >>> up = gsp.statics.directional_stiffness(d, d.home, 10.0, [0, 0, 1])
    >>> bool(up > gsp.statics.directional_stiffness(d, d.home, 10.0, [1, 0, 0]))
    True
    """
    wrench = _unit_wrench(direction)  # raises an error before anything is computed
    matrix = compliance(design, pose, k, preload=preload)
    shape = common_shape("direction", wrench.shape[:-1], matrix.shape[:-2])
    wrench = np.broadcast_to(wrench, (*shape, 6))[..., None]
    with np.errstate(divide="ignore", over="ignore"):
        given = (np.swapaxes(wrench, -1, -2) @ matrix @ wrench)[..., 0, 0]
        return np.asarray(1.0 / given)


def _unit_wrench(direction: ArrayLike) -> Array:
    """Return directions as wrenches (..., 6) whose force, or else whose moment, has unit size."""
    given = bounded_array("direction", direction, (None,))
    if given.shape[-1] not in (3, 6):
        wanted = "shape (..., 3) or (..., 6)"
        raise InvalidInput(expected("direction", wanted, f"shape {given.shape}"))
    force, moment = given[..., :3], given[..., 3:]
    turns = moment.shape[-1] > 0 and ~force.any(axis=-1, keepdims=True)
    size = np.where(turns, norm(moment)[..., None], norm(force)[..., None])
    if (size < 1.0 / LARGEST_NUMBER).any():
        wanted = f"a direction of a size of at least {1.0 / LARGEST_NUMBER:g}"
        raise InvalidInput(expected("direction", wanted, f"{np.abs(given).max(axis=-1).min():g}"))
    zeros = np.zeros((*given.shape[:-1], 6 - given.shape[-1]))
    return np.concatenate((given / size, zeros), axis=-1)


def weighted_inverse(posture: Posture, weights: Array) -> Array:
    """Return the (pseudo-)inverse of diag(weights) J, (W J)⁺.

    It is (JᵀW²J)⁻¹ JᵀW, and its product with its transpose is (JᵀW²J)⁻¹. Neither matrix is formed,
    and rows of very unlike weights, such as those of torques in a small unit, cost no digits.

    Parameters
    ----------
    posture : Posture, batch shape (...)
    weights : (..., n) array [1 per unit of the joint value]
        Positive.

    Returns
    -------
    (..., 6, n) array
        Displacements (δ, θ) of the platform origin, in base axes. NaN where the posture is
        undefined or singular.
    """
    size = posture.design.rms_radius
    rows = posture.about_centre * (weights / np.where(posture.angular, size, 1.0))[..., None]
    value, inverse = log_and_inverse(rows)
    regular = np.isfinite(value) & posture.defined & ~posture.singular()
    inverse = np.where(regular[..., None, None], inverse, np.nan)
    centre = arm_of_centre(posture.design, posture.pose)
    turns = inverse[..., 3:, :] / size
    twists = np.swapaxes(np.concatenate((inverse[..., :3, :], turns), axis=-2), -1, -2)
    return np.swapaxes(twists_about_point(twists, -centre[..., None, :]), -1, -2)


def _stiffness(posture: Posture, springs: Array, preload: ArrayLike | None) -> Array:
    jacobian = finite_rows(posture, posture.jacobian)
    result = np.swapaxes(jacobian, -1, -2) @ (springs[..., None] * jacobian)
    if preload is not None:
        result = result - _change_by_preload(posture, preload)
    return np.asarray(result)


def _change_by_preload(posture: Posture, preload: ArrayLike) -> Array:
    """Return Σ fᵢ ∂Jᵢ/∂x (..., 6, 6) for the actuator forces f that balance a wrench."""
    forces = posture.actuator_forces(forces_or_nan("preload", preload, 6))
    return np.asarray((forces[..., None, None] * rows_and_derivatives(posture)[1]).sum(axis=-3))


def per_actuator(what: str, value: ArrayLike, posture: Posture) -> Array:
    """Return one positive number per actuator, shape (..., n), from one for all or one for each.

    Raises
    ------
    InvalidInput
        On other shapes, or numbers that are not positive, below 1e-100 or beyond 1e100.
    """
    given = bounded_array(what, value, ())
    least = float(given.min(initial=1.0))
    if least < 1.0 / LARGEST_NUMBER:
        got, low = apart(least, 1.0 / LARGEST_NUMBER)
        wanted = "positive numbers" + (f" of at least {low}" if least > 0.0 else "")
        raise InvalidInput(expected(what, wanted, f"{got} as the least"))
    n = len(posture.joint_names)
    if given.ndim and given.shape[-1] != n:
        wanted = f"one number, or shape (..., {n})"
        raise InvalidInput(expected(what, wanted, f"shape {given.shape}"))
    common_shape(what, given.shape[:-1], posture.shape)
    return np.broadcast_to(given, (*given.shape[:-1], n))


def _inverse(matrix: Array) -> Array:
    """Return inverses, NaN of matrices of less than full rank and of undefined ones."""
    known = defined_matrices(matrix)
    safe = np.where(known[..., None, None], matrix, np.eye(matrix.shape[-1]))
    known &= full_rank(singular_values(safe))
    safe = np.where(known[..., None, None], matrix, np.eye(matrix.shape[-1]))
    return np.where(known[..., None, None], np.linalg.inv(safe), np.nan)
