"""Numbers of floating-point operations of the compiled evaluation, counted on its graphs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from gsp.kernels import stages
from gsp.kernels.problems import CONTROL_PROBLEM, ELLIPSOID_PROBLEM, HOMOGENEOUS_PROBLEM
from gsp.kernels.stages import QR_ROWS_AT_ONCE, Stage
from gsp.kernels.trace import needed
from gsp.model.legs import LEGS, Leg


class Operations(NamedTuple):
    """Numbers of operations per pose.

    Attributes
    ----------
    sums, products, divisions, roots : float
        Floating-point operations; a difference is a sum, and a fused product and sum are two.
    choices : float
        Comparisons and selections, which are not floating-point operations.
    """

    sums: float = 0.0
    products: float = 0.0
    divisions: float = 0.0
    roots: float = 0.0
    choices: float = 0.0

    @property
    def total(self) -> float:
        """Number of floating-point operations."""
        return self.sums + self.products + self.divisions + self.roots

    def plus(self, other: Operations, times: float = 1.0) -> Operations:
        """Return these operations and those of another part that runs so many times."""
        return Operations(*(a + times * b for a, b in zip(self, other, strict=True)))


COLUMN = {"+": 0, "-": 0, "*": 1, "/": 2, "sqrt": 3, "<": 4, "choose": 4}


def operations(stage: Stage) -> Operations:
    """Return the operations of one pass of a stage over a pose."""
    counts = [0.0] * len(Operations._fields)
    for node in needed(value for _, _, value in stage.outputs):
        if node.op in COLUMN:
            counts[COLUMN[node.op]] += 1
    return Operations(*counts)


def evaluation(legs: Sequence[Leg], problems: int, steps: float) -> Operations:
    """Return the operations of `gsp.kernels.compiled.evaluation.evaluate_block` per pose.

    Parameters
    ----------
    legs : sequence of Leg
    problems : int
        Sum of HOMOGENEOUS_PROBLEM, ELLIPSOID_PROBLEM, CONTROL_PROBLEM.
    steps : float
        Laguerre steps per problem, on average; they depend on the matrices.

    Returns
    -------
    Operations

    Examples
    --------
    >>> from gsp.model.legs import LEG
    >>> evaluation([LEG["D1"]] * 6, HOMOGENEOUS_PROBLEM, 5.0).roots
    31.0
    """
    kinds = [LEGS.index(leg) for leg in legs]
    n = sum(stages.N_ACTUATORS[kind] for kind in kinds)
    total = operations(stages.REACH_STAGE)
    for kind in kinds:
        total = total.plus(operations(stages.ACTUATORS[kind]))
    if problems & HOMOGENEOUS_PROBLEM:
        total = total.plus(operations(stages.HOMOGENEOUS_ROW), n).plus(_solve(n, steps))
    if problems & ELLIPSOID_PROBLEM:
        total = total.plus(operations(stages.ELLIPSOID_FRAME))
        total = total.plus(operations(stages.ELLIPSOID_ROW), n).plus(_solve(n, steps))
    if problems & CONTROL_PROBLEM:
        for kind in kinds:
            total = total.plus(operations(stages.PASSIVE[kind]))
        total = total.plus(_triangle(sum(stages.N_PASSIVE[kind] for kind in kinds)))
        total = total.plus(operations(stages.SOLVED_ROW), n).plus(_solve(n, steps))
    return total


def _triangle(n: int) -> Operations:
    """QR of an n × 6 matrix: QR_ROWS_AT_ONCE rows of each column at once, then its pivot."""
    total = Operations()
    for column in range(6):
        total = total.plus(
            operations(stages.SWEEPS[column]), len(range(column, n, QR_ROWS_AT_ONCE))
        )
        total = total.plus(operations(stages.PIVOTS[column]))
    return total


def _solve(n: int, steps: float) -> Operations:
    total = Operations() if n == 6 else _triangle(n)
    total = total.plus(operations(stages.BIDIAGONAL)).plus(operations(stages.LAGUERRE), steps)
    return total.plus(operations(stages.EXTREMES))
