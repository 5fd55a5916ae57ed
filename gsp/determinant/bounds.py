"""Bounds of |det J| over all poses: the mechanisms that have one, and proven numbers.

The lines of D1 and D2 rows pass through the base anchors, those of D1 and D3 rows through the
platform anchors, and det J does not depend on the point that moments are taken about. So when all
lines pass through fixed points of one body at distances r_i from a point of it, with M = JᵀJ,

    det M ≤ det M_forces · det M_moments ≤ (tr M_forces / 3)³ (tr M_moments / 3)³

by Fischer's inequality and that of the arithmetic and geometric means, with tr M_forces = n and
tr M_moments ≤ Σ r_i². If the points lie in a plane at distances ≤ r, the components of a unit line
along the plane and across it contribute to forces and moments in the same proportion, which gives
|det J| ≤ (n/2)³ r³ / 4: 27/4 r³ for six legs. Lee's |det J|am, eqs. (21), (59), (68), equals it.

An A1 row is a pure couple and adds to the moments. By the formula of Cauchy and Binet det M is a
sum of squares of minors of six rows. Multiply the k couples by √x. Then det M becomes Σ M_c x^c,
where M_c is the sum over the minors with c couples, and

    M_c ≤ (n/3)³ ((Σ r_i² + k x) / 3)³ / x^c for every x > 0.

x = c Σ r_i² / (k (3 − c)) makes it least. The bound of |det J| is the root of the sum of these
bounds, for 6 − n ≤ c ≤ min(k, 3): one for six rows, and several, of different units, for more.

With three lines, all minors have three couples, and det J of six rows is det U · det C, with the
forces of the lines and the axes of the couples as rows, all unit vectors: |det J| ≤ (k/3)^1.5 for
all lines, 1 for six rows. With fewer lines det J is zero.

With D2 and D3 rows |det J| is bounded if there are enough other rows: see `is_bounded`. With a D4
row and fewer than three A1 rows it has no bound, as the common normal moves to infinity where the
two lines become parallel.
"""

from __future__ import annotations

import math
from collections import Counter
from itertools import combinations

import numpy as np

from gsp import arguments
from gsp.checks import SMALLEST
from gsp.geometry.vectors import EPS, Array, norm
from gsp.model.design import Design, check_undriven
from gsp.model.mechanism import Mechanism


@arguments.validated(mechanism=arguments.kind(Mechanism))
def is_bounded(mechanism: Mechanism) -> bool:
    """Return whether |det J| is bounded over all poses for every design of a mechanism.

    Let c, a, b, d, k be the numbers of D1, D2, D3, D4, A1 rows of six. |det J| is bounded

    - if k ≥ 3, since det J is then the determinant of three unit vectors times another one;
    - if d = 0 and (a = 0 or b = 0), since all lines pass through fixed points of one body;
    - if d = 0 and a, b ≥ 1, exactly if c ≥ 3, or c = 2 and k = 2.

    The last line counts powers of the displacement p → ∞ with moments about the base. D1 rows
    tend to one direction e, so all but one of them have a force of order 1/p after that one is
    subtracted, and a moment of order 1. D2 rows have forces and moments of order 1. D3 rows
    have forces of order 1 and moments of order p; those are at right angles to e up to order 1,
    as the moments of the subtracted D1 rows are up to order 1/p. The largest power over all ways
    to take three rows for the forces and three for the moments is > 0 for the others, ≤ 0 for
    these. For the others it is reached by random designs (a test measures it).

    A redundant mechanism is bounded if all its choices of six rows are, by the formula of Cauchy
    and Binet.

    Parameters
    ----------
    mechanism : Mechanism

    Returns
    -------
    bool
        Particular designs of other mechanisms may be bounded too.

    Raises
    ------
    InvalidInput
        If `mechanism` is not a Mechanism.

    *Source: ours.*

    >>> from gsp.catalogue import mechanisms
    >>> sum(map(is_bounded, mechanisms()))
    58
    """
    rows = sorted(mechanism.constraints)
    if len(rows) <= 6:
        return _six_bounded(Counter(rows))
    return all(_six_bounded(Counter(six)) for six in set(combinations(rows, 6)))


