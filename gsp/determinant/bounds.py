"""What |det J| can never exceed, over all poses: proven bounds, and when there is none.

The lines of D1 and D2 rows pass through the base anchors, those of D1 and D3 rows through the
platform anchors, and det J does not depend on the point that moments are taken about. So when all
lines pass through fixed points of one body at distances r_i from a point of it, with M = JᵀJ,

    det M ≤ det M_forces · det M_moments ≤ (tr M_forces / 3)³ (tr M_moments / 3)³

(Fischer, then the means), with tr M_forces = n and tr M_moments ≤ Σ r_i². An A1 row is a pure
couple and adds to the moments. If the points lie in a plane at distances ≤ r, the share of a unit
line along the plane and across it enters forces and moments the same way, which gives
|det J| ≤ (n/2)³ r³ / 4: 27/4 r³ for six legs. Lee's |det J|am, eqs. (21), (59), (68), equals it.

D2 and D3 rows together, or a D4 row, leave |det J| without bound: the platform of the first may
run away along its lines, and the common normal of a D4 leg runs away where its lines turn
parallel.
"""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import EPS, Array, norm
from gsp.model.design import Design


def upper_bound(design: Design) -> float:
    """Return a number that |det J| exceeds in no pose, or inf where there is none.

    For D1 rows alone, D1 and D2 (and A1), or D1 and D3 (and A1). It is a proof, not an estimate:
    a pose that reaches it has the maximum.

    Returns
    -------
    float
        In the unit of |det J|: unit^(3 − number of A1 rows), for six rows.

    *Source: ours; see the module.*

    >>> import gsp
    >>> bound = upper_bound(gsp.families.lee.octahedral_3_3(a=1.0, b=2.0))
    >>> round(bound, 12) == round(float(gsp.families.lee.absolute_maximum(1.0)), 12)
    True
    """
    distances = [row.leg for row in design.rows if row.constraint.quantity == "distance"]
    couples = int(design.angular.sum())
    kinds = {row.constraint.name for row in design.rows} - {"A1"}
    bounds = [np.inf]
    if kinds <= {"D1", "D2"}:
        bounds.append(_lines_through(design.base_points[distances], couples))
    if kinds <= {"D1", "D3"}:
        bounds.append(_lines_through(design.platform_points[distances], couples))
    return float(min(bounds))


def _lines_through(points: Array, couples: int) -> float:
    """Bound for one line through each point, and a number of couples."""
    arms = points - points.mean(axis=0)
    squares, n = float((arms**2).sum()), len(points)
    bound = _balanced(n, squares, couples)
    if couples == 0 and _coplanar(arms):
        bound = min(bound, (n / 2.0) ** 3 * float(norm(arms).max()) ** 3 / 4.0)
    return bound


def _balanced(n: int, squares: float, couples: int) -> float:
    """Return the bound by means, couples weighted by the squared length that makes it least."""
    if couples >= 3:
        moments = (couples / 3.0) ** 3
    else:
        x = squares / (3.0 - couples)
        moments = ((squares + couples * x) / 3.0) ** 3 / x**couples if x > 0.0 else 0.0
    return float(np.sqrt((n / 3.0) ** 3 * moments))


def _coplanar(arms: Array) -> bool:
    values = np.linalg.svd(arms, compute_uv=False)
    return bool(values[2] <= 8 * EPS * values[0])
