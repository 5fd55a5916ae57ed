"""Planar platforms with three degrees of freedom: their designs, poses and postures."""

from gsp.planar import families, indices
from gsp.planar.catalogue import PlanarMechanism, mechanism, mechanisms, table
from gsp.planar.constraints import PLANAR_CONSTRAINT, PLANAR_CONSTRAINTS, PlanarConstraint
from gsp.planar.corners import corner_poses, radiating_point
from gsp.planar.design import PlanarDesign, read_planar_design
from gsp.planar.outlines import Piece, PlanarComponent, planar_components
from gsp.planar.pose import PlanarPose
from gsp.planar.posture import PlanarPosture
from gsp.planar.published import planar_design, planar_design_names
from gsp.planar.workspace import on_boundary, planar_section

__all__ = [
    "PLANAR_CONSTRAINT",
    "PLANAR_CONSTRAINTS",
    "Piece",
    "PlanarComponent",
    "PlanarConstraint",
    "PlanarDesign",
    "PlanarMechanism",
    "PlanarPose",
    "PlanarPosture",
    "corner_poses",
    "families",
    "indices",
    "mechanism",
    "mechanisms",
    "on_boundary",
    "planar_components",
    "planar_design",
    "planar_design_names",
    "planar_section",
    "radiating_point",
    "read_planar_design",
    "table",
]
