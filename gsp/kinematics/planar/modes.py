"""All assembly modes of planar platforms with three legs, and the one nearest to a guess."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_type
from gsp.errors import InvalidInput, UndefinedPosture, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.matrices import determinant_sign, newton, solve_least_squares
from gsp.geometry.vectors import Array
from gsp.kinematics.modes.modes import LARGEST_DISTANCE_SIZES
from gsp.kinematics.planar.equations import Equations
from gsp.planar.design import PlanarDesign
from gsp.planar.pose import PlanarPose, distance, wrapped

# Newton steps, tolerance of joint values, and distance below which two modes are one: in sizes of
# the design, and rad.
NEWTON_STEPS, JOINT_TOLERANCE, SAME_MODE = 30, 1e-11, 1e-6
# Joint errors that are rounding.
JOINT_ROUNDING = 1e-15


@dataclass(frozen=True, eq=False, kw_only=True)
class PlanarModes(ReadOnly):
    """Result of `planar_modes`.

    Attributes
    ----------
    pose : PlanarPose of batch shape (n,)
        The poses with the joint values, by angle in (−π, π].
    residual : (n,) array [1, rad]
        Largest joint error, distances as a share of `design.rms_radius`.
    side : (n,) array [1]
        Sign of det J; 0 for a singular pose.
    status : str
        "found": all modes but such as differ from others by less than 1e-6. "moving": the joint
        values allow a motion, and there are poses besides those listed. "incomplete": a distance is
        more than 1e6 times `design.rms_radius`, and no modes were sought. "undefined": joint
        values that are NaN or none that a joint can have; there are no poses.
    """

    pose: PlanarPose
    residual: Array
    side: Array
    status: str


def planar_modes(design: PlanarDesign, joints: ArrayLike) -> PlanarModes:
    """Return all poses at which the actuators of a planar platform have given values.

    Per choice of the sides of lines the position is eliminated from the equations of the legs. What
    is left is a polynomial in z = exp(iφ), whose coefficients are the Fourier coefficients of
    samples. Its roots on the unit circle are refined by Newton's method, and kept if the joint
    values are met. For three RPR legs it is the sextic of their direct kinematics.

    Parameters
    ----------
    design : PlanarDesign
        With three legs, at most one of which is A1.
    joints : (3,) array_like [unit of the design, rad]

    Returns
    -------
    PlanarModes

    Raises
    ------
    InvalidInput
        On other designs, types or shapes.

    *Source: ours; the degree six of 3-RPR is classical.*

    Examples
    --------
    >>> import numpy as np
    >>> from gsp.kinematics import planar_modes
    >>> from gsp.planar import PlanarDesign, PlanarPose
    >>> angle = np.arange(3) * 2 * np.pi / 3
    >>> ring = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    >>> design = PlanarDesign(["D1"] * 3, 2 * ring, ring)
    >>> found = planar_modes(design, design.at(PlanarPose([0.1, 0.2], 0.3)).joints)
    >>> found.pose.angle.round(6)
    array([-0.3,  0.3])
    """
    target = _check(design, joints)
    if not _possible(design, target):
        return _result(design, target, np.empty((0, 3)), "undefined")
    if (target[~design.angular] > LARGEST_DISTANCE_SIZES * design.rms_radius).any():
        return _result(design, target, np.empty((0, 3)), "incomplete")
    linear = [i for i, row in enumerate(design.rows) if row.constraint.one_line]
    found, moving = [], False
    for signs in product((1.0, -1.0), repeat=len(linear)):
        signed = target.copy()
        signed[linear] *= signs
        equations = Equations(design, signed)
        turned = design.angular.any()
        angles, vanishes = (equations.given_angle(), False) if turned else equations.angles()
        moving |= vanishes
        for angle in angles:
            positions, free = equations.positions(angle)
            moving |= free
            found += [[*position, angle] for position in positions]
    poses = _refined(design, target, np.array(found).reshape(-1, 3))
    return _result(design, target, poses, "moving" if moving else "found")


def planar_forward(design: PlanarDesign, joints: ArrayLike, guess: PlanarPose) -> PlanarPose:
    """Return the pose with given joint values that is nearest to a guess on its side of det J = 0.

    Of all assembly modes with the sign of det J that the guess has it is the one with the least
    |Δp| / L + |Δφ|, L = `design.rms_radius`. That a regular path leads there is not proven.

    Parameters
    ----------
    design : PlanarDesign
        With three legs, at most one of which is A1.
    joints : (3,) array_like [unit of the design, rad]
    guess : PlanarPose of batch shape ()

    Returns
    -------
    PlanarPose of batch shape ()

    Raises
    ------
    InvalidInput
        If the guess is singular (`PlanarPosture.singular`), there is no such pose, or on other
        designs, types or shapes.
    UndefinedPosture
        If the guess has an undefined leg.

    *Source: ours; the poses are those of `planar_modes`.*

    Examples
    --------
    >>> import numpy as np
    >>> from gsp.kinematics import planar_forward
    >>> from gsp.planar import PlanarDesign, PlanarPose
    >>> angle = np.arange(3) * 2 * np.pi / 3
    >>> ring = np.stack((np.cos(angle), np.sin(angle)), axis=1)
    >>> design = PlanarDesign(["D1"] * 3, 2 * ring, ring)
    >>> joints = design.at(PlanarPose([0.1, 0.2], 0.3)).joints
    >>> planar_forward(design, joints, PlanarPose([0.0, 0.0], 0.2)).position.round(9)
    array([0.1, 0.2])
    """
    check_type("guess", guess, PlanarPose)
    if guess.shape:
        raise InvalidInput(expected("guess", "a single pose", f"shape {guess.shape}"))
    modes = planar_modes(design, joints)
    posture = design.at(guess)
    if posture.undefined:
        raise UndefinedPosture(design.name, posture.undefined)
    here = determinant_sign(posture.about_centre)
    if here == 0.0:
        raise InvalidInput(expected("guess", "a regular pose", "a singular one"))
    move, turn = modes.pose.position - guess.position, modes.pose.angle - guess.angle
    apart = distance(move, turn, design.rms_radius)
    apart[modes.side != here] = np.inf
    if not np.isfinite(apart).any():
        wanted = "values that a pose on the side of the guess has"
        raise InvalidInput(expected("joints", wanted, np.asarray(joints).tolist()))
    return modes.pose[int(np.argmin(apart))]


def _check(design: PlanarDesign, joints: ArrayLike) -> Array:
    check_type("design", design, PlanarDesign, "a gsp.planar.PlanarDesign")
    if design.n_legs != 3 or design.angular.sum() > 1:
        names = [leg.name for leg in design.legs]
        raise InvalidInput(expected("design", "three legs, at most one of them A1", names))
    target = check_array("joints", joints, (3,), finite=False)
    if target.ndim != 1:
        raise InvalidInput(expected("joints", "shape (3,)", f"shape {target.shape}"))
    return target


def _possible(design: PlanarDesign, target: Array) -> bool:
    with np.errstate(invalid="ignore"):
        inside = np.where(design.angular, np.abs(target) <= np.pi, target >= 0.0)
    return bool((inside & np.isfinite(target)).all())


def _errors(design: PlanarDesign, target: Array, poses: Array) -> tuple[Array, Array]:
    """Return joint errors and rows in sizes of the design: (m, 3) and (m, 3, 3)."""
    posture = design.at(PlanarPose(poses[:, :2], poses[:, 2]))
    error = posture.joints - target
    error = np.where(design.angular, wrapped(error), error / design.rms_radius)
    return error, posture.homogeneous(design.rms_radius)


def _refined(design: PlanarDesign, target: Array, poses: Array) -> Array:
    """Return the poses that meet the joint values after Newton's method, each once, by angle."""
    size = design.rms_radius
    best, least = poses.copy(), np.full(len(poses), np.inf)

    def equations(poses: Array) -> tuple[Array, Array]:
        error, rows = _errors(design, target, poses)
        finite = np.isfinite(rows).all(axis=-1) & np.isfinite(error)
        defined = np.asarray(finite.all(axis=-1))
        largest = np.where(np.isnan(error), np.inf, np.abs(error)).max(axis=-1, initial=0.0)
        # At a double root steps become long by rounding, after the pose is as good as it can be.
        better = largest < least
        best[better], least[better] = poses[better], largest[better]
        return (
            np.where(defined[:, None], error, np.nan),
            np.where(defined[:, None, None], rows, 0.0),
        )

    def move(poses: Array, step: Array) -> Array:
        return poses + step * [size, size, 1.0]

    newton(
        poses,
        equations,
        move,
        solve=solve_least_squares,
        longest=1.0,
        most=NEWTON_STEPS,
        rest=JOINT_ROUNDING,
    )
    kept: list[Array] = []
    for pose in best[least <= JOINT_TOLERANCE]:
        pose[2] = -wrapped(-pose[2])
        apart = (distance(pose[:2] - other[:2], pose[2] - other[2], size) for other in kept)
        if min(apart, default=np.inf) > SAME_MODE:
            kept.append(pose)
    return np.array(sorted(kept, key=lambda pose: float(pose[2]))).reshape(-1, 3)


def _result(design: PlanarDesign, target: Array, poses: Array, status: str) -> PlanarModes:
    error, _ = _errors(design, target, poses)
    pose = PlanarPose(poses[:, :2], poses[:, 2])
    return PlanarModes(
        pose=pose,
        residual=np.abs(error).max(axis=-1, initial=0.0),
        side=determinant_sign(design.at(pose).about_centre),
        status=status,
    )
