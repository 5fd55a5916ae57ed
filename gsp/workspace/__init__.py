"""Workspaces: the positions and poses that the limits of a design allow."""

from gsp.limits import Feasibility, Limits, feasible
from gsp.workspace.boundary.bifurcation import bifurcation_point
from gsp.workspace.boundary.mapping import section
from gsp.workspace.boundary.sections import BifurcationPoint, Curve, Section
from gsp.workspace.chains import curve_chain
from gsp.workspace.exact.fixed_orientation import exact_shells
from gsp.workspace.exact.shells import Shells
from gsp.workspace.labelled import LabelledBoundary, boundary_curves
from gsp.workspace.maps import IndexMap, index_map
from gsp.workspace.sets.inside.regular import RegularPart
from gsp.workspace.sets.inside.samples import IndexSample
from gsp.workspace.sets.inside.worst import Worst
from gsp.workspace.sets.questions import dextrous, fixed_orientation, orientations, reachable
from gsp.workspace.sets.region.regions import Region
from gsp.workspace.sets.region.sampling import Estimate
from gsp.workspace.sets.shapes.inscribed import Inscribed
from gsp.workspace.sets.shapes.polygons import Polygons
from gsp.workspace.surfaces import Surface, surface
from gsp.workspace.volumes import Volume

__all__ = [
    "BifurcationPoint",
    "Curve",
    "Estimate",
    "Feasibility",
    "IndexMap",
    "IndexSample",
    "Inscribed",
    "LabelledBoundary",
    "Limits",
    "Polygons",
    "Region",
    "RegularPart",
    "Section",
    "Shells",
    "Surface",
    "Volume",
    "Worst",
    "bifurcation_point",
    "boundary_curves",
    "curve_chain",
    "dextrous",
    "exact_shells",
    "feasible",
    "fixed_orientation",
    "index_map",
    "orientations",
    "reachable",
    "section",
    "surface",
]