def _six_bounded(rows: Counter[str]) -> bool:
    known = ("D1", "D2", "D3", "D4", "A1")
    d1, d2, d3, d4, a1 = (rows[name] for name in known)
    if other := sorted(set(rows).difference(known)):
        raise KeyError(other[0])
    if a1 >= 3:
        return True
    if d4:
        return False
    return not d2 or not d3 or d1 >= 3 or (d1 == 2 and a1 == 2)


@arguments.validated(design=check_undriven)
def upper_bound(design: Design) -> float:
    """Return a number that |det J| does not exceed at any pose, or inf where none is known.

    A proven number, for D1 rows alone, D1 and D2 (and A1), D1 and D3 (and A1), and for three rows
    of any kind with A1 rows. A pose that reaches it has the maximum.

    Parameters
    ----------
    design : Design

    Returns
    -------
    float [unit^(3 − number of A1 rows) for six rows, mixed for more of which some are A1]
        inf where |det J| has no bound over all poses, and where it has one (see `is_bounded`)
        whose value is not known. A number that is not 0 is at least 2.2e-308, and inf if it is too
        large for a float.

    Raises
    ------
    InvalidInput
        If `design` is not a Design.

    *Source: ours; see the module.*

    >>> import gsp
    >>> bound = upper_bound(gsp.families.lee.octahedral_3_3(a=1.0, b=2.0))
    >>> round(bound, 12) == round(float(gsp.families.lee.absolute_maximum(1.0)), 12)
    True
    """
    distances = [row.leg for row in design.rows if row.constraint.quantity == "distance"]
    couples = int(design.angular.sum())
    kinds = {row.constraint.name for row in design.rows} - {"A1"}
    if len(distances) <= 3:
        return (couples / 3.0) ** 1.5 if len(distances) == 3 else 0.0
    bounds = [np.inf]
    if kinds <= {"D1", "D2"}:
        bounds.append(_lines_through(design.base_points[distances], couples))
    if kinds <= {"D1", "D3"}:
        bounds.append(_lines_through(design.platform_points[distances], couples))
    return float(min(bounds))


def _lines_through(points: Array, couples: int) -> float:
    """Bound for one line through each point, and a number of couples."""
    n, arms = len(points), points - points.mean(axis=0)
    # Moments in units of the size, whose sixth power may vanish or overflow.
    size = float(np.abs(arms).max())
    arms = arms / size if size > 0.0 else arms
    squares = float((arms**2).sum())
    minors = {c: _minors(n, squares, couples, c) for c in range(max(6 - n, 0), min(couples, 3) + 1)}
    if 0 in minors and _coplanar(arms, points / max(size, SMALLEST)):
        minors[0] = min(minors[0], ((n / 2.0) ** 3 * float(norm(arms).max()) ** 3 / 4.0) ** 2)
    return _root_of_sum(minors, size)


def _root_of_sum(minors: dict[int, float], size: float) -> float:
    """Return the root of the sum of minors, of which those with c couples are of size^(6 − 2 c).

    Rounded up to the least number whose inverse is finite; inf where it overflows.
    """
    with np.errstate(over="ignore", under="ignore"):
        roots = [np.sqrt(minor) * np.float64(size) ** (3 - c) for c, minor in minors.items()]
    some = size > 0.0 and any(minors.values())
    return max(math.hypot(*roots), SMALLEST if some else 0.0)


def _minors(n: int, squares: float, couples: int, c: int) -> float:
    """Return the bound of the sum of squares of the minors with c couples."""
    if c == 3:
        moments = (couples / 3.0) ** 3  # the limit for x → ∞
    elif c == 0:
        moments = (squares / 3.0) ** 3
    else:
        # ((Σ r² + k x) / 3)³ / x^c with the best x.
        moments = (squares / (3 - c)) ** (3 - c) * (couples / c) ** c
    return (n / 3.0) ** 3 * moments


def _coplanar(arms: Array, points: Array) -> bool:
    """Whether points lie in a plane to the rounding of their coordinates."""
    values = np.linalg.svd(arms, compute_uv=False)
    return bool(values[2] <= 8 * EPS * max(float(values[0]), float(np.abs(points).max())))
