"""Division of designs × poses into blocks, which threads or an executor compute."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from typing import NamedTuple

import numpy as np

from gsp.evaluation.backends import Block, Values, run_block
from gsp.evaluation.request import Request
from gsp.evaluation.scheduling import run_all
from gsp.geometry.pose import Pose
from gsp.geometry.vectors import Array, Mask
from gsp.progress import Report


class Piece(NamedTuple):
    """A block, with the number of its design and of its slice."""

    job: int
    number: int
    block: Block


def _run(piece: Piece) -> Values:
    return run_block(piece.block)


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
    flat, cut = request.pose.reshape(request.pose.size), request.cut
    places = [
        (job, number)
        for job in range(len(request.jobs))
        for number in range(len(cut))
        if not known(job, number)
    ]
    pieces = (Piece(job, number, _block(request, job, flat[cut[number]])) for job, number in places)
    results = run_all(_run, pieces, len(places), workers=request.workers, executor=request.executor)
    steps = request.steps
    for done, (piece, values) in enumerate(results, steps - len(places) + 1):
        report(done, steps)
        yield piece.job, piece.number, values


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
            flags = np.empty((1 + len(request.checks), size), dtype=bool)
            started[job] = DesignValues(job, columns, flags[0], flags[1:])
            left[job] = len(cut)
        started[job].columns[:, cut[number]] = values.columns
        started[job].singular[cut[number]] = values.singular
        if values.checked is not None:
            started[job].checked[:, cut[number]] = values.checked
        left[job] -= 1
        if not left[job]:
            yield started.pop(job)
