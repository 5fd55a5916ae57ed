"""Designs for a task: what is wanted, how designs compare, and samples of spaces of designs."""

from gsp.exploration.assessing import assess
from gsp.exploration.exploring import explore
from gsp.exploration.fronts import distances, knee, losses, pareto
from gsp.exploration.optimisation import gradient, optimise
from gsp.exploration.reading import read_task
from gsp.exploration.space import Space
from gsp.exploration.task import Task, Wanted

__all__ = [
    "Space",
    "Task",
    "Wanted",
    "assess",
    "distances",
    "explore",
    "gradient",
    "knee",
    "losses",
    "optimise",
    "pareto",
    "read_task",
]
