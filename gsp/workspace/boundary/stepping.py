"""Lengths of steps along curves."""

from __future__ import annotations

import numpy as np

from gsp.geometry.vectors import Array
from gsp.limits.labels import Active
from gsp.workspace.boundary.critical import Chart

# Steps along a curve [share of the scale, rad]; a curve is lost where the least one fails.
FIRST_CURVE_STEP, LEAST_CURVE_STEP, LONGEST_CURVE_STEP = 0.01, 1e-6, 0.08
# Stroke [share of the scale] from which on the longest step grows with it: a full turn, which takes
# about 80 steps per size of its radius, takes no more than 800 then.
FAR_STROKE = 10.0


def longest_step(chart: Chart, tangent: Array, active: Active) -> float:
    """Return the longest step along a tangent; it grows with the least of long active strokes.

    Turns and weights change by no more than elsewhere.
    """
    radius = float(chart.strokes(active).min(initial=np.inf)) / FAR_STROKE
    rest = float(np.linalg.norm(tangent[len(chart.axes) :]))
    return LONGEST_CURVE_STEP * max(1.0, min(radius, 1.0 / max(rest, 1e-300)))
