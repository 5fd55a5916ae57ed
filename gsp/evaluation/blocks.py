"""Cutting designs × poses into blocks, and evaluating them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from gsp.evaluation.backends import Block, Values, run_block
from gsp.evaluation.scheduling import run_all
from gsp.evaluation.settings import Settings
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask
from gsp.model.design import Design

# Poses of a block. The cut does not depend on the workers, and so the result does not either.
BLOCK = 8192

Job = tuple[Design, Settings]


@dataclass(frozen=True)
class Task:
    """What is evaluated, by what, and who is told.

    Attributes
    ----------
    jobs : sequence of (design, settings)
    pose : Pose
    names : tuple of str
        Indices.
    singular : bool
        Whether singular poses are wanted too.
    backend : str
    workers, executor : see `scheduling.run_all`
    tell : function (done, total)
    """

    jobs: Sequence[Job]
    pose: Pose
    names: tuple[str, ...]
    singular: bool
    backend: str
    workers: int | None
    executor: Executor | None
    tell: Callable[[int, int], object]

    @property
    def cut(self) -> list[slice]:
        """The poses of each block, as slices of the flat batch."""
        return [slice(i, i + BLOCK) for i in range(0, self.pose.size, BLOCK)]


class Piece(NamedTuple):
    """A block, with the number of its design and of its slice."""

    job: int
    number: int
    block: Block


def _run(piece: Piece) -> Values:
    return run_block(piece.block)


def evaluated(
    task: Task, known: Callable[[int, int], bool] = lambda job, number: False
) -> Iterator[tuple[int, int, Values]]:
    """Yield number of design, number of slice and values of each block, as soon as it is done.

    Blocks that are `known` are left out.
    """
    flat, cut = task.pose.reshape(task.pose.size), task.cut
    places = [
        (job, number)
        for job in range(len(task.jobs))
        for number in range(len(cut))
        if not known(job, number)
    ]
    pieces = (
        Piece(
            job,
            number,
            Block(*task.jobs[job], task.names, task.singular, flat[cut[number]], task.backend),
        )
        for job, number in places
    )
    total = len(task.jobs) * len(cut)
    results = run_all(_run, pieces, len(places), workers=task.workers, executor=task.executor)
    for done, (piece, values) in enumerate(results, total - len(places) + 1):
        task.tell(done, total)
        yield piece.job, piece.number, values


def by_design(task: Task, known: Callable[[int, int], bool]) -> Iterator[tuple[int, Array, Mask]]:
    """Yield each design as it is done: its number, values (n_names, n), and where it is singular.

    Only designs that are in work are held, so that memory does not grow with their number.
    """
    cut = task.cut
    held: dict[int, tuple[Array, Mask]] = {}
    left: dict[int, int] = {}
    for job, number, values in evaluated(task, known):
        if job not in held:
            size = task.pose.size
            held[job] = np.empty((len(task.names), size)), np.empty(size, dtype=bool)
            left[job] = len(cut)
        columns, singular = held[job]
        columns[:, cut[number]] = values.columns
        singular[cut[number]] = values.singular
        left[job] -= 1
        if not left[job]:
            yield job, *held.pop(job)
