"""`gsp.certify_maximum`: a proven upper bound of |det J| beside the maximum found."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from gsp import determinant
from gsp.checks import check_integer, check_positive, check_type
from gsp.determinant.bounds import upper_bound
from gsp.determinant.domain import Domain, Neighbourhood, Region, check_domain
from gsp.errors import InvalidInput, expected
from gsp.geometry.pose import PoseBox
from gsp.geometry.vectors import EPS, Array, norm
from gsp.limits import Limits
from gsp.model.design import Design
from gsp.progress import Progress
from gsp.proof.branching.problem import Angles, Problem, boxes_of, problem_of
from gsp.proof.extremes import Keep, extreme
from gsp.proof.tolerances import Tolerances

# Default number of boxes, and default gap at which the search ends.
BUDGET, TOLERANCE = 500_000, 0.01
# Roundings of the bounds that are written down, of distances, and of a value, relative to them.
OUTWARD = 1.0 + 1e-12
# Least radius, in lengths of the legs' anchors, beyond which poses count as far.
FARTHEST = 1e4


@dataclass(frozen=True, eq=False, kw_only=True)
class CertifiedMaximum:
    """The maximum of |det J| with a proven bound; made by `gsp.certify_maximum`.

    Attributes
    ----------
    found : gsp.determinant.Maximum
        The largest value found, and the poses that count.
    bound : float [unit^(3 − number of A1 rows)]
        No pose that counts has a larger |det J|; inf where no bound is known.
    method : str
        "formula": by a bound that is written down; "boxes": by branch and bound.
    closed : bool
        Whether the gap is within the tolerance.
    n_boxes : int
        Number of boxes evaluated.
    """

    found: determinant.Maximum
    bound: float
    method: str
    closed: bool
    n_boxes: int

    @property
    def gap(self) -> float:
        """Relative gap between the bound and the largest value found.

        Returns
        -------
        float [1]
            In [0, 1]; 0 where the maximum found is the bound. It is 0 as well for a design that is
            singular in every pose to rounding (`found.pose` is None): |det J| is rounding then, of
            which `bound`, and `closed`, which is False, know nothing.
        """
        if self.bound == 0.0 or self.found.pose is None:
            return 0.0
        return max(0.0, 1.0 - self.found.value / self.bound)


def certify_maximum(
    design: Design,
    domain: Domain = None,
    *,
    tolerance: float = TOLERANCE,
    budget: int | None = None,
    progress: Progress = None,
) -> CertifiedMaximum:
    """Return the maximum of |det J| found, with a proven upper bound.

    Over all poses the bound is `gsp.determinant.upper_bound`, where it is one; for D1 rows, boxes,
    and neighbourhoods of the home pose, branch and bound finds a smaller one.

    Parameters
    ----------
    design : Design
    domain : PoseBox, Neighbourhood, "all" or None
        See `gsp.determinant.maximum`.
    tolerance : float [1]
        The search ends when the gap is at most this share of the bound.
    budget : int or None
        Maximum number of boxes, default 500 000.
    progress : function (done, total), bool or None
        Progress of the search for the maximum: see `gsp.determinant.maximum`.

    Returns
    -------
    CertifiedMaximum

    Raises
    ------
    InvalidInput
        On a wrong type or number, a domain where |det J| is unbounded, or a box or neighbourhood
        for redundant designs with angular actuators, whose |det J| has no unit.
    MissingParameter
        If the design needs a home pose for its default domain and has none.

    Examples
    --------
    >>> import gsp
    >>> best = certify_maximum(gsp.families.lee.octahedral_3_3(a=1.0, b=2.0))
    >>> best.method, best.closed, best.gap < 1e-9
    ('formula', True, True)

    *Source: ours; see `docs/proofs.md`.*
    """
    check_type("design", design, Design)
    share = check_positive("tolerance", tolerance)
    if share >= 1.0:
        raise InvalidInput(expected("tolerance", "a number below 1", share))
    most = BUDGET if budget is None else check_integer("budget", budget)
    region = check_domain(design, domain)
    found = determinant.maximum(design, domain, progress=progress)
    bound, method, n_boxes = upper_bound(design) * OUTWARD, "formula", 0
    if found.value < (1.0 - share) * bound:
        search = _search_of(design, region, found.value)
        if search is not None:
            problem, frame, boxes, keep = search
            place = problem.names.index("manipulability")
            end = extreme(
                problem, frame, boxes, place, 1.0, share, most, keep=keep, value=found.value
            )
            n_boxes = end.n_boxes
            if end.bound < bound:
                bound, method = end.bound, "boxes"
    closed = found.value >= (1.0 - share) * bound
    return CertifiedMaximum(
        found=found, bound=float(bound), method=method, closed=bool(closed), n_boxes=n_boxes
    )


_Search = tuple[Problem, Array, Array, Keep | None]


def _search_of(design: Design, region: Region, value: float) -> _Search | None:
    """Return the problem, frame and boxes of a search over a region; None where there is none."""
    if isinstance(region, PoseBox):
        angles = Angles.of(region.order)
        problem = _problem(design, 0.0)
        return problem, problem.frame(angles), boxes_of(region, angles), None
    if isinstance(region, Neighbourhood):
        return _near(design, region)
    return _everywhere(design, value)


def _problem(design: Design, near: float) -> Problem:
    strokes = np.full((len(design.joint_names), 2), np.nan)
    limits = Limits(strokes=strokes, indices=["manipulability >= 1"])
    tolerances = Tolerances(base_points=near, platform_points=near) if near else None
    return problem_of(design, limits, regular=False, tolerances=tolerances)


def _moved(design: Design, base: Array, platform: Array) -> tuple[Design, float]:
    """Return a design with other origins, which |det J| does not depend on, and its rounding."""
    a, b = design.base_points - base, design.platform_points - platform
    sizes = [np.abs(x).max() for x in (design.base_points, base, design.platform_points, platform)]
    return design.replace(base_points=a, platform_points=b), 8.0 * EPS * float(sum(sizes))


def _near(design: Design, region: Neighbourhood) -> _Search | None:
    """Search a neighbourhood: the point whose displacement is bounded becomes the origin."""
    if region.angle > np.pi / 2.0:
        return None
    home = region.home
    point = home.rotation.T @ (region.centre - home.position)
    moved, near = _moved(design, np.zeros(3), point)
    # The rotation of the home pose is one to rounding, which turns anchors by as much.
    problem = _problem(moved, near + 16.0 * EPS * float(norm(moved.platform_points).max()))
    left, _, right = np.linalg.svd(home.rotation)
    frame = problem.frame(Angles.of("ZYX"), left @ right)
    half = np.repeat((region.displacement, region.angle), 3) * OUTWARD
    start = np.concatenate((region.centre, np.zeros(3)))

    def keep(boxes: Array) -> Array:
        low, high = boxes[:, :3] - region.centre, boxes[:, 6:9] - region.centre
        gap = np.maximum(np.maximum(low, -high), 0.0)
        return np.asarray(norm(gap) <= region.displacement * OUTWARD)

    return problem, frame, np.concatenate((start - half, start + half))[None], keep


def _everywhere(design: Design, value: float) -> _Search | None:
    """Search all poses, for D1 rows: beyond some distance |det J| is smaller than a value."""
    if value <= 0.0 or any(leg.name != "D1" for leg in design.legs):
        return None
    moved, near = _moved(
        design, design.base_points.mean(axis=0), design.platform_points.mean(axis=0)
    )
    arms = norm(moved.platform_points)
    reach = norm(moved.base_points) + arms + near
    radius = 2.0 * float(reach.max())
    while far_bound(reach, arms + near, radius) > value:
        radius *= 1.1
        if radius > FARTHEST * float(reach.max()):
            return None
    problem = _problem(moved, near)
    edges = np.linspace(-np.pi, np.pi, 9)
    edges[0], edges[-1] = -np.pi * OUTWARD, np.pi * OUTWARD
    turns = list(pairwise(edges))
    low_high = [
        (-radius, -radius, -radius, yaw[0], pitch[0], roll[0],
         radius, radius, radius, yaw[1], pitch[1], roll[1])
        for yaw in turns for pitch in turns[2:6] for roll in turns
    ]  # fmt: skip

    def keep(boxes: Array) -> Array:
        gap = np.maximum(np.maximum(boxes[:, :3], -boxes[:, 6:9]), 0.0)
        return np.asarray(norm(gap) <= radius)

    return problem, problem.frame(Angles.of("ZYX")), np.array(low_high), keep


def far_bound(reach: Array, arms: Array, radius: float) -> float:
    """Bound of |det J| of D1 rows at distances beyond a radius.

    All lines then are within asin(c_i / (ρ − c_i)) of the direction of the displacement, c_i being
    `reach`; with τ the sum of the squares of these sines, det M_forces ≤ n (τ/2)², and
    det M_moments ≤ (Σ r_i²/3)³: see `gsp.determinant.bounds`.
    """
    spread = float(((reach / (radius - reach)) ** 2).sum())
    return float(np.sqrt(len(arms)) * 0.5 * spread * ((arms**2).sum() / 3.0) ** 1.5) * OUTWARD
