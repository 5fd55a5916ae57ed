"""Volumes of workspaces that a task asks for: proven brackets, one row of columns per design."""

from __future__ import annotations

from collections.abc import Callable
from types import MappingProxyType
from typing import Any

from gsp.exploration.task import HIGH, LOW, RESOLUTION, Task, Wanted
from gsp.geometry.pose import PoseBox
from gsp.limits.bounds import bounded_quantities
from gsp.model.design import Design
from gsp.workspace.sets import Region, dextrous, reachable
from gsp.workspace.sides import side_of


def _reachable(design: Design, box: PoseBox, task: Task, **given: Any) -> Region:
    return reachable(design, task.limits, rotations=box, **given)


def _dextrous(design: Design, box: PoseBox, task: Task, **given: Any) -> Region:
    return dextrous(design, box, task.limits, **given)


REGIONS: MappingProxyType[str, Callable[..., Region]] = MappingProxyType(
    {"reachable": _reachable, "dextrous": _dextrous}
)


def volumes(task: Task) -> list[Wanted]:
    """Return the volumes among what is wanted."""
    return [wish for wish in task.wanted if wish.of == "volume"]


def check_bounded(design: Design, task: Task) -> None:
    """Raise an error if nothing limits a design of which a volume is wanted.

    Raises
    ------
    MissingParameter, InvalidInput
    """
    bounded_quantities(design, task.limits)


def volume_row(
    design: Design, task: Task, wish: Wanted, budget: int, workers: int | None
) -> dict[str, Any]:
    """Return the columns of a volume.

    Parameters
    ----------
    design : Design
    task : Task
        With a box: its angles are the orientations, and its centre is on the side of a plane base
        that counts.
    wish : Wanted
    budget : int
        Most cells of the search: see `gsp.workspace.reachable`.
    workers : int or None

    Returns
    -------
    dict
        Least and greatest volume, proven [unit³], and the longest side of an undecided cell [unit].
    """
    box: Any = task.poses
    centre = 0.5 * (box.low[:3] + box.high[:3])
    region = REGIONS[wish.index](
        design,
        box,
        task,
        half_space=side_of(design, centre).half_space,
        resolution=task.resolution,
        budget=budget,
        workers=workers,
        progress=False,
    )
    low, high = region.bracket
    ends = {LOW: low, HIGH: high, RESOLUTION: float(region.resolution)}
    return {f"{wish.index}_{end}": value for end, value in ends.items()}
