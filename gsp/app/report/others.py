"""The design of a report beside the mechanisms of the catalogue on its anchor lines, for a task."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from gsp.app.state.curves import on_template
from gsp.errors import InvalidInput, MissingParameter
from gsp.exploration import Task, assess
from gsp.limits import Limits
from gsp.limits.bounds import bounded_quantities
from gsp.model.design import Design

if TYPE_CHECKING:
    import pandas as pd


def ranked(design: Design, task: Task) -> pd.DataFrame:
    """Return a design and the mechanisms on its anchor lines, ranked for a task, best first.

    Strokes of the design, or of the task, are for its own actuators: all are without strokes.

    Raises
    ------
    InvalidInput
        If only volumes are wanted, which nothing but strokes would bound.
    """
    short, bare = quick(task), design.replace(strokes=None)
    left = without_strokes(bare, short.limits)
    if not short.indices and left is None:
        raise InvalidInput("they have no strokes, which would bound the volumes that are wanted")
    if has_strokes(design, task):
        design, short = bare, replace(short, limits=left)
    return assess([design, *on_template(design)], short, progress=False)


def has_strokes(design: Design, task: Task) -> bool:
    """Return whether the strokes of a design, or those that the task has for it, are a limit."""
    limits = task.limits
    return limits is not None and (limits.strokes is not None or design.strokes is not None)


def without_strokes(design: Design, limits: Limits | None) -> Limits | None:
    """Return the limits without strokes of a design without them, None if nothing is left."""
    left = None if limits is None else replace(limits, strokes=None)
    try:
        bounded_quantities(design, left, crossed=True)
    except MissingParameter:
        return None
    return left


def quick(task: Task) -> Task:
    """Return a task without proofs: proven worst values become worst values at its poses.

    Volumes are left out, unless nothing else is wanted.
    """
    short = [wish for wish in task.wanted if wish.of != "volume"]
    if not short:
        return task
    wishes = {(w.index, "worst" if w.of == "proven worst" else w.of): w for w in short}
    wanted = [replace(wish, of=of) for (_, of), wish in wishes.items()]
    return replace(task, wanted=wanted, resolution=None)
