"""`calibrate`: dimensions and joint zero points from measurements."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.arguments import bounded_array, positive
from gsp.calibration.fitting import Fit, Problem, best
from gsp.calibration.losses import LOSSES, Robust
from gsp.calibration.measurements import Measurements, State
from gsp.calibration.result import Calibration
from gsp.calibration.settling import settled
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.model.design import Design, check_undriven
from gsp.model.dimensions import PARTS, Dimensions
from gsp.progress import Progress, meter


@arguments.validated(
    design=check_undriven,
    guess=arguments.optional(arguments.kind(Pose, "a gsp.Pose or None")),
    free=arguments.names,
    loss=arguments.one_of(*LOSSES),
    loss_scale=arguments.size,
    tolerance=positive,
    max_iterations=arguments.integer(1),
)
def calibrate(
    design: Design,
    joints: ArrayLike,
    poses: Pose | ArrayLike | None = None,
    *,
    point: ArrayLike = (0.0, 0.0, 0.0),
    guess: Pose | None = None,
    joint_errors: ArrayLike | None = None,
    pose_errors: ArrayLike | None = None,
    free: Iterable[str] | str = PARTS,
    loss: str = "linear",
    loss_scale: float = 1.0,
    tolerance: float = 1e-12,
    max_iterations: int = 100,
    progress: Progress = None,
) -> Calibration:
    """Identify anchors, lines and joint zero points from measurements at k poses.

    A reading of a joint is its value less its zero point. The dimensions are those for which the
    sum of the squares of all residuals is least, each over its standard error; poses that are not
    known exactly are unknowns as well. What the data do not determine stays nearest to the nominal
    dimensions, and is stated.

    Parameters
    ----------
    design : Design
        The nominal one. More than six actuators stand for redundant sensors.
    joints : (k, n) array_like [unit, rad]
        Readings, in the order of `joint_names`.
    poses : Pose of batch shape (k,), (k, 3) array_like [unit], or None
        Measured poses; measured places of `point` alone, in base axes; or nothing, where redundant
        sensors are all there is.
    point : (3,) array_like [unit]
        The point whose place was measured, in platform axes.
    guess : Pose of batch shape () or (k,), or None [unit]
        Where poses are not given: near the poses. Default the home pose of the design. With one
        for each pose the search starts there; with a single one it starts twice, from that one and
        from the poses near it that fit the nominal dimensions, and the better fit is returned.
    joint_errors : float, (n,) array_like or None [unit, rad]
        Standard errors of the readings. None: equal ones, whose size is estimated from the
        residuals; angles have that of distances over `design.rms_radius`.
    pose_errors : float, (2,) array_like or None [unit, rad]
        Standard error of each coordinate of a place; with poses also that of the rotation. None:
        poses are exact; places are as exact as the readings if `joint_errors` is None too.
    free : str or iterable of str
        What is identified: some of base_points, platform_points, base_directions,
        platform_directions, joints (their zero points). The rest stays nominal.
    loss : "linear", "soft_l1", "huber", "cauchy" or "arctan"
        How much large residuals count, as in `scipy.optimize.least_squares`.
        "cauchy" and "arctan" are not convex: the search can end in a minimum that is not the least.
    loss_scale : float [standard errors]
        From which residual on it is a large one, from 1e-100 to 1e100.
    tolerance : float [1]
        Largest component of the last step, of dimensions and poses, in sizes of the design and rad.
    max_iterations : int
        Number of steps from each start.
    progress : see `gsp.rank`

    Returns
    -------
    Calibration

    Raises
    ------
    InvalidInput
        On wrong types or shapes, errors that are missing or not positive, a posture that is
        undefined at a given or guessed pose, no guess where one is needed, or arguments without
        an effect on such measurements.

    *Source: ours; least squares with latent poses, the rows from `TozKucuk2016`, eqs. (2)–(6)*

    Examples
    --------
    >>> import gsp
    >>> nominal = gsp.hexapod(2.0, 0.3, 1.0, 0.4, 1.5)
    >>> real = nominal.replace(base_points=nominal.base_points + 0.01)
    >>> box = gsp.PoseBox.around(nominal.home, [0.3, 0.3, 0.3, 0.3, 0.3, 0.3])
    >>> poses = box.sample(20, rng=1)
    >>> found = gsp.calibrate(nominal, real.at(poses).joints, poses)
    >>> bool(abs(found.design.base_points - real.base_points).max() < 1e-9)
    True
    """
    readings = bounded_array("joints", joints, (None, len(design.joint_names)))
    if readings.ndim != 2 or not len(readings):
        wanted = f"shape (k, {len(design.joint_names)}), k ≥ 1"
        raise InvalidInput(expected("joints", wanted, f"shape {readings.shape}"))
    if loss != "linear" and joint_errors is None:
        raise InvalidInput(expected("joint_errors", f"standard errors, for loss={loss!r}", "none"))
    if guess is not None and guess.shape not in ((), (len(readings),)):
        wanted = f"batch shape () or ({len(readings)},)"
        raise InvalidInput(expected("guess", wanted, f"{guess.shape}"))
    if guess is not None and isinstance(poses, Pose):
        raise InvalidInput(expected("guess", "None beside measured poses", "poses"))
    measured, start = _measured(design, readings, poses, point, guess, joint_errors, pose_errors)
    dimensions = Dimensions.of(design, tuple(free))
    problem = Problem(
        measured=measured, dimensions=dimensions, loss=Robust(name=loss, scale=loss_scale)
    )
    state = State(np.zeros(len(dimensions)), start)
    if not np.isfinite(problem.cost(state)):
        raise InvalidInput(expected("poses", "poses at which every leg is defined", "others"))
    starts = [state]
    if not (measured.exact or isinstance(poses, Pose) or (guess is not None and guess.shape)):
        starts.insert(0, settled(problem, state, max_iterations))
    with meter(progress, "calibration") as report:
        fit = best(problem, starts, tolerance, max_iterations, report)
    return _result(problem, fit, known=joint_errors is not None)


def _measured(
    design: Design,
    readings: Array,
    poses: Any,
    point: ArrayLike,
    guess: Pose | None,
    joint_errors: ArrayLike | None,
    pose_errors: ArrayLike | None,
) -> tuple[Measurements, Pose]:
    """Return the measurements, and poses to start from."""
    k, arm = len(readings), bounded_array("point", point, (3,))
    if arm.ndim != 1:
        raise InvalidInput(expected("point", "a single point", f"shape {arm.shape}"))
    full = isinstance(poses, Pose)
    place = _places(poses, k, arm)
    known = joint_errors is not None
    size = design.rms_radius
    errors = _joint_errors(design, joint_errors)
    if full:
        pair = _pose_errors(pose_errors, 2, known)
    else:
        pair = _pose_errors(pose_errors, 1, known) if place is not None else None
        if place is None and pose_errors is not None:
            raise InvalidInput(expected("pose_errors", "None without poses", brief(pose_errors)))
        if place is None and arm.any():
            raise InvalidInput(expected("point", "the origin without poses", brief(arm)))
        if place is not None and pair is None:
            if known:
                wanted = "the standard error of the places, as joint_errors is given"
                raise InvalidInput(expected("pose_errors", wanted, "none"))
            pair = np.ones(1)
    measured = Measurements(
        joints=readings,
        joint_errors=errors,
        position=place,
        rotation=poses.rotation if full else None,
        point=arm,
        position_error=float(pair[0]) if pair is not None else size,
        rotation_error=float(pair[-1]) if pair is not None else 1.0,
        exact=full and pair is None,
    )
    return measured, poses if full else _start(design, k, guess, place, arm)


def _places(poses: Any, k: int, arm: Array) -> Array | None:
    """Return the measured places (k, 3) of a point, or None."""
    if poses is None:
        return None
    if isinstance(poses, Pose):
        if poses.shape != (k,):
            raise InvalidInput(expected("poses", f"batch shape ({k},)", f"{poses.shape}"))
        return poses.position + poses.rotation @ arm
    place = bounded_array("poses", poses, (3,))
    if place.shape != (k, 3):
        raise InvalidInput(expected("poses", f"shape ({k}, 3)", f"shape {place.shape}"))
    return place


def _joint_errors(design: Design, given: ArrayLike | None) -> Array:
    if given is None:
        return np.where(design.angular, 1.0 / design.rms_radius, 1.0)
    n = len(design.joint_names)
    errors: Array = arguments.sizes("joint_errors", given)
    if errors.shape not in ((), (n,)):
        raise InvalidInput(expected("joint_errors", f"one number or {n}", f"shape {errors.shape}"))
    return np.broadcast_to(errors, (n,))


def _pose_errors(given: ArrayLike | None, number: int, known: bool) -> Array | None:
    if given is None:
        return None
    if not known:
        raise InvalidInput(expected("joint_errors", "standard errors beside pose_errors", "none"))
    errors: Array = arguments.sizes("pose_errors", given)
    if errors.shape not in (((),) if number == 1 else ((number,),)):
        wanted = "one number" if number == 1 else "two numbers"
        raise InvalidInput(expected("pose_errors", wanted, brief(given)))
    return errors.reshape(-1)


def _start(design: Design, k: int, guess: Pose | None, place: Array | None, arm: Array) -> Pose:
    """Return poses (k,) near which those that were not measured are searched."""
    near = design.home if guess is None else guess
    if near is None:
        wanted = "a pose near those of the measurements, as the design has no home"
        raise InvalidInput(expected("guess", wanted, "none"))
    rotation = np.broadcast_to(near.rotation, (k, 3, 3))
    position = near.position if place is None else place - rotation @ arm
    return Pose(np.broadcast_to(position, (k, 3)), rotation)


def _result(problem: Problem, fit: Fit, *, known: bool) -> Calibration:
    """Return the record of a fit; `known`: whether standard errors are given."""
    dimensions, measured = problem.dimensions, problem.measured
    n, sizes = len(measured.joint_errors), dimensions.sizes
    chi_squared = float((fit.weights * fit.residuals**2).sum())
    free = fit.residuals.size - fit.rank
    factor = 1.0 if known else (chi_squared / free if free > 0 else np.nan)
    return Calibration(
        nominal=dimensions.design,
        design=dimensions.at(fit.state.values),
        zero_points=dimensions.zero_points(fit.state.values),
        poses=fit.state.pose,
        residuals=fit.residuals[:, :n] * measured.joint_errors,
        weights=fit.weights[:, :n],
        names=dimensions.names,
        deviations=fit.state.values,
        covariance=fit.reduced.covariance() * factor * sizes * sizes[:, None],
        singular_values=fit.reduced.values,
        undetermined=fit.reduced.undetermined * sizes,
        chi_squared=chi_squared,
        degrees_of_freedom=free,
        converged=fit.converged,
        iterations=fit.iterations,
        _dimensions=dimensions,
    )
