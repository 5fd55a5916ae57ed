"""What an index must be given."""

from __future__ import annotations

from typing import Any

from gsp.checks import check_positive
from gsp.errors import InvalidInput, MissingParameter, expected


def require_posture(posture: Any) -> None:
    """Raise InvalidInput for what is not a posture, such as a design or a matrix."""
    if not hasattr(posture, "jacobian"):
        got = type(posture).__name__
        raise InvalidInput(expected("posture", "a gsp.Posture, as design.at(pose) makes", got))


def require_length(index: str, length: float | None, why: str) -> float:
    """Return a positive length, or raise MissingParameter that says why one is needed."""
    if length is None:
        raise MissingParameter(f"{index}: expected a length, as {why}; received none")
    return check_positive("length", length)
