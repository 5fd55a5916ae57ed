"""All assembly modes of designs with six constraints."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp.checks import check_array, check_type
from gsp.errors import InvalidInput, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.matrices import condition, determinant_sign, singular_values
from gsp.geometry.pose import Pose, unchecked
from gsp.geometry.vectors import Array, Mask
from gsp.kinematics.driven.locked import held, usable
from gsp.kinematics.modes.census import confirmed_counts
from gsp.kinematics.modes.certificates import certified
from gsp.kinematics.modes.drives import of_drives
from gsp.kinematics.modes.ends import Ends, ends_of, real_poses
from gsp.kinematics.modes.equations import order_of, parameters_from, rotations
from gsp.kinematics.modes.reach import contradict
from gsp.kinematics.modes.starts import start_of
from gsp.kinematics.newton.centred import Centred, centred
from gsp.model.design import Design

# Distances in sizes of the design beyond which paths are not followed.
LARGEST_DISTANCE_SIZES = 1e6
# Joint error above which a mode is polished, how often, and the singular values that count then.
POLISHED_RESIDUAL, JOINT_STEPS, POLISHED_RCOND = 1e-14, 3, 1e-12

# Largest residual of a regular mode.
ROUGH_RESIDUAL = 1e-10

# What each status but "found" means, for people.
STATUS_MEANINGS = MappingProxyType({
    "multiple": "some of the modes are singular poses, found to about half of the digits",
    "moving": "the platform can move with locked actuators: there are poses besides those listed",
    "incomplete": "paths were lost, or solutions are in doubt: modes may be missing or wrong",
    "undefined": "joint values that are missing, or none that a joint can have",
    "impossible": "two joint values contradict each other, whatever the pose",
})  # fmt: skip


@dataclass(frozen=True, eq=False, kw_only=True)
class AssemblyModes(ReadOnly):
    """Result of `assembly_modes`.

    Attributes
    ----------
    joints : (6,) array [unit of the design, rad]
        The joint values.
    poses : Pose of batch shape (n,)
        The real poses with the joint values, each once. With drives at the base, on all branches.
    residual : (n,) array [1, rad]
        Largest joint error, distances as a share of `design.rms_radius`; of a drive the error of
        the length of its rod. NaN where a leg is undefined.
    side : (n,) array [1]
        Sign of det J; 0 for a singular solution, and where a drive at the base is singular.
    condition : (n,) array [1]
        Condition number of the Jacobian with the length `design.rms_radius`, twists at the centre
        of the platform anchors; inf where `side` is 0.
    multiplicity : (n,) int array
        Number of paths that ended there: 1 for a regular solution.
    certified : (n,) bool array
        Whether it is proven that there is exactly one solution in a box about the pose, and that
        the boxes are disjoint. False without `certify=True`.
    radius : (n,) array [1]
        Half sides of these boxes: of the components of a unit quaternion, and, in units of
        `design.rms_radius`, of the place of the centre of the platform anchors, seen from that of
        the base anchors. NaN without a proof. The boxes, and whether there is a proof, do not
        depend on the origins of the frames; the rounding of `poses` in frames that are far from the
        anchors is not a part of the boxes. With drives at the base, the tips of the rods are the
        base anchors, at their rounded places, and the size is that of the design with these.
    on_branches : (n,) bool array
        Whether all drives at the base are on the branches that the design states; True without
        drives. On other branches the drives have the given values, but `design.at(pose).joints` are
        those of the stated branches: a motion from one to the other passes a singular drive.
    n_complex : int
        Number of regular solutions in complex numbers, the real ones included.
    n_singular, n_infinite, n_lost : int
        Numbers of paths that ended at singular solutions, of those that diverged, and of those
        that could not be followed. The four numbers add up to `n_paths`.
    n_paths : int
        Number of paths: that of the solutions of a general member of the mechanism.
    status : str
        "found": all modes, as ends of the `n_paths` paths; of a mechanism whose number is not
        confirmed in `catalogue/root_counts.csv` as many as were known. "multiple": the same, some
        of them multiple. These are singular poses, and found to about half of the digits.
        Where two or more motions are hardly controlled, modes within about 1e-5 of the size of a
        multiple one may be missing. "moving": the joint values allow a motion, and there are poses
        besides those listed.
        "incomplete": some paths were lost, an odd number of solutions is not real, a regular mode
        has a residual above 1e-10, or solutions lie on a complex curve without a real mode on it
        that is known, and modes may be missing or wrong; also if a distance is
        more than 1e6 times `design.rms_radius`. "undefined": joint values that are NaN or none that
        a joint can have; there are no poses. "impossible": two joint values contradict each other,
        whatever the pose, by a triangle inequality between the anchors; there are no poses.
    """

    joints: Array
    poses: Pose
    residual: Array
    side: Array
    condition: Array
    multiplicity: NDArray[np.int64]
    certified: Mask
    radius: Array
    on_branches: Mask
    n_complex: int
    n_singular: int
    n_infinite: int
    n_lost: int
    n_paths: int
    status: str


def assembly_modes(design: Design, joints: ArrayLike, *, certify: bool = False) -> AssemblyModes:
    """Return all poses at which the actuators have given values.

    The equations of the legs are polynomials in a quaternion and a position. A general system of
    the same legs, with complex dimensions, was solved once: `catalogue/root_counts.csv` has the
    numbers of its solutions. Its dimensions move on a straight line to those of the design, and
    each solution is followed. No member of the family has more isolated solutions, so the ends of
    the paths are all of them. Which of them are real is decided by Newton's method in real numbers.

    What is counted are complex poses that satisfy squared distances and cosines of angles.

    With drives at the base the locked drives hold the tips of the rods, and the modes are those of
    the D1 legs from these tips, with the lengths of the rods. They include poses on other branches
    than those of the design, which `on_branches` labels.

    Parameters
    ----------
    design : Design
        With six actuators. The first call for a mechanism finds the general system, in a second to
        about a minute; later calls take well under a millisecond for each path.
    joints : (6,) array_like [unit of the design, rad]
        In the order of `design.joint_names`.
    certify : bool
        Prove each real mode in ball arithmetic (extra `verify`).

    Returns
    -------
    AssemblyModes

    Raises
    ------
    InvalidInput
        On other numbers of actuators, types or shapes.
    MissingSoftware
        With `certify` and without python-flint.

    *Source: coefficient-parameter homotopy of Morgan and Sommese; the 40 solutions of six SPS legs
    are those of Ronga and Vust, Lazard, Raghavan and Mourrain.*

    Examples
    --------
    >>> import gsp
    >>> lift = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    >>> modes = gsp.assembly_modes(lift, lift.at(lift.home).joints)
    >>> modes.status, modes.n_complex, len(modes.residual)
    ('found', 28, 8)
    """
    check_type("design", design, Design)
    check_type("certify", certify, bool, "True or False")
    target = _check(design, joints)
    if not design.driven:
        return _modes(design, target, certify=certify)
    if not usable(target):
        return _nothing("undefined", target)
    return of_drives(design, target, _modes(*held(design, target), certify=certify))


def _modes(design: Design, target: Array, *, certify: bool) -> AssemblyModes:
    """Return the modes of a design without drives at the base."""
    system = centred(design)
    values = system.joints_from(target)
    if not system.possible(values):
        return _nothing("undefined", target)
    if contradict(design, target):
        return _nothing("impossible", target)
    if values.max() > LARGEST_DISTANCE_SIZES:
        return _nothing("incomplete", target)
    names, rows = order_of([leg.name for leg in design.legs])
    known = _expected(design, names)
    start = start_of(names, known)
    parameters = np.ascontiguousarray(parameters_from(system, values)[rows])
    ends = ends_of(start, parameters, known)
    poses, places = real_poses(start.layout, parameters, ends)
    return _result(design, target, poses, places, ends, certify=certify)


def _check(design: Design, joints: ArrayLike) -> Array:
    if len(design.joint_names) != 6:
        got = f"{len(design.joint_names)}"
        raise InvalidInput(expected("design", "six actuators", got))
    target = check_array("joints", joints, (6,), finite=False)
    if target.ndim != 1:
        raise InvalidInput(expected("joints", "shape (6,)", f"shape {target.shape}"))
    return target


def _expected(design: Design, names: tuple[str, ...]) -> int | None:
    """Return the number of solutions if the table has the legs of a design, confirmed."""
    mechanism = design.mechanism
    known = mechanism is not None and order_of([leg.name for leg in mechanism.legs])[0] == names
    return confirmed_counts().get(mechanism.name) if known else None


def _nothing(status: str, target: Array) -> AssemblyModes:
    none = np.empty(0)
    return AssemblyModes(
        joints=target,
        poses=Pose(np.empty((0, 3)), np.empty((0, 3, 3))),
        residual=none,
        side=none,
        condition=none,
        multiplicity=np.empty(0, dtype=np.int64),
        certified=np.empty(0, dtype=bool),
        radius=none,
        on_branches=np.empty(0, dtype=bool),
        n_complex=0,
        n_singular=0,
        n_infinite=0,
        n_lost=0,
        n_paths=0,
        status=status,
    )


def _result(
    design: Design,
    target: Array,
    solutions: Array,
    places: NDArray[np.int64],
    ends: Ends,
    *,
    certify: bool,
) -> AssemblyModes:
    system = centred(design)
    solutions[:, :4] /= np.linalg.norm(solutions[:, :4], axis=1, keepdims=True)
    small = unchecked(Pose, solutions[:, 4:], rotations(solutions.astype(np.complex128)).real)
    small = _polished(system, system.joints_from(target), small)
    poses = system.pose_to(small)
    radius = np.full(len(solutions), np.nan)
    if certify:
        centres = np.hstack((small.quaternion[:, [3, 0, 1, 2]], small.position))
        radius = np.where(ends.singular[places], np.nan, certified(design, target, centres))
    singular = ends.singular[places]
    side, ratio = _regularity(system, small)
    regular, total = int((~ends.singular).sum()), int(ends.multiplicity.sum())
    residual = _residual(design, target, poses)
    rough = bool((residual[~singular] > ROUGH_RESIDUAL).any())
    odd = (total - int(ends.multiplicity[places].sum())) % 2 == 1  # others are conjugates
    unseen = ends.curved and not singular.any()  # a curve may have real poses
    return AssemblyModes(
        joints=target,
        poses=poses,
        residual=residual,
        side=np.where(singular, 0.0, side),
        condition=np.where(singular, np.inf, ratio),
        multiplicity=ends.multiplicity[places],
        certified=np.isfinite(radius),
        radius=radius,
        on_branches=np.ones(len(solutions), dtype=bool),
        n_complex=regular,
        n_singular=total - regular,
        n_infinite=ends.at_infinity,
        n_lost=ends.lost,
        n_paths=total + ends.at_infinity + ends.lost,
        status=_status(ends, total - regular, doubtful=rough or odd or unseen),
    )


def _status(ends: Ends, multiple: int, *, doubtful: bool) -> str:
    if ends.moving:
        return "moving"
    if ends.lost or ends.excess or doubtful:
        return "incomplete"
    return "multiple" if multiple else "found"


def _polished(system: Centred, target: Array, poses: Pose) -> Pose:
    """Return poses after Newton steps on the joint values, where these reduce their errors.

    The equations have squared distances and cosines, whose roundings are large errors of distances
    near 0 and of angles near 0 or π.
    """
    for _ in range(JOINT_STEPS):
        posture = system.design.at(poses)
        errors = posture.joints - target
        worst = np.abs(errors).max(axis=-1, initial=0.0)
        poor = np.flatnonzero(worst > POLISHED_RESIDUAL)  # without undefined ones
        if not poor.size:
            break
        inverses = np.linalg.pinv(posture.jacobian[poor], rcond=POLISHED_RCOND)
        moved = poses[poor].moved(-(inverses @ errors[poor, :, None])[..., 0])
        after = np.abs(system.design.at(moved).joints - target).max(axis=-1)
        better = after < worst[poor]
        position, rotation = poses.position.copy(), poses.rotation.copy()
        position[poor[better]] = moved.position[better]
        rotation[poor[better]] = moved.rotation[better]
        poses = unchecked(Pose, position, rotation)
    return poses


def _residual(design: Design, target: Array, poses: Pose) -> Array:
    error = np.abs(design.at(poses).joints - target)
    return np.asarray((error / np.where(design.angular, 1.0, design.rms_radius)).max(axis=-1))


def _regularity(system: Centred, poses: Pose) -> tuple[Array, Array]:
    """Return the sign of det J and the condition number, NaN where a leg is undefined."""
    rows = system.design.at(poses).jacobian
    return determinant_sign(rows), condition(singular_values(rows))
