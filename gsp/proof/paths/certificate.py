"""The result of a proof along a path."""

from __future__ import annotations

from dataclasses import dataclass

from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array
from gsp.proof.certificate import Status


@dataclass(frozen=True, eq=False, kw_only=True)
class PathCertificate:
    """The result of a proof along a path; made by `gsp.certify_path`.

    The parameter is the time, where there are times. Otherwise it runs from 0 at the first node
    to n − 1 at the last.

    Attributes
    ----------
    status : "proven", "refuted" or "undecided"
        As in `gsp.Certificate`, for every pose of the curve.
    reason : str
        The requirement that is violated, if the path is refuted.
    bracket : (float, float) or None [time, or 1]
        Parameters between which the path is refuted: equal ones where a limit is violated; the
        ends of the interval where det J changes its sign.
    counterexample : Pose of shape (), or None
        The pose in the middle of `bracket`.
    proven : (m, 2) array [time, or 1]
        Intervals of the parameter that are proven, in order and joined.
    violated : (m, 2) array [time, or 1]
        Intervals at all whose poses a limit is violated, in order and joined: a lower bound of
        where the path fails. What is in neither list is not decided.
    n_boxes : int
        Intervals that were evaluated.
    """

    status: Status
    reason: str
    bracket: tuple[float, float] | None
    counterexample: Pose | None
    proven: Array
    violated: Array
    n_boxes: int
