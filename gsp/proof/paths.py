"""`gsp.certify_path`: proofs of requirements along a whole curve of poses."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Literal, get_args

import numpy as np

from gsp.checks import check_integer, check_type
from gsp.errors import InvalidInput, brief, expected
from gsp.geometry.frames import exp3, log3
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import EPS, Array
from gsp.limits import Limits
from gsp.model.design import Design
from gsp.proof.branching.enclosure import enclose
from gsp.proof.branching.problem import Angles, Problem, problem_of
from gsp.proof.tolerances import Tolerances
from gsp.proof.variation.layout import HIGH, LOW, MID_HIGH, MID_LOW

# Default number of intervals that are evaluated, and the least width of one.
BUDGET, LEAST_WIDTH = 100_000, 2.0**-40
# Intervals whose signs are checked at a time.
CHUNK = 4096
# Roundings of reaches, relative to them.
OUTWARD = 1.0 + 1e-12
Motion = Literal["straight", "screw"]


@dataclass(frozen=True, eq=False, kw_only=True)
class PathCertificate:
    """The result of a proof along a path; made by `gsp.certify_path`.

    The parameter runs from 0 at the first node to n − 1 at the last.

    Attributes
    ----------
    status : "proven", "refuted" or "undecided"
        As in `gsp.Certificate`, for every pose of the curve.
    reason : str
        The requirement that is violated, if the path is refuted.
    bracket : (float, float) or None [1]
        Parameters between which the path is refuted: equal ones where a limit is violated; the
        ends of the interval where det J changes its sign.
    counterexample : Pose of shape (), or None
        The pose in the middle of `bracket`.
    proven : (m, 2) array [1]
        Intervals of the parameter that are proven, in order and joined.
    n_boxes : int
        Intervals that were evaluated.
    """

    status: Literal["proven", "refuted", "undecided"]
    reason: str
    bracket: tuple[float, float] | None
    counterexample: Pose | None
    proven: Array
    n_boxes: int


@dataclass(frozen=True, eq=False)
class _Segment:
    """A segment of the path: straight, or a screw; and a turn by θ about one axis a.

    With h = θ/2, the position is start + τ along + sin(τ h)/sin h (cos k v − sin k a × v),
    k = (1 − τ) h, where v, `across`, is the part of the displacement that is at right angles to
    the axis of a screw, and 0 on straight lines. The axis itself, which is far away if θ is small,
    does not occur. The position is known to within `margin`.
    """

    start: Array
    along: Array
    across: Array
    margin: float
    angle: float
    frame: Array

    def boxes(self, low: Array, high: Array) -> Array:
        """Boxes (m, 12) that hold the poses with parameters within intervals."""
        middle, half = 0.5 * (low + high), 0.5 * (high - low)
        here = self.start + middle[:, None] * self.along
        rate, bend = np.tile(self.along, (len(low), 1)), 0.0
        if self.across.any():
            turned = np.cross(self.frame[:3], self.across)
            h, s = 0.5 * self.angle, 0.5 * self.angle * middle[:, None]
            ratio = np.sin(s) / np.sin(h)
            here = here + ratio * (np.cos(h - s) * self.across - np.sin(h - s) * turned)
            speed = np.cos(2.0 * s - h) * self.across + np.sin(2.0 * s - h) * turned
            rate = rate + h / np.sin(h) * speed
            bend = self.angle * h / np.sin(h) * np.linalg.norm(self.across)
        # |p''| = bend, so the rest of Taylor's formula is at most half of that.
        rest = 0.5 * bend * half**2
        reach = (np.abs(rate) * half[:, None] + rest[:, None]) * OUTWARD + self.margin
        result = np.zeros((len(low), 12))
        result[:, :3], result[:, 6:9] = here - reach, here + reach
        result[:, 3], result[:, 9] = self.angle * low, self.angle * high
        return result


def certify_path(
    design: Design,
    poses: Pose,
    limits: Limits | None = None,
    *,
    motion: Motion = "straight",
    regular: bool = True,
    tolerances: Tolerances | None = None,
    budget: int | None = None,
) -> PathCertificate:
    """Prove requirements along a path: straight lines with slerp, or screws.

    Parameters
    ----------
    design : Design
    poses : Pose, shape (n,)
        Nodes, n ≥ 2. Between two of them the position moves on the straight line, and the rotation
        turns about one axis through the smaller angle, both in proportion to the parameter.
    limits : Limits or None
        The requirements: see `gsp.certify`.
    motion : "straight" or "screw"
        "screw" joins two nodes by a rotation about one fixed axis and a displacement along it, in
        proportion: `gsp.Pose.interpolate`. It does not depend on the origin of the platform.
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
        On a wrong type, shape or motion, limits that cannot be proven over boxes, or two neighbours
        that differ by a turn of π, whose axis has no sense.
    MissingParameter
        If nothing is required, or an index needs a length that is not given.

    Examples
    --------
    >>> import gsp
    >>> d = gsp.catalogue.design("toz-kucuk-2016-d3-6")
    >>> poses = gsp.Pose.from_rpy([[10, -10, 130], [10, -10, 145]], [[0, 0, 0], [0.1, 0.1, 0]])
    >>> gsp.certify_path(d, poses).status
    'proven'

    *Source: ours; see `docs/proofs.md`.*
    """
    check_type("design", design, Design)
    check_type("poses", poses, Pose)
    if len(poses.shape) != 1 or len(poses) < 2:
        raise InvalidInput(expected("poses", "shape (n,) with n ≥ 2", f"shape {poses.shape}"))
    if limits is not None:
        check_type("limits", limits, Limits)
    if not isinstance(motion, str) or motion not in get_args(Motion):
        raise InvalidInput(expected("motion", " or ".join(get_args(Motion)), brief(motion)))
    most = BUDGET if budget is None else check_integer("budget", budget)
    problem = problem_of(design, limits, regular=regular, tolerances=tolerances)
    segments = [_segment(problem, poses[i], poses[i + 1], i, motion) for i in range(len(poses) - 1)]
    return _search(problem, segments, most)


def _segment(problem: Problem, one: Pose, other: Pose, number: int, motion: Motion) -> _Segment:
    left, _, right = np.linalg.svd(one.rotation)
    vector = log3(other.rotation @ one.rotation.T)
    angle = float(np.linalg.norm(vector))
    if angle > np.pi - 1e-9:
        where = f"between poses {number} and {number + 1}"
        raise InvalidInput(expected("poses", "turns of less than π", brief(angle), where))
    axes = np.eye(3)
    if angle > 0.0:
        # An orthonormal frame whose first axis is that of the turn.
        axes = np.linalg.svd((vector / angle)[None])[2]
        axes *= np.sign(axes[0] @ vector)
    angles = Angles(axes, np.arange(6))
    along, across = other.position - one.position, np.zeros(3)
    size = np.abs(one.position).max() + np.abs(other.position).max()
    # A screw leaves the straight line by less than θ |step|: for θ ≤ EPS, by less than `margin`.
    if motion == "screw" and angle > EPS:
        step, along = along, (axes[0] @ along) * axes[0]
        across = step - along
    return _Segment(
        start=one.position,
        along=along,
        across=across,
        margin=float(64.0 * EPS * size),
        angle=angle,
        frame=problem.frame(angles, left @ right),
    )


def _search(problem: Problem, segments: list[_Segment], budget: int) -> PathCertificate:
    low = np.arange(float(len(segments)))
    high = low + 1.0
    proven: list[tuple[float, float]] = []
    signs: list[tuple[float, float]] = []
    n_boxes, stuck = 0, False
    while len(low) and n_boxes < budget:
        out, sign, _ = _enclosed(problem, segments, low, high)
        n_boxes += len(low)
        found = _violated(problem, segments, out, 0.5 * (low + high))
        if found is not None:
            return _result("refuted", found[1], (found[0],) * 2, found[2], proven, n_boxes)
        values = out[:, problem.chosen]
        good = (values[..., LOW] >= problem.low[problem.chosen]) & (
            values[..., HIGH] <= problem.high[problem.chosen]
        )
        done = good.all(axis=1)
        proven += list(zip(low[done].tolist(), high[done].tolist(), strict=True))
        if problem.signed >= 0:
            certain = (out[:, problem.signed, MID_LOW] > 0.0) & (sign != 0.0)
            middle = 0.5 * (low + high)
            signs += list(zip(middle[certain].tolist(), sign[certain].tolist(), strict=True))
        low, high = low[~done], high[~done]
        wide = high - low > LEAST_WIDTH
        stuck = stuck or not wide.all()
        low, high = low[wide], high[wide]
        middle = 0.5 * (low + high)
        low, high = np.concatenate((low, middle)), np.concatenate((middle, high))
    bracket = _change(signs)
    if bracket is not None:
        bracket = _change(_certain(problem, segments, signs))
    if bracket is not None:
        middle = np.array([0.5 * sum(bracket)])
        _, _, centres = _enclosed(problem, segments, middle, middle)
        reason = "det J changes its sign: a pose between the parameters is singular or undefined"
        return _result("refuted", reason, bracket, centres[0], proven, n_boxes)
    status: Literal["proven", "undecided"] = "undecided" if stuck or len(low) else "proven"
    return _result(status, "", None, None, proven, n_boxes)


def _enclosed(
    problem: Problem, segments: list[_Segment], low: Array, high: Array
) -> tuple[Array, Array, list[tuple[_Segment, Array]]]:
    """Bounds and signs of intervals, and the middle of each."""
    out = np.empty((len(low), len(problem.names), 10))
    signs = np.empty(len(low))
    centres: list[tuple[_Segment, Array]] = [(segments[0], np.zeros(6))] * len(low)
    owner = np.minimum(low.astype(np.int64), len(segments) - 1)
    for number in np.unique(owner):
        some, segment = np.flatnonzero(owner == number), segments[number]
        boxes = segment.boxes(low[some] - number, high[some] - number)
        out[some], signs[some] = enclose(problem, segment.frame, boxes)
        for i, box in zip(some, boxes, strict=True):
            centres[i] = (segment, 0.5 * (box[:6] + box[6:]))
    return out, signs, centres


def _violated(
    problem: Problem, segments: list[_Segment], out: Array, middle: Array
) -> tuple[float, str, tuple[_Segment, Array]] | None:
    """First parameter, in order, where the path violates a bound, and what it is."""
    least, most = problem.bounds[2:, problem.chosen]
    values = out[:, problem.chosen]
    bad = (values[..., MID_HIGH] < least) | (values[..., MID_LOW] > most)
    some = middle[bad.any(axis=1)]
    if not some.size:
        return None
    # The path is within the margin of where it is computed: all poses there must be bad.
    out, _, centres = _enclosed(problem, segments, some, some)
    values = out[:, problem.chosen]
    bad = (values[..., HIGH] < least) | (values[..., LOW] > most)
    if not bad.any():
        return None
    i = int(np.flatnonzero(bad.any(axis=1))[0])
    name = problem.names[problem.chosen[int(bad[i].argmax())]]
    return float(some[i]), f"{name} is out of its bounds", centres[i]


def _certain(
    problem: Problem, segments: list[_Segment], signs: list[tuple[float, float]]
) -> list[tuple[float, float]]:
    """Return the signs of det J that are the same at all poses within the margin."""
    result = []
    for start in range(0, len(signs), CHUNK):
        some = np.array(signs[start : start + CHUNK])
        out, _, _ = _enclosed(problem, segments, some[:, 0], some[:, 0])
        good = out[:, problem.signed, LOW] > 0.0
        result += [(float(x), float(sign)) for x, sign in some[good]]
    return result


def _change(signs: list[tuple[float, float]]) -> tuple[float, float] | None:
    """Narrowest interval between neighbours with opposite signs."""
    ordered = sorted(signs)
    changes = [(b[0] - a[0], a[0], b[0]) for a, b in pairwise(ordered) if a[1] != b[1]]
    return min(changes)[1:] if changes else None


def _result(
    status: Literal["proven", "refuted", "undecided"],
    reason: str,
    bracket: tuple[float, float] | None,
    place: tuple[_Segment, Array] | None,
    proven: list[tuple[float, float]],
    n_boxes: int,
) -> PathCertificate:
    pose = None
    if place is not None:
        segment, point = place
        first, before = segment.frame[:3], segment.frame[9:].reshape(3, 3)
        pose = Pose(point[:3], exp3(point[3] * first) @ before)
    return PathCertificate(
        status=status,
        reason=reason,
        bracket=bracket,
        counterexample=pose,
        proven=_joined(proven),
        n_boxes=n_boxes,
    )


def _joined(intervals: list[tuple[float, float]]) -> Array:
    """Return intervals in order, neighbours joined."""
    result: list[list[float]] = []
    for low, high in sorted(intervals):
        if result and result[-1][1] == low:
            result[-1][1] = high
        else:
            result.append([low, high])
    return np.array(result).reshape(-1, 2)
