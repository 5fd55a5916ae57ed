"""The global search: rounds of climbs from random poses until the best has been found often."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from gsp.determinant.ascent import FLAT, climb, polish
from gsp.determinant.bounds import upper_bound
from gsp.determinant.charts import AllPoses, Box, Chart
from gsp.determinant.domain import PARALLEL, UnboundedDeterminant
from gsp.determinant.record import PROOF, Maximum, expected_unseen
from gsp.determinant.symmetry import Symmetry, representative, symmetries, symmetrised
from gsp.geometry.matrices import reciprocal_condition
from gsp.geometry.pose import Pose, PoseBox
from gsp.geometry.vectors import Array, cross, norm
from gsp.model.design import Design
from gsp.progress import Report

ROUND = 64
MOST_ROUNDS = 8
ENOUGH = 5
# Values of log |det J| closer than this are the same maximum.
SAME = 1e-7
# Beyond this condition of the homogeneous Jacobian at every start, a design counts as singular.
SINGULAR = 1e-12


class _Found(NamedTuple):
    """All climbs so far: their ends (n, k), values (n,), slopes (n,), and evaluations."""

    state: Array
    value: Array
    slope: Array
    evaluations: int

    @property
    def agreed(self) -> int:
        return int((self.value > self.value.max() - SAME).sum())

    @property
    def summits(self) -> int:
        """Number of different local maxima: of gaps between the sorted values of settled climbs."""
        settled = np.sort(self.value[self.slope <= 10.0 * FLAT])
        return int((np.diff(settled) > SAME).sum()) + int(settled.size > 0)


def search(
    design: Design,
    box: PoseBox | None = None,
    seed: int | np.random.Generator | None = None,
    progress: Report = None,
) -> Maximum:
    """Search the maximum of |det J|: see `gsp.determinant.maximum`."""
    rng = np.random.default_rng(0 if seed is None else seed)
    number = seed if isinstance(seed, int) else 0 if seed is None else None
    chart: Chart = AllPoses(design) if box is None else Box(design, box)
    group = symmetries(design) if box is None else ()
    bound = upper_bound(design)
    if _always_singular(design, chart, rng):
        return Maximum(
            0.0, None, box, evaluations=ROUND, seed=number, starts=ROUND, agreed=ROUND, bound=bound
        )
    found = _rounds(chart, group, rng, np.log(bound), progress)
    best = int(np.argmax(found.value))
    end = polish(chart, found.state[best : best + 1])
    pose = chart.pose(end.state)[0]
    _refuse_parallel(design, pose)
    return Maximum(
        value=_determinant(design, pose),
        pose=representative(group, pose) if group else pose,
        domain=box,
        evaluations=found.evaluations + end.evaluations,
        seed=number,
        starts=len(found.value),
        agreed=found.agreed,
        summits=found.summits,
        bound=bound,
        converged=bool(end.slope[0] <= 10.0 * FLAT),
    )


def _rounds(
    chart: Chart,
    group: tuple[Symmetry, ...],
    rng: np.random.Generator,
    bound: float,
    progress: Report,
) -> _Found:
    found: _Found | None = None
    for number in range(1, MOST_ROUNDS + 1):
        ends = climb(chart, _starts(chart, group, rng))
        new = _Found(*ends)
        found = new if found is None else _Found(
            np.concatenate((found.state, new.state)),
            np.concatenate((found.value, new.value)),
            np.concatenate((found.slope, new.slope)),
            found.evaluations + new.evaluations,
        )  # fmt: skip
        if progress is not None:
            progress(number, MOST_ROUNDS)
        proven = found.value.max() >= bound - PROOF
        unseen = expected_unseen(found.summits, len(found.value))
        if found.agreed >= ENOUGH and (proven or unseen < 1.0):
            break
    assert found is not None
    return found


def _starts(chart: Chart, group: tuple[Symmetry, ...], rng: np.random.Generator) -> Array:
    """Random states; of a symmetric design a third of them symmetric, unless singular there."""
    state = chart.start(ROUND, rng)
    if len(group) < 2 or not isinstance(chart, AllPoses):
        return state
    third = slice(0, ROUND // 3)
    symmetric = chart.state(symmetrised(group, chart.pose(state[third]), rng))
    value, usual = chart.evaluate(symmetric)[0], np.median(chart.evaluate(state)[0])
    state[third] = np.where((value > usual - 10.0)[:, None], symmetric, state[third])
    return state


def _always_singular(design: Design, chart: Chart, rng: np.random.Generator) -> bool:
    posture = design.at(chart.pose(chart.start(ROUND, rng)))
    values = posture.singular_values(design.size)
    values = values[np.isfinite(values).all(axis=-1)]
    return bool((reciprocal_condition(values) < SINGULAR).all())


def _refuse_parallel(design: Design, pose: Pose) -> None:
    lines = design.at(pose).lines
    for i in (row.leg for row in design.rows if row.constraint.name == "D4"):
        if norm(cross(lines.t[i], lines.s[i])) < PARALLEL:
            raise UnboundedDeterminant(
                f"maximum of |det J|: expected a domain in which the lines of leg {i + 1} "
                f"(D4) are nowhere parallel, received one that holds {pose!r}, "
                "toward which |det J| grows without bound"
            )


def _determinant(design: Design, pose: Pose) -> float:
    rows = design.at(pose).jacobian
    if rows.shape[0] == 6:
        return float(abs(np.linalg.det(rows)))
    return float(np.prod(np.linalg.svd(rows, compute_uv=False)))
