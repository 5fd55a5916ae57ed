"""What a task wants with a proof: worst values of indices, and volumes; their rows, stored."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from concurrent.futures import Executor
from typing import Any, NamedTuple

from gsp.evaluation.parts import Parts
from gsp.evaluation.request import Request
from gsp.evaluation.scheduling import run_all
from gsp.exploration.task import Task, Wanted
from gsp.exploration.volumes import volume_row, volumes
from gsp.geometry.pose import PoseBox
from gsp.model.design import Design
from gsp.proof.worst_values import worst_of_each

# What a table has of a worst value that was proven, by the end of the name of its column.
PROVEN, FOUND, CLOSED = "proven", "found", "closed"


class Proofs(NamedTuple):
    """How bounds are proven: `tolerance` and `budget` of `gsp.proof.worst`, cells of a volume."""

    tolerance: float
    budget: int
    cells: int


def proven(task: Task) -> list[Wanted]:
    """Return what is wanted with a proof."""
    return [wish for wish in task.wanted if wish.of == "proven worst"]


def recorded(task: Task, proofs: Proofs) -> dict[str, Any]:
    """Return how bounds were proven, as the table records it."""
    how = {"tolerance": proofs.tolerance, "budget": proofs.budget} if proven(task) else {}
    return {**how, **({"cells": proofs.cells} if volumes(task) else {})}


def proof_rows(
    request: Request,
    task: Task,
    wanted: Sequence[Wanted],
    proofs: Proofs,
    parts: Parts | None,
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield number of design and columns of each proof, the stored ones first.

    Parameters
    ----------
    request, task, proofs, parts :
        As `gsp.exploration.assessing.assessed` takes them.
    wanted : sequence of Wanted
        Proven worst values and volumes: one series of parts each.
    """
    for series, wish in enumerate(wanted, 1):
        first = series * len(request.jobs)
        designs = {i: job.design for i, job in enumerate(request.jobs)}
        stored = {i: parts.read_row(first + i) for i in designs if parts and parts.has(first + i)}
        yield from stored.items()
        left = {i: design for i, design in designs.items() if i not in stored}
        rows = _volume_rows if wish.of == "volume" else _proven_rows
        for number, row in rows(request, task, wish, proofs, left):
            if parts:
                parts.write_row(first + number, row)
            yield number, row


def _volume_rows(
    request: Request, task: Task, wish: Wanted, proofs: Proofs, designs: Mapping[int, Design]
) -> Iterator[tuple[int, dict[str, Any]]]:
    """Yield the columns of volumes: one design after another, or one per task of an executor."""
    at_once, threads = shared(request.workers, request.executor)
    tasks = [_Volume(*one, task, wish, proofs.cells, threads) for one in designs.items()]
    for asked, row in run_all(
        _volume, iter(tasks), len(tasks), workers=at_once, executor=request.executor
    ):
        yield asked.number, row


def shared(workers: int | None, executor: Executor | None) -> tuple[int | None, int | None]:
    """Return how many searches run at once, and the threads of each.

    A search has threads of its own, so without an executor there is one after another.
    """
    return (1, workers) if executor is None else (workers, 1)


class _Volume(NamedTuple):
    """The arguments of `volume_row`, with the number of the design."""

    number: int
    design: Design
    task: Task
    wish: Wanted
    cells: int
    workers: int | None


def _volume(asked: _Volume) -> dict[str, Any]:
    return volume_row(*asked[1:])


def _proven_rows(
    request: Request, task: Task, wish: Wanted, proofs: Proofs, designs: Mapping[int, Design]
) -> Iterator[tuple[int, dict[str, Any]]]:
    if not isinstance(task.poses, PoseBox):  # which a task with such a wish has
        return
    options = {"length": task.length, "ellipsoid": task.ellipsoid, "maximum": None}
    lower, how = wish.better == "lower", (proofs.tolerance, proofs.budget)
    for number, value in worst_of_each(
        designs, task.poses, wish.index, *how, options, request.workers, request.executor
    ):
        bound, found = (value.high, value.low) if lower else (value.low, value.high)
        yield (
            number,
            {
                f"{wish.index}_{PROVEN}": bound,
                f"{wish.index}_{FOUND}": found,
                f"{wish.index}_{CLOSED}": bool(value.closed),
            },
        )
