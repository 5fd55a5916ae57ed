"""`gsp.certify_path`: proofs of requirements along a whole curve of poses."""

from __future__ import annotations

from typing import Any, get_args

import numpy as np
from numpy.typing import ArrayLike

from gsp import arguments
from gsp.checks import check_integer, check_type, is_a
from gsp.errors import InvalidInput, MissingParameter, brief, expected
from gsp.geometry.pose import Pose, PosePath
from gsp.geometry.pose.paths import check_nodes, check_times
from gsp.limits import Limits
from gsp.model.design import Design, check_undriven
from gsp.proof.branching.claims import claims_of
from gsp.proof.branching.problem import problem_of
from gsp.proof.paths.certificate import PathCertificate
from gsp.proof.paths.charts import Charts
from gsp.proof.paths.pieces import Motion, Pieces, pieces_of_nodes, pieces_of_path
from gsp.proof.paths.rates import Rates
from gsp.proof.paths.search import search
from gsp.proof.recorded import pose_record
from gsp.proof.tolerances import Tolerances

# Default number of intervals that are evaluated.
INTERVAL_BUDGET = 100_000


def certify_path(
    design: Design,
    poses: Pose | PosePath,
    limits: Limits | None = None,
    *,
    times: ArrayLike | None = None,
    motion: Motion | None = None,
    speeds: ArrayLike | None = None,
    accelerations: ArrayLike | None = None,
    regular: bool = True,
    tolerances: Tolerances | None = None,
    budget: int | None = None,
) -> PathCertificate:
    """Prove requirements along a path: straight lines with slerp, screws, or splines.

    Parameters
    ----------
    design : Design
    poses : Pose of shape (n,), or PosePath
        Nodes, n ≥ 2, or a path in pieces of polynomials, with its times.
    limits : Limits or None
        The requirements: see `gsp.certify`.
    times : (n,) array_like or None [time]
        When each node is reached, increasing.
    motion : "straight", "screw", "spline" or None
        Between two nodes, "straight" (the default) moves the position on the straight line, and
        turns about one axis through the smaller angle, both in proportion to the parameter.
        "screw" joins them by a rotation about one fixed axis and a displacement along it, in
        proportion: `gsp.Pose.interpolate`; it does not depend on the origin of the platform.
        "spline" is `gsp.PosePath.through`. A PosePath has its own motion: None with it.
    speeds : float or (n_joints,) array_like or None [unit of the design/time, rad/time]
        Greatest speeds of the actuated joints in both directions; NaN for no bound.
    accelerations : float or (n_joints,) array_like or None [unit/time², rad/time²]
        Greatest accelerations in both directions.
    regular : bool
        Whether every pose has to be defined and not singular.
    tolerances : Tolerances or None
        The proof then holds for every copy within them.
    budget : int or None
        Most intervals to evaluate, default 100 000.

    Returns
    -------
    PathCertificate

    Raises
    ------
    InvalidInput
        On a wrong type, shape or motion, times or a motion beside a PosePath, limits that cannot
        be proven over boxes, two neighbours that differ by a turn of π, whose axis is not defined,
        or bounds of accelerations on a path with corners, where they are infinite: velocities of
        straight lines and of screws jump at nodes.
        Also if the largest coordinate of an anchor is not between 1e-40 and 1e40.
    MissingParameter
        If nothing is required, an index needs a length that is not given, or speeds or
        accelerations are bounded without times.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> poses = gsp.Pose.from_rpy([[10, -10, 130], [10, -10, 145]], [[0, 0, 0], [0.1, 0.1, 0]])
    >>> gsp.certify_path(d, poses).status
    'proven'
    >>> gsp.certify_path(d, poses, times=[0, 2], speeds=50.0).status
    'proven'

    *Source: ours; see `docs/proofs.md`.*
    """
    check_undriven("design", design)
    if limits is not None:
        check_type("limits", limits, Limits)
    if tolerances is not None:
        check_type("tolerances", tolerances, Tolerances)
    pieces, stated = _pieces(poses, times, motion)
    rates = Rates.of(design, speeds, accelerations, tolerances)
    bounded = speeds is not None or accelerations is not None
    if bounded and times is None and not isinstance(poses, PosePath):
        raise MissingParameter(expected("times", "one for each pose", "none", "with speeds"))
    most = INTERVAL_BUDGET if budget is None else check_integer("budget", budget)
    if rates.accelerated and (node := pieces.corner()) is not None:
        wanted = "a path whose velocity is continuous, such as motion='spline'"
        where = f"at node {node}, where accelerations are infinite"
        raise InvalidInput(expected("accelerations", wanted, "a corner", where))
    poses_matter = regular is not False or limits is not None or not bounded
    problem = (
        problem_of(design, limits, regular=regular, tolerances=tolerances) if poses_matter else None
    )
    charts = Charts.of(pieces)
    found = search(charts, problem, rates, most)
    middle = sum(found.points) / max(len(found.points), 1)
    ends = pieces.time(np.array([found.points[0], found.points[-1]])) if found.points else None
    claims = claims_of(design, problem, regular=poses_matter and regular, tolerances=tolerances)
    return PathCertificate(
        status="refuted" if found.points else "undecided" if found.undecided else "proven",
        reason=found.reason,
        bracket=None if ends is None else (float(ends[0]), float(ends[1])),
        counterexample=pieces.pose(middle) if found.points else None,
        points=found.points,
        intervals=tuple(found.intervals),
        parts=len(charts.piece),
        n_boxes=found.n_boxes,
        claims={**claims, "bounds": {**claims["bounds"], **rates.claims}},
        path={**stated, **pieces.record()},
        design=design,
    )


def _pieces(poses: Any, times: Any, motion: Any) -> tuple[Pieces, dict[str, Any]]:
    """Return the pieces of nodes or of a path, and what is stated of them."""
    if is_a(poses, PosePath):
        for name, given in (("times", times), ("motion", motion)):
            if given is not None:
                raise InvalidInput(expected(name, "none with a PosePath", brief(given)))
        return pieces_of_path(poses), {"motion": "path", "nodes": None}
    if not is_a(poses, Pose):
        check_type("poses", poses, Pose, "a Pose or a PosePath")
    motion = "straight" if motion is None else arguments.one_of(*get_args(Motion))("motion", motion)
    nodes = check_nodes(poses)
    stated = {"motion": motion, "nodes": pose_record(nodes)}
    if motion == "spline":
        return pieces_of_path(PosePath.through(nodes, times)), stated
    ends = np.arange(float(len(nodes))) if times is None else check_times(times)
    if len(ends) != len(nodes):
        raise InvalidInput(expected("times", f"{len(nodes)} numbers", len(ends)))
    return pieces_of_nodes(nodes, ends, motion), stated
