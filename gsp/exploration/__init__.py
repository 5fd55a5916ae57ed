"""Designs for a task: what is wanted, how designs compare, and samples of spaces of designs."""

from gsp.exploration.assessing import assess
from gsp.exploration.exploring import explore
from gsp.exploration.fronts import distances, knee, losses, pareto
from gsp.exploration.optimisation import gradient, optimise
from gsp.exploration.reading import read_space, read_task
from gsp.exploration.sensitivity import sensitivities, sobol_indices
from gsp.exploration.space import Space
from gsp.exploration.task import Task, Wanted
from gsp.exploration.tolerance import (
    Deviations,
    IndexTolerance,
    PoseTolerance,
    index_tolerance,
    pose_tolerance,
)

__all__ = [
    "Deviations",
    "IndexTolerance",
    "PoseTolerance",
    "Space",
    "Task",
    "Wanted",
    "assess",
    "distances",
    "explore",
    "gradient",
    "index_tolerance",
    "knee",
    "losses",
    "optimise",
    "pareto",
    "pose_tolerance",
    "read_space",
    "read_task",
    "sensitivities",
    "sobol_indices",
]
