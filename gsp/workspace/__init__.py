"""Workspaces: where a design can go, and what stops it."""

from gsp.workspace.bifurcation import bifurcation_point
from gsp.workspace.dexterity import Dextrous, dextrous
from gsp.workspace.feasibility import Feasibility, feasible
from gsp.workspace.limits import Limits
from gsp.workspace.mapping import section
from gsp.workspace.maps import IndexMap, index_map
from gsp.workspace.planar import corner_poses, planar_section, radiating_point
from gsp.workspace.sections import BifurcationPoint, Curve, Section
from gsp.workspace.shells import Shells, Volume, fixed_orientation
from gsp.workspace.surfaces import Surface, surface

__all__ = [
    "BifurcationPoint",
    "Curve",
    "Dextrous",
    "Feasibility",
    "IndexMap",
    "Limits",
    "Section",
    "Shells",
    "Surface",
    "Volume",
    "bifurcation_point",
    "corner_poses",
    "dextrous",
    "feasible",
    "fixed_orientation",
    "index_map",
    "planar_section",
    "radiating_point",
    "section",
    "surface",
]
