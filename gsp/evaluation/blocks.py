"""Division of designs × poses into blocks, which threads or an executor compute."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Sequence
from typing import NamedTuple

import numpy as np

from gsp.evaluation.backends import Block, Values, run_block
from gsp.evaluation.request import Request
from gsp.evaluation.scheduling import run_all
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask
from gsp.progress import Report


class Piece(NamedTuple):
    """Blocks of the same slice of the poses, with the number of the design of each."""

    jobs: Sequence[int]
    number: int
    blocks: Sequence[Block]


def _run(piece: Piece) -> list[Values]:
    return [run_block(block) for block in piece.blocks]


def evaluated(
    request: Request, report: Report, known: Callable[[int, int], bool]
) -> Iterator[tuple[int, int, Values]]:
    """Yield number of design, number of slice and values of each block, as soon as it is done.

    Parameters
    ----------
    request : Request
    report : function (done, total)
        Called after each block.
    known : function (number of design, number of slice) -> bool
        Whether the values of a block are known already, so that it is not computed.
    """
    flat = request.pose.reshape(request.pose.size)
    places = _places(request, known)
    pieces = (_piece(request, *place, flat) for place in places)
    results = run_all(_run, pieces, len(places), workers=request.workers, executor=request.executor)
    steps = request.steps
    done = steps - sum(len(jobs) for jobs, _ in places)
    for piece, found in results:
        for job in piece.jobs:
            done += 1
            report(done, steps)
            yield job, piece.number, found.pop(0)  # whose memory is free while others are computed


def _places(request: Request, known: Callable[[int, int], bool]) -> list[tuple[Sequence[int], int]]:
    """Return numbers of designs, and of the slice, of what is computed at once.

    Designs at few poses are computed several at a time: what runs in Python between them, one
    thread at a time, takes as long as the evaluation of some hundred poses.
    """
    jobs, slices = range(len(request.jobs)), range(len(request.cut))
    if len(slices) > 1:
        return [([job], number) for job in jobs for number in slices if not known(job, number)]
    left, together = [job for job in jobs if not known(job, 0)], request.designs_at_once
    return [(left[i : i + together], 0) for i in range(0, len(left), together)]


def _piece(request: Request, jobs: Sequence[int], number: int, flat: Pose) -> Piece:
    part = flat if len(request.cut) == 1 else flat[request.cut[number]]
    return Piece(jobs, number, [_block(request, job, part) for job in jobs])


def _block(request: Request, job: int, pose: Pose) -> Block:
    design, settings = request.jobs[job]
    return Block(
        design, settings, request.names, request.singular, pose, request.backend, request.checks
    )


class DesignValues(NamedTuple):
    """Values of one design at all n poses: see `gsp.evaluation.backends.Values`."""

    job: int
    columns: Array
    singular: Mask
    checked: Mask


def by_design(
    request: Request, report: Report, known: Collection[int] = ()
) -> Iterator[DesignValues]:
    """Yield the values of each design, except known ones, as soon as they are computed.

    Memory is used for the designs in progress only, so that it does not grow with their number.
    """
    cut, size = request.cut, request.pose.size
    started: dict[int, DesignValues] = {}
    left: dict[int, int] = {}
    for job, number, values in evaluated(request, report, lambda job, number: job in known):
        if job not in started:
            columns = np.empty((len(request.names), size))
            conditions = 0 if values.checked is None else len(values.checked)
            flags = np.empty((1 + conditions, size), dtype=bool)
            started[job] = DesignValues(job, columns, flags[0], flags[1:])
            left[job] = len(cut)
        started[job].columns[:, cut[number]] = values.columns
        started[job].singular[cut[number]] = values.singular
        if values.checked is not None:
            started[job].checked[:, cut[number]] = values.checked
        left[job] -= 1
        if not left[job]:
            yield started.pop(job)
