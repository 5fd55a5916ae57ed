"""Designs as multibody models of Pinocchio, and the rates of their joints."""

from gsp.bridges.pinocchio.model import PinocchioModel, to_pinocchio
from gsp.bridges.pinocchio.rates import pinocchio_rates

__all__ = ["PinocchioModel", "pinocchio_rates", "to_pinocchio"]
