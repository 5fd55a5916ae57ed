"""Postures: designs at poses, evaluated by the formulas of their legs."""

from gsp.model.posture.evaluated import Evaluated
from gsp.model.posture.postures import Posture

__all__ = ["Evaluated", "Posture"]
