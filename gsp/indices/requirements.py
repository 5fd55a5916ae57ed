"""Checks of the arguments of indices."""

from __future__ import annotations

from typing import Any

from gsp.checks import has
from gsp.errors import InvalidInput, expected


def require_posture(posture: Any) -> None:
    """Raise InvalidInput for what is not a posture, such as a design or a matrix."""
    if not has(posture, "jacobian"):
        got = type(posture).__name__
        raise InvalidInput(expected("posture", "a gsp.Posture, as design.at(pose) makes", got))
