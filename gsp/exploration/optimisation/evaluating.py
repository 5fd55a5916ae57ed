"""Evaluation of batches of designs of a space, in steps that are stored and read again."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np

from gsp.errors import GspError
from gsp.evaluation.parts import Parts
from gsp.evaluation.scheduling import run_all
from gsp.exploration.assessing import Run, assessed, checked, requested
from gsp.exploration.optimisation.goals import CERTIFIED, Goals
from gsp.exploration.proving import Proofs, shared
from gsp.exploration.space import Space
from gsp.exploration.task import Task
from gsp.geometry.vectors import Array
from gsp.model.design import Design
from gsp.proof.boxes import search_box


class Evaluator:
    """Evaluates designs of a space for a task, and keeps all of them.

    The same calls in the same order give the same steps, so a run that is repeated takes the
    stored steps instead of computing them: any search that is deterministic continues to the same
    bits.

    Parameters
    ----------
    space : Space
    goals : Goals
    proofs : Proofs
    run : Run
        workers and executor.
    parts : Parts or None
        Where steps are stored.
    report : function (number of designs)
        Called after each step.

    Attributes
    ----------
    rows : list of dict
        Parameters and columns of all designs, in the order of evaluation; "error" where there is
        no design.
    points : list of (d,) arrays
        Their points of the unit cube.
    """

    def __init__(
        self,
        space: Space,
        goals: Goals,
        proofs: Proofs,
        run: Run,
        parts: Parts | None,
        report: Callable[[int], object],
    ) -> None:
        self.space, self.goals, self.proofs, self.run = space, goals, proofs, run
        self.parts, self.report, self.rows = parts, report, list[dict[str, Any]]()
        self.points: list[Array] = []
        self._steps = 0

    def step(self, compute: Callable[[], dict[str, Any]]) -> dict[str, Any]:
        """Return the result of the next step: a stored one, or a computed one, which is stored."""
        number, self._steps = self._steps, self._steps + 1
        if self.parts and self.parts.has(number):
            return self.parts.read_row(number)
        found = compute()
        if self.parts:
            self.parts.write_row(number, found)
        return found

    def evaluate(self, points: Array) -> list[dict[str, Any]]:
        """Return the rows of designs at points (n, d) of the unit cube, and keep them."""
        wanted = [parameters_at(self.space, point) for point in points]
        found: list[dict[str, Any]] = self.step(lambda: {"rows": self._computed(wanted)})["rows"]
        self.rows += found
        self.points += list(points)
        self.report(len(self.rows))
        return found

    def _computed(self, wanted: Sequence[dict[str, Any]]) -> list[dict[str, Any]]:
        rows, designs, places = [dict(one) for one in wanted], list[Design](), list[int]()
        first = len(self.rows)
        for i, parameters in enumerate(wanted):
            try:
                made = self.space.design(**parameters)
            except GspError as error:
                rows[i]["error"] = str(error)
            else:
                designs.append(made.replace(name=f"{made.name or 'design'} {first + i}"))
                places.append(i)
        if designs:
            for i, row in zip(places, self._assessed(designs), strict=True):
                rows[i] |= row
            if self.goals.certify:
                self._certify(rows, dict(zip(places, designs, strict=True)))
        return rows

    def _assessed(self, designs: Sequence[Design]) -> list[dict[str, Any]]:
        task = self.goals.watched
        chosen, _ = checked(designs, task, self.proofs.tolerance, self.proofs.budget)
        request, asked = requested(chosen, task, self.run, False)
        return assessed(request, task, asked, self.proofs, None)[1]

    def _certify(self, rows: Sequence[dict[str, Any]], designs: Mapping[int, Design]) -> None:
        """State in rows which designs are proven; those that violate a bound are not tried."""
        task, executor = self.goals.task, self.run.executor
        at_once, threads = shared(self.run.workers, executor)
        asked = [
            _Proof(i, design, task, self.proofs.budget, threads)
            for i, design in designs.items()
            if self.goals.shortfall(rows[i]) == 0.0
        ]
        for i in designs:
            rows[i][CERTIFIED] = False
        for one, found in run_all(
            _proved, iter(asked), len(asked), workers=at_once, executor=executor
        ):
            rows[one.number][CERTIFIED] = found


class _Proof(NamedTuple):
    """What is proven of a design, with its number."""

    number: int
    design: Design
    task: Task
    budget: int
    threads: int | None


def _proved(asked: _Proof) -> bool:
    """Return whether every pose of the box of a task is proven regular and within the limits."""
    box: Any = asked.task.poses
    given: dict[str, Any] = {"budget": asked.budget, "workers": asked.threads}
    found, interrupted = search_box(asked.design, box, asked.task.limits, **given)
    if interrupted:  # no verdict on the design, which would otherwise be stored as one
        raise KeyboardInterrupt
    return bool(found.status == "proven")


def parameters_at(space: Space, point: Array) -> dict[str, Any]:
    """Return the parameters at a point (d,) of the unit cube: ranges, then choices."""
    numbers = np.clip(point, 0.0, 1.0).tolist()
    found: dict[str, Any] = {}
    for (name, (low, high)), x in zip(space.ranges.items(), numbers, strict=False):
        found[name] = low + (high - low) * x
    for (name, values), x in zip(space.choices.items(), numbers[len(space.ranges) :], strict=True):
        found[name] = values[min(int(x * len(values)), len(values) - 1)]
    return found
