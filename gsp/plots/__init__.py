"""Figures. They need matplotlib, which is imported when one is drawn."""

from gsp.plots import workspace
from gsp.plots.common.style import save
from gsp.plots.explorers import explorer
from gsp.plots.films import Film
from gsp.plots.fronts import front
from gsp.plots.indices import contours, screw_axes, screws
from gsp.plots.mechanisms import mechanism
from gsp.plots.modes import assembly_modes
from gsp.plots.motions import animate
from gsp.plots.parallels import parallel
from gsp.plots.plan import plan_view
from gsp.plots.rankings import against, ranges, ranking
from gsp.plots.sweeps import along, over_plane, sweep

__all__ = [
    "Film",
    "against",
    "along",
    "animate",
    "assembly_modes",
    "contours",
    "explorer",
    "front",
    "mechanism",
    "over_plane",
    "parallel",
    "plan_view",
    "ranges",
    "ranking",
    "save",
    "screw_axes",
    "screws",
    "sweep",
    "workspace",
]
