"""Workspaces: sections and boundaries with labelled curves, shells, surfaces, maps of indices."""

from gsp.plots.workspace.labelled import boundary
from gsp.plots.workspace.maps import index_map
from gsp.plots.workspace.plane import arcs, section
from gsp.plots.workspace.space import shells, surface

__all__ = ["arcs", "boundary", "index_map", "section", "shells", "surface"]
