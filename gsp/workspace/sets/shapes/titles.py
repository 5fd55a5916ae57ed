"""Titles of pictures of regions: the design, the plane, and the orientations."""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.figures import wrapped
from gsp.geometry.rotations import moving_places
from gsp.geometry.vectors import Array

# Degrees and components that differ by less come from rounding.
ROUNDING = 1e-9


def heading(region: Any) -> str:
    """Return the lines that state what a region is of: design, plane, and orientations."""
    lines = [region.problem.design.name, _plane(region), _orientations(region)]
    return wrapped("\n".join(line for line in lines if line))


def range_words(box: Array, order: str, *, some: bool) -> str:
    """Return the words for one orientation, or for all or some of those of a range.

    Parameters
    ----------
    box : (3, 2) array [°]
        Least and greatest angles of the angle set `order`.
    order : str
    some : bool
        Whether one orientation of the range is enough.
    """
    if (box[:, 0] == box[:, 1]).all():
        return f"angles {' '.join(f'{angle:g}°' for angle in box[:, 0])} ({order})"
    ends = " ".join(f"{low:g}°…{high:g}°" if high > low else f"{low:g}°" for low, high in box)
    return f"{'some' if some else 'all'} of the angles {ends} ({order})"


def direction_name(v: Array) -> str:
    """Return the name of a direction: an axis of the base, or its components."""
    k = int(np.argmax(np.abs(v)))
    if abs(abs(v[k]) - 1.0) < ROUNDING:
        return ("−" if v[k] < 0.0 else "") + "xyz"[k]
    return "along (" + ", ".join(f"{x:.3g}" for x in v) + ")"


def _plane(region: Any) -> str:
    if region.kind != "plane":
        return ""
    first, second = region.problem.frame[:2]
    if abs(first[2]) < ROUNDING and abs(second[2] - 1.0) < ROUNDING:
        turn = np.rad2deg(np.arctan2(first[1], first[0]))
        return f"vertical plane at {_rounded(turn):g}°"
    return f"plane {direction_name(first)}, {direction_name(second)}"


def _orientations(region: Any) -> str:
    problem = region.problem
    if region.kind == "orientations":
        place = ", ".join(f"{x:.4g}" for x in problem.outward(problem.low) + 0.0)
        return f"orientations at ({place}) {problem.design.unit}".rstrip()
    if problem.free:
        return "all orientations" if region.all_rotations else "any orientation"
    box = np.empty((3, 2))
    box[moving_places(problem.order)] = np.stack((problem.least, problem.most), axis=1)
    return range_words(_rounded(np.rad2deg(box)), problem.order, some=not region.all_rotations)


def _rounded(degrees: Any) -> Any:
    """Return degrees without what rounding adds, and without a minus before zero."""
    return np.round(degrees, 9) + 0.0
