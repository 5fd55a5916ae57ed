"""Forward kinematics, and fast evaluation of one pose after another."""

from gsp.kinematics.forward import ForwardSolution, forward
from gsp.kinematics.prepared import prepare

__all__ = ["ForwardSolution", "forward", "prepare"]
