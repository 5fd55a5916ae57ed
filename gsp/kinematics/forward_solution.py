"""Forward kinematics: the pose that given actuator values belong to, near a guess."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from gsp.checks import check_array, check_integer, check_positive, check_type, is_a, plain_text
from gsp.errors import InvalidInput, brief, expected
from gsp.evaluation.backends import check_backend
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import Pose, unchecked
from gsp.geometry.vectors import Array, Mask
from gsp.kinematics.driven.locked import held, on_branches, scales_of_held, usable
from gsp.kinematics.newton import reference
from gsp.kinematics.newton.centred import Centred, centred
from gsp.model.design import Design

Solver = Callable[[Centred, Array, Pose, float, int], tuple[Pose, Array]]

# By the numbers of `gsp.kinematics.newton.control`, and that of a pose by `fallback="modes"`.
STATUS = np.array(["", "converged", "not converged", "singular", "undefined", "nearest mode"])
CONVERGED, NOT_CONVERGED, UNDEFINED, NEAREST_MODE = 1, 2, 4, 5
STATUS.flags.writeable = False
# Views of them, of shape (), for one pose; and usual numbers of iterations.
STATUSES = tuple(STATUS[i, ...] for i in range(len(STATUS)))
_COUNT = np.arange(101)
_COUNT.flags.writeable = False
COUNTS = tuple(_COUNT[i, ...] for i in range(len(_COUNT)))


@dataclass(frozen=True, eq=False)
class ForwardSolution(ReadOnly):
    """Result of `forward`, for one pose or a batch.

    Attributes
    ----------
    pose : Pose of batch shape (...)
        The pose found; NaN wherever `converged` is false.
    status : (...) array of str
        "converged": joint values reproduced, at an isolated solution that a path of regular
        postures connects to the guess (see `forward`). "singular": the guess, or the solution, does
        not differ from a singular posture in double precision, or the search came to a posture
        with ‖J⁻¹‖ > 1000 (dimensionless, Frobenius) and no further: joint values that are out of
        reach end so. "undefined": the guess has an undefined leg (`design.at(guess).undefined` has
        the reason), or a joint value is NaN, a distance < 0 or infinite, or an angle outside
        (0, π). "not converged": none of these. "nearest mode": of the other three, with
        `fallback="modes"`, a pose with these joint values, but no path from the guess.
    residual : (...) array [1, rad]
        Largest error of a joint value where the search ended, distances as a share of
        `design.rms_radius`, angles in rad. NaN where undefined.
    iterations : (...) array of int
        Numbers of postures evaluated after the guess.
    """

    pose: Pose
    status: NDArray[np.str_]
    residual: Array
    iterations: NDArray[np.int64]

    @property
    def converged(self) -> Mask:
        """Whether a pose was found, from the guess or as the nearest mode, shape (...).

        *Source: ours; see docs/kinematics.md*
        """
        return np.asarray(np.isin(self.status, STATUS[[CONVERGED, NEAREST_MODE]]))

    @property
    def singular(self) -> Mask:
        """Whether the search ended as singular, shape (...).

        *Source: ours; see docs/kinematics.md*
        """
        return np.asarray(self.status == "singular")


def forward(
    design: Design,
    joints: ArrayLike,
    guess: Pose,
    *,
    tolerance: float = 1e-12,
    max_iterations: int = 100,
    backend: str = "compiled",
    fallback: Literal["modes"] | None = None,
) -> ForwardSolution:
    """Return the pose at which the actuators have given values, near a given pose.

    Newton's method on the rows of the inverse Jacobian, with steps of bounded length. A step is
    taken only if the joint errors shrink and it is proven that det J is not zero on it.

    What is guaranteed: the steps are straight, p + s v and exp(s ω×) R for 0 ≤ s ≤ 1 with p the
    centre of the platform anchors, and together they are a path from the guess to the result. On
    this path no leg becomes undefined, no Jacobian is singular, and so the sign of det J is that of
    the guess throughout. (For D4 the sign of t × s counts, which stays where lines meet.) Per step
    the proof bounds how far J is from the straight line between its values A and B at the ends, by
    the second derivatives of `gsp.variation`, and requires ‖A⁻¹ J(s) − I‖ < 0.9 on the first half
    and ‖B⁻¹ J(s) − I‖ < 0.9 on the second. The rounding of J is included; of the inverses, below
    1e-5 where the search does not stop as singular, it is covered by what 0.9 leaves to 1. The
    rounding of the result itself, from centred frames back to those of the design, is not.

    What is not: that the result is the solution nearest to the guess, or one that a motion within
    the strokes reaches. The distance of two lines is taken with the sign that it has at the guess.
    For more than six actuators the steps are least-squares ones, the proof is that the rank stays
    six, and values that contradict each other do not converge.

    With drives at the base the rods are the legs, between the platform and their tips, which the
    joint values give. What is above holds for the design of these D1 legs, and errors are those of
    the lengths of the rods. A pose on another branch of a drive has the status "not converged".

    Parameters
    ----------
    design : Design
    joints : (..., n) array_like [unit of the design, rad]
        Actuated distances and angles, in the order of `design.joint_names`; names of the columns of
        a DataFrame are not read.
    guess : Pose of batch shape (...)
        Where to start; its batch shape and that of `joints` broadcast.
    tolerance : float [1, rad]
        Largest joint error, distances as a share of `design.rms_radius`. Below some 1e-15 rounding
        decides.
    max_iterations : int
        Most postures evaluated per element.
    backend : "compiled" or "numpy"
        What evaluates; both make the same steps up to rounding. More than six actuators are always
        evaluated by numpy.
    fallback : "modes" or None
        What follows where no path of regular postures leads to a pose, as from guesses half a turn
        away: nothing, or "modes", the nearest regular assembly mode that `gsp.assembly_modes` finds
        (distances as in `gsp.nearest`), for six actuators, with drives at the base on their
        branches. About 10 ms per element for SPS legs. Such a pose has the status "nearest mode",
        and may be beyond singular postures.

    Returns
    -------
    ForwardSolution
        With `pose`, `converged`, `residual`, `iterations` and `status`. A pose that was not found
        is NaN, and not another pose. The bits of an element do not depend on the batch.

    Raises
    ------
    InvalidInput
        On wrong types or shapes, a tolerance or count that is not positive, or `fallback` for other
        numbers of actuators than six.

    *Source: Newton's method; the bounds that decide on its steps are ours (`gsp.variation`).*

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> joints = d.at(d.home).joints
    >>> found = gsp.forward(d, joints, d.home.moved([3, -2, 4, 0.1, -0.05, 0.08]))
    >>> bool(found.converged), found.pose.position.round(9)
    (True, array([ 10., -10., 138.]))
    """
    target, start, shape = _check(design, joints, guess)
    limit = check_positive("tolerance", tolerance)
    most = check_integer("max_iterations", max_iterations)
    by_numpy = check_backend(backend) == "numpy" or target.shape[-1] > 6
    solver = _with_numpy if by_numpy else _with_compiled
    modes = check_fallback(fallback, target.shape[-1])
    if design.driven:
        pose, numbers = _with_drives(solver, design, target, start, limit, most)
    else:
        pose, numbers = solver(centred(design), target, start, limit, most)
    if modes:
        pose = _with_modes(design, target, start, limit, pose, numbers)
    ends = numbers[:, 0].astype(np.int64).reshape(shape)
    return ForwardSolution(
        pose.reshape(*shape),
        np.asarray(STATUS[ends, ...]),  # of one type, also for one pose
        numbers[:, 1].reshape(shape),
        numbers[:, 2].astype(np.int64).reshape(shape),
    )


def _with_numpy(
    design: Centred, joints: Array, guess: Pose, tolerance: float, most: int
) -> tuple[Pose, Array]:
    each = guess[np.zeros(len(joints), dtype=np.int64)] if guess.size == 1 else guess
    return reference.solve(design, joints, each, tolerance, most)


def _with_compiled(
    design: Centred, joints: Array, guess: Pose, tolerance: float, most: int
) -> tuple[Pose, Array]:
    from gsp.kinematics.newton.compiled import solve

    n = len(joints)
    position, rotation, numbers = np.empty((n, 3)), np.empty((n, 9)), np.empty((n, 3))
    solve(
        joints,
        np.ascontiguousarray(guess.position),
        np.ascontiguousarray(guess.rotation).reshape(-1, 9),
        design.kinds,
        design.geometry,
        design.paths,
        design.design.angular,
        design.frame,
        tolerance,
        most,
        position,
        rotation,
        numbers,
    )
    return unchecked(Pose, position, rotation.reshape(-1, 3, 3)), numbers


def _with_drives(
    solver: Solver, design: Design, joints: Array, guess: Pose, tolerance: float, most: int
) -> tuple[Pose, Array]:
    """Return poses and numbers as the solvers do, element by element: each has its own tips."""
    n = len(joints)
    position, rotation = np.full((n, 3), np.nan), np.full((n, 3, 3), np.nan)
    numbers = np.tile([UNDEFINED, np.nan, 0.0], (n, 1))
    for i in range(n):
        if not usable(joints[i]):
            continue
        rods, values = held(design, joints[i])
        near = guess[[i if guess.size > 1 else 0]]
        pose, numbers[i : i + 1] = solver(centred(rods), values[None], near, tolerance, most)
        position[i], rotation[i] = pose.position[0], pose.rotation[0]
        if numbers[i, 0] == CONVERGED:
            _, cosines = scales_of_held(design, joints[i], pose)
            if not on_branches(cosines)[0]:
                position[i], rotation[i], numbers[i, 0] = np.nan, np.nan, NOT_CONVERGED
    return unchecked(Pose, position, rotation), numbers


def _with_modes(
    design: Design, joints: Array, guess: Pose, tolerance: float, pose: Pose, numbers: Array
) -> Pose:
    """Return the poses with the nearest mode in place of those not found; change their numbers."""
    from gsp.kinematics.modes.choice import nearest_mode

    position, rotation = pose.position.copy(), pose.rotation.copy()
    for i in np.flatnonzero(numbers[:, 0] != CONVERGED):
        found = nearest_mode(design, joints[i], guess[i if guess.size > 1 else 0], tolerance)
        if found is not None:
            position[i], rotation[i] = found.pose.position, found.pose.rotation
            numbers[i, :2] = NEAREST_MODE, found.residual
    return unchecked(Pose, position, rotation)


def check_fallback(fallback: str | None, actuators: int) -> bool:
    """Whether `fallback` is "modes"; InvalidInput if it is wrong or cannot be done."""
    if fallback is None:
        return False
    if not is_a(fallback, str) or plain_text(fallback) != "modes":
        raise InvalidInput(expected("fallback", "'modes' or None", brief(fallback)))
    if actuators != 6:
        raise InvalidInput(expected("fallback", "None for other than six actuators", "'modes'"))
    return True


def _check(design: Design, joints: ArrayLike, guess: Pose) -> tuple[Array, Pose, tuple[int, ...]]:
    """Return joints (m, n), guesses (m,) or (1,), and the batch shape of m elements."""
    check_type("design", design, Design)
    check_type("guess", guess, Pose)
    n = len(design.joint_names)
    target = check_array("joints", joints, (n,), finite=False)
    try:
        shape = np.broadcast_shapes(target.shape[:-1], guess.shape)
    except ValueError as error:
        got = f"{target.shape[:-1]} and {guess.shape}"
        raise InvalidInput(expected("joints, guess", "batch shapes that broadcast", got)) from error
    flat = np.ascontiguousarray(np.broadcast_to(target, (*shape, n))).reshape(-1, n)
    if guess.size == 1:
        return flat, guess.reshape(1), shape
    start = unchecked(
        Pose,
        np.broadcast_to(guess.position, (*shape, 3)).reshape(-1, 3),
        np.broadcast_to(guess.rotation, (*shape, 3, 3)).reshape(-1, 3, 3),
    )
    return flat, start, shape
