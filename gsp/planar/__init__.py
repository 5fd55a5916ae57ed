"""Planar platforms with three freedoms: the plane counterpart of designs, poses and postures."""

from gsp.planar import families, indices
from gsp.planar.catalogue import PlanarMechanism, mechanism, mechanisms, table
from gsp.planar.constraints import PLANAR_CONSTRAINT, PLANAR_CONSTRAINTS, PlanarConstraint
from gsp.planar.design import PlanarDesign
from gsp.planar.pose import PlanarPose
from gsp.planar.posture import PlanarPosture

__all__ = [
    "PLANAR_CONSTRAINT",
    "PLANAR_CONSTRAINTS",
    "PlanarConstraint",
    "PlanarDesign",
    "PlanarMechanism",
    "PlanarPose",
    "PlanarPosture",
    "families",
    "indices",
    "mechanism",
    "mechanisms",
    "table",
]
