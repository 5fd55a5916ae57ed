"""`gsp.certify`: proof or refutation of requirements over a box of poses."""

from __future__ import annotations

import os
from concurrent.futures import Executor
from dataclasses import replace
from typing import Any

import numpy as np

from gsp.checks import check_integer, check_type
from gsp.errors import InvalidInput, apart, brief, expected
from gsp.geometry.copies import changeable
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.vectors import Array, norm
from gsp.limits import Limits
from gsp.model.design import Design, check_undriven, toml_from_design
from gsp.progress import Progress, meter
from gsp.proof.branching.claims import claims_of, value_at, violation
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import Angles, Problem, boxes_of, problem_of
from gsp.proof.branching.search import Found, explore, runner
from gsp.proof.branching.tree import Codes, Tree
from gsp.proof.certificate import Certificate
from gsp.proof.recorded import Status
from gsp.proof.tolerances import Tolerances
from gsp.variation.layout import DONE, LOW, MID_LOW, PROVEN, SIGN_CHANGED, VIOLATED

# Default budget of boxes: some seconds.
DEFAULT_BOXES = 2_000_000
# Largest angle, and largest width of an interval of angles [rad]: doubles of ±2π round outward.
LARGEST_ANGLE = 2.0 * np.pi
# Distance of the platform origin from the anchors, over their size, beyond which it is reported.
FAR_ORIGIN = 300.0
# Halvings of the segment between two poses with determinants of opposite sign.
MOST_BISECTIONS = 200


def certify(
    design: Design,
    box: PoseBox,
    limits: Limits | None = None,
    *,
    regular: bool = True,
    budget: int | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
    tolerances: Tolerances | None = None,
    resume: Certificate | None = None,
) -> Certificate:
    """Prove that requirements hold at every pose of a box, or find a pose where one does not.

    Parameters
    ----------
    design : Design
        Its numbers are taken as they are; lines as their normalised directions.
    box : PoseBox
        An interval of no width is a fixed coordinate. Angles within
        [−2π, 2π] and no wider than a turn, so that [170°, 190°] is allowed.
    limits : Limits or None
        Strokes (default those of the design), cones, position, distances of legs, and thresholds on
        CDN_CL, σ_min, CDN_OE, CTN, |det J| and λ. None: regularity alone.
    regular : bool
        Whether every pose has to be defined and not singular.
    budget : int or None
        Largest number of boxes to evaluate, default 2 000 000; as they are evaluated in batches, up
        to 112 more may be. If it is used up, the certificate is undecided and contains the boxes
        that are proven so far.
    workers : int or None
        Threads, default one per core; the result does not depend on it.
    executor : concurrent.futures.Executor or None
        Runs the searches instead of threads; it is not shut down. The result does not depend on it.
    progress : function (done, total), bool or None
        Called with the used part of the budget: see `gsp.evaluate`.
    tolerances : Tolerances or None
        The proof then holds for every manufactured copy within them; a refutation is for the
        design itself.
    resume : Certificate or None
        An undecided certificate of the same requirements: its open boxes are continued, and the
        budget is for these.

    Returns
    -------
    Certificate
        An interrupt (Ctrl-C) leaves an undecided one, with what was proven before; it can be
        resumed.

    Raises
    ------
    InvalidInput
        On a wrong type, angles beyond 2π or wider than a turn, limits that cannot be proven over
        boxes, or a certificate to resume that is decided or of other requirements.
        Also if the largest coordinate of an anchor is not between 1e-40 and 1e40.
    MissingParameter
        If nothing is required, or an index needs a length that is not given.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> box = gsp.PoseBox.around(d.home, [5, 5, 5, 0.05, 0.05, 0.05])
    >>> gsp.certify(d, box).status
    'proven'

    *Source: ours; see `docs/proofs.md`.*
    """
    return search_box(
        design,
        box,
        limits,
        regular=regular,
        budget=budget,
        workers=workers,
        executor=executor,
        progress=progress,
        tolerances=tolerances,
        resume=resume,
    )[0]


def search_box(
    design: Design,
    box: PoseBox,
    limits: Limits | None = None,
    *,
    regular: bool = True,
    budget: int | None = None,
    workers: int | None = None,
    executor: Executor | None = None,
    progress: Progress = None,
    tolerances: Tolerances | None = None,
    resume: Certificate | None = None,
) -> tuple[Certificate, bool]:
    """Return the certificate of `certify`, and whether an interrupt ended its search."""
    check_undriven("design", design)
    check_box(box)
    if limits is not None:
        check_type("limits", limits, Limits)
    if tolerances is not None:
        check_type("tolerances", tolerances, Tolerances)
    most = DEFAULT_BOXES if budget is None else check_integer("budget", budget)
    threads = (os.cpu_count() or 1) if workers is None else check_integer("workers", workers)
    problem = problem_of(design, limits, regular=regular, tolerances=tolerances)
    if executor is not None:
        check_type("executor", executor, Executor, "a concurrent.futures.Executor")
    angles = Angles.of(box.order)
    claims = claims_of(design, problem, regular=regular, tolerances=tolerances)
    before = None if resume is None else _continued(resume, design, box, claims, angles)
    with meter(progress, "certify") as report, runner(threads, executor) as run:
        found = explore(
            problem, problem.frame(angles), boxes_of(box, angles), most, run, report, before
        )
    boxes = found.n_boxes + (0 if resume is None else resume.n_boxes)
    result = _certificate(problem, angles, box, replace(found, n_boxes=boxes), claims)
    return result, found.interrupted


