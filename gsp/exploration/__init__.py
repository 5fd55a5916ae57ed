"""Designs for a task: what is wanted, and how designs compare."""

from gsp.exploration.assessing import assess
from gsp.exploration.reading import read_task
from gsp.exploration.task import Task, Wanted

__all__ = ["Task", "Wanted", "assess", "read_task"]
