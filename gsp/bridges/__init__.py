"""Bridges to other people's software: Pinocchio, MuJoCo, URDF."""

from gsp.bridges.agreement import Agreement, agreement
from gsp.bridges.pinocchio_model import PinocchioModel, to_pinocchio

__all__ = ["Agreement", "PinocchioModel", "agreement", "to_pinocchio"]