def _continued(
    given: Certificate, design: Design, box: PoseBox, claims: dict[str, Any], angles: Angles
) -> Tree:
    """Return the tree of a certificate that is to be resumed, in coordinates of the search."""
    check_type("resume", given, Certificate)
    same = (
        given.status == "undecided"
        and changeable(given.claims) == claims
        and toml_from_design(given.design) == toml_from_design(design)
        and given.box.order == box.order
        and (given.box.low == box.low).all()
        and (given.box.high == box.high).all()
    )
    if not same:
        wanted = "an undecided certificate of this design, box, limits and tolerances"
        raise InvalidInput(expected("resume", wanted, brief(given)))
    numbers = np.empty(PROVEN + 2, dtype=np.int8)
    numbers[angles.coordinates] = np.arange(6)
    numbers[PROVEN:] = PROVEN, PROVEN + 1
    return Tree.of(numbers[given.tree])


def check_box(box: Any) -> None:
    """Raise InvalidInput unless it is a box with angles within [−2π, 2π], no wider than 2π."""
    check_type("box", box, PoseBox)
    far = np.abs(np.concatenate((box.low[3:], box.high[3:]))).max()
    if far > LARGEST_ANGLE:
        raise InvalidInput(expected("box.angles", "angles within [-2π, 2π]", _angle(far)))
    wide = (box.high - box.low)[3:].max()
    if wide > LARGEST_ANGLE:
        raise InvalidInput(expected("box.angles", "intervals of at most 2π", _angle(wide)))


def _angle(angle: float) -> str:
    """Return an angle beyond 2π, with the digits of 2π that tell them apart."""
    got, most = apart(angle, LARGEST_ANGLE)
    return f"{got} rad, and 2π is {most}"


def _certificate(
    problem: Problem, angles: Angles, box: PoseBox, found: Found, claims: dict[str, Any]
) -> Certificate:
    tree = _in_box_coordinates(found.tree.preorder(), angles)
    status: Status = "proven" if found.ended == DONE else "undecided"
    pose, reason, bracket, points = None, "", None, np.zeros((0, 6))
    if found.ended == VIOLATED and found.point is not None:
        points = _in_order(angles, found.point[None])
        status, pose = "refuted", box.pose(points[0])
        reason = _violation(problem, angles, found.point, found.quantity, pose)
    elif found.ended == SIGN_CHANGED and found.point is not None and found.other is not None:
        ends = _in_order(angles, _narrowed(problem, angles, found.point, found.other))
        points = ends[:2]
        status, bracket, pose = "refuted", box.pose(points), box.pose(ends[2])
        reason = "det J changes its sign: a pose between the two of the bracket is singular"
        reason += " or undefined"
    elif status == "undecided":
        reason = f"after {found.n_boxes} boxes{_origin(problem.design)}"
    return Certificate(
        status=status,
        counterexample=pose,
        reason=reason,
        bracket=bracket,
        points=points,
        n_boxes=found.n_boxes,
        tree=tree,
        claims=claims,
        design=problem.design,
        box=box,
    )


def _origin(design: Design) -> str:
    """Warn that the platform origin is far from the anchors: bounds are wide there."""
    centre = design.platform_points.mean(axis=0)
    size = norm(design.platform_points - centre).max()
    sizes = float(norm(centre) / size) if size > 0.0 else 0.0
    if sizes < FAR_ORIGIN:
        return ""
    return (
        f"; the platform origin is {sizes:.2g} sizes of the platform from its anchors, where bounds"
        " are wide: see design.with_origin and docs/proofs.md, rounding"
    )


def _in_box_coordinates(tree: Codes, angles: Angles) -> Codes:
    names = np.concatenate((angles.coordinates, [PROVEN, PROVEN + 1])).astype(np.int8)
    return np.asarray(names[tree])


def _in_order(angles: Angles, points: Array) -> Array:
    """Return points of the search in the coordinates of the box."""
    values = np.empty_like(points)
    values[..., angles.coordinates] = points
    return values


def _violation(problem: Problem, angles: Angles, point: Array, quantity: int, pose: Pose) -> str:
    """Return the bound that a pose violates, as text, with the value of the design itself.

    The enclosure of an index is wide where its rows are badly conditioned, as for a platform origin
    that is far away: the value is then that of `gsp.evaluate`.
    """
    nominal, here = problem.nominal(), np.concatenate((point, point))[None]
    out, _ = enclose(nominal, problem.frame(angles), here)
    least, most = out[0, quantity, MID_LOW : MID_LOW + 2]
    bounded = problem.named[quantity]
    if bounded.kind == "index":
        given = {"length": problem.length, "ellipsoid": problem.ellipsoid, "maximum": None}
        value = np.clip(value_at(problem.design, pose, bounded.name, given), least, most)
        if np.isfinite(value):
            least = most = value
    return violation(problem, quantity, least, most)


def _narrowed(problem: Problem, angles: Angles, one: Array, other: Array) -> Array:
    """Halve a segment while the signs of det J at its ends are certain; the ends and the zero.

    Returns
    -------
    (3, 6) array
        Two points with certain and opposite signs, and one between them, the best estimate of
        where det J vanishes.
    """
    frame, least = problem.frame(angles), problem.signed
    _, signs = enclose(problem, frame, np.stack([np.tile(x, 2) for x in (one, other)]))
    first = signs[0]
    certain, ends = [one, other], [one, other]
    for _ in range(MOST_BISECTIONS):
        middle = 0.5 * (ends[0] + ends[1])
        if any((middle == end).all() for end in ends):
            break
        out, sign = enclose(problem, frame, np.tile(middle, 2)[None])
        side = 0 if sign[0] == first else 1
        ends[side] = middle
        if out[0, least, LOW] > 0.0:
            certain[side] = middle
        if sign[0] == 0.0:
            break
    return np.stack([*certain, ends[1]])
