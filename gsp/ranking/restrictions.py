"""Poses of a ranking that are within the strokes of a design, or satisfy given limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from functools import partial
from typing import Any

import numpy as np

from gsp.checks import check_type
from gsp.evaluation.backends import Check
from gsp.geometry.ellipsoid import Ellipsoid
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Mask
from gsp.indices import Index
from gsp.limits import Limits, feasible
from gsp.limits.bounds import bounded_quantities
from gsp.model.design import Design

# Columns of a ranking: shares of the poses.
WITHIN_STROKES, FEASIBLE = "within_strokes", "feasible"


def within_strokes(design: Design, pose: Pose) -> Mask:
    """Whether all joints are within the strokes of a design, shape (...); true without strokes."""
    if design.strokes is None:
        return np.ones(pose.shape, dtype=bool)
    return feasible(design, pose).ok


def _satisfied(design: Design, pose: Pose, limits: Limits) -> Mask:
    return feasible(design, pose, limits).ok


def restrictions(designs: Sequence[Design], limits: Limits | None) -> dict[str, Check]:
    """Return the conditions that are evaluated at each pose, by the name of the column.

    Parameters
    ----------
    designs : sequence of Design
    limits : Limits or None

    Raises
    ------
    InvalidInput, MissingParameter
        If the limits do not fit a design.
    """
    asked: dict[str, Check] = {}
    if any(design.strokes is not None for design in designs):
        asked[WITHIN_STROKES] = within_strokes
    if limits is not None:
        check_type("limits", limits, Limits)
        for design in designs:
            bounded_quantities(design, limits, crossed=True)
        strokes_alone = limits_record(limits) == limits_record(Limits())
        asked[FEASIBLE] = within_strokes if strokes_alone else partial(_satisfied, limits=limits)
    return asked


def limits_record(limits: Limits | None) -> dict[str, Any] | None:
    """Return all parts of limits, as lists, numbers and texts; None for None.

    Two limits have the same record if and only if their numbers are the same, so that a checksum
    can be computed from it.
    """
    if limits is None:
        return None
    # "thresholds" holds what the texts of "indices" mean.
    names = [f.name for f in fields(limits) if f.name != "indices"]
    return {name: _plain(getattr(limits, name)) for name in names}


def _plain(value: Any) -> Any:
    if isinstance(value, Index):
        return value.name
    if isinstance(value, Ellipsoid):
        return [_plain(part) for part in (value.semi_axes, value.center, value.rotation)]
    if isinstance(value, np.ndarray | np.generic):
        return value.tolist()
    if isinstance(value, list | tuple):
        return [_plain(part) for part in value]
    if value is None or isinstance(value, str | int | float):
        return value
    raise TypeError(f"limits hold a {type(value).__name__}")
