"""`gsp.largest_box`: the largest box of given proportions that is proven around a pose."""

from __future__ import annotations

from concurrent.futures import Executor
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from gsp.checks import check_array, check_positive, check_type
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.vectors import Array
from gsp.limits import Limits
from gsp.model.design import Design, check_undriven
from gsp.proof.boxes import LARGEST_ANGLE, search_box
from gsp.proof.certificate import Certificate
from gsp.proof.tolerances import Tolerances

# Default relative gap of the factor, and default number of boxes of one proof.
FACTOR_TOLERANCE, BOXES_PER_PROOF = 0.02, 200_000
# Doublings of the factor before it counts as unbounded.
DOUBLINGS = 40


@dataclass(frozen=True, eq=False, kw_only=True)
class LargestBox(ReadOnly):
    """The largest box that was proven; made by `gsp.largest_box`.

    Attributes
    ----------
    factor : float [1]
        The multiple of the half-widths in the box that is proven; 0 if none is.
    above : float [1]
        The least factor whose box was not proven; inf where an interval of angles would pass a
        turn before that.
    certificate : Certificate or None
        The proof of the box with `factor`.
    refuted : Certificate or None
        The result for the box with `above`: refuted, or undecided within the budget.
    """

    factor: float
    above: float
    certificate: Certificate | None
    refuted: Certificate | None

    @property
    def box(self) -> PoseBox | None:
        """The box that is proven."""
        return None if self.certificate is None else self.certificate.box


def largest_box(
    design: Design,
    pose: Pose,
    half_widths: ArrayLike,
    limits: Limits | None = None,
    *,
    order: str = "rpy",
    tolerance: float = FACTOR_TOLERANCE,
    regular: bool = True,
    budget: int | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    tolerances: Tolerances | None = None,
) -> LargestBox:
    """Return the largest box around a pose, of given proportions, that is proven.

    Parameters
    ----------
    design : Design
    pose : Pose of shape ()
        The centre.
    half_widths : (6,) array_like [unit of the design, rad]
        Proportions: half-widths of position and angles for the factor 1; 0 fixes a coordinate.
    limits : Limits or None
        See `gsp.certify`.
    order : str
        The angle set of the box: see `gsp.PoseBox`.
    tolerance : float [1]
        The factor is closed to this share.
    regular : bool
        Whether every pose has to be defined and not singular.
    budget : int or None
        Most boxes of one proof, default 200 000.
    workers : int or None
        Threads, default one per core; the result does not depend on it.
    executor : concurrent.futures.Executor or None
        Runs the searches instead of threads: see `gsp.certify`.
    tolerances : Tolerances or None
        The proofs then hold for every manufactured copy within them.

    Returns
    -------
    LargestBox
        The box of the factor `above` need not be refuted: it may be undecided.

    Raises
    ------
    InvalidInput
        On a wrong type or shape, or half-widths that are negative or all zero.
    MissingParameter
        If an index needs a length that is not given.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> found = gsp.largest_box(d, d.home, [1, 1, 1, 0.01, 0.01, 0.01], tolerance=0.5)
    >>> found.factor > 5
    True

    *Source: ours.*
    """
    check_undriven("design", design)
    wide = check_around(pose, half_widths)
    share = check_positive("tolerance", tolerance)
    most = BOXES_PER_PROOF if budget is None else budget

    def attempt(factor: float) -> Certificate | None:
        box = PoseBox.around(pose, factor * wide, order=order)
        if (
            max(np.abs([box.low[3:], box.high[3:]]).max(), (box.high - box.low)[3:].max())
            > LARGEST_ANGLE
        ):
            return None
        done, interrupted = search_box(
            design,
            box,
            limits,
            regular=regular,
            budget=most,
            workers=workers,
            executor=executor,
            tolerances=tolerances,
        )
        if interrupted:
            raise KeyboardInterrupt
        return done

    low, high = 0.0, np.inf
    best: Certificate | None = None
    worst: Certificate | None = None
    factor = 1.0
    for _ in range(2 * DOUBLINGS):
        done = attempt(factor)
        if done is not None and done.status == "proven":
            low, best = factor, done
        else:
            high, worst = factor, done
        if not 2.0**-DOUBLINGS < factor < 2.0**DOUBLINGS or high - low <= share * low:
            break
        factor = 2.0 * low if np.isinf(high) else 0.5 * high if low == 0.0 else 0.5 * (low + high)
    return LargestBox(
        factor=low, above=np.inf if worst is None else high, certificate=best, refuted=worst
    )


def check_around(pose: Any, half_widths: Any) -> Array:
    """Return half-widths (6,) about a pose, if the pose is single and they are ≥ 0, not all 0.

    Raises
    ------
    InvalidInput
    """
    check_type("pose", pose, Pose)
    wide = check_array("half_widths", half_widths, (6,))
    if pose.shape or wide.ndim != 1 or (wide < 0.0).any() or not wide.any():
        wanted = "a single pose and six numbers ≥ 0, not all 0"
        raise InvalidInput(expected("pose, half_widths", wanted, brief((pose, half_widths))))
    return wide
