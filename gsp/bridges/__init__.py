"""Bridges to other people's software: Pinocchio, MuJoCo, URDF."""

from gsp.bridges.agreement import Agreement, agreement
from gsp.bridges.export import export
from gsp.bridges.mjcf import to_mjcf
from gsp.bridges.pinocchio_model import PinocchioModel, to_pinocchio
from gsp.bridges.rendering import render
from gsp.bridges.simulation import Simulation, actuator_jacobian, simulate
from gsp.bridges.solids import Solids
from gsp.bridges.urdf import Urdf, to_urdf

__all__ = [
    "Agreement",
    "PinocchioModel",
    "Simulation",
    "Solids",
    "Urdf",
    "actuator_jacobian",
    "agreement",
    "export",
    "render",
    "simulate",
    "to_mjcf",
    "to_pinocchio",
    "to_urdf",
]
