"""Workspaces: plane sections with labelled curves, shells and surfaces in space."""

from gsp.plots.workspace.plane import arcs, section
from gsp.plots.workspace.space import shells, surface

__all__ = ["arcs", "section", "shells", "surface"]
