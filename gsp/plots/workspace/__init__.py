"""Workspaces: plane sections and boundaries with labelled curves, shells and surfaces in space."""

from gsp.plots.workspace.labelled import boundary
from gsp.plots.workspace.plane import arcs, section
from gsp.plots.workspace.space import shells, surface

__all__ = ["arcs", "boundary", "section", "shells", "surface"]
