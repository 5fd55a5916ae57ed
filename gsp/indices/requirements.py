"""Checks of the arguments of indices."""

from __future__ import annotations

from typing import Any

import numpy as np

from gsp.checks import is_a
from gsp.errors import InvalidInput, expected
from gsp.geometry.vectors import Array
from gsp.model.posture import Posture


def require_posture(posture: Any) -> None:
    """Raise InvalidInput for what is not a posture in space: a design, a planar posture."""
    if not is_a(posture, Posture):
        got = type(posture).__name__
        raise InvalidInput(expected("posture", "a gsp.Posture, as design.at(pose) makes", got))


def with_singular_drives(posture: Posture, values: Array, worst: float) -> Array:
    """Return values of an index (...), the worst one where a drive at the base is singular.

    The Jacobian has an infinite row there; other legs that are undefined leave NaN.
    """
    if not posture.design.driven:
        return values
    return np.asarray(np.where(posture.poses_of_singular_drives, worst, values))
