"""The search of the largest |det J|: rounds of climbs from random poses until many reach it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from gsp.determinant.bounds import upper_bound
from gsp.determinant.canonical import Canonical
from gsp.determinant.domain import (
    PARALLEL_SINE,
    SearchRegion,
    UnboundedDeterminant,
    inside,
    two_line_distances,
)
from gsp.determinant.record import PROOF_TOLERANCE, Maximum
from gsp.determinant.search.ascent import FLAT_SLOPE, Climbed, climb, joined, polish
from gsp.determinant.search.charts import AllPoses, Chart, FarPoses, chart_of
from gsp.determinant.symmetry import symmetries, symmetrised
from gsp.geometry.matrices import absolute_determinant, reciprocal_condition
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, norm
from gsp.model.design import Design
from gsp.model.design.symmetry import Symmetry
from gsp.progress import Progress, Report, meter

# Starts of a round, and rounds at most.
STARTS_PER_ROUND = 256
MOST_ROUNDS = 12
# Starts that must have ended at the best maximum.
LEAST_AGREED = 8
# Rounds after which a search ends if as many starts have approached a limit, where none settles.
ROUNDS_TO_LIMIT = 3
# Share of starts that may have ended where no other one did.
MOST_SINGLES_SHARE = 0.01
# Copies of the best ends that climb again from poses nearby, in every round.
STARTS_NEARBY = 64
# Values of log |det J| closer than this do not differ but by rounding.
ROUNDING_OF_LOG = 1e-12
# Values of log |det J| closer than this are the same maximum.
SAME_MAXIMUM = 1e-7
# Poses at which it is tested whether a design is singular everywhere.
SINGULARITY_TRIALS = 64
# Beyond this condition of the homogeneous Jacobian at every start, a design counts as singular:
# coordinates of frames 1e4 sizes away are known to 1e-12 only.
SINGULAR_SHARE = 1e-10
# Displacement, in sizes, beyond which a climb continues at infinity.
FAR_DISPLACEMENT = 1e4
# Length of a segment, in sizes, below which its row counts as undefined.
UNDEFINED_LENGTH = 1e-6
# Length of a segment, in sizes, below which it is tested whether |det J| has a limit as it
# vanishes: about where climbs toward such a limit end.
VANISHING_LENGTH = 1e-3
# Sine of the angle of lines of an A1 leg below which the same holds.
A1_PARALLEL_SINE = 1e-3


@dataclass(frozen=True)
class _Tally:
    """Ends of climbs from independent random starts, and of climbs from their neighbours."""

    random: Climbed
    near: Climbed | None = None

    @property
    def all(self) -> Climbed:
        return self.random if self.near is None else joined(self.random, self.near)

    @property
    def best(self) -> float:
        return float(self.all.value.max())

    @property
    def settled(self) -> Array:
        """Sorted values of the random climbs that have settled."""
        return np.sort(self.random.value[self.random.slope <= 10.0 * FLAT_SLOPE])

    @property
    def agreed(self) -> int:
        return int((self.settled > self.best - SAME_MAXIMUM).sum())

    @property
    def at_limit(self) -> bool:
        """Whether many starts have ended near the best value, and none settled there.

        They climb toward a limit that no pose attains, and more rounds do not settle either.
        """
        near = int((self.random.value > self.best - SAME_MAXIMUM).sum())
        return self.agreed == 0 and near >= LEAST_AGREED

    @property
    def hits(self) -> Array:
        """How often each different local maximum was found: of gaps between the sorted values."""
        if not self.settled.size:
            return np.zeros(0, dtype=int)
        ends = np.flatnonzero(np.diff(self.settled) > SAME_MAXIMUM) + 1
        return np.diff(np.concatenate(([0], ends, [self.settled.size])))

    @property
    def enough(self) -> bool:
        new = int((self.hits == 1).sum()) / max(self.settled.size, 1)
        return self.agreed >= LEAST_AGREED and new <= MOST_SINGLES_SHARE


def search(
    form: Canonical, seed: int | np.random.Generator | None = None, progress: Progress = False
) -> Maximum:
    """Return the largest |det J| found for a canonical design; see `gsp.determinant.maximum`.

    Parameters
    ----------
    form : Canonical
    seed : int, numpy Generator or None
        None stands for 0.
    progress : function (done, total), bool or None
        Called after each round of starts; see `gsp.determinant.maximum`.

    Returns
    -------
    Maximum
        Of the canonical design, over the canonical region.
    """
    design, region = form.design, form.region
    rng = np.random.default_rng(0 if seed is None else seed)
    number = seed if isinstance(seed, int) else 0 if seed is None else None
    chart, bound = chart_of(design, region), upper_bound(design)
    if _singular_in_all(design, chart, rng):
        return Maximum(
            value=0.0,
            pose=None,
            domain=region,
            evaluations=SINGULARITY_TRIALS,
            seed=number,
            starts=SINGULARITY_TRIALS,
            agreed=SINGULARITY_TRIALS,
            n_local_maxima=1,
            bound=bound,
        )
    group = symmetries(design) if region is None else ()

    def check(tally: _Tally) -> None:
        """Where the best climb ends at parallel lines, more rounds only come nearer to them."""
        best = int(np.argmax(tally.all.value))
        _refuse_parallel(design, chart.pose(tally.all.state[best : best + 1])[0], region)

    with meter(progress, "maximum of |det J|") as report:
        tally = _rounds(chart, group, rng, np.log(bound), report, check)
    found = _ended(design, region, tally.all, bound)
    hits = tally.hits
    return replace(
        found,
        seed=number,
        starts=int(tally.settled.size),
        agreed=tally.agreed,
        n_local_maxima=len(hits),
        singles=int((hits == 1).sum()),
        converged=found.converged and (tally.agreed >= 2 or found.proven),
    )


def climbed_from(form: Canonical, pose: Pose) -> Maximum:
    """Return the local maximum of |det J| that a climb from one pose reaches.

    Parameters
    ----------
    form : Canonical
    pose : Pose
        A single pose of the canonical design, in its region.

    Returns
    -------
    Maximum
        Of the canonical design; `starts` and `agreed` are 0.
    """
    design, region = form.design, form.region
    chart = chart_of(design, region)
    state = chart.state(Pose(pose.position[None], pose.rotation[None]))
    ends = climb(chart, state)
    if isinstance(chart, AllPoses):
        ends = _to_infinity(chart, ends)
    return _ended(design, region, ends, upper_bound(design))


def _ended(design: Design, region: SearchRegion, ends: Climbed, bound: float) -> Maximum:
    """Return the best of the ends of climbs, polished, without the numbers of starts."""
    chart = chart_of(design, region)
    # Of results equal to rounding, the one with the smallest gradient: a search may stop where no
    # step increases the value although its gradient is not small, and Newton's steps neither.
    high = ends.value >= ends.value.max() - ROUNDING_OF_LOG
    best = int(np.argmin(np.where(high, ends.slope, np.inf)))
    state = ends.state[best : best + 1]
    far = (
        isinstance(chart, AllPoses)
        and float(norm(state[0, :3])) > FAR_DISPLACEMENT * design.rms_radius
    )
    end = polish(_nearest_chart(chart, design, state), state)
    pose = chart.pose(end.state)[0]
    _refuse_parallel(design, pose, region)
    flat = bool(end.slope[0] <= 10.0 * FLAT_SLOPE)
    return Maximum(
        value=_determinant(design, pose),
        pose=pose,
        domain=region,
        evaluations=ends.evaluations + end.evaluations,
        bound=bound,
        converged=flat,
        attained=not far
        and _defined(design, pose)
        and (flat or not _vanishing(design, region, pose)),
    )


def slope_at(design: Design, region: SearchRegion, pose: Pose) -> float:
    """Return the slope of log |det J| at a pose: 0 at a maximum, also one at a border.

    Parameters
    ----------
    design : Design
        In canonical form.
    region : PoseBox, Neighbourhood or None
        Its canonical poses; None for all.
    pose : Pose of batch shape () [unit]

    Returns
    -------
    float [1]
        Along six steps of a size or a radian, as the search takes them. inf where J is singular.

    *Source: ours*
    """
    chart = chart_of(design, region)
    state = chart.state(Pose(pose.position[None], pose.rotation[None]))
    value, slope = _nearest_chart(chart, design, state).evaluate(state)
    return float(norm(slope)[0]) if np.isfinite(value[0]) else np.inf


def _nearest_chart(chart: Chart, design: Design, state: Array) -> Chart:
    """Return the chart of far poses for a state at infinity, else the given one."""
    if not isinstance(chart, AllPoses):
        return chart
    far = FarPoses(design)
    return far if norm(state[0, :3]) > 0.5 * far.farthest else chart


def _defined(design: Design, pose: Pose) -> bool:
    """Whether no distance of the design is zero, to rounding, at a pose."""
    lengths = [not row.constraint.two_lines for row in design.rows]
    some = design.at(pose).joints[lengths]
    return bool((np.abs(some) > UNDEFINED_LENGTH * design.rms_radius).all())


def _vanishing(design: Design, region: SearchRegion, pose: Pose) -> bool:
    """Whether a search has ended at a limit, beside a pose where a row is undefined.

    |det J| then stays the same when a short segment is shortened to nearly nothing.

    A climb toward a pose where a row is undefined ends before it: the slope along the directions
    of the segment grows as its length vanishes, and so does its rounding. The lines of an A1 leg
    that are nearly parallel count as such a pose.
    """
    short = 0.1 * UNDEFINED_LENGTH * design.rms_radius
    posture = design.at(pose)
    sine = posture.segments.sine
    angles = [row.leg for row in design.rows if row.constraint.quantity == "angle"]
    if (sine[angles] < A1_PARALLEL_SINE).any():
        return True
    least = _determinant(design, pose) * (1.0 - SAME_MAXIMUM)
    for length, row in zip(posture.joints, design.rows, strict=True):
        if row.constraint.two_lines or length > VANISHING_LENGTH * design.rms_radius:
            continue
        shift = (length - short) * posture.segments.along[row.leg]
        nearer = Pose(pose.position - shift, pose.rotation)
        if inside(region, nearer) and _determinant(design, nearer) >= least:
            return True
    return False


def _rounds(
    chart: Chart,
    group: tuple[Symmetry, ...],
    rng: np.random.Generator,
    bound: float,
    report: Report,
    check: Callable[[_Tally], None],
) -> _Tally:
    tally: _Tally | None = None
    for number in range(1, MOST_ROUNDS + 1):
        ends = _climbed(chart, _starts(chart, group, rng))
        near = _climbed(chart, _neighbours(chart, tally.all if tally else ends, rng))
        tally = (
            _Tally(joined(tally.random, ends), joined(tally.near, near))
            if tally is not None and tally.near is not None
            else _Tally(ends, near)
        )
        report(number, MOST_ROUNDS)
        check(tally)
        proven = tally.best >= bound - PROOF_TOLERANCE and tally.agreed >= 2
        if proven or tally.enough or (number >= ROUNDS_TO_LIMIT and tally.at_limit):
            break
    assert tally is not None
    return tally


def _climbed(chart: Chart, state: Array) -> Climbed:
    ends = climb(chart, state)
    return _to_infinity(chart, ends) if isinstance(chart, AllPoses) else ends


def _to_infinity(chart: AllPoses, ends: Climbed) -> Climbed:
    """Continue climbs that diverge at infinity, and return the better of both ends."""
    away = np.flatnonzero(norm(ends.state[:, :3]) > FAR_DISPLACEMENT * chart.design.rms_radius)
    if not away.size:
        return ends
    infinity = FarPoses(chart.design)
    far = climb(infinity, infinity.project(ends.state[away]))
    # A limit that is not exceeded on the way counts, as no pose on the way has settled.
    better = far.value >= ends.value[away] - SAME_MAXIMUM
    state, value, slope = ends.state.copy(), ends.value.copy(), ends.slope.copy()
    at = away[better]
    state[at], value[at], slope[at] = far.state[better], far.value[better], far.slope[better]
    return Climbed(state, value, slope, ends.evaluations + far.evaluations)


def _starts(chart: Chart, group: tuple[Symmetry, ...], rng: np.random.Generator) -> Array:
    """Random states; of a symmetric design a third of them symmetric, unless singular there."""
    state = chart.start(STARTS_PER_ROUND, rng)
    if len(group) < 2 or not isinstance(chart, AllPoses):
        return state
    third = slice(0, STARTS_PER_ROUND // 3)
    symmetric = chart.state(symmetrised(group, chart.pose(state[third]), rng))
    # Random starts are symmetric with probability 0, and maxima of symmetric designs often are.
    # One below e⁻¹⁰ of the usual |det J| counts as singular; the random start is kept instead.
    value, usual = chart.evaluate(symmetric)[0], np.median(chart.evaluate(state)[0])
    state[third] = np.where((value > usual - 10.0)[:, None], symmetric, state[third])
    return state


def _neighbours(chart: Chart, ends: Climbed, rng: np.random.Generator) -> Array:
    """Return states near the best of the different ends."""
    order = np.argsort(-ends.value)[:STARTS_PER_ROUND]
    values = ends.value[order]
    different = order[np.concatenate(([True], -np.diff(values) > SAME_MAXIMUM))]
    chosen = different[rng.integers(min(4, len(different)), size=STARTS_NEARBY)]
    # Even in the logarithm, as the distance of a neighbouring maximum is not known.
    length = 10.0 ** rng.uniform(-1.0, 0.3, size=(STARTS_NEARBY, 1))
    return chart.move(ends.state[chosen], length * rng.normal(size=(STARTS_NEARBY, 6)) / 2.0)


def always_singular(design: Design, region: SearchRegion) -> bool:
    """Return whether a design is singular in all of a number of random poses of a region.

    Parameters
    ----------
    design : Design
        In canonical form.
    region : PoseBox, Neighbourhood or None
        Its canonical poses; None for all.

    Returns
    -------
    bool
    """
    return _singular_in_all(design, chart_of(design, region), np.random.default_rng(0))


def _singular_in_all(design: Design, chart: Chart, rng: np.random.Generator) -> bool:
    posture = design.at(chart.pose(chart.start(SINGULARITY_TRIALS, rng)))
    values = posture.singular_values(design.rms_radius)
    values = values[np.isfinite(values).all(axis=-1)]
    return bool((reciprocal_condition(values) < SINGULAR_SHARE).all())


def _refuse_parallel(design: Design, pose: Pose, region: SearchRegion) -> None:
    if region is None:
        return
    sine = design.at(pose).segments.sine
    for i in two_line_distances(design):
        if sine[i] < PARALLEL_SINE:
            raise UnboundedDeterminant(
                f"maximum of |det J|: expected a domain in which the lines of leg {i + 1} "
                f"(D4) are nowhere parallel, received one that holds {pose!r}, "
                "toward which |det J| grows without bound"
            )


def _determinant(design: Design, pose: Pose) -> float:
    return float(absolute_determinant(design.at(pose).jacobian))
