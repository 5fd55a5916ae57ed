"""Limits of poses: strokes, cones, clearances, intervals, thresholds on indices."""

from gsp.limits.feasibility import Feasibility, feasible
from gsp.limits.limits import Limits

__all__ = ["Feasibility", "Limits", "feasible"]
