"""Postures: designs at poses, evaluated by the formulas of their legs."""

from gsp.model.posture.evaluated import Evaluated, Undefined
from gsp.model.posture.postures import Lines, Posture, Segments

__all__ = ["Evaluated", "Lines", "Posture", "Segments", "Undefined"]
