"""One pose after another, fast: the Jacobian and an index in a few microseconds."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_type
from gsp.errors import InvalidInput, MissingParameter, expected
from gsp.evaluation.backends import COMPILED, flat_design, flat_ellipsoid, length_of
from gsp.evaluation.request import choose_indices
from gsp.evaluation.settings import Job, Maximum, maximum_of_each, settings_of
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.rotations import ROTATION_TOLERANCE
from gsp.geometry.vectors import Array
from gsp.indices import INDICES, index_name
from gsp.model.design import Design


class Prepared:
    """A design ready for one pose after another; made by `gsp.prepare`.

    Calling it with a position and a rotation gives what `design.at(Pose(position, rotation))` and
    the function of the index would give, without making the objects in between.
    """

    def __init__(
        self,
        design: Design,
        index: str,
        length: float | None,
        ellipsoid: Ellipsoid | None,
        maximum: Maximum,
    ) -> None:
        check_type("design", design, Design)
        self.design, self.index = design, index_name(index)
        index = self.index
        settings = settings_of(design, length, ellipsoid, *maximum_of_each(maximum, [design]))
        _, sought = choose_indices(index, [Job(design, settings)])
        if sought:
            raise MissingParameter(f"{index}: expected maximum=, received none")
        uses_length = "length" in INDICES[index].parameters
        self._settings = settings if uses_length else replace(settings, length=None)
        if index not in COMPILED or not COMPILED[index].covers(design, self._settings):
            names = [n for n in COMPILED if COMPILED[n].covers(design, self._settings)]
            wanted = "one that compiled code covers for this design: " + ", ".join(names)
            raise InvalidInput(expected("index", wanted, repr(index)))
        self._compiled = COMPILED[index]
        self._length = length_of(design, self._settings)
        self._kinds, self._geometry = flat_design(design)
        self._ellipsoid = flat_ellipsoid(self._settings.ellipsoid)
        angular = design.angular
        self._divisors = np.where(angular, self._length, 1.0)[:, None] if angular.any() else None
        self._shape = (len(angular), 6)
        self._load()

    def _load(self) -> None:
        """Get the compiled code now, so that the first call is as fast as the others."""
        from gsp.kernels.compiled import evaluate_block, is_pose

        self._evaluate, self._is_pose = evaluate_block, is_pose

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
        """
        p, r = _contiguous(position), _contiguous(rotation)
        if p.shape != (3,) or r.shape != (3, 3) or not self._is_pose(p, r, ROTATION_TOLERANCE):
            return self._slowly(position, rotation)
        jacobian, results = np.empty((1, 6 * self._shape[0])), np.empty((5, 1))
        self._evaluate(
            p.reshape(1, 3), r.reshape(1, 9), self._kinds, self._geometry, self._ellipsoid,
            self._length, self._compiled.problem, results, jacobian,
        )  # fmt: skip
        value = float(self._compiled.read(results, self.design, self._settings)[0])
        if value != value:
            return self._slowly(position, rotation)
        rows = jacobian.reshape(self._shape)
        return (rows if self._divisors is None else rows / self._divisors), value

    def _slowly(self, position: ArrayLike, rotation: ArrayLike) -> tuple[Array, float]:
        """Return the same from a posture, which checks what is undefined and what is wrong."""
        pose = Pose(position, rotation)
        if pose.shape:
            raise InvalidInput(expected("position, rotation", "a single pose", f"{pose!r}"))
        posture = self.design.at(pose)
        index = INDICES[self.index]
        value = index.function(posture, **self._settings.for_index(index))
        return posture.jacobian, float(value)


def _contiguous(value: ArrayLike) -> Array:
    try:
        return np.ascontiguousarray(value, dtype=np.float64)
    except (TypeError, ValueError, OverflowError):
        return np.empty(0)


def prepare(
    design: Design,
    index: str = "condition_number",
    *,
    length: float | None = None,
    ellipsoid: Ellipsoid | None = None,
    maximum: float | None = None,
) -> Prepared:
    """Return a function for real time: the Jacobian and an index at one pose in microseconds.

    Parameters
    ----------
    design : Design
    index : str
        One of the names in `gsp.indices.INDICES` that compiled code covers.
    length : float or None [unit of the design]
        Characteristic length; default that of the design.
    ellipsoid : Ellipsoid or None
        Operation ellipsoid; default that of the design.
    maximum : float or None [unit of |det J|]
        Maximum of |det J|, for λ: see `gsp.evaluate`.

    Returns
    -------
    Prepared
        A function of position (3,) and rotation (3, 3).

    Raises
    ------
    UnknownIndex
        If there is no such index.
    MissingParameter
        If the index needs a length, an ellipsoid or a maximum that there is not.
    InvalidInput
        If compiled code does not cover the index, or on arguments of other types.

    *Source: Nawratil asks of an index, as the sixth property, that it be computable in real time.*

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
