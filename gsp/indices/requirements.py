"""Checks of the arguments of indices."""

from __future__ import annotations

from typing import Any

from gsp.checks import is_a
from gsp.errors import InvalidInput, expected
from gsp.model.posture import Posture


def require_posture(posture: Any) -> None:
    """Raise InvalidInput for what is not a posture in space: a design, a planar posture."""
    if not is_a(posture, Posture):
        got = type(posture).__name__
        raise InvalidInput(expected("posture", "a gsp.Posture, as design.at(pose) makes", got))
