"""Poses of a ranking that are within the strokes of a design, or satisfy given limits."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from functools import partial
from typing import Any, NamedTuple

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

# Columns of a ranking: shares of the poses; and the beginning of the names of those by kinds.
WITHIN_STROKES, FEASIBLE, VIOLATED = "within_strokes", "feasible", "violated_"


class Restrictions(NamedTuple):
    """Conditions at each pose.

    Attributes
    ----------
    columns : tuple of str
        Their names.
    checks : tuple of functions (design, pose) -> (n,) or (k, n) bool array
        One after the other they give the columns. Each evaluates the design at the poses once.
    """

    columns: tuple[str, ...]
    checks: tuple[Check, ...]


NONE = Restrictions((), ())


def within_strokes(design: Design, pose: Pose) -> Mask:
    """Whether all joints are within the strokes of a design, shape (...); true without strokes."""
    if design.strokes is None:
        return np.ones(pose.shape, dtype=bool)
    return feasible(design, pose).ok


def _judged(design: Design, pose: Pose, limits: Limits, columns: Sequence[str]) -> Mask:
    """Return columns of `restrictions`, shape (k, n); the strokes are those of the limits."""
    found = feasible(design, pose, limits)
    violated, kinds = np.asarray(found.violated.any(axis=-1)), np.array(found.kinds)
    ok = ~violated.any(axis=-1)
    rows = []
    for column in columns:
        kind = "joint" if column == WITHIN_STROKES else column.removeprefix(VIOLATED)
        wrong = ~ok if column == FEASIBLE else violated[:, kinds == kind].any(axis=-1)
        rows.append(wrong if column.startswith(VIOLATED) else ~wrong)
    return np.stack(rows)


def restrictions(
    designs: Sequence[Design], limits: Limits | None, *, by_kind: bool = False
) -> Restrictions:
    """Return the conditions that are evaluated at each pose.

    Parameters
    ----------
    designs : sequence of Design
    limits : Limits or None
    by_kind : bool
        Whether there is a column for each kind of limits as well: where one is violated.

    Raises
    ------
    InvalidInput, MissingParameter
        If the limits do not fit a design.
    """
    strokes = any(design.strokes is not None for design in designs)
    if limits is None:
        return Restrictions((WITHIN_STROKES,), (within_strokes,)) if strokes else NONE
    check_type("limits", limits, Limits)
    kinds: dict[str, None] = {}
    for design in designs:
        named = bounded_quantities(design, limits, crossed=True).named
        kinds |= dict.fromkeys(quantity.kind for quantity in named)
    first = (WITHIN_STROKES,) if strokes else ()
    rest = (FEASIBLE, *(VIOLATED + kind for kind in kinds if by_kind))
    # Without other strokes, the joints of the limits are within those of the design.
    if limits.strokes is None:
        columns = (*first, *rest)
        return Restrictions(columns, (partial(_judged, limits=limits, columns=columns),))
    judged = partial(_judged, limits=limits, columns=rest)
    return Restrictions((*first, *rest), (within_strokes, judged) if strokes else (judged,))


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
