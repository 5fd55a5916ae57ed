"""Branches: curves that were followed, with their two ends."""

from __future__ import annotations

from dataclasses import dataclass

from gsp.limits.labels import Active
from gsp.workspace.boundary.critical import Points


@dataclass(frozen=True, eq=False)
class Trace:
    """One curve, from one end to the other.

    Attributes
    ----------
    active : Active
    points : Points, N of them
    status : str
        As that of `Curve`.
    """

    active: Active
    points: Points
    status: str


@dataclass(frozen=True, eq=False)
class Branch:
    """A curve with its two ends: indices of nodes, None where it is closed or was lost.

    `held` are all constraints that stay at their bounds along it: those that it was followed
    with, and, in a plane of symmetry, those that repeat them. `free` is whether the platform may
    turn at every point of it, so that its positions are those of all such turns.
    """

    trace: Trace
    held: Active
    first: int | None
    last: int | None
    connecting: bool = False
    free: bool = False
