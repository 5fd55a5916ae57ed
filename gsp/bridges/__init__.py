"""Bridges to other people's software: Pinocchio, MuJoCo, URDF."""

from gsp.bridges.agreement import Agreement, agreement
from gsp.bridges.export import export
from gsp.bridges.mjcf import to_mjcf
from gsp.bridges.mujoco_rates import mujoco_rates
from gsp.bridges.pinocchio_model import PinocchioModel, to_pinocchio
from gsp.bridges.pinocchio_rates import pinocchio_rates
from gsp.bridges.rates import LegRates, Rates
from gsp.bridges.rendering import render
from gsp.bridges.simulation import Simulation, simulate
from gsp.bridges.solids import Solids
from gsp.bridges.urdf import Urdf, to_urdf

__all__ = [
    "Agreement",
    "LegRates",
    "PinocchioModel",
    "Rates",
    "Simulation",
    "Solids",
    "Urdf",
    "agreement",
    "export",
    "mujoco_rates",
    "pinocchio_rates",
    "render",
    "simulate",
    "to_mjcf",
    "to_pinocchio",
    "to_urdf",
]
