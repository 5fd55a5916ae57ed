"""Appendix A of `Workspace-A`: the planar program, its identification vectors and truth table."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np

from gsp.errors import InvalidInput, expected
from gsp.geometry.vectors import Array
from gsp.planar import PlanarDesign, corner_poses, radiating_point

N_LEGS = 3


def rows_of_truth_table(legs: int) -> int:
    """Count the rows of the matrix IDAll: labels with every leg at one of its two limits."""
    return len(list(product((0, 1), repeat=legs)))


def number_of_bifurcation_points(
    base: Sequence[Sequence[float]],
    platform: Sequence[Sequence[float]],
    low: float,
    high: float,
) -> int:
    """Count the poses of a planar platform at which all of its three legs are at a limit."""
    design = PlanarDesign(["D1"] * N_LEGS, base, platform, strokes=[[low, high]] * N_LEGS)
    return sum(pose.angle.size for pose in corner_poses(design, starts=120).values())


def lengths_at_radiating_point(
    base: Sequence[Sequence[float]],
    platform: Sequence[Sequence[float]],
    low: float,
    high: float,
) -> Array:
    """Leg lengths at the radiating point of (A.2), solved from the middle of the base."""
    design = PlanarDesign(["D1"] * N_LEGS, base, platform, strokes=[[low, high]] * N_LEGS)
    return design.at(radiating_point(design, np.mean(base, axis=0))).joints


def rules_that_apply(length: float, low: float, high: float, tolerance: float, reading: str) -> int:
    """How many of the three rules for an entry of the identification vector a length satisfies.

    With c = low − length and c' = length − high, the third rule is c ≤ tolerance and
    c' ≤ tolerance "as printed", or c < −tolerance and c' < −tolerance "inside".
    """
    c, other = low - length, length - high
    third = {
        "as printed": c <= tolerance and other <= tolerance,
        "inside": c < -tolerance and other < -tolerance,
    }
    if reading not in third:
        raise InvalidInput(expected("reading", "one of " + ", ".join(third), repr(reading)))
    return int(abs(c) <= tolerance) + int(abs(other) <= tolerance) + int(third[reading])


def rows_without_label(boundary: Sequence[Sequence[int]], matrix: str) -> int:
    """Count the rows of IDAll or IDBound that are not the row of a point on the boundary."""
    rows = {"IDAll": list(product((0, 1), repeat=N_LEGS)), "IDBound": [tuple(r) for r in boundary]}
    if matrix not in rows:
        raise InvalidInput(expected("matrix", "one of " + ", ".join(rows), repr(matrix)))
    return len(set(rows[matrix]) - {tuple(row) for row in boundary})


QUANTITIES = (
    rows_of_truth_table,
    number_of_bifurcation_points,
    lengths_at_radiating_point,
    rules_that_apply,
    rows_without_label,
)
