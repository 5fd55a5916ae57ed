"""Models of other software, written and read, and comparison: Pinocchio, MuJoCo, URDF, SDF."""

from gsp.bridges.agreements import Agreement, agreement
from gsp.bridges.exports import export
from gsp.bridges.formats.sdf import Sdf, to_sdf
from gsp.bridges.formats.urdf import Urdf, to_urdf
from gsp.bridges.links.drives import Drives
from gsp.bridges.links.solids import Solids, masses
from gsp.bridges.mujoco import Simulation, mujoco_rates, render, render_motion, simulate, to_mjcf
from gsp.bridges.pinocchio import PinocchioModel, pinocchio_rates, to_pinocchio
from gsp.bridges.rates import LegRates, Rates
from gsp.bridges.reading import read_model

__all__ = [
    "Agreement",
    "Drives",
    "LegRates",
    "PinocchioModel",
    "Rates",
    "Sdf",
    "Simulation",
    "Solids",
    "Urdf",
    "agreement",
    "export",
    "masses",
    "mujoco_rates",
    "pinocchio_rates",
    "read_model",
    "render",
    "render_motion",
    "simulate",
    "to_mjcf",
    "to_pinocchio",
    "to_sdf",
    "to_urdf",
]
