"""`gsp.certify_maximum`: a proven upper bound of |det J| beside the maximum found."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from gsp import determinant
from gsp.checks import check_integer, check_positive
from gsp.determinant.bounds import upper_bound
from gsp.determinant.domain import Domain, Neighbourhood, check_domain
from gsp.errors import InvalidInput, expected
from gsp.geometry.copies import ReadOnly
from gsp.geometry.pose import PoseBox
from gsp.geometry.rotations import nearest_rotations
from gsp.geometry.vectors import EPS, Array, norm
from gsp.limits import Limits
from gsp.model.design import Design, check_undriven
from gsp.progress import Progress, meter
from gsp.proof.branching.problem import Angles, Problem, boxes_of, problem_of
from gsp.proof.extremes import Keep, extreme
from gsp.proof.sextic.region import bounded, sextic
from gsp.proof.tolerances import Tolerances

# Default numbers of boxes, over a region and over all poses, and gap at which the search ends.
REGION_BOXES, ALL_POSES_BOXES, GAP_TOLERANCE = 500_000, 20_000_000, 0.01
# Roundings of the bounds that are written down, of distances, and of a value, relative to them.
VALUE_OUTWARD = 1.0 + 1e-12
# Least radius, in lengths of the legs' anchors, beyond which poses count as far.
LEAST_FAR_RADIUS = 1e4


@dataclass(frozen=True, eq=False, kw_only=True)
class CertifiedMaximum(ReadOnly):
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
            which `bound` does not include; `closed` is False there.

        *Source: ours; see `docs/proofs.md`*
        """
        if self.bound == 0.0 or self.found.pose is None:
            return 0.0
        return max(0.0, 1.0 - self.found.value / self.bound)


def certify_maximum(
    design: Design,
    domain: Domain = None,
    *,
    tolerance: float = GAP_TOLERANCE,
    budget: int | None = None,
    progress: Progress = None,
) -> CertifiedMaximum:
    """Return the maximum of |det J| found, with a proven upper bound.

    Over all poses the bound is `gsp.determinant.upper_bound`, where it is one. For six D1 rows,
    and over boxes and neighbourhoods of the home pose, branch and bound finds a smaller one.

    Parameters
    ----------
    design : Design
    domain : PoseBox, Neighbourhood, "all" or None
        See `gsp.determinant.maximum`.
    tolerance : float [1]
        The search ends when the gap is at most this share of the bound. Over all poses this gap is
        proven or nothing is: if the budget ends, a greater tolerance may need fewer boxes.
    budget : int or None
        Maximum number of boxes, default 500 000 over a box or a neighbourhood and 2·10⁷ over all
        poses: some two minutes.
    progress : function (done, total), bool or None
        Progress of the search for the maximum, see `gsp.determinant.maximum`, and then of the proof
        over all poses.

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
    check_undriven("design", design)
    share = check_positive("tolerance", tolerance)
    if share >= 1.0:
        raise InvalidInput(expected("tolerance", "a number below 1", share))
    if budget is not None:
        budget = check_integer("budget", budget)
    region = check_domain(design, domain)
    found = determinant.maximum(design, domain, progress=progress)
    bound, method, n_boxes = upper_bound(design) * VALUE_OUTWARD, "formula", 0
    if found.value < (1.0 - share) * bound:
        if region is None:
            most = ALL_POSES_BOXES if budget is None else budget
            least = found.value / (1.0 - share)
            proven, n_boxes = _over_all_poses(design, found.value, least, most, progress)
            end = least if proven else bound
        else:
            most = REGION_BOXES if budget is None else budget
            end, n_boxes = _over_region(design, region, found.value, share, most)
        if end < bound:
            bound, method = end, "boxes"
    closed = found.value >= (1.0 - share) * bound
    return CertifiedMaximum(
        found=found, bound=float(bound), method=method, closed=bool(closed), n_boxes=n_boxes
    )


_Search = tuple[Problem, Array, Array, Keep | None]


def _over_region(
    design: Design, region: PoseBox | Neighbourhood, value: float, share: float, budget: int
) -> tuple[float, int]:
    """Return a bound of |det J| over a box or a neighbourhood, inf if there is none, and boxes."""
    if isinstance(region, PoseBox):
        angles = Angles.of(region.order)
        problem = _problem(design, 0.0)
        search: _Search | None
        search = problem, problem.frame(angles), boxes_of(region, angles), None
    else:
        search = _near(design, region)
    if search is None:
        return np.inf, 0
    problem, frame, boxes, keep = search
    place = problem.names.index("manipulability")
    end = extreme(problem, frame, boxes, place, 1.0, share, budget, keep=keep, value=value)
    return end.bound, end.n_boxes


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
    frame = problem.frame(Angles.of("ZYX"), nearest_rotations(home.rotation))
    half = np.repeat((region.displacement, region.angle), 3) * VALUE_OUTWARD
    start = np.concatenate((region.centre, np.zeros(3)))

    def keep(boxes: Array) -> Array:
        low, high = boxes[:, :3] - region.centre, boxes[:, 6:9] - region.centre
        gap = np.maximum(np.maximum(low, -high), 0.0)
        return np.asarray(norm(gap) <= region.displacement * VALUE_OUTWARD)

    return problem, frame, np.concatenate((start - half, start + half))[None], keep


def _over_all_poses(
    design: Design, value: float, bound: float, budget: int, progress: Progress
) -> tuple[bool, int]:
    """Return whether a bound of |det J| is proven over all poses of six D1 legs, and the boxes.

    Beyond some distance |det J| is smaller than a value that occurs.
    """
    if value <= 0.0 or design.n_legs != 6 or not design.between_points:
        return False, 0
    base, platform = (x - x.mean(axis=0) for x in (design.base_points, design.platform_points))
    near = 8.0 * EPS * float(np.abs((design.base_points, design.platform_points)).max())
    arms = norm(platform) + near
    reach = norm(base) + near + arms
    radius = 2.0 * float(reach.max())
    while far_bound(reach, arms, radius) > value:
        radius *= 1.1
        if radius > LEAST_FAR_RADIUS * float(reach.max()):
            return False, 0
    problem = sextic(design)
    with meter(progress, "bound of |det J|") as report:
        return bounded(problem, radius, bound, budget, report)


def far_bound(reach: Array, arms: Array, radius: float) -> float:
    """Bound of |det J| of D1 rows at distances beyond a radius.

    All lines then are within asin(c_i / (ρ − c_i)) of the direction of the displacement, c_i being
    `reach`; with τ the sum of the squares of these sines, det M_forces ≤ n (τ/2)², and
    det M_moments ≤ (Σ r_i²/3)³: see `gsp.determinant.bounds`.
    """
    spread = float(((reach / (radius - reach)) ** 2).sum())
    return float(np.sqrt(len(arms)) * 0.5 * spread * ((arms**2).sum() / 3.0) ** 1.5) * VALUE_OUTWARD
