"""Regularity over boxes by a general interval library, for the comparison of `bench_proofs`.

It needs codac (`pip install codac`), which is not among the dependencies of this project.
"""

from __future__ import annotations

import time
from typing import Any

import numpy as np

import gsp


def jacobian(design: gsp.Design) -> list[list[Any]]:
    """Return the entries of the Jacobian of D1 rows as functions of x, y, z, roll, pitch, yaw.

    The library intersects the natural extension of a function with its centred form.
    """
    import codac

    arguments = [codac.ScalarVar() for _ in range(6)]
    p, angles = arguments[:3], arguments[3:]
    (cr, cp, cy), (sr, sp, sy) = map(codac.cos, angles), map(codac.sin, angles)
    rotation = [
        [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
        [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
        [-sp, cp * sr, cp * cr],
    ]
    rows = []
    for a, b in zip(design.base_points.tolist(), design.platform_points.tolist(), strict=True):
        arm = [row[0] * b[0] + row[1] * b[1] + row[2] * b[2] for row in rotation]
        d = [p[k] + arm[k] - a[k] for k in range(3)]
        length = codac.sqrt(codac.sqr(d[0]) + codac.sqr(d[1]) + codac.sqr(d[2]))
        u = [x / length for x in d]
        moment = [arm[i] * u[j] - arm[j] * u[i] for i, j in ((1, 2), (2, 0), (0, 1))]
        rows.append([codac.AnalyticFunction(arguments, x) for x in (*u, *moment)])
    return rows


def regular(design: gsp.Design, box: gsp.PoseBox, patience: float) -> tuple[int, float]:
    """Prove regularity by halving; boxes and seconds, NaN if the patience [s] ends before.

    A box is regular if ‖I − T J‖ < 1 in the norm of row sums, where T is the inverse of J at the
    centre. The widest coordinate is halved.
    """
    import codac

    entries = jacobian(design)
    start, boxes = time.process_time(), 0
    waiting = [list(zip(box.low.tolist(), box.high.tolist(), strict=True))]
    while waiting:
        if time.process_time() - start > patience:
            return boxes, float("nan")
        pairs = waiting.pop()
        boxes += 1
        given = [codac.Interval(*pair) for pair in pairs]
        rows = [[entry.eval(*given) for entry in row] for row in entries]
        inverse = np.linalg.inv([[x.mid() for x in row] for row in rows])
        if _departure(inverse.tolist(), rows) < 1.0:
            continue
        widths = [high - low for low, high in pairs]
        k = widths.index(max(widths))
        low, high = pairs[k]
        middle_k = 0.5 * (low + high)
        for half in ((low, middle_k), (middle_k, high)):
            waiting.append([*pairs[:k], half, *pairs[k + 1 :]])
    return boxes, time.process_time() - start


def _departure(inverse: list[list[float]], rows: list[list[Any]]) -> float:
    """Greatest row sum of |I − T J|."""
    worst = 0.0
    for i, t in enumerate(inverse):
        total = 0.0
        for j in range(6):
            entry = sum((t[k] * rows[k][j] for k in range(1, 6)), t[0] * rows[0][j])
            total += (entry - float(i == j)).mag()
        worst = max(worst, total)
    return worst
