"""Figures. They need matplotlib, which is imported when one is drawn."""

from gsp.plots.mechanism import mechanism
from gsp.plots.ranking import against, ranking
from gsp.plots.sweeps import along, contours

__all__ = ["against", "along", "contours", "mechanism", "ranking"]
