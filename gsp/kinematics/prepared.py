"""One pose after another, fast: joints, Jacobian, an index and the pose in a few microseconds."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, replace
from typing import Any, Literal, NoReturn

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_integer, check_positive, check_type
from gsp.errors import InvalidInput, MissingParameter, expected
from gsp.evaluation.backends import COMPILED, flat_design, flat_ellipsoid, length_of
from gsp.evaluation.request import choose_indices
from gsp.evaluation.settings import Job, Maximum, Settings, maximum_of_each, settings_of
from gsp.geometry.copies import made, read_only
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.rotations import ROTATION_TOLERANCE
from gsp.geometry.vectors import Array
from gsp.indices import INDICES, index_name
from gsp.kinematics.forward_solution import COUNTS, STATUSES, ForwardSolution, forward
from gsp.kinematics.newton.centred import centred
from gsp.model.design import Design

DEFAULT_INDEX = "condition_number"


class Prepared:
    """A design ready for one pose after another; made by `gsp.prepare`.

    A call with a position and a rotation returns the same as `design.at(Pose(position, rotation))`
    and the function of the index, without the objects in between. It can be pickled and copied,
    and not be changed.

    Parameters
    ----------
    design : Design
    index : str or None
    length : float or None [unit of the design]
    ellipsoid : Ellipsoid or None
    maximum : float or None [unit of |det J|]
        All as for `gsp.prepare`, with the same errors.

    Attributes
    ----------
    design : Design
    index_name : str
        The index that `index` and a call evaluate.

    Raises
    ------
    UnknownIndex
        If there is no such index.
    MissingParameter
        If the index needs a length, an ellipsoid or a maximum that is not given.
    InvalidInput
        If compiled code does not cover the index, or on arguments of other types.
    """

    def __init__(
        self,
        design: Design,
        index: str | None,
        length: float | None,
        ellipsoid: Ellipsoid | None,
        maximum: Maximum,
    ) -> None:
        check_type("design", design, Design)
        self._given = (design, index, length, ellipsoid, maximum)
        self.design, self.index_name = design, index_name(DEFAULT_INDEX if index is None else index)
        settings = settings_of(design, length, ellipsoid, *maximum_of_each(maximum, [design]))
        self._missing = ""
        try:
            self._choose(settings)
        except MissingParameter as error:
            if index is not None:
                raise
            self._missing, self._settings = str(error), settings
        if not design.driven:
            self._prepare()
        self._complete = True

    def _prepare(self) -> None:
        """Set what compiled code needs."""
        design = self.design
        self._length = length_of(design, self._settings)
        self._kinds, self._geometry = flat_design(design)
        self._ellipsoid = flat_ellipsoid(self._settings.ellipsoid)
        angular = design.angular
        self._divisors = np.where(angular, self._length, 1.0)[:, None] if angular.any() else None
        self._shape = (len(angular), 6)
        c = centred(design)
        self._search = c.kinds, c.geometry, c.paths, c.design.angular, c.frame
        self._load()

    def __setattr__(self, name: str, value: object) -> None:
        if "_complete" in vars(self):
            raise FrozenInstanceError(f"cannot assign to field {name!r}")
        super().__setattr__(name, value)

    def __delattr__(self, name: str) -> NoReturn:
        raise FrozenInstanceError(f"cannot delete field {name!r}")

    def __reduce__(self) -> tuple[Any, ...]:
        # Compiled functions cannot be pickled: another process makes the object again.
        return type(self), self._given

    def _choose(self, settings: Settings) -> None:
        """Set how the index is evaluated."""
        index, design = self.index_name, self.design
        _, sought = choose_indices(index, [Job(design, settings)])
        if sought:
            raise MissingParameter(f"{index}: expected maximum=, received none")
        uses_length = "length" in INDICES[index].parameters
        self._settings = settings if uses_length else replace(settings, length=None)
        if design.driven:
            return
        if index not in COMPILED or not COMPILED[index].covers(design, self._settings):
            names = [n for n in COMPILED if COMPILED[n].covers(design, self._settings)]
            wanted = "one that compiled code covers for this design: " + ", ".join(names)
            raise InvalidInput(expected("index", wanted, repr(index)))
        self._compiled = COMPILED[index]

    def _load(self) -> None:
        """Get the compiled code now, so that the first call is as fast as the others."""
        from gsp.kernels.compiled.evaluation import evaluate_block, is_pose
        from gsp.kernels.compiled.inverse import joint_block
        from gsp.kinematics.newton.compiled import solve

        self._evaluate, self._is_pose = evaluate_block, is_pose
        self._measure, self._solve = joint_block, solve

    def __call__(self, position: ArrayLike, rotation: ArrayLike) -> tuple[Array, float]:
        """Return the inverse Jacobian, (n, 6), and the value of the index.

        Parameters
        ----------
        position : (3,) array_like [unit of the design]
        rotation : (3, 3) array_like

        Raises
        ------
        InvalidInput, InvalidRotation
            As `Pose` does.
        MissingParameter
            If the index needs a length, an ellipsoid or a maximum that was not given.
        """
        if self._missing:
            raise MissingParameter(self._missing)
        if self.design.driven:
            return self._slowly(position, rotation)
        p, r = _contiguous(position), _contiguous(rotation)
        if p.shape != (3,) or r.shape != (3, 3) or not self._is_pose(p, r, ROTATION_TOLERANCE):
            return self._slowly(position, rotation)
        jacobian, results = self._block(p, r, self._compiled.problem)
        value = float(self._compiled.read(results, self.design, self._settings)[0])
        if value != value:
            return self._slowly(position, rotation)
        rows = jacobian.reshape(self._shape)
        return (rows if self._divisors is None else rows / self._divisors), value

    def joints(self, pose: Pose) -> Array:
        """Return the joint values of poses: `design.at(pose).joints`, to rounding.

        Parameters
        ----------
        pose : Pose of batch shape (...) [unit of the design]

        Returns
        -------
        (..., n) array [unit of the design, rad]
            NaN for all joints of a pose with an undefined leg.

        Raises
        ------
        InvalidInput
            If `pose` is not a Pose.

        *Source: as `Posture.joints`*

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
        >>> gsp.prepare(d).joints(d.home).shape
        (6,)
        """
        check_type("pose", pose, Pose)
        if self.design.driven:
            posture = self.design.at(pose)
            return np.where(posture.defined[..., None], posture.joints, np.nan)
        n = self._shape[0]
        p = np.ascontiguousarray(pose.position).reshape(-1, 3)
        out = np.empty((len(p), n))
        self._measure(
            p, np.ascontiguousarray(pose.rotation).reshape(-1, 9), self._kinds, self._geometry, out
        )
        return out.reshape(*pose.shape, n)

    def jacobian(self, pose: Pose) -> Array:
        """Return the inverse Jacobian at one pose: `design.at(pose).jacobian`, to rounding.

        Parameters
        ----------
        pose : Pose of batch shape () [unit of the design]

        Returns
        -------
        (n, 6) array [1 and the unit; of angles 1/unit and 1]
            NaN in the rows of undefined legs.

        Raises
        ------
        InvalidInput
            If `pose` is not a single Pose.

        *Source: as `Posture.jacobian`*
        """
        _check_single(pose)
        if self.design.driven:
            return self.design.at(pose).jacobian
        p, r = np.ascontiguousarray(pose.position), np.ascontiguousarray(pose.rotation)
        rows, _ = self._block(p, r, 0)
        rows = rows.reshape(self._shape)
        if not np.isfinite(rows).all():
            return self.design.at(pose).jacobian
        return rows if self._divisors is None else rows / self._divisors

    def index(self, pose: Pose) -> float:
        """Return the value of the index at one pose.

        Parameters
        ----------
        pose : Pose of batch shape () [unit of the design]

        Returns
        -------
        float [as the index: see `gsp.indices.INDICES`]
            NaN where a leg is undefined.

        Raises
        ------
        InvalidInput
            If `pose` is not a single Pose.
        MissingParameter
            If the index needs a length, an ellipsoid or a maximum that was not given.

        *Source: that of the index, in its record in `gsp.indices.INDICES`*
        """
        _check_single(pose)
        return self(pose.position, pose.rotation)[1]

    def forward(
        self,
        joints: ArrayLike,
        guess: Pose,
        *,
        tolerance: float = 1e-12,
        max_iterations: int = 100,
        fallback: Literal["modes"] | None = None,
    ) -> ForwardSolution:
        """Return the pose of given joint values near a guess: `gsp.forward`, bit by bit.

        Parameters
        ----------
        joints : (..., n) array_like [unit of the design, rad]
        guess : Pose of batch shape (...)
        tolerance : float [1, rad]
        max_iterations : int
        fallback : "modes" or None
            See `gsp.forward`.

        Returns
        -------
        ForwardSolution

        Raises
        ------
        InvalidInput
            As `gsp.forward`.

        *Source: ours, as `gsp.forward`*

        Examples
        --------
        >>> import gsp
        >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
        >>> robot = gsp.prepare(d)
        >>> found = robot.forward(robot.joints(d.home), d.home.moved([3, -2, 4, 0.1, 0, 0]))
        >>> bool(found.converged), found.pose.position.round(9)
        (True, array([ 10., -10., 138.]))
        """
        check_type("guess", guess, Pose)
        target, start, turn = _contiguous(joints), guess.position, guess.rotation
        one = target.shape == (6,) and start.ndim == 1 and fallback is None
        if not one or self.design.driven or self._shape[0] != 6:
            return forward(
                self.design,
                joints,
                guess,
                tolerance=tolerance,
                max_iterations=max_iterations,
                fallback=fallback,
            )
        limit = check_positive("tolerance", tolerance)
        most = check_integer("max_iterations", max_iterations)
        # One array for position, numbers and rotation: each array takes a third of a microsecond.
        out = np.empty((5, 3))
        self._solve(
            target[None],
            np.ascontiguousarray(start)[None],
            np.ascontiguousarray(turn).reshape(1, 9),
            *self._search,
            limit,
            most,
            out[:1],
            out[2:].reshape(1, 9),
            out[1:2],
        )
        end, steps = int(out[1, 0]), int(out[1, 2])
        out.setflags(write=False)
        return made(
            ForwardSolution,
            pose=made(Pose, position=out[0], rotation=out[2:]),
            status=STATUSES[end],
            residual=out[1, 1, ...],
            iterations=COUNTS[steps] if steps < len(COUNTS) else read_only(np.asarray(steps)),
        )

    def _block(self, p: Array, r: Array, problem: int) -> tuple[Array, Array]:
        """Rows of the Jacobian, with those of angles multiplied by the length, and results."""
        jacobian, results = np.empty((1, 6 * self._shape[0])), np.empty((5, 1))
        self._evaluate(
            p.reshape(1, 3),
            r.reshape(1, 9),
            self._kinds,
            self._geometry,
            self._ellipsoid,
            self._length,
            problem,
            results,
            jacobian,
        )
        return jacobian, results

    def _slowly(self, position: ArrayLike, rotation: ArrayLike) -> tuple[Array, float]:
        """Return the same from a posture, which checks the arguments and what is undefined."""
        pose = Pose(position, rotation)
        _check_single(pose)
        posture = self.design.at(pose)
        index = INDICES[self.index_name]
        value = index.function(posture, **self._settings.for_index(index))
        return posture.jacobian, float(value)


def _check_single(pose: Pose) -> None:
    check_type("pose", pose, Pose)
    if pose.shape:
        raise InvalidInput(expected("position, rotation", "a single pose", f"{pose!r}"))


def _contiguous(value: ArrayLike) -> Array:
    """Return numbers as the compiled code takes them, or none where they are no real numbers."""
    if type(value) is np.ndarray and value.dtype.char == "d":  # without the time of a check
        # (Numbers in another order of bytes have this letter, too.)
        if value.flags.c_contiguous and value.dtype.isnative:
            return value
        return np.ascontiguousarray(value, dtype=np.float64)
    try:
        return check_array("numbers", value, (), finite=False)
    except InvalidInput:  # `Pose` and `forward` state which argument it is
        return np.empty(0)


def prepare(
    design: Design,
    index: str | None = None,
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: float | None = None,
) -> Prepared:
    """Return an object for real time: joints, Jacobian, an index and the pose in microseconds.

    Parameters
    ----------
    design : Design
        One with legs that are driven at the base is evaluated by numpy, with the same results as
        otherwise, but in some 0.1 to 1 ms per pose.
    index : str or None
        One of the names in `gsp.indices.INDICES` that compiled code covers, or any with drives at
        the base; None for the condition number, whose parameters may be missing as long as it is
        not evaluated.
    length : float or None [unit of the design]
        Characteristic length; default that of the design.
    ellipsoid : Ellipsoid or None
        Operation ellipsoid; default that of the design.
    maximum : float or None [unit of |det J|]
        Maximum of |det J|, for λ: see `gsp.evaluate`.

    Returns
    -------
    Prepared
        With `joints(pose)`, `jacobian(pose)`, `index(pose)` and `forward(joints, guess)`. It is
        itself a function of position (3,) and rotation (3, 3) that gives Jacobian and index.

    Raises
    ------
    UnknownIndex
        If there is no such index.
    MissingParameter
        If the index needs a length, an ellipsoid or a maximum that is not given.
    InvalidInput
        If compiled code does not cover the index, or on arguments of other types.

    *Source: Nawratil requires, as the sixth property, that an index is computable in real time.*

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> fast = gsp.prepare(d, "condition_number")
    >>> jacobian, value = fast(d.home.position, d.home.rotation)
    >>> jacobian.shape, round(value, 3)
    ((6, 6), 3.063)
    """
    return Prepared(design, index, length, ellipsoid, maximum)
