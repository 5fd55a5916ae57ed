"""What an optimisation maximises, and what it requires."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from gsp import arguments
from gsp.errors import InvalidInput, apart, expected
from gsp.exploration.task import Task, Wanted, wanted_value
from gsp.geometry.vectors import Array
from gsp.ranking.restrictions import FEASIBLE

# The column that states whether limits and regularity are proven over the box of the task.
CERTIFIED = "certified"
# Merits of values that are missing or zero: worse than any that occurs.
NO_MERIT = -1e6


@dataclass(frozen=True, eq=False, kw_only=True)
class Goals:
    """Merits and bounds of designs, from their rows.

    Attributes
    ----------
    task : Task
    bounds : tuple of (Wanted, float)
        Values that a design has to reach.
    feasible : float [1]
        Least share of poses within the limits of the task, where it has limits.
    certify : bool
        Whether every pose of the box has to be proven regular and within the limits.
    """

    task: Task
    bounds: tuple[tuple[Wanted, float], ...]
    feasible: float
    certify: bool

    @property
    def watched(self) -> Task:
        """The task, with what the bounds are about among what is wanted."""
        known = {wish.column for wish in self.task.wanted}
        extra = [wish for wish, _ in self.bounds if wish.column not in known]
        return replace(self.task, wanted=[*self.task.wanted, *extra])

    @property
    def shares(self) -> Array:
        """Weights of what is wanted, with the sum 1."""
        weights = np.array([wish.weight for wish in self.task.wanted])
        return np.asarray(weights / weights.sum())

    def merits(self, row: Mapping[str, Any]) -> Array:
        """Return the logarithms of what is wanted, negative where lower is better, (m,)."""
        return np.array([_merit(wish, row) for wish in self.task.wanted])

    def without_value(self, row: Mapping[str, Any]) -> list[str]:
        """Return what is wanted and undefined in a row, such as "worst CTN"."""
        wanted = self.task.wanted
        return [w.label for w in wanted if np.isnan(float(row.get(w.column, np.nan)))]

    def missed(self, row: Mapping[str, Any]) -> list[str]:
        """Return which bounds a row violates: what it has, and what is required."""
        texts = []
        for wish, bound in self.bounds:
            value = float(row.get(wish.column, np.nan))
            if merit(wish, bound) > merit(wish, value):
                got, wanted = apart(value, bound)
                most = "at least" if wish.better == "higher" else "at most"
                texts.append(f"{wish.label} is {got}, {most} {wanted} is required")
        return texts

    def shortfall(self, row: Mapping[str, Any]) -> float:
        """Return by how much a row violates the bounds, 0 if it does not, without certificates.

        Missing shares of feasible poses, and the logarithms of what is missing from the bounds.
        """
        if "error" in row:
            return -NO_MERIT
        missing = [max(0.0, merit(w, b) - _merit(w, row)) for w, b in self.bounds]
        if self.task.limits is not None:
            missing.append(max(0.0, self.feasible - row[FEASIBLE]))
        return float(sum(missing))

    def violation(self, row: Mapping[str, Any]) -> float:
        """Return the shortfall, and 1 more for a design without the certificate that is required.

        0 for a design that is accepted.
        """
        missing = self.shortfall(row)
        return missing + float(self.certify and not row.get(CERTIFIED, False))


def _merit(wish: Wanted, row: Mapping[str, Any]) -> float:
    value = row.get(wish.column, float("nan"))
    return merit(wish, float(value))


def merit(wish: Wanted, value: float) -> float:
    """Return the logarithm of a value, negative where lower is better; bounded by ±NO_MERIT."""
    if np.isnan(value):
        return NO_MERIT
    with np.errstate(divide="ignore"):
        log = float(np.log(max(value, 0.0)))
    good = log if wish.better == "higher" else -log
    return float(np.clip(good, NO_MERIT, -NO_MERIT))


def read_bounds(given: Any) -> tuple[tuple[Wanted, float], ...]:
    """Return bounds from a mapping such as {"worst CTN": 0.2}.

    Raises
    ------
    InvalidInput, UnknownIndex
    """
    pairs = arguments.mapping("require", {} if given is None else given)
    found = []
    for text, value in pairs.items():
        bound = arguments.positive(f"require[{text!r}]", value)
        found.append((wanted_value("require", text), bound))
    columns = [wish.column for wish, _ in found]
    if len(set(columns)) < len(columns):
        raise InvalidInput(expected("require", "each value once", ", ".join(columns)))
    return tuple(found)
