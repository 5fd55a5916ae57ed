"""What an index must be given."""

from __future__ import annotations

from gsp.errors import MissingParameter
from gsp.vectors import check_positive


def require_length(index: str, length: float | None, why: str) -> float:
    """Return a positive length, or raise MissingParameter that says why one is needed."""
    if length is None:
        raise MissingParameter(f"{index}: expected a length, as {why}; received none")
    return check_positive("length", length)
