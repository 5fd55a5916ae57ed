"""Figures. They need matplotlib, which is imported when one is drawn."""

from gsp.plots.indices import contours, screw_axes, screws
from gsp.plots.mechanism import mechanism
from gsp.plots.ranking import against, ranking

__all__ = ["against", "contours", "mechanism", "ranking", "screw_axes", "screws"]
